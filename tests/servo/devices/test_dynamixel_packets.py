"""Packets of Protocol 2.0, byte by byte."""

import os

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from servo.emulators.dynamixel import DynamixelEmulator, packet

from zwidth.machine.servo.connection import CLOSED, GARBLED, GOOD, REFUSED, SILENT, STALE
from zwidth.machine.servo.devices.dynamixel_packets import put_read, put_write, receive
from zwidth.machine.servo.posix import now

OUT = np.zeros(512, np.uint8)


def heard(data, count, identifier=1):
    """What becomes of these bytes, all of them there at once; the state and parameters of the answer."""
    near, far = os.pipe()
    os.set_blocking(near, False)
    os.write(far, data)
    inbox = np.zeros(512, np.uint8)
    status = receive(near, inbox, identifier, count, now() - 1)
    os.close(near)
    os.close(far)
    return status, inbox[: count + 1].tobytes()


def test_the_question_of_the_e_manual():
    """ "Read": present position, 4 bytes at 132 of servo 1."""
    count = put_read(OUT, 1, 132, 4)
    assert OUT[:count].tobytes().hex(" ") == "ff ff fd 00 01 07 00 02 84 00 04 00 1d 15"


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
    with DynamixelEmulator([166], model=1030, firmware=38) as other:
        other.write = said.append
        other.hear(bytes.fromhex(asked))
    assert b"".join(said).hex() == answered.replace(" ", "")


def test_the_answer_of_the_e_manual():
    """ "Read": position 166."""
    status, answer = heard(bytes.fromhex("fffffd000108005500a60000008cc0"), 4)
    assert (status, answer.hex()) == (GOOD, "00a6000000")


@given(identifier=st.integers(0, 252), address=st.integers(0, 661), value=st.integers(-(2**15), 2**15 - 1))
def test_a_register_is_written_to_one_servo_without_an_answer(identifier, address, value):
    """A sync write to a single one; a second packet may follow the first in the same bytes."""
    first = put_write(OUT, 0, identifier, address, 2, value)
    both = put_write(OUT, first, identifier, 98, 1, 2)
    body = address.to_bytes(2, "little") + b"\x02\x00" + bytes([identifier])
    expected = packet(0xFE, b"\x83" + body + value.to_bytes(2, "little", signed=True))
    assert OUT[:first].tobytes() == expected
    assert OUT[first:both].tobytes() == packet(0xFE, b"\x83\x62\x00\x01\x00" + bytes([identifier, 2]))


@given(parameters=st.lists(st.sampled_from([0xFF, 0xFD, 0x00, 0x01]), min_size=6, max_size=12))
def test_parameters_with_headers_in_them(parameters):
    """They come back as they were before an FD was put in behind each FF FF FD."""
    assert heard(packet(1, bytes([0x55, 0, *parameters])), len(parameters)) == (GOOD, bytes([0, *parameters]))


RIGHT = packet(1, bytes([0x55, 0, 1, 2, 3, 4]))
OLD = packet(1, bytes([0x55, 0, 9, 9]))
OTHERS = packet(2, bytes([0x55, 0, 9, 9, 9, 9]))


@pytest.mark.parametrize(
    "before", [OLD, OTHERS, b"\xff", b"\xff\xff\xfd", RIGHT[:-1] + b"\0", b"noise", RIGHT[5:]]
)
def test_what_stands_before_the_answer_is_passed_over(before):
    """An old answer, another servo's, noise, a wrong checksum, the end of an answer."""
    assert heard(before + RIGHT, 4) == (GOOD, bytes([0, 1, 2, 3, 4]))


@pytest.mark.parametrize(
    ("data", "status"),
    [
        (b"", SILENT),
        (OLD, STALE),
        (OTHERS, SILENT),
        (packet(1, b"\x02\x84\x00\x04\x00"), SILENT),
        (RIGHT[:-1], GARBLED),
        (RIGHT[:3], GARBLED),
        (RIGHT[:-1] + b"\0", GARBLED),
        (b"\xff\xff\xfd\x00\x01\xff\xff" * 9, GARBLED),
        (packet(1, bytes([0x55, 4])), REFUSED),
        (b"\0" * 5_000, GARBLED),
    ],
)
def test_what_is_said_of_other_bytes(data, status):
    """The last but one: the servo says that it does not take the question."""
    assert heard(data, 4)[0] == status


def test_an_alert_is_handed_on():
    """It comes with the parameters; what it means is for the adapter."""
    assert heard(packet(1, bytes([0x55, 0x80, 1, 2, 3, 4])), 4) == (GOOD, bytes([0x80, 1, 2, 3, 4]))


def test_a_closed_line():
    """Nobody can write any more."""
    near, far = os.pipe()
    os.close(far)
    assert receive(near, np.zeros(512, np.uint8), 1, 4, now()) == CLOSED
    os.close(near)


@given(data=st.binary(max_size=80))
def test_noise_is_no_answer(data):
    """Whatever length it claims."""
    assert heard(data, 4)[0] in (SILENT, GARBLED)
