"""Packets of Feetech's bus servos, byte by byte."""

import os

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from servo.emulators.feetech import FeetechEmulator, packet

from zwidth.machine.servo.connection import CLOSED, GARBLED, GOOD, SILENT, STALE
from zwidth.machine.servo.devices.feetech import (
    magnitude,
    put_read,
    put_write,
    receive,
    with_sign_bit,
)
from zwidth.machine.servo.posix import now

OUT = np.zeros(512, np.uint8)


def heard(data, count):
    """What becomes of these bytes, all of them there at once; the state and parameters of the answer."""
    near, far = os.pipe()
    os.set_blocking(near, False)
    os.write(far, data)
    inbox = np.zeros(512, np.uint8)
    status = receive(near, inbox, 1, count, now() - 1)
    os.close(near)
    os.close(far)
    return status, inbox[: count + 1].tobytes()


def test_the_question_and_the_answer_of_the_protocol_manual():
    """The position of servo 1: 2 bytes at 38 hex; it is 0518 hex."""
    count = put_read(OUT, 1, 0x38, 2)
    assert OUT[:count].tobytes().hex(" ") == "ff ff 01 04 02 38 02 be"
    assert heard(bytes.fromhex("ffff0104001805dd"), 2) == (GOOD, b"\x00\x18\x05")


@pytest.mark.parametrize(
    ("identifier", "asked", "answered"),
    [(1, "01", "00"), (1, "03 28 01", "00"), (0xFE, "82 38 02 01 02", "00 18 05"), (0xFE, "03 28 01", None)],
    ids=["ping", "write", "sync read", "write to all"],
)
def test_the_emulator_answers_as_a_servo(identifier, asked, answered):
    """A ping and a write with its state, a sync read with its registers; a write to all is not answered."""
    said = []
    with FeetechEmulator([0x518]) as other:
        other.write = said.append
        other.hear(packet(identifier, bytes.fromhex(asked)))
    assert said == ([] if answered is None else [packet(1, bytes.fromhex(answered))])


@given(identifier=st.integers(0, 253), address=st.integers(0, 86), value=st.integers(0, 2**16 - 1))
def test_a_duty_is_written_to_one_servo_without_an_answer(identifier, address, value):
    """A sync write to a single one."""
    count = put_write(OUT, identifier, address, 2, value)
    body = bytes([0x83, address, 2, identifier]) + value.to_bytes(2, "little")
    assert OUT[:count].tobytes() == packet(0xFE, body)


@given(value=st.integers(-1023, 1023), sign_bit=st.sampled_from([10, 11, 15]))
def test_a_magnitude_with_a_sign_bit(value, sign_bit):
    """There and back, and the size is below the bit."""
    word = with_sign_bit(value, sign_bit)
    assert magnitude(word, sign_bit) == value
    assert word % (1 << sign_bit) == abs(value)
    assert word >> sign_bit == (1 if value < 0 else 0)


RIGHT = packet(1, bytes([0, 1, 2, 3, 4]))
OLD = packet(1, bytes([0, 9, 9]))
OTHERS = packet(2, bytes([0, 9, 9, 9, 9]))


@pytest.mark.parametrize(
    "before", [OLD, OTHERS, b"\xff", b"\xff\xff", RIGHT[:-1] + b"\0", b"noise", RIGHT[5:]]
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
        (RIGHT[:-1], GARBLED),
        (RIGHT[:3], GARBLED),
        (RIGHT[:-1] + b"\0", GARBLED),
        (b"\xff\xff\x01\xff" * 9, GARBLED),
        (b"\0" * 5_000, GARBLED),
    ],
)
def test_what_is_said_of_other_bytes(data, status):
    """None of it is an answer."""
    assert heard(data, 4)[0] == status


def test_the_state_is_handed_on():
    """It comes with the parameters; what it means is for the adapter."""
    assert heard(packet(1, bytes([0x20, 1, 2, 3, 4])), 4) == (GOOD, bytes([0x20, 1, 2, 3, 4]))


def test_a_closed_line():
    """Nobody can write any more."""
    near, far = os.pipe()
    os.close(far)
    assert receive(near, np.zeros(512, np.uint8), 1, 4, now()) == CLOSED
    os.close(near)


@given(data=st.binary(max_size=40).filter(lambda data: b"\xff\xff\x01\x06" not in data))
def test_noise_is_no_answer(data):
    """Whatever length it claims; an answer of ours would have to begin as one."""
    assert heard(data, 4)[0] != GOOD
