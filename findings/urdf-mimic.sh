#!/usr/bin/env bash
# A URDF joint that mimics another, in four readers: pin 4.1.0, mujoco 4.0.0, yourdfpy 0.0.60, urchin 0.0.30.
#
# j2 follows j1: twice as far, plus 0.1 rad. The mechanism has one degree of freedom. Seen:
#   pin                 2 (nv); 1 only with mimic=True, which has to be asked for
#   mujoco              2, and an equality, soft: 5 N*m on j2 take it 0.009 rad off j1 in 0.1 s
#   yourdfpy, urchin    1
#   yourdfpy, write_xml_file   writes the file without <mimic>: read again, it is an arm of 2
# Where it bites: the stiffness and the mass at the tip are those of another machine: a gripper or a
# parallelogram becomes limp. Converting a description through yourdfpy changes the mechanism for good.
# Instead: ask each reader for its number of degrees of freedom; mimic=True in pin; after writing, count
# <mimic> in the file.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check \
  pin==4.1.0 mujoco==4.0.0 mujoco-core==4.0.0 urchin==0.0.30 yourdfpy==0.0.60 numpy==2.4.6
cd "$work"
venv/bin/python - <<'PYTHON'
import mujoco
import pinocchio
import urchin
import yourdfpy

LINK = (
    '<link name="{}"><inertial><origin xyz="0.1 0 0"/><mass value="1"/>'
    '<inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial></link>'
)
JOINT = (
    '<joint name="{}" type="revolute"><parent link="{}"/><child link="{}"/><origin xyz="0.2 0 0"/><axis xyz="0 0 1"/>'
    '<limit lower="-2" upper="2" effort="6" velocity="3"/>{}</joint>'
)
URDF = (
    '<robot name="linkage"><link name="base"/>' + LINK.format("l1") + LINK.format("l2") + JOINT.format("j1", "base", "l1", "")
    + JOINT.format("j2", "l1", "l2", '<mimic joint="j1" multiplier="2" offset="0.1"/>') + "</robot>"
)
with open("linkage.urdf", "w") as file:
    file.write(URDF)

plain, asked = pinocchio.buildModelFromUrdf("linkage.urdf").nv, pinocchio.buildModelFromUrdf("linkage.urdf", mimic=True).nv
print("pin:", plain, "and with mimic=True", asked)
assert (plain, asked) == (2, 1)

model = mujoco.MjModel.from_xml_string(URDF)
model.opt.gravity[:] = 0
data = mujoco.MjData(model)
data.qpos[1] = 0.1
worst = 0.0
data.qfrc_applied[1] = 5.0
for _ in range(50):
    mujoco.mj_step(model, data)
    worst = max(worst, abs(data.qpos[1] - 2 * data.qpos[0] - 0.1))
print("mujoco:", model.nv, "with", model.neq, "equality; off by up to", worst, "rad")
assert (model.nv, model.neq) == (2, 1)
assert 0.005 < worst < 0.02, worst

ours, theirs = yourdfpy.URDF.load("linkage.urdf"), urchin.URDF.load("linkage.urdf")
print("yourdfpy:", ours.num_dofs, "urchin:", len(theirs.actuated_joints))
assert ours.num_dofs == len(theirs.actuated_joints) == 1
ours.write_xml_file("written.urdf")
again = yourdfpy.URDF.load("written.urdf").num_dofs
print("yourdfpy, written and read:", again)
assert again == 2 and "mimic" not in open("written.urdf").read()
print("as described")
PYTHON
