"""A finger that holds a device while its actuator shakes it; the truth is known."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.signal import butter, lfilter

import zwidth as zw
from zwidth.model.operator.operator import LinearHand, Operator, Signals

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, eq=False)
class _Shaken(Operator):
    """To the device it is the same whether its actuator or the hand pushes with −f_a."""

    push: Array
    wanted: Array
    constants: LinearHand

    @property
    def hand(self) -> LinearHand:
        return self.constants

    def signals(self, times: Array) -> Signals:
        return Signals(force=self.push, anchor=self.wanted)

    def describe(self, motion: str = "linear") -> str:
        return "a finger that is shaken"


def shaken(
    device: zw.Device,
    finger: tuple[float, float, float],
    seconds: float,
    seed: int,
    *,
    push: float = 1.0,
    noise: float = 0.02,
    tremor: float = 0.0,
) -> dict[str, Array]:
    """Arrays of a log: ±push [N] for 10 ms each at random, a finger (m, c, k) that wanders a little.

    The load cell has white noise [N]; the finger trembles at 8 to 12 Hz with so many newtons.
    """
    rng = np.random.default_rng(seed)
    period = float(device.exact("sample_period"))
    samples, hold = round(seconds / period), max(round(0.01 / period), 1)
    time = np.arange(samples + 1) * period
    push_made = push * np.repeat(rng.choice([-1.0, 1.0], samples // hold + 1), hold)[:samples]
    waves = zip(rng.normal(size=12), rng.uniform(0.1, 1.5, 12), rng.uniform(0, 6.28, 12), strict=True)
    wanted = sum(a * np.sin(2 * np.pi * f * time + p) for a, f, p in waves)
    wanted = wanted * 0.0005 / wanted.std() - 1.0
    own = lfilter(*butter(2, [16 * period, 24 * period], "band"), rng.normal(size=samples))
    mass, damping, stiffness = finger
    operator = _Shaken(
        push=push_made + tremor * own / own.std(),
        wanted=wanted,
        constants=LinearHand(mass, stiffness, damping),
    )
    wall = zw.Wall(stiffness=1)  # a metre away
    trace = zw.simulate(
        device, wall, operator, samples * device.exact("sample_period"), initial_position=wanted[0]
    )
    return {
        "time": time[:samples],
        "position": trace.measured_position.values[:samples],
        "hand_force": trace.hand_force.values[:samples] - push_made + noise * rng.normal(size=samples),
        "actuator_force": -push_made,
    }
