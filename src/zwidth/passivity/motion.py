"""A motion of the hand, exact, and how one is made from the law's inner signal.

With x = D w the force is f = N w, so a motion made from whole numbers w keeps
exact, short numbers through the filter, and a w that ends in zeros brings the
filter back to rest.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from fractions import Fraction
from math import ceil, floor, log10

from zwidth.passivity.loop import LinearLoop
from zwidth.passivity.supremum import tightest


@dataclass(frozen=True)
class Motion:
    """Positions at the samples, with a part that may be done many times.

    Parameters
    ----------
    positions
        x(k) [m; rad], from rest to rest.
    switch_positions
        Position in each interval at the instant when a delayed force changes;
        empty for a delay of whole samples.
    first, last, times
        The part from sample `first` to `last` is done `times` times in all.
    """

    positions: tuple[Fraction, ...]
    switch_positions: tuple[Fraction, ...] = ()
    first: int = 0
    last: int = 0
    times: int = 1

    def repeated(self, times: int) -> Motion:
        """The same motion with another number of rounds."""
        return replace(self, times=times)

    @property
    def samples(self) -> int:
        """Intervals in the whole motion."""
        return len(self.positions) - 1 + (self.times - 1) * (self.last - self.first)


@dataclass(frozen=True)
class Pattern:
    """A motion in whole numbers: w of the law's direct form, x = unit · D w.

    `cycle` begins after `lead` and may be repeated; `ends_inside` says that the
    last move, from the end of `fall` to x = 0, is a step and not part of w.
    """

    lead: tuple[int, ...]
    cycle: tuple[int, ...]
    fall: tuple[int, ...]
    ends_inside: bool = False


def realize(loop: LinearLoop, pattern: Pattern, unit: Fraction, offset: Fraction, times: int) -> Motion:
    """The motion x = unit · D w, with the best instants inside samples.

    `offset` is added away from the ends: it moves the hand off the encoder's
    edges without changing a count.
    """
    w = pattern.lead + pattern.cycle + pattern.fall
    x = [unit * v for v in convolve(loop.denominator, w)]
    if pattern.ends_inside:
        x.append(Fraction(0))
    placed = tuple(v + offset if 0 < k < len(x) - 1 else v for k, v in enumerate(x))
    first = len(pattern.lead) - 1
    switches = _switches(loop, w, placed, unit) if loop.part_delay else ()
    return Motion(placed, switches, first, first + len(pattern.cycle), times)


def convolve(a: tuple[int, ...], w: tuple[int, ...]) -> list[int]:
    """(a ∗ w)(k) for k < len(w)."""
    return [sum(c * w[k - i] for i, c in enumerate(a) if c and k >= i) for k in range(len(w))]


def _switches(
    loop: LinearLoop, w: tuple[int, ...], x: tuple[Fraction, ...], unit: Fraction
) -> tuple[Fraction, ...]:
    """Where to be when the force changes: y = x + α Δx − (T/2b) α(1−α) (f_before − f_after).

    There the net work of the interval is least.  Without damping any b will do.
    """
    alpha, d = loop.part_delay, loop.whole_delay
    b = loop.damping or Fraction(max(tightest(loop)[0], 1e-9)).limit_denominator(10**12) / 100
    gain = loop.period / (2 * b) * alpha * (1 - alpha)
    force = [unit * f for f in convolve(loop.numerator, w)]

    def at(k: int) -> Fraction:
        return force[k] if 0 <= k < len(force) else Fraction(0)

    grid = unit / 4096
    ideal = (
        x[k] + alpha * (x[k + 1] - x[k]) - gain * (at(k - d - 1) - at(k - d)) for k in range(len(x) - 1)
    )
    return tuple(round(y / grid) * grid for y in ideal)


def round_up(target: Fraction) -> Fraction:
    """The decimal of one digit at or just above a target > 0."""
    power = Fraction(10) ** floor(log10(target.numerator) - log10(target.denominator))
    return power * ceil(target / power)
