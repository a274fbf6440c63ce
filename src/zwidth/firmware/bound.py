"""What is known of a number: where it lies, how it depends on what is remembered, how far it is off.

    exact     v ∈ [low, high],   v = Σ c_i m_i + r,   r ∈ [rest_low, rest_high]
    computed  |ṽ − v| ≤ error,   with m̃ − m of error 0 no more than `own`

The sums hold where v is a sum of what is remembered, m_i; so the error of a filter is summed with the signs
that it has, as the filter itself forgets it.  The bounds are computed in double and widened by parts in 10¹².
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from math import ceil, copysign, floor, inf, isfinite, sqrt

WIDER = 1e-12
"""Of each bound, relative: thousands of roundings of the bound itself."""


@dataclass(frozen=True)
class Bound:
    """See above.

    Parameters
    ----------
    low, high
        Of the exact number.
    error
        How far the computed one is from it, ≥ 0.
    coefficients
        c_i by place in the memory; None where it is no sum of what is remembered.
    rest_low, rest_high
        Of r.
    own
        The error that arises here, without that of what is remembered.
    signed
        True where the computed number has the sign of the exact one, and is 0 where it is.
    """

    low: float
    high: float
    error: float = 0.0
    coefficients: dict[int, float] | None = field(default_factory=dict)
    rest_low: float = 0.0
    rest_high: float = 0.0
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

    @property
    def is_plain(self) -> bool:
        """True where nothing remembered is in it."""
        return self.coefficients == {}

    def with_error(self, more: float) -> Bound:
        """The same with an error of its own added."""
        if more == 0.0:
            return self
        return replace(self, error=self.error + more, own=self.own + more)

    def within(self, low: float, high: float) -> Bound:
        """The same where it is known to lie in [low, high]; None of the two may be lost to rounding."""
        low, high = max(self.low, low), min(self.high, high)
        return replace(self, low=min(low, high), high=max(low, high))


def plain(low: float, high: float, error: float = 0.0, signed: bool = False) -> Bound:
    """Of a number that depends on nothing remembered."""
    return Bound(low, high, error, {}, low, high, error, signed or error == 0.0)


def bent(low: float, high: float, error: float, of: tuple[Bound, ...], signed: bool = False) -> Bound:
    """Of a number that is no sum of others: plain where they are."""
    if all(b.is_plain for b in of):
        return plain(low, high, error, signed)
    return Bound(low, high, error, None, low, high, error, signed or error == 0.0)


def remembered(place: int, low: float, high: float, error: float) -> Bound:
    """Of what is remembered in a place."""
    return Bound(low, high, error, {place: 1.0}, 0.0, 0.0, 0.0, error == 0.0)


def added(a: Bound, b: Bound, sign: float) -> Bound:
    """a + b, or a − b."""
    low, high = (b.low, b.high) if sign > 0 else (-b.high, -b.low)
    exact = a.error == b.error == 0.0
    if a.coefficients is None or b.coefficients is None:
        return bent(_less(a.low + low), _more(a.high + high), a.error + b.error, (a, b), exact)
    places = {**a.coefficients}
    for place, c in b.coefficients.items():
        places[place] = places.get(place, 0.0) + sign * c
    rest_low, rest_high = (b.rest_low, b.rest_high) if sign > 0 else (-b.rest_high, -b.rest_low)
    return Bound(
        _less(a.low + low),
        _more(a.high + high),
        _more(a.error + b.error),
        places,
        _less(a.rest_low + rest_low),
        _more(a.rest_high + rest_high),
        _more(a.own + b.own),
        exact,
    )


def scaled(a: Bound, c: float) -> Bound:
    """c a, of a number c that is known."""
    ends = sorted((c * a.low, c * a.high)) if c else [0.0, 0.0]
    rest = sorted((c * a.rest_low, c * a.rest_high)) if c else [0.0, 0.0]
    places = None if a.coefficients is None else {p: c * k for p, k in a.coefficients.items() if c}
    return Bound(
        _less(ends[0]),
        _more(ends[1]),
        _more(abs(c) * a.error) if c else 0.0,
        places,
        _less(rest[0]),
        _more(rest[1]),
        _more(abs(c) * a.own) if c else 0.0,
        a.signed,
    )


def multiplied(a: Bound, b: Bound) -> Bound:
    """A product of two numbers that are not known."""
    corners = [_product(x, y) for x in (a.low, a.high) for y in (b.low, b.high)]
    error = _product(a.size, b.error) + _product(b.size, a.error) + _product(a.error, b.error)
    return bent(_less(min(corners)), _more(max(corners)), _more(error), (a, b), a.signed and b.signed)


def divided(a: Bound, b: Bound) -> Bound:
    """A quotient; nothing is known of it where the divisor may be 0."""
    least = max(b.low, -b.high, 0.0)
    if least - b.error <= 0.0 or not isfinite(a.computed_size):
        return bent(-inf, inf, inf, (a, b))
    corners = [x / y for x in (a.low, a.high) for y in (b.low, b.high)]
    error = (a.error + b.error * a.size / least) / (least - b.error)
    return bent(_less(min(corners)), _more(max(corners)), _more(error), (a, b), a.signed and b.signed)


def rooted(a: Bound) -> Bound:
    """A square root."""
    left = a.low - a.error
    if a.low < 0.0 or (left < 0.0 and not a.signed):  # of a negative number a machine gives none
        return bent(0.0, inf, inf, (a,))
    low, high = sqrt(a.low), sqrt(a.high)
    error = a.error / (2 * sqrt(left)) if left > 0 else sqrt(a.error)
    return bent(_less(low), _more(high), _more(error), (a,), a.signed)


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
    return bent(low, high, max(a.error, b.error), (a, b), a.signed and b.signed)


def absolute(a: Bound) -> Bound:
    """|a|."""
    if a.low >= 0.0 and (a.error == 0.0 or a.signed):
        return a
    low = 0.0 if a.low <= 0.0 <= a.high else min(abs(a.low), abs(a.high))
    return bent(low, a.size, a.error, (a,), a.signed)


def floored(a: Bound) -> Bound:
    """⌊a⌋: an error, however small, may be a whole one."""
    low = float(floor(a.low)) if isfinite(a.low) else a.low
    high = float(floor(a.high)) if isfinite(a.high) else a.high
    error = float(ceil(a.error)) if isfinite(a.error) else inf
    return bent(low, high, error, (a,))


def hull(a: Bound, b: Bound) -> Bound:
    """One or the other, as both programs choose alike."""
    if a == b:
        return a
    low, high, error = min(a.low, b.low), max(a.high, b.high), max(a.error, b.error)
    return bent(low, high, error, (a, b), a.signed and b.signed)


def apart(a: Bound, b: Bound) -> float:
    """The most by which a computed number may differ from the other's exact one."""
    return _more(max(a.high - b.low, b.high - a.low, 0.0) + max(a.error, b.error))


def _product(a: float, b: float) -> float:
    return 0.0 if a == 0.0 or b == 0.0 else a * b


def _more(x: float) -> float:
    return x + WIDER * abs(x) if isfinite(x) else x


def _less(x: float) -> float:
    return x - WIDER * abs(x) if isfinite(x) else copysign(inf, x)
