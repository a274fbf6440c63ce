"""What is known of a number: where it lies, how it depends on others, how far it is off.

    exact     v ∈ [low, high],   v = Σ c_i s_i + r,   r ∈ [rest_low, rest_high]
    computed  ṽ − v = Σ c_i e_i + Σ d_j ε_j + δ,      |δ| ≤ own,      |ṽ − v| ≤ error

The s_i are what is remembered, off by e_i, and what is no sum of other numbers: a reading, a product of two
of them.  The ε_j are roundings, each in its range.  As each keeps its sign, what cancels is seen to cancel,
and `invariant` sums up what a filter makes of each.  The bounds are computed in double and widened by parts
in 10¹², the coefficients are off by what is in r and in δ.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from math import ceil, copysign, floor, inf, isfinite, sqrt

WIDER = 1e-12
"""Of each bound, relative: thousands of roundings of the bound itself."""

_OFF = 2.0**-52
"""Relative: what a product or a sum of two coefficients is off."""
_LEAST = 2.0**-1060
"""The same where they are very small."""


@dataclass(frozen=True, eq=False)
class Source:
    """A number of its own in [low, high]: no sum of others, a rounding, or a place of the memory, off by
    `error`.
    """

    low: float
    high: float
    place: int | None = None
    error: float = 0.0

    @property
    def size(self) -> float:
        """The largest |s|."""
        return max(abs(self.low), abs(self.high))


Sum = dict[Source, float]
"""Coefficients."""


@dataclass(frozen=True)
class Bound:
    """See above: c_i in `terms`, r in [rest_low, rest_high]; d_j in `noise`, δ in `own`.

    `signed` where the computed number has the sign of the exact one, and is 0 where it is.
    """

    low: float
    high: float
    error: float = 0.0
    terms: Sum = field(default_factory=dict)
    rest_low: float = 0.0
    rest_high: float = 0.0
    noise: Sum = field(default_factory=dict)
    own: float = 0.0
    signed: bool = False

    @property
    def size(self) -> float:
        """The largest |v|."""
        return max(abs(self.low), abs(self.high))

    @property
    def computed_size(self) -> float:
        """The largest |ṽ|."""
        return self.size + self.error

    def with_error(self, more: float) -> Bound:
        """The same with a rounding of its own added."""
        if more == 0.0:
            return self
        return replace(self, error=self.error + more, noise={**self.noise, Source(-more, more): 1.0})

    def within(self, low: float, high: float) -> Bound:
        """The same where it is known to lie in [low, high]; None of the two may be lost to rounding."""
        low, high = max(self.low, low), min(self.high, high)
        return replace(self, low=min(low, high), high=max(low, high))


def plain(low: float, high: float, error: float = 0.0, signed: bool = False) -> Bound:
    """Of a number that is no sum of others."""
    signed = signed or error == 0.0
    noise = {Source(-error, error): 1.0} if error else {}
    if low == high:
        return Bound(low, high, error, {}, low, high, noise, 0.0, signed)
    return Bound(low, high, error, {Source(low, high): 1.0}, 0.0, 0.0, noise, 0.0, signed)


def remembered(place: int, low: float, high: float, error: float) -> Bound:
    """Of what is remembered in a place."""
    return Bound(low, high, error, {Source(low, high, place, error): 1.0}, signed=error == 0.0)


def added(a: Bound, b: Bound, sign: float) -> Bound:
    """a + b, or a − b."""
    low, high = (b.low, b.high) if sign > 0 else (-b.high, -b.low)
    rest_low, rest_high = (b.rest_low, b.rest_high) if sign > 0 else (-b.rest_high, -b.rest_low)
    terms, off, more = _summed(a.terms, b.terms, sign)
    noise, too, _ = _summed(a.noise, b.noise, sign)
    return _of_sum(
        _less(a.low + low),
        _more(a.high + high),
        _more(a.error + b.error),
        terms,
        _less(_less(a.rest_low + rest_low) - off),
        _more(_more(a.rest_high + rest_high) + off),
        noise,
        _more(a.own + b.own + more + too),
        a.error == b.error == 0.0,
    )


def scaled(a: Bound, c: float) -> Bound:
    """c a, of a number c that is known."""
    if c == 0.0:
        return plain(0.0, 0.0)
    low, high = sorted((c * a.low, c * a.high))
    rest_low, rest_high = sorted((c * a.rest_low, c * a.rest_high))
    terms, off, more = _summed({s: c * k for s, k in a.terms.items()}, {}, 1.0, rounded=c not in (1.0, -1.0))
    noise, too, _ = _summed({s: c * k for s, k in a.noise.items()}, {}, 1.0, rounded=c not in (1.0, -1.0))
    return _of_sum(
        _less(low),
        _more(high),
        _more(abs(c) * a.error),
        terms,
        _less(_less(rest_low) - off),
        _more(_more(rest_high) + off),
        noise,
        _more(abs(c) * a.own + more + too),
        a.signed,
    )


def _summed(a: Sum, b: Sum, sign: float, rounded: bool = False) -> tuple[Sum, float, float]:
    """a ± b; and how far the rounding of its coefficients makes it off, and makes its error off."""
    found = dict(a)
    for source, c in b.items():
        found[source] = found.get(source, 0.0) + sign * c
    off = more = 0.0
    for source in found if rounded else a.keys() & b.keys():
        by = _OFF * abs(found[source]) + _LEAST
        off, more = off + by * source.size, more + by * source.error
    return {s: c for s, c in found.items() if c}, 2 * off, 2 * more


def _of_sum(
    low: float,
    high: float,
    error: float,
    terms: Sum,
    rest_low: float,
    rest_high: float,
    noise: Sum,
    own: float,
    signed: bool,
) -> Bound:
    """Of a sum: no farther than its terms together, nor farther off."""
    least, most, size, off = rest_low, rest_high, 0.0, own
    for s, c in terms.items():
        one, other = c * s.low, c * s.high
        least, most = least + min(one, other), most + max(one, other)
        size += abs(c) * s.size
        off += abs(c) * s.error
    off += sum(abs(d) * s.high for s, d in noise.items())
    low, high = max(low, _less(least) - WIDER * size), min(high, _more(most) + WIDER * size)
    return Bound(low, high, min(error, _more(off)), terms, rest_low, rest_high, noise, own, signed)


def multiplied(a: Bound, b: Bound) -> Bound:
    """A product of two numbers that are not known."""
    corners = [_product(x, y) for x in (a.low, a.high) for y in (b.low, b.high)]
    error = _product(a.size, b.error) + _product(b.size, a.error) + _product(a.error, b.error)
    return plain(_less(min(corners)), _more(max(corners)), _more(error), a.signed and b.signed)


def divided(a: Bound, b: Bound) -> Bound:
    """A quotient; nothing is known of it where the divisor may be 0."""
    least = max(b.low, -b.high, 0.0)
    if least - b.error <= 0.0 or not isfinite(a.computed_size):
        return plain(-inf, inf, inf)
    corners = [x / y for x in (a.low, a.high) for y in (b.low, b.high)]
    error = (a.error + b.error * a.size / least) / (least - b.error)
    return plain(_less(min(corners)), _more(max(corners)), _more(error), a.signed and b.signed)


def rooted(a: Bound) -> Bound:
    """A square root."""
    left = a.low - a.error
    if a.low < 0.0 or (left < 0.0 and not a.signed):  # of a negative number a machine gives none
        return plain(0.0, inf, inf)
    low, high = sqrt(a.low), sqrt(a.high)
    error = a.error / (2 * sqrt(left)) if left > 0 else sqrt(a.error)
    return plain(_less(low), _more(high), _more(error), a.signed)


def least(a: Bound, b: Bound) -> Bound:
    """min(a, b)."""
    return _chosen(min(a.low, b.low), min(a.high, b.high), a, b, a.high <= b.low, b.high <= a.low)


def most(a: Bound, b: Bound) -> Bound:
    """max(a, b)."""
    return _chosen(max(a.low, b.low), max(a.high, b.high), a, b, a.low >= b.high, b.low >= a.high)


def _chosen(low: float, high: float, a: Bound, b: Bound, first: bool, second: bool) -> Bound:
    """One of two; which one, where their ranges say so and their errors leave no doubt."""
    if first and a.error == b.error == 0.0:
        return a
    if second and a.error == b.error == 0.0:
        return b
    return plain(low, high, max(a.error, b.error), a.signed and b.signed)


def absolute(a: Bound) -> Bound:
    """|a|."""
    if a.low >= 0.0 and (a.error == 0.0 or a.signed):
        return a
    low = 0.0 if a.low <= 0.0 <= a.high else min(abs(a.low), abs(a.high))
    return plain(low, a.size, a.error, a.signed)


def floored(a: Bound) -> Bound:
    """⌊a⌋: an error, however small, may be a whole one."""
    low = float(floor(a.low)) if isfinite(a.low) else a.low
    high = float(floor(a.high)) if isfinite(a.high) else a.high
    error = float(ceil(a.error)) if isfinite(a.error) else inf
    return plain(low, high, error)


def hull(a: Bound, b: Bound) -> Bound:
    """One or the other, as both programs choose alike."""
    if a == b:
        return a
    low, high, error = min(a.low, b.low), max(a.high, b.high), max(a.error, b.error)
    return plain(low, high, error, a.signed and b.signed)


def apart(a: Bound, b: Bound) -> float:
    """The most by which a computed number may differ from the other's exact one."""
    return _more(max(a.high - b.low, b.high - a.low, 0.0) + max(a.error, b.error))


def _product(a: float, b: float) -> float:
    return 0.0 if a == 0.0 or b == 0.0 else a * b


def _more(x: float) -> float:
    return x + WIDER * abs(x) if isfinite(x) else x


def _less(x: float) -> float:
    return x - WIDER * abs(x) if isfinite(x) else copysign(inf, x)
