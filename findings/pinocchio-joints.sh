#!/usr/bin/env bash
# pin 4.1.0: what a URDF says of damping and friction is read and not used, and a continuous joint takes two numbers.
#
# One continuous joint, <dynamics damping="0.3" friction="0.2"/>, turning at 2 rad/s without torque; then a
# revolute one behind it. Seen:
#   model.damping, upperDryFrictionLimit   0.3, 0.2: they are read
#   aba (acceleration), rnea (torque)      0 and 0: they are not used; mujoco 4.0.0 slows the same file at 40 rad/s²
#   nq, nv                                 3, 2: the first joint's place in q is (cos, sin), so q[1] is not joint 2
#   position limits of the first           ±1.01 twice: they are those of cosine and sine, no angle of ±1.01 rad
# Where it bites: damping is what a virtual wall lives on: a simulation by aba has none, an energy balance
# from rnea misses what the joint takes. An index of joints used in q is off by one after each continuous
# joint, and a range of ±58° is read that no one stated.
# Instead: subtract damping * v and the dry friction yourself; model.idx_qs / idx_vs for places; infinite
# limits where nq is 2.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check pin==4.1.0 mujoco==4.0.0 mujoco-core==4.0.0 numpy==2.4.6
cd "$work"
venv/bin/python - <<'PYTHON'
import mujoco
import numpy as np
import pinocchio

LINK = (
    '<link name="{}"><inertial><origin xyz="0 0 0"/><mass value="1"/>'
    '<inertia ixx="0.01" iyy="0.01" izz="0.02" ixy="0" ixz="0" iyz="0"/></inertial></link>'
)
WHEEL = (
    '<joint name="j1" type="continuous"><parent link="base"/><child link="l1"/><axis xyz="0 0 1"/>'
    '<limit effort="5" velocity="7"/><dynamics damping="0.3" friction="0.2"/></joint>'
)
SECOND = (
    '<joint name="j2" type="revolute"><parent link="l1"/><child link="l2"/><axis xyz="0 0 1"/>'
    '<limit lower="-2" upper="2" effort="5" velocity="7"/></joint>'
)
wheel = '<robot name="r"><link name="base"/>' + LINK.format("l1") + WHEEL
model = pinocchio.buildModelFromXML(wheel + "</robot>")
data, rest, turning = model.createData(), pinocchio.neutral(model), np.array([2.0])
read = float(model.damping[0]), float(model.upperDryFrictionLimit[0])
slowed = float(pinocchio.aba(model, data, rest, turning, np.zeros(1))[0])
torque = float(pinocchio.rnea(model, data, rest, turning, np.zeros(1))[0])
print("pin: damping and friction", read, "acceleration", slowed, "torque", torque)
assert (read, slowed, torque) == ((0.3, 0.2), 0.0, 0.0)

theirs = mujoco.MjModel.from_xml_string(wheel + "</robot>")
state = mujoco.MjData(theirs)
state.qvel[0] = 2.0
mujoco.mj_forward(theirs, state)
print("mujoco: acceleration", state.qacc[0])
assert np.isclose(state.qacc[0], -(0.3 * 2 + 0.2) / 0.02, rtol=1e-3)

both = pinocchio.buildModelFromXML(wheel + LINK.format("l2") + SECOND + "</robot>")
print("with a second joint: nq, nv", (both.nq, both.nv), "places in q", both.idx_qs.tolist(), "limits", both.upperPositionLimit)
assert (both.nq, both.nv, both.idx_qs.tolist()[1:]) == (3, 2, [0, 2])
assert both.upperPositionLimit.tolist() == [1.01, 1.01, 2.0]
print("as described")
PYTHON
