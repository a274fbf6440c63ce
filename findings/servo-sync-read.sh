#!/usr/bin/env bash
# A sync read in which one servo of three is silent: dynamixel-sdk 4.1.0 and feetech-servo-sdk 1.0.0.
#
# Servos 1, 2, 3 answer 100, 200, 300; in the next cycle they hold 111, 222, 333 and servo 2 says nothing.
# Seen:
#   dynamixel-sdk      result -3001, getData 0, 0, 0: the answer of servo 1, which came, is hidden, too
#   feetech-servo-sdk  result -6, getData 111, 0, 300: servo 1 is new, servo 2 is 0, servo 3 is the OLD value, and
#                      isAvailable says True of it
#   both               the call comes back after 34 ms or more (2 x 16 ms + 2 ms, fixed in the code), whatever the baud rate
# Where it bites: a 0 is a valid position, so a spring pulls to it with all its force; an old position is a
# loop that runs late; and for 34 ms the motors hold the last torque, which is 34 samples of a 1 kHz loop.
# Instead: look at the result of txRxPacket before any getData; after a failure use none of its values and
# send zero force; make packet_timeout short with a port handler of your own.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check dynamixel-sdk==4.1.0 feetech-servo-sdk==1.0.0 pyserial==3.5
cd "$work"
venv/bin/python - <<'PYTHON'
import time

import dynamixel_sdk
import scservo_sdk

held = {}
silent = set()


def feetech_answers(packet):
    assert packet[4] == scservo_sdk.INST_SYNC_READ
    for servo in packet[7:-1]:
        if servo not in silent:
            body = bytes([servo, 4, 0]) + held[servo].to_bytes(2, "little")
            yield b"\xff\xff" + body + bytes([~sum(body) & 255])


def dynamixel_answers(packet):
    assert packet[7] == dynamixel_sdk.INST_SYNC_READ
    for servo in packet[12:-2]:
        if servo not in silent:
            body = b"\xff\xff\xfd\x00" + bytes([servo, 6, 0, 0x55, 0]) + held[servo].to_bytes(2, "little")
            yield body + dynamixel_sdk.PacketHandler(2.0).updateCRC(0, body, len(body)).to_bytes(2, "little")


def bus(sdk, answers):
    class Bus(sdk.PortHandler):
        """The servos' side of the wire, in memory."""

        waiting = b""

        def clearPort(self):
            pass

        def getBytesAvailable(self):
            return len(self.waiting)

        def writePort(self, packet):
            self.waiting += b"".join(answers(bytes(packet)))
            return len(packet)

        def readPort(self, length):
            read, self.waiting = self.waiting[:length], self.waiting[length:]
            return read

    return Bus("in memory")


def two_cycles(sdk, handler, answers):
    group = sdk.GroupSyncRead(bus(sdk, answers), handler, 56, 2)
    for servo in (1, 2, 3):
        group.addParam(servo)
    held.update({1: 100, 2: 200, 3: 300})
    silent.clear()
    assert group.txRxPacket() == sdk.COMM_SUCCESS
    assert [group.getData(servo, 56, 2) for servo in (1, 2, 3)] == [100, 200, 300]
    held.update({1: 111, 2: 222, 3: 333})
    silent.add(2)
    start = time.monotonic()
    result = group.txRxPacket()
    took = time.monotonic() - start
    seen = [group.getData(servo, 56, 2) for servo in (1, 2, 3)]
    told = [group.isAvailable(servo, 56, 2) for servo in (1, 2, 3)]
    print(f"{sdk.__name__}: result {result}, data {seen}, available {told}, after 34 ms or more: {took >= 0.0339}")
    assert took >= 0.0339, took
    return result, seen, told


assert two_cycles(dynamixel_sdk, dynamixel_sdk.PacketHandler(2.0), dynamixel_answers) == (-3001, [0, 0, 0], [False] * 3)
assert two_cycles(scservo_sdk, scservo_sdk.PacketHandler(0), feetech_answers) == (-6, [111, 0, 300], [True, False, True])
print("as described")
PYTHON
