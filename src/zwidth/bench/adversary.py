"""A hand that tries many motions against any law, for laws that remember too much for the game.

    gain = −∮ f_h dx      per round, once the law has settled to the motion

A fixed set of motions and what is found against the wall alone; up to the speed of a hand, and
where nothing gains, faster.  A gain is a witness, replayed in the simulator by its very making; no
gain is no proof.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import ceil
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from zwidth.bench.motions import REALISTIC, as_speed, fixed_motions, speed_of
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

FASTEST = 10.0
"""Speed that is not exceeded [m/s], unless another is given."""

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
    speed
        Largest mean speed over a sample [m/s].
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
    speed: float
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
        if self.extracts:
            said = f"{self.name}: a round of {len(self.positions)} samples takes {self.gain:.3g} J out"
            return f"{said}, at up to {self.speed:.3g} m/s" if self.speed > REALISTIC else said
        return (
            f"none of {self.tried} motions takes energy out; the best, {self.name}, "
            f"{'costs' if self.gain <= 0 else 'gets back from what it paid'} {abs(self.gain):.3g} J a round"
        )


class _Played(NamedTuple):
    """Gain of a round in the last half, taken out in all [J], rounds."""

    gain: float
    total: float
    rounds: int

    @property
    def extracts(self) -> bool:
        return self.gain > 0 and self.total > 0


def attack(
    device: Device,
    environment: Environment,
    *,
    fastest: float = FASTEST,
    known: Mapping[str, Floats] | None = None,
) -> Attack:
    """Try all motions on a loop.

    Parameters
    ----------
    device
        Every number certain; its mass plays no part.
    environment
        Any that can be simulated, laws in a row included.
    fastest
        Speed of the fastest hand [m/s], > 0.  Beyond 1 m/s, about what a hand reaches, motions are tried
        only where no slower one gains.
    known
        More motions by name, a round each at the samples [m], as `motions.found_motions` gives them.

    Raises
    ------
    InputError
        If the speed is too low for any motion, or infinite.
    """
    limit, period = as_speed(device, fastest), float(device.exact("sample_period"))
    motions = {**fixed_motions(device, limit), **(known or {})}
    tried: dict[str, _Played] = {}
    for reach in sorted({min(REALISTIC, limit), limit}):
        for name, positions in motions.items():
            if name not in tried and speed_of(positions, period) <= reach:
                tried[name] = _played(device, environment, positions)
        if any(played.extracts for played in tried.values()):
            break
    name = max(tried, key=lambda n: (tried[n].extracts, tried[n].gain))
    best, positions = tried[name], motions[name]
    return Attack(
        name=name,
        positions=tuple(map(float, positions)),
        speed=speed_of(positions, period),
        gain=best.gain,
        total=best.total,
        rounds=best.rounds,
        tried=len(tried),
    )


def _played(device: Device, environment: Environment, positions: Floats) -> _Played:
    """All rounds of a motion; more of them where it gains and has not yet earned its beginning."""
    played = _taken(device, environment, positions, ROUNDS)
    if played.gain > 0 >= played.total:
        rounds = ROUNDS + ceil(-1.5 * played.total / played.gain)
        if rounds * len(positions) <= LONGEST:
            return _taken(device, environment, positions, rounds)
    return played


def _taken(device: Device, environment: Environment, positions: Floats, rounds: int) -> _Played:
    path = _listed(positions, rounds)
    period = device.exact("sample_period")
    trace = simulate(device, environment, PrescribedMotion(path), (len(path) - 1) * period)
    taken = trace["kinetic_energy"].values - trace["hand_work"].values  # what moves at the end is not lost
    half = max((len(taken) - 1) // len(positions) // 2, 1)  # a motion that diverges ends early
    since = max(len(taken) - 1 - half * len(positions), 0)
    lost = float(trace["coulomb_loss"][-1] + trace["viscous_loss"][-1])
    total = float(taken[-1])
    return _Played(
        float(taken[-1] - taken[since]) / half, total if abs(total) > ROUNDING * lost else 0.0, rounds
    )


def _listed(positions: Floats, rounds: int) -> Floats:
    return np.concatenate([np.tile(positions, rounds), positions[:1]])
