#!/usr/bin/env bash
# A second torque given to a sync write is not sent: dynamixel-sdk 4.1.0 and feetech-servo-sdk 1.0.0.
#
# In a loop: group.addParam(servo, torque), group.txPacket(). Seen, with 100 in the first cycle and 0 in the
# second:
#   addParam comes back True, then False; txPacket says success both times; both packets on the wire carry 100
# addParam refuses a servo that is in the group already, and its answer is easily passed over.
# Where it bites: the servo keeps its first torque for ever, and a "zero on exit" sent the same way is not
# sent.
# Instead: changeParam from the second cycle on, or clearParam after every txPacket, and look at what both
# give back.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check dynamixel-sdk==4.1.0 feetech-servo-sdk==1.0.0 pyserial==3.5
cd "$work"
venv/bin/python - <<'PYTHON'
import dynamixel_sdk
import scservo_sdk


def sent(sdk, handler, torque_at, tail):
    packets = []

    class Bus(sdk.PortHandler):
        def clearPort(self):
            pass

        def writePort(self, packet):
            packets.append(bytes(packet))
            return len(packet)

    group = sdk.GroupSyncWrite(Bus("in memory"), handler, torque_at, 2)
    told = []
    for torque in (100, 0):
        added = group.addParam(1, [torque & 255, torque >> 8])
        told.append((added, group.txPacket() == sdk.COMM_SUCCESS))
    group.changeParam(1, [0, 0])
    group.txPacket()
    torques = [int.from_bytes(packet[-2 - tail : -tail], "little") for packet in packets]
    print(f"{sdk.__name__}: (added, sent) {told}, torques on the wire {torques}, the last one by changeParam")
    return told, torques


for seen in (
    sent(dynamixel_sdk, dynamixel_sdk.PacketHandler(2.0), 102, tail=2),
    sent(scservo_sdk, scservo_sdk.PacketHandler(0), 48, tail=1),
):
    assert seen == ([(True, True), (False, True)], [100, 100, 0]), seen
print("as described")
PYTHON
