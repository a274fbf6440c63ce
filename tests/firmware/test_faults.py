"""Faults while an emulated chip closes the loop: which end in force 0, and what the others can cost."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from firmware.chip_laws import DEVICE, TRAVEL
from firmware.emulated import cortex
from firmware.emulated.avr import AvrLaw
from firmware.emulated.board import PERIOD, Board
from firmware.emulated.host import HostLaw
from firmware.emulated.loop import closed
from firmware.emulated.required import require
from firmware.tools import MAINS, sketch

import zwidth as zw
from zwidth.machine.firmware.emit import emit
from zwidth.machine.firmware.telemetry import read_telemetry

WALL, HAND = zw.Wall(150, 0.05), zw.operators.Dowel(force=2)
SERVING, ENDED = 1, 2
LATE = 5


@pytest.mark.parametrize(
    ("late", "ended"),
    [(100, False), (PERIOD // 2, True), (PERIOD + 100, True), (3 * PERIOD + 100, True)],
    ids=["in time", "half a period", "one is missed", "three are missed"],
)
def test_a_sample_that_is_missed_ends_the_force(tmp_path: Path, late: int, ended: bool) -> None:
    """The whole sketch, at its true rate; interrupts are off until `late` cycles after a sample was due."""
    device, fault = DEVICE.replace(force_limit=5), 130
    emit(device, WALL, target="arduino").write(tmp_path / "wall")
    with Board(sketch(tmp_path / "wall"), tmp_path / "line.bin") as board:
        due: list[int] = []

        def begin(counts: int) -> None:
            for way in range(0, counts, -20):  # the sketch begins where the wall does
                assert board.run(way, 10**9)
            due.append(int(board.at[0]))

        def force(counts: int) -> float:
            due.append(due[-1] + PERIOD)
            if len(due) == fault + 2:
                board.deaf(due[-1] + late)
            board.run(counts, due[-1] + PERIOD - 1000)
            return board.force

        command = closed(device, HAND, 0.3, force, begin).command
    back = fault + late // PERIOD
    assert command[fault - 1] > 1
    assert set(command[fault:back]) <= {command[fault - 1]}
    assert command[back:].all() != ended
    assert command[back:].any() != ended
    data = read_telemetry(tmp_path / "line.bin")
    assert (data.phase.values[-1], data.reason.values[-1]) == ((ENDED, LATE) if ended else (SERVING, 0))


# ---- the law with its guard on two chips, and readings that are not the position

NONE, DEEPEST = -(2**31), 54
"""In the place of a reading that does not come; the sample at which the handle turns."""


def guarded(law: str) -> str:
    """A header whose steps are those of the guard."""
    guard = (MAINS / "shared" / "guard.h").read_text(encoding="utf-8").replace('#include "law.h"', "")
    guard = f'#pragma GCC diagnostic ignored "-Wpedantic"\n{guard}'
    for name in ("state guard", "init(g, n) guard_init(g)", "step guard_step", "reset(g) guard_end(g, 1)"):
        guard += f"#define law_{name}\n"
    return law + guard


@pytest.mark.parametrize(
    ("reading", "samples", "ends"),
    [(None, 1000, None), (None, 15, None), (None, 40, 40), (NONE, 1, None), (NONE, 2, 1)],
    ids=["sticks for good", "sticks for 6 mm", "sticks for a jump", "is missing once", "is missing twice"],
)
def test_a_reading_that_is_not_the_position(
    tmp_path: Path, reading: int | None, samples: int, ends: int | None
) -> None:
    """A jump and silence end the force; a reading that sticks is that of a hand that rests.

    Its force stays, and gives the hand no more than itself times the way.
    """
    require("host", "avr", "cortex-m4")
    text = emit(DEVICE, WALL, number="fixed", travel=TRAVEL).text
    read: list[int] = []
    given: list[float] = []
    with AvrLaw(guarded(text)) as chip:

        def force(counts: int) -> float:
            if 0 < len(read) - DEEPEST <= samples:
                counts = read[DEEPEST] if reading is None else reading
            read.append(counts)
            given.append(chip.force(counts))
            return given[-1]

        motion = closed(DEVICE, HAND, 0.3, force, chip.init)
    host = HostLaw(text, tmp_path)
    host.init(read[0])
    wanted = host.run([counts for counts in read if counts != NONE])
    wanted = np.insert(wanted, DEEPEST + 1, [wanted[DEEPEST]] * read.count(NONE))
    if ends is not None:
        wanted[DEEPEST + 1 + ends :] = 0
    assert given == (wanted * host.force_per_unit).tolist()
    assert np.array_equal(cortex.run(guarded(text), read).forces, wanted)
    if ends is None:
        assert motion.counts.argmax() == DEEPEST
    if samples == 1000:
        x, v, work = (row[DEEPEST + 1 :] for row in (motion.position, motion.velocity, motion.hand_work))
        stuck, taken, way = given[-1], work[0] - work[-1], x[0] - x[-1]
        assert given[DEEPEST + 1 :] == [stuck] * len(x)
        assert 0 < motion.extracted < taken <= stuck * way + DEVICE.mass * v[0] ** 2 / 2
