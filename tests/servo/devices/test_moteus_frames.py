"""Lines of moteus, byte by byte."""

import struct

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from servo.emulators.moteus import checksum

from zwidth.machine.servo.devices.moteus_frames import (
    ANY,
    BROKEN,
    EARLIER,
    FAILED,
    FAULT,
    MODE,
    NOT_OURS,
    RIGHT,
    TURNS,
    put_question,
    put_stop,
    put_torque,
    remainder,
    understood,
)

OUT = np.zeros(512, np.uint8)


def text(count):
    return OUT[:count].tobytes()


def read(line, checked=False, servo=1, source=112):
    """What a line is, and the numbers in it."""
    memory = np.full(40, np.nan)
    buffer = np.frombuffer(line, np.uint8).copy()
    return understood(buffer, len(line), servo, source, checked, memory), memory


def answer(mode=10, position=0.25, fault=0):
    return (
        struct.pack("<BBb", 0x21, 0x00, mode)
        + struct.pack("<BBf", 0x2D, 0x01, position)
        + struct.pack("<BBb", 0x21, 0x0F, fault)
    ).hex()


def test_a_question_of_registers():
    """One register of one byte, one float, one of one byte; an answer goes to the source."""
    assert text(put_question(OUT, 1, 0x70, False)) == b"can send f001 11001d01110f\n"
    assert text(put_question(OUT, 0x2A, 0x7F, False)) == b"can send ff2a 11001d01110f\n"


def test_a_torque_and_a_stop():
    """Position mode; no position, velocity 0; the torque; both gains 0; the watchdog; the integral part 0."""
    expected = b"can send 0001 01000a022080000d220000c0bf022300000527f401012b00\n"
    assert text(put_torque(OUT, 1, -1.5, 500, False)) == expected
    assert b"05270080" in text(put_torque(OUT, 1, 0.0, ANY, False))
    assert text(put_stop(OUT, 3, False)) == b"can send 0003 010000\n"


@given(line=st.binary(max_size=60))
def test_the_checksum_of_a_line(line):
    """Division of polynomials, by another road."""
    assert remainder(np.frombuffer(line + b"\0", np.uint8).copy(), len(line)) == checksum(line)


def test_the_answer_of_the_documentation():
    """The example of "CAN protocol" has other registers: it is no answer of ours."""
    assert read(b"rcv 100 2404000a005000000170ff230d181400", source=0)[0] == BROKEN


@pytest.mark.parametrize("flags", ["", " ", " E B F", " E b F t1234 f-1"])
def test_a_right_answer(flags):
    for data in (answer(), answer().upper()):
        kind, memory = read(f"rcv 170 {data}{flags}".encode())
        assert (kind, memory[MODE], memory[TURNS], memory[FAULT]) == (RIGHT, 10, 0.25, 0)
    kind, memory = read(f"rcv 170 {answer(-3, -7.125, 38)}5050".encode())
    assert (kind, memory[MODE], memory[TURNS], memory[FAULT]) == (RIGHT, -3, -7.125, 38)


@pytest.mark.parametrize(
    ("line", "kind"),
    [
        (b"", NOT_OURS),
        (b"OK", NOT_OURS),
        (b"ERR unknown", FAILED),
        (f"rcv 270 {answer()}".encode(), NOT_OURS),
        (f"rcv 10170 {answer()}".encode(), NOT_OURS),
        (f"rcv 171 {answer()}".encode(), EARLIER),
        (f"rcv 170 {answer()}0".encode(), BROKEN),
        (f"rcv 170 {answer()}xx".encode(), BROKEN),
        (f"rcv 1x0 {answer()}".encode(), BROKEN),
        (f"rcv 170 {answer()[:-6]}".encode(), BROKEN),
        (f"rcv 170 {answer()[:-2]}".encode(), BROKEN),
        (f"rcv 170 {answer()}210102".encode(), BROKEN),
        (b"rcv 170", BROKEN),
        (b"rcv 170 20", BROKEN),
        (b"rcv 170 2d", BROKEN),
        (b"rcv 170 20ff", BROKEN),
        (b"rcv", BROKEN),
        (b"OKAY", BROKEN),
        (b"\xff", BROKEN),
    ],
)
def test_other_lines(line, kind):
    assert read(line)[0] == kind


def test_a_line_whose_checksum_is_wrong_or_missing():
    """Wrong is wrong wherever it stands; missing only where there must be one."""
    body = f"rcv 170 {answer()} ".encode()
    right = checksum(body)
    for checked in (False, True):
        assert read(body + b"*%02x" % right, checked)[0] == RIGHT
        assert read(body + b"*%02X" % (right ^ 0x10), checked)[0] == BROKEN
    assert read(body.rstrip())[0] == RIGHT
    assert read(body.rstrip(), checked=True)[0] == BROKEN


@given(data=st.binary(max_size=40))
def test_no_data_read_beyond_their_end(data):
    """Whatever the bytes say of their number; only the three registers together are an answer."""
    kind, memory = read(b"rcv 170 " + data.hex().encode())
    assert kind in (RIGHT, BROKEN)
    assert (kind == RIGHT) <= (not np.isnan(memory[MODE]) and not np.isnan(memory[FAULT]))
