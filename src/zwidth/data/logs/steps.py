"""The step of the encoder, from the positions it gave: x = x₀ + n q.

The spacings between the values that occur are whole multiples of q, up to the
rounding of the numbers.  Their common divisor is found by Euclid's algorithm
with that rounding as its zero, then fitted over the whole range.  Decimals are
a grid too, 0.001 mm in a text: behind it the coarser grid of an encoder is
looked for, with half a decimal as rounding.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

_DOUBLE, _SINGLE = 4 * 2.0**-52, 2.0**-23
FEWEST = 8
"""Different positions that it takes to speak of a step."""

ON_GRID = 0.1
"""Farthest from a multiple, in steps, that still counts as one."""


class Grid(NamedTuple):
    """Positions x₀ + n q."""

    step: float
    offset: float


def grid_of(positions: Array, unit: float = 1.0) -> Grid | None:
    """The coarsest grid that the positions lie on; None if they lie on none, or too few differ.

    Parameters
    ----------
    positions
        [m; rad] some of the log.
    unit
        [m; rad] of the numbers in the file: decimals are decimals in it.
    """
    levels = np.unique(positions)
    if levels.size < FEWEST:
        return None
    size = float(np.abs(levels).max())
    for noise in (_DOUBLE * size, _SINGLE * size):
        grid = _fitted(levels, noise)
        if grid is None or grid.step < 2 * _SINGLE * size:
            continue
        if _is_decimal(grid.step / abs(unit)):
            return _fitted(levels, 0.5 * grid.step) or grid
        return grid
    return None


def on_grid(positions: Array, grid: Grid) -> int:
    """How many positions lie on the grid."""
    turns = (positions - grid.offset) / grid.step
    return int(np.count_nonzero(np.abs(turns - np.rint(turns)) <= ON_GRID))


def offset_on(positions: Array, step: float) -> float:
    """x₀ in (−q/2, q/2] for a known step: the mean direction of the positions on a circle of length q."""
    angles = 2 * np.pi * np.remainder(positions / step, 1.0)
    turn = math.atan2(float(np.sin(angles).mean()), float(np.cos(angles).mean())) / (2 * np.pi)
    return 0.0 if abs(turn) < 1e-3 else turn * step


def _fitted(levels: Array, noise: float) -> Grid | None:
    spacings = np.diff(levels)
    spacings = np.unique(spacings[spacings > 4 * noise])
    step = _divisor(spacings, noise) if spacings.size else 0.0
    if step < 8 * noise or step == 0.0:
        return None
    step = _refined(levels, step, noise)
    grid = Grid(_short(step, 2 * noise / max(1.0, (levels[-1] - levels[0]) / step)), 0.0)
    grid = Grid(grid.step, offset_on(levels, grid.step))
    turns = (levels - grid.offset) / grid.step
    rest = np.abs(turns - np.rint(turns))
    return grid if np.mean(rest <= max(ON_GRID * 0.5, 2 * noise / grid.step)) > 0.995 else None


def _divisor(spacings: Array, noise: float) -> float:
    """The greatest common divisor of lengths known within a few times the noise."""
    step = float(spacings[0])
    for _ in range(64):
        counts = np.rint(spacings / step)
        slack = 4 * noise * (1 + counts)
        sure = slack < 0.25 * step
        rest = np.abs(spacings - counts * step)[sure]
        if not sure.any():
            return 0.0
        left = rest[rest > slack[sure]]
        if left.size == 0:
            return float((spacings * counts)[sure].sum() / (counts[sure] ** 2).sum())
        step = float(left.min())
        if step < 8 * noise:
            return 0.0
    return 0.0


def _refined(levels: Array, step: float, noise: float) -> float:
    """The step fitted over wider and wider ranges, each so wide that no count is in doubt."""
    away = np.abs(levels - levels[0])
    reach = 16.0 * step
    while True:
        near = levels[away <= reach] - levels[0]
        counts = np.rint(near / step)
        if counts.any():
            centred = counts - counts.mean()
            step = float((centred * near).sum() / (centred**2).sum())
        if reach >= away[-1]:
            return step
        reach *= 4.0


def _short(value: float, uncertainty: float) -> float:
    """The shortest decimal within the uncertainty."""
    for digits in range(3, 17):
        text = float(f"{value:.{digits - 1}e}")
        if abs(text - value) <= uncertainty:
            return text
    return value


def _is_decimal(value: float) -> bool:
    """True for 1, 0.1, 0.01 … up to rounding."""
    exponent = math.log10(value)
    return abs(exponent - round(exponent)) < 1e-6 and exponent < 0.5
