"""A hand that tries a fixed set of motions against any law, for laws that remember too much for the game.

    gain = −∮ f_h dx      per round, once the law has settled to the motion

The motions are those that take energy out of held springs, encoders and filters: across one
edge and back, fast in and fast out over more and more counts, slow one way and fast the
other, with rests at either end, and sinusoids inside and through the surface.  A gain is a
witness, replayed in the simulator by its very making; no gain is no proof.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, pi

import numpy as np
from numpy.typing import NDArray

from zwidth.device.device import Device
from zwidth.environment.environment import Environment
from zwidth.loop.simulate import simulate
from zwidth.operator import PrescribedMotion

ROUNDS = 150
"""Rounds of each motion."""

COUNTS = (1, 2, 4, 8, 16, 32, 64)
"""Amplitudes tried, in encoder counts, or in tenths of a millimetre behind an ideal encoder."""

IDEAL_COUNT = 1e-4
"""What stands for a count where the encoder is ideal [m]."""

FASTEST = 1.0
"""Speed that is not exceeded [m/s]: about what a hand reaches."""

_SURE = 1e-6
"""Part of what friction takes in a round that a gain must exceed."""

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
        Taken out of the loop by the last round, after all friction [J]; < 0: it cost energy.
    total
        Taken out by all rounds from the beginning [J].
    tried
        How many motions were tried.
    """

    name: str
    positions: tuple[float, ...]
    gain: float
    total: float
    tried: int

    @property
    def extracts(self) -> bool:
        """True if it gains with every round."""
        return self.gain > 0

    @property
    def motion(self) -> PrescribedMotion:
        """All rounds, as a hand for the simulator."""
        return PrescribedMotion(_rounds(np.array(self.positions)))

    def __str__(self) -> str:
        return (
            f"{self.name}: a round of {len(self.positions)} samples takes {self.gain:.3g} J out"
            if self.extracts
            else f"the best of {self.tried} motions, {self.name}, costs the hand {-self.gain:.3g} J a round"
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
    best: Attack | None = None
    motions = _motions(device)
    for name, positions in motions.items():
        gain, total = _played(device, environment, positions)
        if best is None or gain > best.gain:
            best = Attack(name, tuple(map(float, positions)), gain, total, len(motions))
    assert best is not None
    return best


def _played(device: Device, environment: Environment, positions: Floats) -> tuple[float, float]:
    path = _rounds(positions)
    period = device.exact("sample_period")
    trace = simulate(device, environment, PrescribedMotion(path), (len(path) - 1) * period)
    work = trace["hand_work"].values
    size = len(positions)
    friction = trace["coulomb_loss"].values + trace["viscous_loss"].values
    gain = float(work[-1 - size] - work[-1])
    lost = float(friction[-1] - friction[-1 - size])
    return (gain if abs(gain) > _SURE * lost else min(gain, 0.0)), -float(work[-1])


def _rounds(positions: Floats) -> Floats:
    return np.concatenate([np.tile(positions, ROUNDS), positions[:1]])


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
