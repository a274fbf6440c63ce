"""The published way to identify a device: smooth, differentiate, smooth, differentiate, least squares.

    [ẍ  ẋ  sgn ẋ] [m  b  f_c]ᵀ = f_h,    p = A† f_h

one row a sample, A† the pseudoinverse by singular value decomposition.  The position goes
through a three-point moving average several times before it is differentiated, and so does the
velocity (Abbott & Okamura 2005, section IV-B).  Without the last column it is the fit of a mass
and a damper that the same section warns of.

The paper does not say how often the average is taken, nor how it differentiates: here central
differences, and a number of passes that can be chosen.  N passes blur by √(2N/3) samples.  The force is not
smoothed, and where the smoothed velocity turns is not where friction does; both bias the
estimate, few passes leave the counts of the encoder in, many take away the motion.  It is
here to be compared with `identify`, which has no such number to choose.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

import numpy as np

from zwidth.data.logs import Block, Log
from zwidth.data.logs.table import whole_runs
from zwidth.errors import InputError
from zwidth.native.compiled import Array
from zwidth.showing import Shown

PASSES = 20
"""Of the moving average where nothing else is said; the paper gives no number."""


@dataclass(frozen=True, kw_only=True, repr=False)
class PublishedFit(Shown):
    """What smoothing and least squares make of a log; without intervals, for the method has none.

    Parameters
    ----------
    mass
        m [kg; kg·m²].
    damping
        b [N·s/m; N·m·s/rad].
    coulomb_friction
        f_c [N; N·m]; None for a mass and a damper.
    explained
        r², part of the force's variance that is explained.
    passes
        Of the moving average, over the position and again over the velocity.
    samples
        Rows of A.
    """

    mass: float
    damping: float
    coulomb_friction: float | None
    explained: float
    passes: int
    samples: int

    def report(self) -> Iterator[str]:
        """The numbers in SI, on one line."""
        yield ", ".join(f"{name} {value:.6g}" for name, value in vars(self).items() if value is not None)


def identify_published(
    log: Log,
    *,
    passes: int = PASSES,
    model: Literal["Coulomb and viscous", "viscous"] = "Coulomb and viscous",
) -> PublishedFit:
    """Fit ``m ẍ + b ẋ + f_c sgn ẋ = f_h − f_a`` to smoothed positions, as Abbott & Okamura (2005) did.

    All samples are held in memory, some 100 bytes each: `identify` reads logs of any length.

    Parameters
    ----------
    log
        With a force; the zero of the load cell set before each run, for no offset is fitted.
    passes
        Of the three-point moving average, ≥ 0.
    model
        "viscous": a mass and a damper.

    Raises
    ------
    InputError
        If there is no force, the passes are no count, or the runs are too short for them.
    """
    if not log.channels:
        raise InputError(f"{log.source} has no force: nothing to fit mass and friction to; log a force")
    if isinstance(passes, bool) or not isinstance(passes, int) or passes < 0:
        raise InputError(f"passes must be a whole number ≥ 0, got {passes!r}: so often the average is taken")
    if model not in ("Coulomb and viscous", "viscous"):
        raise InputError(f'model is "Coulomb and viscous" or "viscous", got {model!r}')
    parts = [
        _rows(run.position, _force(run), passes, log.sample_period)
        for run in whole_runs(log.blocks())
        if run.position.size > 4 * passes + 4
    ]
    matrix = np.concatenate([m for m, _ in parts]) if parts else np.empty((0, 3))
    if model == "viscous":
        matrix = matrix[:, :2]
    if len(matrix) <= matrix.shape[1]:
        raise InputError(
            f"{log.source} has no run longer than the smoothing, {4 * passes + 4} samples: take fewer passes"
        )
    force = np.concatenate([f for _, f in parts])
    found, _, rank, _ = np.linalg.lstsq(matrix, force)
    if rank < matrix.shape[1]:
        raise InputError(f"{log.source} does not tell the parameters apart: move to and fro, at many speeds")
    left = force - matrix @ found
    return PublishedFit(
        mass=float(found[0]),
        damping=float(found[1]),
        coulomb_friction=float(found[2]) if model == "Coulomb and viscous" else None,
        explained=float(1 - left @ left / np.sum((force - force.mean()) ** 2)),
        passes=passes,
        samples=len(matrix),
    )


def _force(run: Block) -> Array:
    """f_h − f_a, as far as they were logged."""
    force = np.zeros(run.position.size)
    if run.hand_force is not None:
        force += run.hand_force
    if run.actuator_force is not None:
        force -= run.actuator_force
    return force


def _rows(position: Array, force: Array, passes: int, period: float) -> tuple[Array, Array]:
    """[ẍ ẋ sgn ẋ] and f where both averages and both differences are whole."""
    speed = _smoothed(_slope(_smoothed(position, passes), period), passes)
    acceleration = _slope(speed, period)
    speed = speed[1:-1]
    edge = 2 * passes + 2
    # what rounding leaves of a speed of 0, where the handle turns, has no side
    rounded = 4 * (passes + 1) * np.finfo(float).eps * np.abs(position).max() / period
    side = np.where(np.abs(speed) > rounded, np.sign(speed), 0.0)
    return np.stack([acceleration, speed, side], axis=1), force[edge:-edge]


def _smoothed(values: Array, passes: int) -> Array:
    for _ in range(passes):
        values = (values[:-2] + values[1:-1] + values[2:]) / 3
    return values


def _slope(values: Array, period: float) -> Array:
    return np.asarray((values[2:] - values[:-2]) / (2 * period))
