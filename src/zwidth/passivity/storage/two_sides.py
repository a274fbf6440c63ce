"""Two claims sought from two sides of a limit, the work shared fairly between them.

Each side asks at one value after the other: on from the farthest at which its claim was shown, and then
between it and the nearest at which it was not.  An answer is evidence by itself, so that a law which is safe,
unsafe and safe again loses only the best bracket.
"""

from __future__ import annotations

from collections.abc import Callable
from math import log2, sqrt

from zwidth.quantity.exact import Exact

_FARTHEST = 60
"""Doublings from the first guess after which there is no limit."""

_AHEAD = 0.5
"""Work by which the first side may be ahead of the other: it tells the other where to begin."""


Clock = Callable[[], float]
"""What has been done so far, as `solve.effort` counts it."""


class Side:
    """One claim, and how far it has been shown.

    Parameters
    ----------
    holds
        Whether the claim was shown at a value with no more than what is given, of all that is done.
    towards
        1 if it is the harder to show the larger the value, −1 if the smaller.
    origin
        The first guess.
    good
        The farthest value at which it is known already.
    """

    def __init__(
        self, holds: Callable[[Exact, float], bool], towards: int, origin: Exact, good: Exact | None = None
    ) -> None:
        self.holds, self.towards, self.origin, self.good = holds, towards, origin, good
        self.bad: Exact | None = None
        self.spent = 0.0
        self._ahead = 0

    def begin(self) -> None:
        """Seek anew with sharper means: what failed before may be shown now."""
        self.bad, self._ahead = None, 0

    def ask(self, value: Exact, other: Side, most: float, clock: Clock) -> None:
        """Try the claim at a value, with a part of the work that is left, that there is some for others."""
        self._ahead += (self.good is None) != (self._nearest(other.good) is None)
        begun = clock()
        left = max(most - begun, 0.0)
        if self.holds(value, begun + left / (2 if self.good is None else 4)):
            self.good = value
        else:
            self.bad = value
        self.spent += clock() - begun

    def next(self, other: Side, fine: float) -> Exact | None:
        """Where to ask; None if nothing is to be gained by it."""
        good, bad = self.good, self._nearest(other.good)
        if good is not None and bad is not None:
            if abs(bad - good) <= fine * max(bad, good):
                return None
            value = _decimal(sqrt(good * bad))
            return None if value in (good, bad) else value
        if good is None and self.bad is None and other.bad is not None:
            return other.bad
        known = bad if good is None else good
        if known is None:
            return self.origin
        onward = -self.towards if good is None else self.towards
        factor = min((1.0 + 4 * fine) ** (2.0 ** min(self._ahead, 10)), 4.0)
        value = _decimal(known * factor**onward)
        return value if abs(log2(value / self.origin)) <= _FARTHEST else None

    def _nearest(self, other: Exact | None) -> Exact | None:
        """The value that is known to be beyond: here it was not shown, or its contrary was."""
        known = [value for value in (self.bad, other) if value is not None]
        return min(known, key=lambda value: self.towards * value) if known else None


def approach(first: Side, second: Side, fine: float, most: float, clock: Clock) -> None:
    """Let both sides ask until neither gains, or so much is done; the one that has had less goes next."""
    for side in (first, second):
        side.begin()
    while clock() < most:
        own, others = first.next(second, fine), second.next(first, fine)
        behind = first.spent <= second.spent + _AHEAD
        if own is not None and (behind or others is None):
            first.ask(own, second, most, clock)
        elif others is not None:
            second.ask(others, first, most, clock)
        else:
            return


def _decimal(value: float) -> Exact:
    """A value of six digits, as a person would write it down."""
    return Exact(f"{value:.6g}")
