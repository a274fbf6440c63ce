"""Where a force sensor is at the end of its range: one of its outermost readings comes far too often.

A force that turns round spends little time at its extreme: of a sine in steps of a converter the outermost
step comes six times as often as those beside it, of most motions more seldom.  At an end stop it comes
hundreds of times as often, or each of a few steps does where there is noise behind the stop.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

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

        Infinite where it never is.  A force of exactly 0 is no stop: nobody touches the sensor then.
        """
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
        """From the smallest reading to the largest."""
        return float(self._ends[-1][0][0] + self._ends[1][0][0])


def beyond(force: Array, stops: tuple[float, float]) -> NDArray[np.bool_]:
    """Where a force is at one of its stops, or further out."""
    found: NDArray[np.bool_] = (force <= stops[0]) | (force >= stops[1])
    return found


def at_ends(stops: tuple[float, float], unit: str) -> str:
    """The finite ones in a sentence: "-10 N and at 10 N"; nothing where there is none."""
    return " and at ".join(f"{end:.4g} {unit}" for end in stops if np.isfinite(end))


def _piles_up(counts: NDArray[np.int64], k: int) -> bool:
    beside = counts[k + 1 : k + 1 + _BESIDE]
    if beside.size < 2:
        return False
    alone = beside.size == _BESIDE and bool((beside == 1).all())
    fewest = _FEWEST_WITHOUT_STEPS if alone else max(_FEWEST, _OFTEN * float(np.median(beside)))
    return bool(counts[k] >= fewest)
