#!/usr/bin/env bash
# moteus 1.1.1: at an integer resolution a command is cut towards zero, held at the type's end, and infinity becomes "not given".
#
# make_position with PositionResolution of INT16, and what is on the wire. Seen, without a word:
#   feedforward_torque 0.29 N*m        28 steps of 0.01: 0.28 (0.29/0.01 is 28.99…, and the rest is cut off, not rounded)
#   feedforward_torque ±0.0099 N*m     0: the step at zero is twice as wide as the others
#   position 0.3 turns                 2999 steps of 0.0001
#   position 3.5 turns                 32767: 3.2767 turns is the end, to either side
#   kp_scale 1.5                       32767, which is 1.0
#   maximum_torque infinity            -32768, the code of NaN: "use the one that is configured"
# Where it bites: INT16 halves the frame, which tempts at 1 kHz and more. A force law then loses up to a step
# towards zero, always (a weaker spring, a dead band), and a handle that has turned more than 3.27 turns is
# told to go back.
# Instead: F32 (the default) for position and torque; round to whole steps yourself; keep the zero of the
# position near.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check moteus==1.1.1
cd "$work"
venv/bin/python - <<'PYTHON'
import math

import moteus
from moteus import multiplex

resolution = moteus.PositionResolution()
resolution.position = resolution.feedforward_torque = moteus.INT16
resolution.kp_scale = resolution.maximum_torque = moteus.INT16
controller = moteus.Controller(id=1, position_resolution=resolution)


def steps(register, **command):
    frame = controller.make_position(query=False, **command)
    (value,) = [part.value for part in multiplex.parse_frame(frame.data) if part.register == register]
    print(command, "is sent as", value)
    return value


names = moteus.Register
assert steps(names.COMMAND_FEEDFORWARD_TORQUE, position=math.nan, feedforward_torque=0.29) == 28
assert steps(names.COMMAND_FEEDFORWARD_TORQUE, position=math.nan, feedforward_torque=0.0099) == 0
assert steps(names.COMMAND_FEEDFORWARD_TORQUE, position=math.nan, feedforward_torque=-0.0099) == 0
assert steps(names.COMMAND_POSITION, position=0.3) == 2999
assert steps(names.COMMAND_POSITION, position=3.5) == 32767
assert steps(names.COMMAND_POSITION, position=-3.5) == -32767
assert steps(names.COMMAND_KP_SCALE, position=math.nan, kp_scale=1.5) == 32767
assert steps(names.COMMAND_POSITION_MAX_TORQUE, position=math.nan, maximum_torque=math.inf) == -32768
print("as described")
PYTHON
