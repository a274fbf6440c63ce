"""From a cycle that gains against laws in a chain to a witness: replayed by the law, counted exactly.

The cycle is one of states, so that the law does the same in each round, to the bit.
"""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from math import ceil, floor
from typing import Any

import numpy as np

from zwidth.checker import verify
from zwidth.loop.kernel import R_HAND_WORK
from zwidth.loop.setup import empty_record, prepare
from zwidth.loop.simulate import run_setup
from zwidth.model.device.device import Device
from zwidth.model.environment.environment import Environment
from zwidth.model.operator import PrescribedMotion
from zwidth.passivity.storage.evidence.gain import Gain, motion_document
from zwidth.passivity.storage.hand_bounds import hand_bounds
from zwidth.passivity.storage.row.document import MOTION, Run, columns, law_document, same_law
from zwidth.passivity.storage.row.grid import NO_LAW, RowGrid
from zwidth.passivity.storage.row.law import RowLaw
from zwidth.passivity.storage.solve.value_iteration import ValueIteration
from zwidth.passivity.witness.motion import Motion, Repeat

_NEAREST = 40
"""Halvings of a count by which a hand at an edge may have to stay inside its cell."""

_SLOWEST, _SETTLING = 50_000, 40
"""Samples of a slow way in, and rounds within which a law settles, at most."""

_LONGEST = 2_000_000
"""Samples that are simulated at most; of a longer motion the first rounds."""


def row_gain(
    iteration: ValueIteration[RowGrid], law: RowLaw, device: Device, environment: Environment
) -> Gain | None:
    """The cycle of a value iteration as a witness, or None if, run again, it gains nothing.

    It is accepted only if exact arithmetic finds a gain with the forces that the law gives, and
    the simulator finds energy coming out.
    """
    grid = iteration.grid
    for halvings in range(grid.count_steps.bit_length(), _NEAREST, 4):
        found_motion = _document(grid, iteration.cycle, law, halvings, device.motion)
        if found_motion is None:
            return None
        document, path = found_motion
        counted = verify(document)
        if counted.energy is None or counted.gain is None or counted.gain <= 0:  # it would leave the bounds
            continue
        energy, per_round = counted.energy, counted.gain
        times = 1 if energy > 0 else ceil(-energy / per_round) + 2
        document["repeats"]["times"] = times
        energy += (times - 1) * per_round
        path = path.repeated(times)
        found = Gain(
            {**document, "energy_J": energy},
            path,
            energy,
            per_round,
            NO_LAW,
            grid.losses,
            device.unit("position"),
        )
        if same_law(found.document, device, environment) and _simulated(path, law, device, environment):
            return found
    return None


def _document(
    grid: RowGrid, cycle: tuple[tuple[int, int], ...], law: RowLaw, halvings: int, motion: str
) -> tuple[dict[str, Any], Motion] | None:
    """Way in, one round, and the forces that the law gives; None if no way in is found."""
    resolution, counts = grid.losses.resolution, grid.table.counts
    round_ = [_place(grid, node, int(counts[state]), halvings) for node, state in cycle]
    way = _way_in(grid, cycle[0][1], round_[0], halvings) or _slow_way_in(grid, law, round_)
    if way is None:
        return None
    x = [*way, *round_[1:], round_[0]]
    part = Repeat(len(way) - 1, len(x) - 1, 1)
    run = Run(law, int(x[0] // resolution))
    forces = [Fraction(run.force(int(p // resolution))) for p in x[:-1]]
    path = Motion(tuple(x), (), (part,))
    bounds = hand_bounds(NO_LAW, grid.losses, grid.domain)
    document = motion_document(MOTION, grid.losses, law_document(law), bounds, path, motion)
    return {**document, columns(motion)[1]: forces}, path


def _way_in(grid: RowGrid, goal: int, end: Fraction, halvings: int) -> list[Fraction] | None:
    """Positions on the shortest way to a state, within each count as near to the next as may be."""
    way = grid.table.way(goal, floor(grid.domain.speed))
    if way is None:
        return None
    near = Fraction(1, 2**halvings)
    x = [end / grid.losses.resolution]
    for state in reversed(way[:-1]):
        count = int(grid.table.counts[state])
        x.append(min(max(x[-1], count + near / 2**8), count + 1 - near))
    return [p * grid.losses.resolution for p in reversed(x)]


def _slow_way_in(grid: RowGrid, law: RowLaw, round_: list[Fraction]) -> list[Fraction] | None:
    """Straight in as fast as may be, then round until the law remembers after a round what it did before."""
    resolution = grid.losses.resolution
    end = round_[0] // resolution
    begin = min(law.resting, key=lambda n: abs(n - end))
    start = round_[0] if begin == end else (begin + Fraction(1, 2)) * resolution
    count = max(1, ceil(abs(round_[0] - start) / (grid.domain.speed * resolution)))
    way = [start + (round_[0] - start) * Fraction(k, count) for k in range(count + 1)]
    if count > _SLOWEST:
        return None
    run, before = Run(law, begin), b""
    for p in way:
        run.force(int(p // resolution))
    for _ in range(_SETTLING):
        if run.memory == before:
            return way
        before = run.memory
        for p in (*round_[1:], round_[0]):
            run.force(int(p // resolution))
        way += [*round_[1:], round_[0]]
    return None


def _place(grid: RowGrid, node: int, cell: int, halvings: int) -> Fraction:
    """Where the hand stands: near an edge a little inside its cell, where no rounding moves the reading."""
    near = Fraction(1, 2**halvings)
    x = Fraction(node, grid.steps)
    return min(max(x, cell + near / 2**8), cell + 1 - near) * grid.losses.resolution


def _simulated(path: Motion, law: RowLaw, device: Device, environment: Environment) -> bool:
    """True if the simulator finds energy coming out: of all of it, or of the last of some rounds."""
    part = path.repeats[0]
    samples = part.last - part.first
    rounds = min(part.times, max(2, _LONGEST // samples))
    x = np.array([float(v) for v in path.positions])
    around = np.tile(x[part.first + 1 : part.last + 1], rounds)  # a round ends where it began
    x = np.concatenate((x[: part.first + 1], around, x[part.last + 1 :], x[-1:]))  # the mass at rest again
    period = device.exact("sample_period")
    setup = prepare(device, environment, PrescribedMotion(x), (len(x) - 1) * period)
    commands, record, work = empty_record(setup.frame)
    setup = replace(setup, law=law.packed)
    run_setup(setup, setup.state.copy(), setup.memory.copy(), work, commands, record, None)
    taken = -record[R_HAND_WORK]
    last, begun = (-1, 0) if rounds == part.times else (len(x) - 2, len(x) - 2 - samples)
    return bool(taken[last] > taken[begun])
