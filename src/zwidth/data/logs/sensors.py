"""What the sensors did: the step of an encoder, a counter that overflows, a force at the end of its range.

    x = x₀ + n q

The spacings between the values that occur are whole multiples of q, up to the rounding of the numbers.  Their
common divisor is found by Euclid's algorithm with that rounding as its zero, then fitted over the whole
range.  Decimals are a grid too, 0.001 mm in a text: behind it the coarser grid of an encoder is looked for,
with half a decimal as rounding.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from zwidth.quantity.text import shown

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from zwidth.native.compiled import Array

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
    """The coarsest grid that the positions [m; rad] lie on; None if they lie on none, or too few differ.
    Decimals are decimals in the `unit` [m; rad] of the numbers in the file."""
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
    step = _refined(levels, step)
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


def _refined(levels: Array, step: float) -> float:
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
    for digits in range(3, 17):
        text = float(f"{value:.{digits - 1}e}")
        if abs(text - value) <= uncertainty:
            return text
    return value


def _is_decimal(value: float) -> bool:
    """True for 1, 0.1, 0.01 … up to rounding."""
    exponent = math.log10(value)
    return abs(exponent - round(exponent)) < 1e-6 and exponent < 0.5


# Counters that overflow: 65535 is followed by 0, and the device did not jump.  A position wraps with period P
# if every large jump is nearly P, and the positions fill nearly all of P:  x = y + P w(k)  with w the jumps
# so far.

_BITS = range(8, 33)
_LARGE_KEPT = 4096


class Jumps:
    """The largest jumps of a position, and its range."""

    def __init__(self) -> None:
        self.low, self.high = np.inf, -np.inf
        self.large: Array = np.empty(0)
        self._last: float | None = None

    def take(self, position: Array, follows: bool) -> None:
        """Go on with a stretch; `follows` says that it continues the one before."""
        self.low, self.high = min(self.low, float(position.min())), max(self.high, float(position.max()))
        steps = np.abs(np.diff(position))
        if follows and self._last is not None:
            steps = np.append(steps, abs(position[0] - self._last))
        self._last = float(position[-1])
        limit = 0.4 * (self.high - self.low)
        if steps.size and steps.max() > limit:
            all_large = np.unique(np.concatenate((self.large, steps[steps > limit])))
            self.large = all_large[-_LARGE_KEPT:]

    def period(self, step: float, rotary: bool) -> float:
        """[m; rad] P, or 0 if the position does not wrap."""
        span = self.high - self.low
        candidates = [2 * np.pi] if rotary else []
        if step > 0:
            candidates += [2**bits * step for bits in _BITS if 2**bits * step > span * (1 - 1e-9)][:1]
        large = self.large[self.large > 0.4 * span]
        for period in candidates:
            if large.size and span <= period * (1 + 1e-6) and large[-1] >= 0.75 * period:
                away = np.minimum(large, np.abs(period - large))
                if away.max() <= 0.25 * period:
                    return float(period)
        return 0.0


class Unwrapper:
    """Takes the overflows out of a stream of positions."""

    def __init__(self, period: float) -> None:
        self.period, self.count = period, 0
        self._turns = 0.0
        self._last: float | None = None

    def take(self, position: Array) -> Array:
        """The positions as if the counter had no end."""
        if self.period == 0.0:
            return position
        before = position[0] if self._last is None else self._last
        turns = -np.rint(np.diff(position, prepend=before) / self.period)
        self._last = float(position[-1])
        self.count += int(np.count_nonzero(turns))
        total = self._turns + np.cumsum(turns)
        self._turns = float(total[-1])
        return np.asarray(position + self.period * total)


# Where a force sensor is at the end of its range: one of its outermost readings comes far too often.
#
# A force that turns round spends little time at its extreme: of a sine in steps of a converter the outermost
# step comes six times as often as those beside it, of most motions more seldom.  At an end stop it comes
# hundreds of times as often, or each of a few steps does where there is noise behind the stop.

_KEPT, _BESIDE = 64, 16
"""Different readings that are counted at either end, and with how many further inside each is compared."""

_NEAR = 0.01
"""Parts of the whole range within which readings may scatter about a stop."""

_OFTEN = 10
"""Times as often as those a reading at a stop comes."""

_FEWEST = 30
"""Samples of one reading below which nothing is said."""

_FEWEST_WITHOUT_STEPS = 8
"""The same where no other reading beside it comes twice."""


class Stops:
    """How often the outermost readings of a force come, block by block."""

    def __init__(self) -> None:
        self._ends = {sign: (np.empty(0), np.empty(0, dtype=np.int64)) for sign in (-1, 1)}

    def take(self, force: Array) -> None:
        """Count one block."""
        for sign, (values, counts) in self._ends.items():
            outward = sign * force
            if values.size == _KEPT:
                outward = outward[outward >= values[-1]]
            new, times = np.unique(outward, return_counts=True)
            together = np.concatenate((values, new[::-1][:_KEPT]))
            numbers = np.concatenate((counts, times[::-1][:_KEPT]))
            found, where = np.unique(-together, return_inverse=True)
            summed = np.bincount(where.ravel(), weights=numbers).astype(np.int64)
            self._ends[sign] = -found[:_KEPT], summed[:_KEPT]

    def found(self) -> tuple[tuple[float, float], int]:
        """The readings from which on the sensor is at its lower and its upper end, and how many samples are.
        Infinite where it never is. A force of exactly 0 is no stop: nobody touches the sensor then."""
        ends, samples = {-1: -np.inf, 1: np.inf}, 0
        for sign, (values, counts) in self._ends.items():
            if not values.size:
                continue
            near = values >= values[0] - _NEAR * self._range
            at = [k for k in np.flatnonzero(near).tolist() if values[k] != 0 and _piles_up(counts, k)]
            if at:
                ends[sign] = sign * float(values[at[-1]])
                samples += int(counts[: at[-1] + 1].sum())
        return (ends[-1], ends[1]), samples

    @property
    def _range(self) -> float:
        return float(self._ends[-1][0][0] + self._ends[1][0][0])


def beyond(force: Array, stops: tuple[float, float]) -> NDArray[np.bool_]:
    """Where a force is at one of its stops, or further out."""
    return np.asarray((force <= stops[0]) | (force >= stops[1]))


def at_ends(stops: tuple[float, float], unit: str) -> str:
    """The finite ones in a sentence: "-10 N and at 10 N"; nothing where there is none."""
    return " and at ".join(shown(end, unit) for end in stops if np.isfinite(end))


def _piles_up(counts: NDArray[np.int64], k: int) -> bool:
    beside = counts[k + 1 : k + 1 + _BESIDE]
    if beside.size < 2:
        return False
    alone = beside.size == _BESIDE and bool((beside == 1).all())
    fewest = _FEWEST_WITHOUT_STEPS if alone else max(_FEWEST, _OFTEN * float(np.median(beside)))
    return bool(counts[k] >= fewest)
