"""How much an encoder's error can move the force: ‖h‖₁, bounded above exactly.

With the encoder's middle as reference its error is at most Δ/2, so the force
of H(z) is off by at most ‖h‖₁ Δ/2, h the impulse response.  Coulomb friction
of that size takes out whatever work the error does, at every instant.

Slow real poles, such as those of tissues that relax over seconds, are split
off first: r/(1 − p ζ) has norm |r|/(1 − |p|).  For the rest, R/S, and for any
polynomial E, ‖R/S‖₁ ≤ ‖R E‖₁/(|e₀| − ‖S E − e₀‖₁), e₀ = (S E)(0), as
1/(1 + ε) has norm at most 1/(1 − ‖ε‖₁).  E is 1/S, cut off and rounded.
"""

from __future__ import annotations

from fractions import Fraction
from functools import lru_cache
from typing import NamedTuple

from flint import fmpq_poly, fmpz_poly

from zwidth.passivity.linear.exact_algebra import rational_roots_inside
from zwidth.passivity.linear.loop import LinearLoop
from zwidth.quantity.balls import as_fmpq, as_fraction

LONGEST = 1500
"""Coefficients of 1/S kept; a rest that remembers longer than this stays unbounded."""

_SLOW = Fraction(985, 1000)
_BITS = 80


class Mode(NamedTuple):
    """r/(1 − p ζ), |p| < 1."""

    pole: Fraction
    residue: Fraction


class NormBound(NamedTuple):
    """‖h‖₁ ≤ bound [N/m] for H = Σ modes + R/S; coefficients in ascending powers of ζ = z⁻¹."""

    bound: Fraction
    modes: tuple[Mode, ...]
    rest_numerator: tuple[Fraction, ...]
    rest_denominator: tuple[Fraction, ...]
    inverse: tuple[int, ...]


def bound_one_norm(loop: LinearLoop) -> NormBound | None:
    """An exact upper bound on ‖h‖₁; None where too slow a part is left."""
    return _bounded(loop.numerator, loop.denominator)


@lru_cache(maxsize=128)
def _bounded(top: tuple[int, ...], bottom: tuple[int, ...]) -> NormBound | None:
    """The same for N and D: limits and advice ask for one law on many devices."""
    numerator, denominator = fmpq_poly(list(top)), fmpq_poly(list(bottom))
    if len(bottom) == 1:
        return _bound((), numerator, denominator, (1,))
    modes, numerator, denominator = _split_slow(numerator, denominator)
    whole = [int(c) for c in denominator.numer().coeffs()]
    length = 64
    while length <= LONGEST:
        found = _bound(modes, numerator, denominator, _series(whole, length))
        if found is not None:
            return found
        length = LONGEST if length < LONGEST < 2 * length else 2 * length
    return None


def _split_slow(n: fmpq_poly, d: fmpq_poly) -> tuple[tuple[Mode, ...], fmpq_poly, fmpq_poly]:
    """N/D as slow simple modes with rational poles, and the rest."""
    modes, rest = [], d
    for pole in rational_roots_inside(fmpz_poly(d.numer().coeffs()[::-1])):
        if abs(pole) <= _SLOW:
            continue
        line = fmpq_poly([1, as_fmpq(-pole)])
        others = d // line
        at = 1 / as_fmpq(pole)
        residue = n(at) / others(at)
        modes.append(Mode(pole, as_fraction(residue)))
        rest //= line
    for pole, residue in modes:
        n -= as_fmpq(residue) * (d // fmpq_poly([1, as_fmpq(-pole)]))
    return tuple(modes), n // (d // rest), rest


def _series(d: list[int], length: int) -> tuple[int, ...]:
    """2^_BITS d₀/S, rounded, first `length` coefficients."""
    scale = 1 << _BITS
    e: list[int] = []
    for k in range(length):
        value = scale * d[0] if k == 0 else 0
        value -= sum(d[i] * e[k - i] for i in range(1, min(k, len(d) - 1) + 1))
        e.append(_rounded(value, d[0]))
    return tuple(e)


def _rounded(top: int, bottom: int) -> int:
    """The whole number nearest to top/bottom, of two the even one: `round` of a fraction, but quick."""
    top, bottom = (top, bottom) if bottom > 0 else (-top, -bottom)
    quotient, left = divmod(top, bottom)
    up = 2 * left > bottom or (2 * left == bottom and quotient % 2)
    return quotient + 1 if up else quotient


def _bound(
    modes: tuple[Mode, ...], numerator: fmpq_poly, denominator: fmpq_poly, inverse: tuple[int, ...]
) -> NormBound | None:
    e = fmpq_poly(list(inverse))
    cut = denominator * e
    head = abs(as_fraction(cut[0]))
    left_over = _size(cut) - head
    if left_over * 10**9 > head:
        return None
    rest = _size(numerator * e) / (head - left_over)
    slow = sum((abs(mode.residue) / (1 - abs(mode.pole)) for mode in modes), Fraction(0))
    return NormBound(
        rest + slow, modes, tuple(_fractions(numerator)), tuple(_fractions(denominator)), inverse
    )


def _size(p: fmpq_poly) -> Fraction:
    return Fraction(sum(abs(int(c)) for c in p.numer().coeffs()), int(p.denom()))


def _fractions(p: fmpq_poly) -> list[Fraction]:
    return [as_fraction(c) for c in p.coeffs()]
