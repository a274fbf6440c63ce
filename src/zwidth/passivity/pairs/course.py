"""What a motion of both hands has taken out by and by: the energy of each of its beginnings, exact.

A repeated part is told at the ends of its rounds, the rest at its samples; where they are many, some of them.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from fractions import Fraction

import numpy as np

from zwidth.passivity.pairs.evidence import PairWitness, energy_of
from zwidth.passivity.witness.motion import Motion, Repeat

MOST, LEAST = 48, 6
"""Beginnings of each part."""

_EFFORT = 300_000
"""Samples listed in all the beginnings together."""


def energy_in_time(witness: PairWitness) -> tuple[list[Fraction], list[Fraction]]:
    """Times [s] from 0 to the end, and what has come out by then [J], by the checker's reckoning."""
    pair, step = witness.pair, witness.pair.sample_period / witness.pair.own_readings
    most = max(LEAST, min(MOST, _EFFORT // len(witness.leader.positions)))
    times, energies = [Fraction(0)], [Fraction(0)]
    for last, rounds in _ends(witness.leader, most):
        leader, follower = (_until(motion, last, rounds) for motion in (witness.leader, witness.follower))
        energy = energy_of(pair, leader, follower)
        if energy is not None:
            times.append(leader.samples * step)
            energies.append(energy)
    return times, energies


def _ends(motion: Motion, most: int) -> Iterator[tuple[int, int]]:
    """Samples of the list at which a beginning ends, and how often the part that ends there was done."""
    size, before = len(motion.positions) - 1, 0
    for part in (*(p for p in motion.repeats if p.times > 1), Repeat(size, size, 0)):
        yield from ((k, 1) for k in _some(before + 1, part.first, most))
        yield from ((part.last, n) for n in _some(1, part.times, most))
        before = part.last


def _some(first: int, last: int, most: int) -> list[int]:
    """Whole numbers from the first to the last, at about equal distances."""
    count = min(most, last - first + 1)
    return [] if count < 1 else sorted({round(v) for v in np.linspace(first, last, count).tolist()} | {last})


def _until(motion: Motion, last: int, rounds: int) -> Motion:
    """Its beginning; of the part that ends there so many rounds."""
    parts = [part for part in motion.repeats if part.last <= last]
    return replace(
        motion,
        positions=motion.positions[: last + 1],
        switch_positions=motion.switch_positions[:last],
        repeats=tuple(part._replace(times=rounds) if part.last == last else part for part in parts),
    )
