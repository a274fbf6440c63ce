"""A hand that tries a fixed set of motions against any law, for laws that remember too much for the game.

    gain = −∮ f_h dx      per round, once the law has settled to the motion

The motions are those that take energy out of held springs, encoders and filters: across one
edge and back, fast in and fast out over more and more counts, slow one way and fast the
other, with rests at either end, and sinusoids inside and through the surface.  A gain is a
witness, replayed in the simulator by its very making; no gain is no proof.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil, cos, pi

import numpy as np
from numpy.typing import NDArray

from zwidth.device.device import Device
from zwidth.environment.environment import Environment
from zwidth.loop.simulate import simulate
from zwidth.operator import PrescribedMotion

ROUNDS = 150
"""Rounds of each motion at first; more where it gains but has not yet earned what its beginning cost."""

ROUNDING = 1e-9
"""Part of what friction took that counts as nothing: sums of so many samples are no better."""

LONGEST = 400_000
"""Samples of the longest motion."""

COUNTS = (1, 2, 4, 8, 16, 32, 64)
"""Amplitudes tried, in encoder counts, or in tenths of a millimetre behind an ideal encoder."""

IDEAL_COUNT = 1e-4
"""What stands for a count where the encoder is ideal [m]."""

FASTEST = 1.0
"""Speed that is not exceeded [m/s]: about what a hand reaches."""

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Attack:
    """The motion that took out most in each round, at the end of all rounds.

    Parameters
    ----------
    name
        What it does.
    positions
        One round, at the samples [m].
    gain
        Taken out by a round, after all friction, the mean over the last half of all rounds [J]; < 0: it
        cost energy.
    total
        Taken out by all rounds from rest [J]: only if this is > 0 has energy come out of the loop.
    rounds
        How many that were.
    tried
        How many motions were tried.
    """

    name: str
    positions: tuple[float, ...]
    gain: float
    total: float
    rounds: int
    tried: int

    @property
    def extracts(self) -> bool:
        """True if more came out than ever went in, and each round brings more."""
        return self.gain > 0 and self.total > 0

    @property
    def motion(self) -> PrescribedMotion:
        """All rounds, as a hand for the simulator."""
        return PrescribedMotion(_listed(np.array(self.positions), self.rounds))

    def __str__(self) -> str:
        return (
            f"{self.name}: a round of {len(self.positions)} samples takes {self.gain:.3g} J out"
            if self.extracts
            else f"none of {self.tried} motions takes energy out; the best, {self.name}, "
            f"{'costs' if self.gain <= 0 else 'gets back from what it paid'} {abs(self.gain):.3g} J a round"
        )


def attack(device: Device, environment: Environment) -> Attack:
    """Try all motions on a loop.

    Parameters
    ----------
    device
        Every number certain; its mass plays no part.
    environment
        Any that can be simulated, laws in a row included.
    """
    motions = _motions(device)
    found = [
        Attack(name, tuple(map(float, positions)), *_played(device, environment, positions), len(motions))
        for name, positions in motions.items()
    ]
    return max(found, key=lambda a: (a.extracts, a.gain))


def _played(device: Device, environment: Environment, positions: Floats) -> tuple[float, float, int]:
    """Gain of a round, taken out in all, rounds."""
    rounds = ROUNDS
    gain, total = _taken(device, environment, positions, rounds)
    if gain > 0 >= total:
        rounds += ceil(-1.5 * total / gain)
        if rounds * len(positions) > LONGEST:
            return gain, total, ROUNDS
        gain, total = _taken(device, environment, positions, rounds)
    return gain, total, rounds


def _taken(device: Device, environment: Environment, positions: Floats, rounds: int) -> tuple[float, float]:
    path = _listed(positions, rounds)
    period = device.exact("sample_period")
    trace = simulate(device, environment, PrescribedMotion(path), (len(path) - 1) * period)
    taken = trace["kinetic_energy"].values - trace["hand_work"].values  # what moves at the end is not lost
    half = max((len(taken) - 1) // len(positions) // 2, 1)  # a motion that diverges ends early
    gain = (taken[-1] - taken[max(len(taken) - 1 - half * len(positions), 0)]) / half
    lost = float(trace["coulomb_loss"][-1] + trace["viscous_loss"][-1])
    total = float(taken[-1])
    return float(gain), total if abs(total) > ROUNDING * lost else 0.0


def _listed(positions: Floats, rounds: int) -> Floats:
    return np.concatenate([np.tile(positions, rounds), positions[:1]])


def _motions(device: Device) -> dict[str, Floats]:
    count = float(device.exact("resolution")) or IDEAL_COUNT
    reach = FASTEST * float(device.exact("sample_period"))
    found: dict[str, Floats] = {}
    for n in COUNTS:
        for name, start in (("from the surface", 0.0), ("inside", float(n))):
            low, high = (start - 0.02) * count, (start + n + 0.02 - 1) * count + 0.0
            if n == 1:
                low, high = (start + 1 - 0.02) * count, (start + 1 + 0.02) * count
            if high - low > reach:
                continue
            for rest in (1, 2, 4):
                there = [low] * rest + [high] * rest
                found[f"{n} counts and back {name}, {rest} samples at each end"] = np.array(there)
            for slow in (4, 16):
                way = np.linspace(low, high, slow + 1)
                found[f"{n} counts {name}, slowly in and fast out"] = np.concatenate([way, [low]])
                found[f"{n} counts {name}, fast in and slowly out"] = np.concatenate([[low], way[::-1]])
    for n in COUNTS:
        for period in (3, 4, 6, 10, 20):
            amplitude = n * count
            if 2 * pi * amplitude / period > reach:
                continue
            wave = amplitude * np.array([cos(2 * pi * k / period) for k in range(period)])
            found[f"a sinusoid of {n} counts and {period} samples, inside"] = wave + 3 * amplitude
            found[f"a sinusoid of {n} counts and {period} samples, through the surface"] = wave
    return found
