"""The real roots of an integer polynomial, to as many bits as are asked for."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction

from flint import arb, fmpz_poly

from zwidth.passivity.linear.descartes import halves, on_unit_interval, sign_changes
from zwidth.quantity.balls import as_fmpq, ball, middle, precision


def real_roots(p: fmpz_poly, bits: int = 128) -> list[Fraction]:
    """Rationals within rounding at `bits` of each real root."""
    with precision(bits):
        return [middle(root.real) for root, _ in p.complex_roots() if abs(float(root.imag)) <= 1e-30]


def roots_inside(p: fmpz_poly, bits: int = 128) -> list[Fraction]:
    """The same of the roots in (−1, 1) alone, in a fraction of the time.

    Roots that are no further apart than the rounding are one.
    """
    if p.degree() < 1:
        return []
    simple = p // p.gcd(p.derivative())
    return [root_between(simple, low, high, bits) for low, high in _isolated(simple, bits)]


def root_between(p: fmpz_poly, low: Fraction, high: Fraction, bits: int) -> Fraction:
    """The one root of p in (low, high), within rounding at `bits`; `low` where that is `high`."""
    with precision(bits + 4 * p.degree() + 64):  # near a root the powers cancel about as many bits
        return middle(_refined(p, low, high, bits)) if low < high else low


def rational_roots_inside(p: fmpz_poly) -> list[Fraction]:
    """The simple rational roots in (−1, 1), in time bounded by degree and digits, as factoring is not."""
    largest = abs(int(p[p.degree()]))  # denominators divide it: between two such fractions lies 1/largest²
    bits = 2 * largest.bit_length() + 2
    near = (root.limit_denominator(largest) for root in roots_inside(p, bits))
    slope = p.derivative()
    return [root for root in near if _vanishes(p, root, bits) and slope(as_fmpq(root)) != 0]


def _vanishes(p: fmpz_poly, at: Fraction, bits: int) -> bool:
    """True where p(at) = 0; balls see most that are not."""
    with precision(bits):
        if not p(ball(at)).contains(0):
            return False
    return bool(p(as_fmpq(at)) == 0)


def _isolated(p: fmpz_poly, bits: int) -> Iterator[tuple[Fraction, Fraction]]:
    """Open intervals of one root each, of a narrowest perhaps more; or the root itself as both ends."""
    work = [(on_unit_interval(p), Fraction(-1), Fraction(1))]
    while work:
        h, low, high = work.pop()
        changes = sign_changes(h)
        if changes == 0:
            continue
        if changes == 1 or high - low < Fraction(1, 1 << bits):
            yield low, high
            continue
        between = (low + high) / 2
        left, right = halves(h)
        if right[0] == 0:
            yield between, between
        work += [(left, low, between), (right, between, high)]


def _refined(p: fmpz_poly, low: Fraction, high: Fraction, bits: int) -> arb:
    """The root by Newton's steps, and by halving where they leave the interval or shrink too little."""
    slope = p.derivative()
    a, b = ball(low), ball(high)
    rising = not _is_positive_after(p, slope, low)
    x, before, close = (a + b) / 2, b - a, arb(2) ** -bits
    while b - a > close:
        value = p(x)
        if value.contains(0):
            break
        a, b = (x.mid(), b) if (value < 0) == rising else (a, x.mid())
        step = (value / slope(x)).mid()
        if not (abs(step) * 2 < before and a < x - step and x - step < b):
            step = (x - (a + b) / 2).mid()
        x, before = (x - step).mid(), abs(step)
        if before < close:
            break
    return x


def _is_positive_after(p: fmpz_poly, slope: fmpz_poly, at: Fraction) -> bool:
    """The sign of p just above a point, which may be a simple root."""
    point = as_fmpq(at)
    return bool((p(point) or slope(point)) > 0)
