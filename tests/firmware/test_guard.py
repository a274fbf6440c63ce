"""guard.h, compiled here: where the force of a law begins, how it is cut, and where it ends for good."""

from __future__ import annotations

import ctypes
from itertools import pairwise
from pathlib import Path

import pytest
from firmware.tools import DATA, KINDS, UNIT, library

WAITING, SERVING, ENDED = range(3)
ASKED, JUMPED, SILENT, NO_FORCE = 1, 2, 3, 4
NO_READING = -(2**31)
JUMP = 446
"""By hand: 10 m/s in 1 ms are 10 mm, 446.4 counts of 22.4 µm."""


def guarded(folder: Path, kind: int, *options: str) -> ctypes.CDLL:
    found = library(DATA / "guarded.c", folder, f"-DLAW_KIND={kind}", *options)
    found.step.restype = found.law.restype = ctypes.c_double
    found.begin()
    return found


@pytest.mark.parametrize("kind", KINDS)
def test_a_law_begins_where_its_force_is_small(tmp_path: Path, kind: int) -> None:
    """Deep in the wall nothing acts, moving or not; at a hundredth of the limit the law's own force does."""
    guard = guarded(tmp_path, kind)
    for counts in (300, 310, 150, 9, 8):
        assert guard.step(counts) == 0.0
        assert guard.phase() == WAITING
    small = 7 if kind < 4 else 5  # K x just within 0.05 N: whole units of 0.01 N for kind 4
    assert guard.step(small) == guard.law(small, small) > 0.0
    assert guard.phase() == SERVING
    assert guard.law(small, small) * UNIT[kind] <= 0.05 < guard.law(small + 1, small + 1) * UNIT[kind]


@pytest.mark.parametrize("kind", KINDS)
def test_afterwards_the_force_is_the_laws_bit_by_bit(tmp_path: Path, kind: int) -> None:
    """However fast it changes: a force that may change only so much is another law."""
    guard = guarded(tmp_path, kind)
    guard.step(-400)
    readings = (-400, -1, 120, 333, 334, 200, 260, -80, 10, 400, 401)
    for before, counts in pairwise(readings):
        force = guard.law(before, counts)
        if 0 < force * UNIT[kind] <= 5.0 or force == 0.0:
            assert guard.step(counts) == force
        else:
            assert guard.step(counts) * UNIT[kind] == pytest.approx(5.0, abs=UNIT[kind] if kind > 2 else 1e-6)
    assert guard.phase() == SERVING


@pytest.mark.parametrize("kind", KINDS)
def test_a_force_beyond_the_limit_is_cut_and_counted(tmp_path: Path, kind: int) -> None:
    guard = guarded(tmp_path, kind)
    for counts in (0, 400, 800, 1200):
        force = guard.step(counts)
    assert force * UNIT[kind] == pytest.approx(5.0, rel=1e-9)
    assert guard.status() & 0x40
    cut = guard.cut()
    assert cut >= 1
    assert guard.step(790) == 0.0  # going out so fast the damper would pull: the wall gives nothing
    assert not guard.status() & 0x40
    assert guard.cut() == cut


@pytest.mark.parametrize(
    ("way", "phase"), [(JUMP, SERVING), (-JUMP, SERVING), (JUMP + 1, ENDED), (-JUMP - 1, ENDED)]
)
def test_a_reading_that_no_hand_can_reach_ends_the_force(tmp_path: Path, way: int, phase: int) -> None:
    """A jump of 10 mm in a period is one that a hand can, a count more is none; no difference overflows."""
    guard = guarded(tmp_path, 1)
    assert guard.jump() == JUMP
    guard.step(-1000)
    guard.step(-1000 + way)
    assert guard.phase() == phase
    if phase == ENDED:
        assert guard.reason() == JUMPED
        assert guard.step(-1000) == 0.0
    guard.begin()
    guard.step(2**31 - 1)
    guard.step(-(2**31) + 1)
    assert guard.reason() == JUMPED


def test_one_missing_reading_is_bridged_and_two_are_not(tmp_path: Path) -> None:
    guard = guarded(tmp_path, 1)
    guard.step(0)
    force = guard.step(100)
    assert guard.step(NO_READING) == force > 0.0
    assert guard.step(100 + 2 * JUMP - 200) >= 0.0
    assert guard.phase() == SERVING
    guard.step(NO_READING)
    assert guard.step(NO_READING) == 0.0
    assert (guard.phase(), guard.reason()) == (ENDED, SILENT)


@pytest.mark.parametrize("force", ["(0.0/0.0)", "(1.0/0.0)", "(-1.0/0.0)"])
def test_a_force_that_is_no_finite_number_ends_it(tmp_path: Path, force: str) -> None:
    guard = guarded(tmp_path, 1, f"-DLAW_STIFFNESS={force}", "-DLAW_NEVER_GATED")
    assert guard.step(5) == 0.0
    assert (guard.phase(), guard.reason()) == (ENDED, NO_FORCE)


def test_what_has_ended_stays_ended_and_the_first_reason_stays(tmp_path: Path) -> None:
    guard = guarded(tmp_path, 1)
    guard.step(0)
    assert guard.step(100) > 0.0
    guard.end(ASKED)
    guard.end(NO_FORCE)
    assert [guard.step(counts) for counts in (100, 0, -50, 3)] == [0.0] * 4
    assert (guard.phase(), guard.reason()) == (ENDED, ASKED)
    assert guard.status() == ENDED | ASKED << 2


def test_a_law_may_say_where_it_may_begin(tmp_path: Path) -> None:
    """Of a spring with several zeros only one is a place to begin at."""
    guard = guarded(tmp_path, 1, "-DLAW_BEGINS_MIN=(-50)", "-DLAW_BEGINS_MAX=50")
    for counts in (-100, -51):
        guard.step(counts)
        assert guard.phase() == WAITING
    guard.step(-50)
    assert guard.phase() == SERVING


@pytest.mark.parametrize(
    ("option", "what"),
    [
        ("-DLAW_RESOLUTION=0.0", "the_law_reads_counts"),
        ("-DLAW_RESOLUTION=1e-12", "a_jump_fits"),
        ("-DLAW_RESOLUTION=1.0", "a_jump_is_a_count_at_least"),
        ("-ffast-math", "fast-math"),
    ],
)
def test_what_cannot_be_guarded_does_not_compile(tmp_path: Path, option: str, what: str) -> None:
    with pytest.raises(AssertionError, match=what):
        guarded(tmp_path, 1, option)
