"""Frequencies up to half the rate, for curves of what is sampled."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from zwidth.errors import InputError

_POINTS = 2000


def sampled_frequencies(given: ArrayLike | None, period: float) -> NDArray[np.float64]:
    """Those that were given, or 2000 evenly between 0 and 1/(2T) [Hz]."""
    nyquist = 0.5 / period
    if given is None:
        return np.asarray((np.arange(_POINTS) + 0.5) * (nyquist / _POINTS), dtype=np.float64)
    hertz = np.atleast_1d(np.asarray(given, dtype=np.float64))
    if hertz.ndim != 1 or not np.all((hertz > 0) & (hertz <= nyquist * (1 + 1e-12))):
        raise InputError(f"frequencies must lie above 0 and up to half the rate, {nyquist:g} Hz")
    return hertz
