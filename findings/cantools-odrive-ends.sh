#!/usr/bin/env bash
# cantools 45.1.0 and the scaled signals of ODrive's Set_Input_Pos: beyond the ends it is no error of cantools that is raised.
#
# Vel_FF and Torque_FF are 16-bit signals of 0.001 a step, without a stated range ([0|0]). Seen:
#   Torque_FF 32.767 N*m   sent
#   Torque_FF 32.768 N*m   OverflowError of Python, with strict=False, too; it is no cantools.Error
#   Torque_FF NaN          ValueError of Python; Input_Pos, a float signal, takes NaN without a word
# Where it bites: a loop that guards its sending with "except cantools.Error" ends at the first torque that is
# too great, with the motor still under its last command; with another package (moteus) the same torque would
# have been cut off at the end.
# Instead: clamp to ±32.767 and test for finite numbers before encode, and command zero from a finally.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check cantools==45.1.0 bitstruct==8.24.0
cd "$work"
venv/bin/python - <<'PYTHON'
import math

import cantools

database = cantools.database.load_string(
    """VERSION ""
BU_: Master
BO_ 12 Set_Input_Pos: 8 Master
 SG_ Input_Pos : 0|32@1- (1,0) [0|0] "rev" Vector__XXX
 SG_ Vel_FF : 32|16@1- (0.001,0) [0|0] "rev/s" Vector__XXX
 SG_ Torque_FF : 48|16@1- (0.001,0) [0|0] "Nm" Vector__XXX
SIG_VALTYPE_ 12 Input_Pos : 1;
""",
    "dbc",
)


def outcome(position, torque, strict=True):
    try:
        sent = database.encode_message(12, {"Input_Pos": position, "Vel_FF": 0, "Torque_FF": torque}, strict=strict)
    except Exception as error:
        said = type(error).__name__, isinstance(error, cantools.Error)
    else:
        said = "sent", int.from_bytes(sent[6:], "little", signed=True)
    print(f"Input_Pos {position}, Torque_FF {torque}, strict {strict}: {said}")
    return said


assert outcome(0.0, 32.767) == ("sent", 32767)
assert outcome(0.0, 32.768) == ("OverflowError", False)
assert outcome(0.0, 32.768, strict=False) == ("OverflowError", False)
assert outcome(0.0, math.nan) == ("ValueError", False)
assert outcome(math.nan, 0.0) == ("sent", 0)
print("as described")
PYTHON
