"""Angles counted on, and what is said where no right answer came."""

import os

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from zwidth.machine.servo.connection import GARBLED, SILENT, STALE
from zwidth.machine.servo.devices.frames import counted_on, dropped, more_bytes, unanswered
from zwidth.machine.servo.posix import now


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
