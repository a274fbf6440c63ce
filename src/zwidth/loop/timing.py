"""The clock of the loop: regular, or with samples that come late or not at all.

    t_k = k T + ε_k,   0 ≤ ε_k < T,   ε_0 = 0

A late sample is measured late, and its force is applied `delay` after it.  At a missed sample nothing is
measured and nothing computed: the law and the force stay as they were.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from zwidth.errors import InputError
from zwidth.quantity.exact import RealLike
from zwidth.quantity.parameter import Parametric, Reads, part, read_number
from zwidth.quantity.text import shown

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]


def _seconds(given: Any, name: str) -> Any:
    return float(read_number(given, "sample_period", name)) if isinstance(given, str) else given


@dataclass(frozen=True, kw_only=True, eq=False)
class Timing(Parametric):
    """Lateness and missed samples, drawn at random or as recorded.

    Parameters
    ----------
    lateness
        The largest lateness [s], 0 ≤ lateness < T: each sample is late by an amount drawn
        evenly from 0 to it; or ε_k of every sample 0 … N as recorded.
    missed
        The probability that a sample is missed, 0 ≤ p ≤ 1; or, for every sample, whether it is.
        Sample 0 is never missed when drawn.
    seed
        Of the random draws.
    """

    lateness: Reads[float | Sequence[float], RealLike | Sequence[float]] = part(
        "seconds", _seconds, 0.0, meaning="largest lateness, or that of every sample"
    )
    missed: float | Sequence[bool] = 0.0
    seed: int = 0

    def late(self, samples: int, period: float) -> Array:
        """ε_k of samples 0 … N [s].

        Raises
        ------
        InputError
            If one is negative, T or more, not finite, or their number is not N + 1.
        """
        if np.ndim(self.lateness) == 0:
            draws = np.random.default_rng(self.seed).random(samples + 1) * float(self.lateness)  # type: ignore[arg-type]
            draws[0] = 0.0
            if not 0 <= float(self.lateness) < period:  # type: ignore[arg-type]
                raise InputError(_lateness(self.lateness, period))
            return draws
        given = _of_length(self.lateness, samples + 1, "lateness")
        bad = given[~((given >= 0) & (given < period))]
        if bad.size:
            raise InputError(_lateness(bad[0], period))
        if given[0] != 0.0:
            raise InputError(
                f"the first lateness must be 0 s, got {given[0]:g}: time is counted from sample 0"
            )
        return given

    def skipped(self, samples: int) -> Array:
        """1 where a sample 0 … N is missed, else 0.

        Raises
        ------
        InputError
            If the probability is not one, or the record has not N + 1 values.
        """
        if np.ndim(self.missed) == 0:
            chance = float(self.missed)  # type: ignore[arg-type]
            if not 0 <= chance <= 1:
                raise InputError(f"missed is a probability from 0 to 1, got {chance:g}")
            draws = np.random.default_rng([self.seed, 1]).random(samples + 1)
            result = (draws < chance).astype(np.float64)
            result[0] = 0.0
            return result
        return (_of_length(self.missed, samples + 1, "missed") != 0).astype(np.float64)

    def describe(self) -> str:
        """In words."""
        late = "lateness as recorded"
        if isinstance(self.lateness, (int, float)):
            late = f"up to {shown(self.lateness, 's', 6)} late"
        lost = f"{self.missed:.4g} of them missed" if np.ndim(self.missed) == 0 else "missed as recorded"
        return f"samples {late}, {lost}, seed {self.seed}"


def _of_length(values: object, length: int, what: str) -> Array:
    array = np.asarray(values, dtype=np.float64)
    if array.shape != (length,):
        raise InputError(
            f"{what} has shape {array.shape}; it needs one value for each sample 0 … N, that is ({length},)"
        )
    if not np.isfinite(array).all():
        raise InputError(f"{what}[{int(np.flatnonzero(~np.isfinite(array))[0])}] is not finite")
    return array


def _lateness(value: object, period: float) -> str:
    return (
        f"lateness must be ≥ 0 s and below the sample period {shown(period, 's', 6)}, got {value}: samples "
        "keep their order; a longer pause is a missed sample"
    )
