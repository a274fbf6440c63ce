"""Numbers and checksums in the bytes of a frame."""

import binascii
import math
import struct

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from zwidth.machine.servo.devices.frames import (
    CCITT,
    crc16,
    get_float32,
    get_signed,
    get_unsigned,
    put,
    put_float32,
)


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
