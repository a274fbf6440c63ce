"""Numbers and checksums in the bytes of a frame, angles counted on, bytes waited for."""

import binascii
import math
import os
import struct

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from zwidth.machine.servo.connection import GARBLED, SILENT, STALE
from zwidth.machine.servo.devices.frames import (
    CCITT,
    counted_on,
    crc16,
    dropped,
    get_float32,
    get_signed,
    get_unsigned,
    more_bytes,
    put,
    put_float32,
    unanswered,
)
from zwidth.machine.servo.posix import now


def as_bytes(data):
    return np.frombuffer(data, np.uint8).copy()


@pytest.mark.parametrize(("count", "code"), [(1, "b"), (2, "h"), (4, "i")])
@given(data=st.binary(min_size=16, max_size=16), at=st.integers(0, 12))
def test_whole_numbers_as_struct_reads_and_writes_them(count, code, data, at):
    """At every place, aligned or not; a negative one is written as it was read."""
    frame = as_bytes(data)
    signed = get_signed(frame, at, count)
    assert signed == struct.unpack_from(f"<{code}", data, at)[0]
    assert get_unsigned(frame, at, count) == struct.unpack_from(f"<{code.upper()}", data, at)[0]
    frame[at : at + count] = 0
    assert put(frame, at, count, signed) == at + count
    assert frame.tobytes() == data


@given(number=st.floats(width=32), at=st.integers(0, 12))
def test_singles_as_struct_reads_and_writes_them(number, at):
    frame = np.zeros(16, np.uint8)
    assert put_float32(frame, at, number) == at + 4
    back = get_float32(frame, at)
    assert (
        back == struct.unpack_from("<f", frame.tobytes(), at)[0]
        or math.isnan(number) == math.isnan(back) == 1
    )


@given(number=st.floats(-1e30, 1e30))
def test_a_number_is_rounded_to_the_nearest_single(number):
    frame = np.zeros(4, np.uint8)
    put_float32(frame, 0, number)
    assert frame.tobytes() == struct.pack("<f", number)


@given(data=st.binary(max_size=40), initial=st.sampled_from([0, 0xFFFF]))
def test_the_checksum_is_that_of_the_standard_library(data, initial):
    """`binascii.crc_hqx` has the polynomial of ITU-T V.41."""
    assert crc16(as_bytes(data), 0, len(data), CCITT, initial) == binascii.crc_hqx(data, initial)


def test_the_checksum_of_another_polynomial():
    """The check value of x¹⁶ + x¹⁵ + x² + 1 in the catalogue of CRCs (Greg Cook) is FEE8 for "123456789"."""
    assert crc16(as_bytes(b"..123456789"), 2, 11, 0x8005, 0) == 0xFEE8


@given(start=st.integers(0, 4095), steps=st.lists(st.integers(-2047, 2047), max_size=30))
def test_a_counter_that_begins_anew_is_followed(start, steps):
    """Steps of less than half a turn are found again from the counts modulo 4096, exactly."""
    true, memory = float(start), np.zeros(2)
    assert counted_on(memory, 0, true, 4096.0) == true
    for step in steps:
        true += step
        assert counted_on(memory, 0, true % 4096, 4096.0) == true


@given(reading=st.floats(-1e3, 1e3), before=st.floats(-1e3, 1e3), turn=st.floats(0.1, 1e3))
def test_the_nearest_of_all_turns(reading, before, turn):
    """Half a turn away at most, and whole turns from the reading."""
    found = counted_on(np.array([before, 1.0]), 0, reading, turn)
    assert abs(found - before) <= 0.5 * turn * (1 + 1e-9) + 1e-9
    turns = (found - reading) / turn
    assert turns == pytest.approx(round(turns), abs=1e-6)


@pytest.mark.parametrize(
    ("garbled", "stale", "said"),
    [(False, False, SILENT), (False, True, STALE), (True, False, GARBLED), (True, True, GARBLED)],
)
def test_what_is_said_of_no_answer(garbled, stale, said):
    """Bytes that mean nothing weigh more than an old answer, which weighs more than silence."""
    assert unanswered(garbled, stale) == said


def test_bytes_are_waited_for_until_the_time_is_over():
    near, far = os.pipe()
    os.set_blocking(near, False)
    inbox = np.zeros(16, np.uint8)
    os.write(far, b"abc")
    assert more_bytes(near, inbox, 2, now() - 1) == 3
    assert inbox[:5].tobytes() == b"\0\0abc"
    assert more_bytes(near, inbox, 5, now() - 1) == 0
    os.close(far)
    assert more_bytes(near, inbox, 5, now() - 1) == -2
    os.close(near)


def test_bytes_that_were_looked_at_are_dropped():
    inbox = np.frombuffer(b"abcdefgh", np.uint8).copy()
    assert dropped(inbox, 3, 7) == 4
    assert inbox[:4].tobytes() == b"defg"
