"""Strokes of a hand along a path that is given, the forces by the equation of motion."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

import zwidth as zw

TRUE = {"mass": 0.036, "damping": 0.15, "coulomb_friction": 0.12}
"""The haptic paddle of Abbott & Okamura (2005)."""


def recorded(
    kinds: Sequence[tuple[float, float, float]],
    rng: np.random.Generator,
    *,
    period: float = 1e-3,
    resolution: float = 22.4e-6,
    noise: float = 0.1,
    mass: float = 0.036,
    damping: float = 0.15,
    coulomb_friction: float = 0.12,
) -> zw.Log:
    """A log of strokes, (length [m], duration [s], seconds of such), varied by 15 %."""
    parts = []
    here = 0.0
    for length, duration, seconds in kinds:
        end, goal = seconds, length / 2
        while end > 0:
            time = duration * np.exp(0.15 * rng.normal())
            there = goal * np.exp(0.15 * rng.normal())
            phase = np.pi * np.arange(round(time / period)) / round(time / period)
            half, omega = (there - here) / 2, np.pi / (round(time / period) * period)
            parts.append(
                (
                    here + half * (1 - np.cos(phase)),
                    half * omega * np.sin(phase),
                    half * omega**2 * np.cos(phase),
                )
            )
            here, goal, end = there, -goal, end - time
    x, v, a = (np.concatenate(column) for column in zip(*parts, strict=True))
    force = mass * a + damping * v + coulomb_friction * np.sign(v)
    zero = 0.05 * np.interp(np.arange(x.size) * period, [0, 20, 40, 60, 80], rng.normal(size=5))
    return zw.Log.from_arrays(
        time=np.arange(x.size) * period,
        position=np.floor(x / resolution) * resolution,
        hand_force=force + zero + noise * rng.normal(size=x.size),
        sample_period=period,
        resolution=resolution,
    )
