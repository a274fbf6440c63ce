"""Where a slider stands for a number: decades along its length, with 0 at the very left.

    value = low (high/low)^share,  0 < share ≤ 1;    share = 0: nothing, where that may be

The ends come from the unit of the quantity, or lie around the number that a loop came with.
"""

from __future__ import annotations

from collections.abc import Mapping
from math import isfinite, log
from types import MappingProxyType
from typing import NamedTuple

AROUND = 30.0
"""A number that is given stands in the middle, with so many times less and more beside it."""

_LINEAR = {
    "1": (0.01, 1.0, 100.0), "N*s/m": (1e-3, 0.1, 100.0), "N": (1e-3, 0.1, 100.0), "m": (1e-7, 1e-5, 0.01),
    "N/m": (1.0, 200.0, 1e5), "kg": (1e-3, 0.1, 10.0), "s/m": (0.01, 1.0, 100.0), "m/s": (1e-3, 0.2, 10.0),
    "s": (1e-5, 1e-3, 0.1), "Hz": (50.0, 1000.0, 20e3), "J": (1e-5, 1e-3, 1.0), "N/s": (1.0, 1e3, 1e6),
    "H": (1e-5, 1e-3, 0.1), "V": (1.0, 24.0, 100.0), "A": (0.1, 3.0, 50.0), "s/m^2": (0.01, 1.0, 1e3),
}  # fmt: skip
_ROTARY = {
    "N*m*s/rad": (1e-6, 1e-3, 1.0), "N*m": (1e-4, 5e-3, 10.0), "rad": (1e-6, 1e-3, 0.1),
    "N*m/rad": (1e-3, 0.5, 1e3), "kg*m^2": (1e-7, 1e-4, 0.1), "s/rad": (1e-3, 0.1, 10.0),
    "rad/s": (0.01, 2.0, 100.0), "N*m/s": (0.01, 10.0, 1e4),
}  # fmt: skip

SPANS: Mapping[str, tuple[float, float, float]] = MappingProxyType({**_LINEAR, **_ROTARY})
"""By unit: the least, a usual one, and the most that a slider reaches where no number is given."""

_ELSE = (1e-3, 1.0, 1e3)


class Scale(NamedTuple):
    """What a slider's length stands for.

    Parameters
    ----------
    low, high
        > 0, of the share 0 and 1 of its length.
    has_zero
        True where the very left is nothing.
    whole
        True for a count.
    """

    low: float
    high: float
    has_zero: bool
    whole: bool = False

    def share(self, value: float) -> float:
        """Where a number stands, 0 to 1; one that is not on it stands at the nearer end."""
        if value <= 0 or not isfinite(value):
            return 0.0
        return min(max(log(value / self.low) / log(self.high / self.low), 0.0), 1.0)

    def value(self, share: float) -> float:
        """What stands at a share of the length, to three digits."""
        if not isfinite(share) or (share <= 0 and self.has_zero):
            return 0.0 if self.has_zero else self.low
        found = self.low * (self.high / self.low) ** min(share, 1.0)
        return float(max(1, round(found))) if self.whole else float(f"{found:.3g}")


def scale_of(value: float | None, unit: str, has_zero: bool, whole: bool = False) -> Scale:
    """The scale around a number; by its unit where there is none, or it is not above 0."""
    if value is None or value <= 0:
        low, _, high = SPANS.get(unit, _ELSE)
    else:
        low, high = value / AROUND, value * AROUND
    return Scale(max(low, 1.0) if whole else low, max(high, 10.0) if whole else high, has_zero, whole)


def usual(unit: str) -> float:
    """A number of this unit to begin with."""
    return SPANS.get(unit, _ELSE)[1]
