#!/usr/bin/env bash
# feetech-servo-sdk 1.0.0: the byte order is one for the whole process, that of the packet handler that was made last.
#
# STS and SMS servos send the low byte first (PacketHandler(0)), SCS servos the high byte (PacketHandler(1)).
# Seen, of an STS servo at position 111, read through its own handler:
#   111 before a second handler is made, 28416 (0x6F00) after PacketHandler(1) was made for another bus
# Where it bites: an arm of STS servos with a gripper of the SCS series: positions jump by the factor 256, and
# torques that are written, too. The object that you hold is not what decides.
# Instead: one kind of servo in a process, or call SCS_SETEND before every exchange, with a lock where there
# are threads.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check feetech-servo-sdk==1.0.0 pyserial==3.5
cd "$work"
venv/bin/python - <<'PYTHON'
import scservo_sdk


class OneServo(scservo_sdk.PortHandler):
    """An STS servo with the id 1 that holds 111, low byte first, in every register."""

    waiting = b""

    def clearPort(self):
        pass

    def getBytesAvailable(self):
        return len(self.waiting)

    def writePort(self, packet):
        body = bytes([1, 4, 0, 111, 0])
        self.waiting += b"\xff\xff" + body + bytes([~sum(body) & 255])
        return len(packet)

    def readPort(self, length):
        read, self.waiting = self.waiting[:length], self.waiting[length:]
        return read


port = OneServo("in memory")
sts = scservo_sdk.PacketHandler(0)
before = sts.read2ByteTxRx(port, 1, 56)
scs = scservo_sdk.PacketHandler(1)
after = sts.read2ByteTxRx(port, 1, 56)
print("position, result, error:", before, "and, with another handler alive,", after)
assert before == (111, 0, 0), before
assert after == (0x6F00, 0, 0), after
print("as described")
PYTHON
