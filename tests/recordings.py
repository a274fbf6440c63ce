"""What a load cell and an encoder record of a hand that moves a device about; the truth is known."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

import zwidth as zw

Array = NDArray[np.float64]


class Recording(NamedTuple):
    """Samples: what was read, and what was true."""

    time: Array
    position: Array
    hand_force: Array
    true_position: Array
    true_velocity: Array
    true_force: Array


def paddle(**others: object) -> zw.Device:
    """The haptic paddle of Abbott & Okamura (2005)."""
    numbers = {"mass": 0.036, "damping": 0.15, "coulomb_friction": 0.12}
    return zw.Device(**{**numbers, "resolution": "22.4 um", "sample_period": "1 ms", **others})


def hand_moves(
    device: zw.Device, seconds: float, seed: int, *, noise: float = 0.1, drift: float = 0.05
) -> Recording:
    """A hand wanders about 20 mm to and fro; the load cell has white noise [N] and a drifting zero [N].

    The hand is a spring without damper or mass: its force has no jumps where the path is bent.  It is soft,
    since the path is straight between samples: that looks like a mass of k T²/12.
    """
    rng = np.random.default_rng(seed)
    period = float(device.exact("sample_period"))
    samples = round(seconds / period)
    time = np.arange(samples + 1) * period
    waves = zip(rng.normal(size=12), rng.uniform(0.3, 4.0, 12), rng.uniform(0, 6.28, 12), strict=True)
    path = sum(a * np.sin(2 * np.pi * f * time + p) for a, f, p in waves)
    path = path * 0.02 / path.std() - 1.0
    hand = zw.operators.Tracking(path, stiffness=40.0, damping=0.0)
    wall = zw.Wall(stiffness=1)  # a metre away
    trace = zw.simulate(device, wall, hand, samples * device.exact("sample_period"), initial_position=path[0])
    read, x, v, force = (
        trace[name].values[:samples] for name in ("measured_position", "position", "velocity", "hand_force")
    )
    knots = np.arange(0.0, seconds + 20.0, 20.0)
    zero = np.interp(time[:-1], knots, drift * np.cumsum(rng.normal(size=knots.size)))
    measured = force + zero + noise * rng.normal(size=samples)
    return Recording(time[:-1], read, measured, x, v, force)


def best_possible(recording: Recording, noise: float) -> Array:
    """Cramér–Rao bound of m, b, f_c with the true motion known and a line of drift in each 10 s."""
    moving = recording.true_velocity != 0
    v = recording.true_velocity
    regressors = np.stack([np.gradient(v, recording.time), v, np.sign(v)], axis=1)[moving]
    piece = (recording.time[moving] // 10.0).astype(int)
    for k in np.unique(piece):
        here = piece == k
        line = np.stack([np.ones(here.sum()), recording.time[moving][here]], axis=1)
        basis, _ = np.linalg.qr(line)
        regressors[here] -= basis @ (basis.T @ regressors[here])
    return noise * np.sqrt(np.diag(np.linalg.inv(regressors.T @ regressors)))
