"""How times are spread, counted while the loop runs: in bins that are each a sixteenth of an octave wide."""

from __future__ import annotations

from math import log2

import numpy as np
from numpy.typing import NDArray

from zwidth.native.compiled import compiled

_PER_OCTAVE = 16
BINS = 40 * _PER_OCTAVE
"""Up to 2⁴⁰ ns, 18 minutes."""


@compiled
def count(bins: NDArray[np.int64], nanoseconds: float) -> None:
    """Count a time."""
    at = int(log2(nanoseconds) * _PER_OCTAVE) if nanoseconds > 1.0 else 0
    bins[min(at, bins.shape[0] - 1)] += 1


def quantile(bins: NDArray[np.int64], share: float) -> float:
    """The time that this share of those counted does not exceed [s], 4.4 % too long at most; 0 of none."""
    total = int(bins.sum())
    if total == 0:
        return 0.0
    upto = np.cumsum(bins)
    at = int(np.searchsorted(upto, np.ceil(share * total)))
    return float(2.0 ** ((at + 1) / _PER_OCTAVE) * 1e-9)
