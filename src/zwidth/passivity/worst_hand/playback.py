"""A motion that gains, played back: the force held in each interval, to rounding, to look at."""

from __future__ import annotations

from fractions import Fraction
from itertools import accumulate, pairwise
from typing import NamedTuple

from zwidth.passivity.checker.contact_law import Law, Losses, read_law, read_losses
from zwidth.passivity.worst_hand.gain import Gain

_SETTLING = 400
"""Rounds after which the law is taken to do the same in each."""


class Round(NamedTuple):
    """One round of the cycle, the law settled.

    Parameters
    ----------
    positions
        x at the samples, the last as the first [m; rad].
    forces
        Held from each sample to the next [N; N·m].
    energies
        Taken out since the first sample, at each [J].
    resolution
        Δ [m; rad].
    """

    positions: tuple[float, ...]
    forces: tuple[float, ...]
    energies: tuple[float, ...]
    resolution: float


def settled_round(gain: Gain) -> Round:
    """The round that is gained with, again and again."""
    _, forces = _forces(gain)
    losses = read_losses(gain.document)
    friction, drag = float(losses.friction), float(losses.damping / losses.period)
    moves = [b - a for a, b in pairwise(gain.cycle)]
    out = (-f * d - friction * abs(d) - drag * d * d for f, d in zip(forces, moves, strict=True))
    energies = tuple(accumulate(out, initial=0.0))
    return Round(gain.cycle, tuple(forces), energies, float(losses.resolution))


def peak_force(gain: Gain) -> float:
    """Largest actuator force on the way in and in the cycle [N; N·m]."""
    return max(abs(f) for part in _forces(gain) for f in part)


def _forces(gain: Gain) -> tuple[list[float], list[float]]:
    """Forces on the way in, and in a round once the law has settled."""
    controller = _Controller(read_law(gain.document), read_losses(gain.document), gain.motion.positions[0])
    x, (first, last, _) = gain.motion.positions, gain.motion.repeats[0]
    way_in = [controller.force(position) for position in x[:first]]
    before: list[float] = []
    for _ in range(_SETTLING):
        forces = [controller.force(position) for position in x[first:last]]
        if forces == before:
            break
        before = forces
    return way_in, before


class _Controller:
    """The law behind the encoder, sample by sample."""

    def __init__(self, law: Law, losses: Losses, start: Fraction) -> None:
        self._law, self._late, self._resolution = law, losses.delay, losses.resolution
        self._taps = max(len(law.taps), 1)
        rested = self._read(start)
        average = Fraction(0) if law.surface == "penetration" or law.relaxing is None else rested
        self._readings = [rested] * (self._taps + self._late)
        self._averages = [average] * (self._late + 1)

    def force(self, position: Fraction) -> float:
        """The force held after a sample at this position."""
        reading = self._read(position)
        self._readings = [reading, *self._readings[:-1]]
        force = self._law.force(self._readings[self._late :], self._averages[self._late])
        after = float(self._law.averaged(self._averages[0], reading))  # exact, its digits would grow
        self._averages = [Fraction(after), *self._averages[:-1]]
        return float(force)

    def _read(self, position: Fraction) -> Fraction:
        return self._resolution * (position // self._resolution)
