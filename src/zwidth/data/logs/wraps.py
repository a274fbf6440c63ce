"""Counters that overflow: 65535 is followed by 0, and the device did not jump.

A position wraps with period P if every large jump is nearly P, and the
positions fill nearly all of P:  x = y + P w(k)  with w the jumps so far.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

_BITS = range(8, 33)
_KEPT = 4096


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
            self.large = all_large[-_KEPT:]

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
