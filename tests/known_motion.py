"""A device moved along a known path: the force follows from its equation of motion, without a simulator."""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np

MASS, DAMPING, COULOMB = 0.0357, 0.153, 0.118
"""[kg, N·s/m, N] of the device in every recording here."""

STEP, PERIOD, NOISE = 22.4e-6, 1e-3, 0.05
"""[m] of the encoder, [s] between samples, [N] of the load cell."""


class Recording(NamedTuple):
    """Time [s], position as the encoder read it [m], force of the hand as the load cell read it [N]."""

    time: np.ndarray
    position: np.ndarray
    force: np.ndarray


@lru_cache
def paddle(seconds: float = 20.0, quadratic: float = 0.0, coulomb: float = COULOMB) -> Recording:
    """Strokes of some centimetres, ten sines together; friction f_c + b |v| + c v²."""
    random = np.random.default_rng(11)
    time = PERIOD * np.arange(round(seconds / PERIOD))
    rate = 2 * np.pi * random.uniform(0.4, 5.0, 10)
    phase, size = random.uniform(0, 2 * np.pi, 10), 0.03 * random.normal(size=10) / np.sqrt(rate)
    angle = rate[:, None] * time + phase[:, None]
    position = size @ np.sin(angle)
    velocity, acceleration = (size * rate) @ np.cos(angle), -(size * rate**2) @ np.sin(angle)
    friction = np.sign(velocity) * (coulomb + quadratic * velocity**2) + DAMPING * velocity
    force = MASS * acceleration + friction + 0.3 + NOISE * random.normal(size=time.size)
    return Recording(time, STEP * np.floor(position / STEP), force)
