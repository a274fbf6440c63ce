#!/usr/bin/env bash
# mujoco 4.0.0: in a file that counts in degrees, an actuator's range stays in radians.
#
# MJCF counts angles in degrees unless told otherwise. One hinge with range="-90 90", springref="45",
# stiffness="1". Seen:
#   joint range, springref        ±1.5708 rad, 0.7854 rad: turned into radians
#   stiffness                     1 N*m/rad: never per degree
#   <position ctrlrange="-90 90"> ±90, which are radians: 14 turns to either side
#   <position inheritrange="1">   ±1.5708
# Where it bites: the limit that should keep a commanded position inside the joint's range keeps nothing, and
# the spring of the position actuator (kp) pulls with kp times 90 rad where 1.57 was meant.
# Instead: inheritrange="1", or <compiler angle="radian"/> and one unit in the whole file.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check mujoco==4.0.0 mujoco-core==4.0.0 numpy==2.4.6
cd "$work"
venv/bin/python - <<'PYTHON'
import mujoco
import numpy as np

model = mujoco.MjModel.from_xml_string(
    '<mujoco><worldbody><body><joint name="j" range="-90 90" springref="45" stiffness="1"/><geom size="0.1"/></body></worldbody>'
    '<actuator><position name="typed" joint="j" kp="10" ctrlrange="-90 90"/>'
    '<position name="taken over" joint="j" kp="10" inheritrange="1"/></actuator></mujoco>'
)
quarter = np.pi / 2
print("joint", model.jnt_range, model.qpos_spring, model.jnt_stiffness.ravel(), "actuators", model.actuator_ctrlrange.tolist())
assert np.allclose(model.jnt_range, [[-quarter, quarter]])
assert np.allclose(model.qpos_spring, quarter / 2)
assert model.actuator_ctrlrange.tolist()[0] == [-90.0, 90.0]
assert np.allclose(model.actuator_ctrlrange[1], [-quarter, quarter])
data = mujoco.MjData(model)
data.ctrl[0] = 90.0
mujoco.mj_forward(model, data)
print("torque of the first at ctrl 90:", data.actuator_force[0], "N*m")
assert np.isclose(data.actuator_force[0], 900.0)
print("as described")
PYTHON
