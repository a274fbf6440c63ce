#!/usr/bin/env bash
# A negative reading of a bus servo: dynamixel-sdk 4.1.0 and feetech-servo-sdk 1.0.0 both hand out the bare word.
#
# The call has one name in both, read2ByteTxRx, and gives a number that is never negative. -5 is
#   65531  in a Dynamixel's present current (two's complement)
#   1029   in a Feetech STS's present load (sign in bit 10)
#   32773  in a Feetech STS's present position or speed (sign in bit 15)
# Feetech's own SCS_TOHOST puts the sign right only with the bit of that register; with the wrong one it says
# nothing: load 1029 read with bit 15 stays 1029, speed 32773 read with bit 10 stays 32773. Dynamixel's
# package has no function for it at all.
# Where it bites: just left of zero a spring is given a position of eight turns, or a current of the full
# scale; code ported from one maker to the other runs without an error and is right on one side of zero.
# Instead: a table of registers with width and way of the sign, and a test with -1 for each of them.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check dynamixel-sdk==4.1.0 feetech-servo-sdk==1.0.0 pyserial==3.5
cd "$work"
venv/bin/python - <<'PYTHON'
import dynamixel_sdk
import scservo_sdk


def read(sdk, handler, packet):
    class OneServo(sdk.PortHandler):
        waiting = b""

        def clearPort(self):
            pass

        def getBytesAvailable(self):
            return len(self.waiting)

        def writePort(self, sent):
            self.waiting += packet
            return len(sent)

        def readPort(self, length):
            out, self.waiting = self.waiting[:length], self.waiting[length:]
            return out

    value, result, error = handler.read2ByteTxRx(OneServo("in memory"), 1, 56)
    assert (result, error) == (sdk.COMM_SUCCESS, 0)
    return value


def feetech(word):
    body = bytes([1, 4, 0]) + word.to_bytes(2, "little")
    return b"\xff\xff" + body + bytes([~sum(body) & 255])


def dynamixel(word):
    body = b"\xff\xff\xfd\x00" + bytes([1, 6, 0, 0x55, 0]) + word.to_bytes(2, "little")
    return body + dynamixel_sdk.PacketHandler(2.0).updateCRC(0, body, len(body)).to_bytes(2, "little")


current = read(dynamixel_sdk, dynamixel_sdk.PacketHandler(2.0), dynamixel(-5 & 0xFFFF))
load = read(scservo_sdk, scservo_sdk.PacketHandler(0), feetech(5 | 1 << 10))
speed = read(scservo_sdk, scservo_sdk.PacketHandler(0), feetech(5 | 1 << 15))
print("-5 is read as", current, load, speed)
assert (current, load, speed) == (65531, 1029, 32773)
right = scservo_sdk.SCS_TOHOST(load, 10), scservo_sdk.SCS_TOHOST(speed, 15)
wrong = scservo_sdk.SCS_TOHOST(load, 15), scservo_sdk.SCS_TOHOST(speed, 10)
print("SCS_TOHOST with the right bit", right, "with the other", wrong)
assert right == (-5, -5)
assert wrong == (1029, 32773)
print("as described")
PYTHON
