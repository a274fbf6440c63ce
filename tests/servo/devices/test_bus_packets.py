"""Packets of Dynamixel's Protocol 2.0 and of Feetech's bus servos, byte by byte."""

import os
from functools import partial

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from servo.emulators import dynamixel as x_series
from servo.emulators import feetech as sts

from zwidth.machine.servo.connection import CLOSED, GARBLED, GOOD, REFUSED, SILENT, STALE
from zwidth.machine.servo.devices import dynamixel_packets, feetech
from zwidth.machine.servo.posix import now

OUT = np.zeros(512, np.uint8)


def heard(receive, data, count):
    """What becomes of these bytes, all of them there at once; the state and parameters of the answer."""
    near, far = os.pipe()
    os.set_blocking(near, False)
    os.write(far, data)
    inbox = np.zeros(512, np.uint8)
    status = receive(near, inbox, 1, count, now() - 1)
    os.close(near)
    os.close(far)
    return status, inbox[: count + 1].tobytes()


dynamixel_heard = partial(heard, dynamixel_packets.receive)
feetech_heard = partial(heard, feetech.receive)
BUSES = [dynamixel_heard, feetech_heard]


def status_of(bus, parameters, identifier=1, state=0):
    packet, kind = (sts.packet, b"") if bus is feetech_heard else (x_series.packet, b"\x55")
    return packet(identifier, kind + bytes([state, *parameters]))


def test_the_question_and_the_answer_of_the_e_manual():
    """ "Read": present position, 4 bytes at 132 of servo 1; it is 166."""
    count = dynamixel_packets.put_read(OUT, 1, 132, 4)
    assert OUT[:count].tobytes().hex(" ") == "ff ff fd 00 01 07 00 02 84 00 04 00 1d 15"
    status, answer = dynamixel_heard(bytes.fromhex("fffffd000108005500a60000008cc0"), 4)
    assert (status, answer.hex()) == (GOOD, "00a6000000")


def test_the_question_and_the_answer_of_the_protocol_manual():
    """The position of servo 1: 2 bytes at 38 hex; it is 0518 hex."""
    count = feetech.put_read(OUT, 1, 0x38, 2)
    assert OUT[:count].tobytes().hex(" ") == "ff ff 01 04 02 38 02 be"
    assert feetech_heard(bytes.fromhex("ffff0104001805dd"), 2) == (GOOD, b"\x00\x18\x05")


@pytest.mark.parametrize(
    ("asked", "answered"),
    [
        ("fffffd00 01 0300 01 194e", "fffffd00 01 0700 55 00 0604 26 655d"),  # ping: model 1030, firmware 38
        ("fffffd00 01 0900 03 7400 00020000 ca89", "fffffd00 01 0400 55 00 a10c"),
        ("fffffd00 fe 0900 82 8400 0400 01 02 cefa", "fffffd00 01 0800 55 00 a6000000 8cc0"),
    ],
    ids=["ping", "write", "sync read"],
)
def test_the_emulator_answers_as_the_e_manual(asked, answered):
    """ "Ping", "Write" and "Sync Read" of Protocol 2.0, byte by byte."""
    said = []
    with x_series.DynamixelEmulator([166], model=1030, firmware=38) as other:
        other.write = said.append
        other.hear(bytes.fromhex(asked))
    assert b"".join(said).hex() == answered.replace(" ", "")


@pytest.mark.parametrize(
    ("identifier", "asked", "answered"),
    [(1, "01", "00"), (1, "03 28 01", "00"), (0xFE, "82 38 02 01 02", "00 18 05"), (0xFE, "03 28 01", None)],
    ids=["ping", "write", "sync read", "write to all"],
)
def test_the_emulator_answers_as_a_feetech_servo(identifier, asked, answered):
    said = []
    with sts.FeetechEmulator([0x518]) as other:
        other.write = said.append
        other.hear(sts.packet(identifier, bytes.fromhex(asked)))
    assert said == ([] if answered is None else [sts.packet(1, bytes.fromhex(answered))])


@given(identifier=st.integers(0, 252), address=st.integers(0, 661), value=st.integers(-(2**15), 2**15 - 1))
def test_a_register_of_a_dynamixel_is_written_without_an_answer(identifier, address, value):
    """A sync write to a single one; a second packet may follow the first in the same bytes."""
    first = dynamixel_packets.put_write(OUT, 0, identifier, address, 2, value)
    both = dynamixel_packets.put_write(OUT, first, identifier, 98, 1, 2)
    body = address.to_bytes(2, "little") + b"\x02\x00" + bytes([identifier])
    expected = x_series.packet(0xFE, b"\x83" + body + value.to_bytes(2, "little", signed=True))
    assert OUT[:first].tobytes() == expected
    watchdog = b"\x83\x62\x00\x01\x00" + bytes([identifier, 2])
    assert OUT[first:both].tobytes() == x_series.packet(0xFE, watchdog)


@given(identifier=st.integers(0, 253), address=st.integers(0, 86), value=st.integers(0, 2**16 - 1))
def test_a_duty_of_a_feetech_servo_is_written_without_an_answer(identifier, address, value):
    """A sync write to a single one."""
    count = feetech.put_write(OUT, identifier, address, 2, value)
    body = bytes([0x83, address, 2, identifier]) + value.to_bytes(2, "little")
    assert OUT[:count].tobytes() == sts.packet(0xFE, body)


@given(value=st.integers(-1023, 1023), sign_bit=st.sampled_from([10, 11, 15]))
def test_a_magnitude_with_a_sign_bit(value, sign_bit):
    word = feetech.with_sign_bit(value, sign_bit)
    assert feetech.magnitude(word, sign_bit) == value
    assert word % (1 << sign_bit) == abs(value)
    assert word >> sign_bit == (1 if value < 0 else 0)


@given(parameters=st.lists(st.sampled_from([0xFF, 0xFD, 0x00, 0x01]), min_size=6, max_size=12))
def test_parameters_with_headers_in_them(parameters):
    """They come back as they were before an FD was put in behind each FF FF FD."""
    answer = status_of(dynamixel_heard, parameters)
    assert dynamixel_heard(answer, len(parameters)) == (GOOD, bytes([0, *parameters]))


RIGHT = [status_of(bus, [1, 2, 3, 4]) for bus in BUSES]
OLD = [status_of(bus, [9, 9]) for bus in BUSES]
OTHERS = [status_of(bus, [9, 9, 9, 9], identifier=2) for bus in BUSES]


@pytest.mark.parametrize("bus", [0, 1])
@pytest.mark.parametrize(
    "before",
    [
        OLD,
        OTHERS,
        [b"\xff"] * 2,
        [b"\xff\xff\xfd", b"\xff\xff"],
        [right[:-1] + b"\0" for right in RIGHT],
        [b"noise"] * 2,
        [right[5:] for right in RIGHT],
    ],
    ids=["old", "another's", "begun", "header", "checksum", "noise", "end"],
)
def test_what_stands_before_the_answer_is_passed_over(before, bus):
    assert BUSES[bus](before[bus] + RIGHT[bus], 4) == (GOOD, bytes([0, 1, 2, 3, 4]))


@pytest.mark.parametrize("bus", [0, 1])
@pytest.mark.parametrize(
    ("data", "status"),
    [
        ([b""] * 2, SILENT),
        (OLD, STALE),
        (OTHERS, SILENT),
        ([right[:-1] for right in RIGHT], GARBLED),
        ([right[:3] for right in RIGHT], GARBLED),
        ([right[:-1] + b"\0" for right in RIGHT], GARBLED),
        ([b"\xff\xff\xfd\x00\x01\xff\xff" * 9, b"\xff\xff\x01\xff" * 9], GARBLED),
        ([b"\0" * 5_000] * 2, GARBLED),
    ],
    ids=["nothing", "old", "another's", "cut", "begun", "checksum", "headers", "zeros"],
)
def test_what_is_said_of_other_bytes(data, status, bus):
    assert BUSES[bus](data[bus], 4)[0] == status


@pytest.mark.parametrize(
    ("data", "status"),
    [
        (x_series.packet(1, b"\x02\x84\x00\x04\x00"), SILENT),  # a question
        (x_series.packet(1, bytes([0x55, 4])), REFUSED),  # the servo does not take the question
    ],
)
def test_what_is_said_of_a_question_and_a_refusal(data, status):
    assert dynamixel_heard(data, 4)[0] == status


@pytest.mark.parametrize(("bus", "state"), [(dynamixel_heard, 0x80), (feetech_heard, 0x20)])
def test_an_alert_is_handed_on_with_the_parameters(bus, state):
    assert bus(status_of(bus, [1, 2, 3, 4], state=state), 4) == (GOOD, bytes([state, 1, 2, 3, 4]))


@pytest.mark.parametrize("receive", [dynamixel_packets.receive, feetech.receive])
def test_a_closed_line(receive):
    near, far = os.pipe()
    os.close(far)
    assert receive(near, np.zeros(512, np.uint8), 1, 4, now()) == CLOSED
    os.close(near)


@given(data=st.binary(max_size=80))
def test_noise_is_no_answer(data):
    assert dynamixel_heard(data, 4)[0] in (SILENT, GARBLED)
    if b"\xff\xff\x01\x06" not in data:  # as an answer of ours would have to begin
        assert feetech_heard(data, 4)[0] != GOOD
