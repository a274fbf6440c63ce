"""A motion that gains, played back: the force held in each interval, to rounding, to look at."""

from __future__ import annotations

from fractions import Fraction
from itertools import accumulate, pairwise
from typing import NamedTuple

from zwidth.passivity.storage.evidence.gain import Gain
from zwidth.passivity.storage.law import FiniteLaw
from zwidth.passivity.storage.losses import Losses

_SETTLING = 400
"""Rounds after which the law is taken to do the same in each."""


class Round(NamedTuple):
    """One round of the cycle, the law settled.

    Parameters
    ----------
    times
        The samples, and the instants between them at which a delayed force changes [T].
    positions
        x then, the last as the first [m; rad].
    forces
        Held from each of them to the next [N; N·m].
    energies
        Taken out since the first sample, at each [J].
    resolution
        Δ [m; rad].
    """

    times: tuple[float, ...]
    positions: tuple[float, ...]
    forces: tuple[float, ...]
    energies: tuple[float, ...]
    resolution: float


def settled_round(gain: Gain) -> Round:
    """The round that is gained with, again and again."""
    _, forces = _forces(gain)
    losses = gain.losses
    first, last, _ = gain.motion.repeats[0]
    x, switches = gain.motion.positions, gain.motion.switch_positions
    times, positions = [Fraction(0)], [x[first]]
    for k in range(first, last):
        if switches:
            times.append(k - first + losses.part)
            positions.append(switches[k])
        times.append(Fraction(k - first + 1))
        positions.append(x[k + 1])
    out = (
        -f * float(b - a) - float(losses.lost(b - a, t1 - t0))
        for f, (a, b), (t0, t1) in zip(forces, pairwise(positions), pairwise(times), strict=True)
    )
    energies = tuple(accumulate(out, initial=0.0))
    return Round(
        tuple(map(float, times)),
        tuple(map(float, positions)),
        tuple(forces),
        energies,
        float(losses.resolution),
    )


def peak_force(gain: Gain) -> float:
    """Largest actuator force on the way in and in the cycle [N; N·m]."""
    return max(abs(f) for part in _forces(gain) for f in part)


def _forces(gain: Gain) -> tuple[list[float], list[float]]:
    """Forces on the way in, and in a round once the law has settled."""
    listed = next((gain.document[key] for key in gain.document if key.startswith("forces_")), None)
    if listed is not None:  # laws in a chain, settled from the first round on
        first = gain.motion.repeats[0].first
        return [float(f) for f in listed[:first]], [float(f) for f in listed[first:]]
    controller = _Controller(gain.law, gain.losses, gain.motion.positions[0])
    x, (first, last, _) = gain.motion.positions, gain.motion.repeats[0]
    way_in = [force for position in x[:first] for force in controller.forces(position)]
    before: list[float] = []
    for _ in range(_SETTLING):
        forces = [force for position in x[first:last] for force in controller.forces(position)]
        if forces == before:
            break
        before = forces
    return way_in, before


class _Controller:
    """The law behind the encoder, sample by sample."""

    def __init__(self, law: FiniteLaw, losses: Losses, start: Fraction) -> None:
        self._law, self._losses = law, losses
        self._used = law.memory + 1
        resting = self._read(start)
        average = Fraction(0) if law.surface == "penetration" or law.relaxing is None else resting
        self._readings = [resting] * (self._used + losses.delay)
        self._averages = [average] * (losses.delay + 1)

    def forces(self, position: Fraction) -> list[float]:
        """The force held after a sample at this position; two where it changes within the interval."""
        reading = self._read(position)
        self._readings = [reading, *self._readings[:-1]]
        late = self._losses.delay
        ages = [late] if self._losses.part == 1 else [late, late - 1]
        forces = [
            self._law.force(tuple(self._readings[age : age + self._used]), self._averages[age])
            for age in ages
        ]
        after = float(self._law.averaged(self._averages[0], reading))  # exact, its digits would grow
        self._averages = [Fraction(after), *self._averages[:-1]]
        return [float(force) for force in forces]

    def _read(self, position: Fraction) -> Fraction:
        return self._losses.resolution * (position // self._losses.resolution)
