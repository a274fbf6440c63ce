"""A log from arrays."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from zwidth.errors import InputError
from zwidth.identification.logs.log import BLOCK_SIZE, Block, Log, Motion

if TYPE_CHECKING:
    from numpy.typing import ArrayLike


def log_of(
    *,
    time: ArrayLike,
    position: ArrayLike,
    hand_force: ArrayLike | None = None,
    actuator_force: ArrayLike | None = None,
    resolution: float = 0.0,
    motion: Motion = "linear",
) -> Log:
    """A log from arrays in SI units."""
    t, x = np.asarray(time, dtype=np.float64), np.asarray(position, dtype=np.float64)
    hand, actuator = (
        None if a is None else np.asarray(a, dtype=np.float64) for a in (hand_force, actuator_force)
    )
    if t.size < 2 or t.shape != x.shape:
        raise InputError("time and position need two samples at least, and as many of each")

    def blocks() -> Iterator[Block]:
        for k in range(0, t.size, BLOCK_SIZE):
            part = slice(k, k + BLOCK_SIZE)
            yield Block(
                0,
                t[part],
                x[part],
                None if hand is None else hand[part],
                None if actuator is None else actuator[part],
            )

    channels = tuple(n for n, a in (("hand_force", hand), ("actuator_force", actuator)) if a is not None)
    period = float((t[-1] - t[0]) / (t.size - 1))
    return Log(
        source="arrays",
        motion=motion,
        sample_period=period,
        resolution=float(resolution),
        samples=t.size,
        channels=channels,
        _blocks=blocks,
    )
