"""A hand that tries many motions against any law, for laws that remember too much for value iteration.

    gain = −∮ f_h dx      per round, once the law has settled to the motion

A fixed set of motions and what is found against the wall alone; up to the speed of a hand, and where nothing
gains, faster.  A gain is a witness, replayed in the simulator before it is told; no gain is no proof.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from math import ceil, isfinite
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from zwidth.loop.law import PHASE, RESOLUTION, measured
from zwidth.loop.plant import STATE_SIZE
from zwidth.loop.runs import run_rounds
from zwidth.loop.setup import prepare, resting_memory
from zwidth.loop.simulate import simulate
from zwidth.model.device.device import Device
from zwidth.model.environment.environment import Environment
from zwidth.model.environment.transfer_function import as_environment
from zwidth.model.operator import PrescribedMotion
from zwidth.quantity.exact import RealLike
from zwidth.quantity.text import shown
from zwidth.study.bench.motions import USUAL, as_speed, fixed_motions, speed_of

if TYPE_CHECKING:
    import xarray as xr

ROUNDS = 150
"""Rounds of each motion at first; more where it gains but has not yet earned what its beginning cost."""

FEW = 25
"""The same where the simulator moves two bodies."""

ROUNDING = 1e-9
"""Part of what friction took that counts as nothing: sums of so many samples are no better."""

LONGEST = 400_000
"""Samples of the longest motion."""

FASTEST = 10.0
"""Speed that is not exceeded [m/s], unless another is given."""

REALISTIC = 1.0
"""Speed about which a hand reaches [m/s]: of faster motions it is said how fast they are."""

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
            said = f"{self.name}: a round of {len(self.positions)} samples takes {shown(self.gain, 'J')} out"
            return f"{said}, at up to {shown(self.speed, 'm/s', 3)}" if self.speed > REALISTIC else said
        return (
            f"none of {self.tried} motions takes energy out; the best, {self.name}, "
            f"{'costs' if self.gain <= 0 else 'gets back from what it paid'} {shown(abs(self.gain), 'J')} "
            "a round"
        )


class _Played(NamedTuple):
    """Gain of a round in the last half, taken out in all [J], rounds."""

    gain: float
    total: float
    rounds: int

    @property
    def extracts(self) -> bool:
        return self.gain > 0 and self.total > 0


Play = Callable[[Floats, int], _Played]
"""Tries so many rounds of a motion."""


def attack(
    device: Device,
    environment: Environment,
    *,
    fastest: RealLike = FASTEST,
    known: Mapping[str, Floats] | None = None,
) -> Attack:
    """Try all motions on a loop.

    Parameters
    ----------
    device
        Every number certain; its mass plays no part. With a transmission the simulator moves its handle.
    environment
        Any that can be simulated, laws in a chain included.
    fastest
        Speed of the fastest hand [m/s], > 0.  Beyond a tenth of it, of 10 m/s about what a hand reaches,
        motions are tried only where no slower one gains.
    known
        More motions by name, a round each at the samples [m], as `motions.found_motions` gives them.

    Raises
    ------
    InputError
        If the speed is too low for any motion, or infinite.
    """
    motor = device.motor_side
    limit, period = as_speed(motor, fastest), float(motor.exact("sample_period"))
    law = as_environment(environment, device=device)
    motions = {**fixed_motions(motor, limit, law), **(known or {})}
    play = _player(device, law) if device is motor else partial(_taken, device, law)
    speeds = {name: speed_of(positions, period) for name, positions in motions.items()}
    tried: dict[str, _Played] = {}
    for reach in (float(USUAL * limit), float(limit)):
        for name, positions in motions.items():
            if name not in tried and speeds[name] <= reach:
                tried[name] = _played(play, positions)
        if any(played.extracts for played in tried.values()):
            break
    name, best = _replayed(device, law, motions, tried)
    return Attack(
        name=name,
        positions=tuple(map(float, motions[name])),
        speed=speeds[name],
        gain=best.gain,
        total=best.total,
        rounds=best.rounds,
        tried=len(tried),
    )


def _replayed(
    device: Device, law: Environment, motions: Mapping[str, Floats], tried: Mapping[str, _Played]
) -> tuple[str, _Played]:
    """The best motion, as the simulator finds it; the next one where that does not gain after all."""
    ranked = sorted(tried, key=lambda name: (tried[name].extracts, tried[name].gain), reverse=True)
    for name in ranked:
        again = _taken(device, law, motions[name], tried[name].rounds)
        if again.extracts or not tried[name].extracts:
            return name, again
    return ranked[0], _taken(device, law, motions[ranked[0]], tried[ranked[0]].rounds)


def _played(play: Play, positions: Floats) -> _Played:
    """All rounds of a motion; more of them where it gains and has not yet earned its beginning."""
    played = play(positions, FEW if isinstance(play, partial) else ROUNDS)
    if played.gain > 0 >= played.total:
        rounds = ROUNDS + ceil(-1.5 * played.total / played.gain)
        if rounds * len(positions) <= LONGEST:
            return play(positions, rounds)
    return played


def _player(device: Device, law: Environment) -> Play:
    """Tries motions on a loop that is laid out once; what grows without bound is left to the simulator."""
    setup = prepare(device, law, PrescribedMotion(np.zeros(2)), device.exact("sample_period"))
    frame, numbers = setup.frame, setup.law
    coulomb, drag = frame.plant.coulomb, frame.plant.damping / float(frame.period)
    share = frame.offset / float(frame.period)
    late = int(device.exact("delay") // frame.period)
    resting: dict[float, Floats] = {}

    def play(positions: Floats, rounds: int) -> _Played:
        reading = measured(positions[0], numbers[RESOLUTION], numbers[PHASE])
        if reading not in resting:
            resting[reading] = resting_memory(setup, reading)
        memory, taken = resting[reading].copy(), np.zeros(rounds)
        scratch = np.empty(len(memory)), np.zeros(STATE_SIZE), np.zeros(late + 2)
        lost = run_rounds(positions, numbers, memory, *scratch, late, share, coulomb, drag, taken)
        total, half = float(taken[-1]), max(rounds // 2, 1)
        if not isfinite(total):
            return _taken(device, law, positions, rounds)
        since = float(taken[-1 - half]) if half < rounds else 0.0
        return _Played((total - since) / half, total if abs(total) > ROUNDING * lost else 0.0, rounds)

    return play


def _taken(device: Device, environment: Environment, positions: Floats, rounds: int) -> _Played:
    path = _listed(positions, rounds)
    period = device.motor_side.exact("sample_period")
    trace = simulate(device, environment, PrescribedMotion(path), (len(path) - 1) * period)
    taken, total = _balance(trace)
    half = max((len(taken) - 1) // len(positions) // 2, 1)  # a motion that diverges ends early
    since = max(len(taken) - 1 - half * len(positions), 0)
    return _Played(float(taken[-1] - taken[since]) / half, total, rounds)


def _balance(trace: xr.Dataset) -> tuple[Floats, float]:
    """What was taken out up to each sample, and in all, 0 where that is rounding [J]."""
    taken = trace["kinetic_energy"].values - trace["hand_work"].values  # what moves at the end is not lost
    lost = float(trace["coulomb_loss"][-1] + trace["viscous_loss"][-1])
    return taken, float(taken[-1]) if abs(taken[-1]) > ROUNDING * lost else 0.0


def taken_out(device: Device, law: Environment, positions: Floats, switches: Floats | None) -> float:
    """What a whole motion takes out, from rest to rest, by the simulator [J]."""
    stays = None if switches is None else np.append(switches, positions[-1])  # for a sample at its end
    hand = PrescribedMotion(np.append(positions, positions[-1]), switch_positions=stays)
    return _balance(simulate(device, law, hand, len(positions) * device.exact("sample_period")))[1]


def _listed(positions: Floats, rounds: int) -> Floats:
    return np.concatenate([np.tile(positions, rounds), positions[:1]])
