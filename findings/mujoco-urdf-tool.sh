#!/usr/bin/env bash
# A URDF's tool, a link without mass on a fixed joint: mujoco 4.0.0 and urchin 0.0.30.
#
# base - j1 - l1 (0.2 kg) - fixed, 0.3 m - tip. The tip is where the hand is and has no <inertial>. Seen:
#   mujoco   bodies world and l1: tip is gone, name2id gives -1; with <mujoco><compiler fusestatic="false"/></mujoco> in the URDF
#            it is there, without mass
#   urchin   tip has 1 kg and 1 kg*m² about each axis, base too; save() writes them into the file as if they had been stated
#   yourdfpy 0.0.60   tip is there, inertial None
# Where it bites: with -1 as an index NumPy takes the last body, in silence, so the Jacobian of "the tip" is
# that of another point; and a handle of 0.2 kg becomes one of 1.2 kg, with which a virtual wall looks far
# calmer than it is.
# Instead: ask whether each name was found; write fusestatic into the URDF; take masses from a reader that
# leaves out what is not there.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check \
  mujoco==4.0.0 mujoco-core==4.0.0 urchin==0.0.30 yourdfpy==0.0.60 numpy==2.4.6
cd "$work"
venv/bin/python - <<'PYTHON'
import mujoco
import numpy as np
import urchin
import yourdfpy

URDF = (
    '<robot name="handle"><link name="base"/><link name="l1"><inertial><mass value="0.2"/>'
    '<inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial></link><link name="tip"/>'
    '<joint name="j1" type="continuous"><parent link="base"/><child link="l1"/><axis xyz="0 0 1"/></joint>'
    '<joint name="end" type="fixed"><parent link="l1"/><child link="tip"/><origin xyz="0.3 0 0"/></joint></robot>'
)
KEEP = '<robot name="handle"><mujoco><compiler fusestatic="false"/></mujoco>'
with open("handle.urdf", "w") as file:
    file.write(URDF)


def found(text):
    model = mujoco.MjModel.from_xml_string(text)
    names = [model.body(number).name for number in range(model.nbody)]
    at = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, "tip")
    print("mujoco:", names, "tip is", at, "masses", model.body_mass.tolist())
    return names, at


assert found(URDF) == (["world", "l1"], -1)
assert found(URDF.replace('<robot name="handle">', KEEP)) == (["world", "base", "l1", "tip"], 3)

read = urchin.URDF.load("handle.urdf")
masses = {link.name: link.inertial.mass for link in read.links}
print("urchin:", masses, read.link_map["tip"].inertial.inertia.tolist())
assert masses == {"base": 1.0, "l1": 0.2, "tip": 1.0}
assert np.array_equal(read.link_map["tip"].inertial.inertia, np.eye(3))
read.save("saved.urdf")
assert open("saved.urdf").read().count("<mass ") == 3 and URDF.count("<mass ") == 1

bare = {link.name: link.inertial for link in yourdfpy.URDF.load("handle.urdf").robot.links}
print("yourdfpy:", {name: inertial and inertial.mass for name, inertial in bare.items()})
assert bare["tip"] is None and bare["base"] is None and bare["l1"].mass == 0.2
print("as described")
PYTHON
