"""How much an encoder's error can move the force: ‖h‖₁, bounded above exactly.

With the encoder's middle as reference its error is at most Δ/2, so the force
of H(z) is off by at most ‖h‖₁ Δ/2, h the impulse response.  Coulomb friction
of that size takes out whatever work the error does, at every instant.

For any polynomial E, ‖N/D‖₁ ≤ ‖N E‖₁/(|e₀| − ‖D E − e₀‖₁), e₀ = (D E)(0), as
1/(1 + ε) has norm at most 1/(1 − ‖ε‖₁).  E is 1/D, cut off and rounded.
"""

from __future__ import annotations

from fractions import Fraction
from typing import NamedTuple

from flint import fmpz_poly

from zwidth.passivity.loop import LinearLoop

LONGEST = 1500
"""Coefficients of 1/D kept; a law that remembers longer than this stays unbounded."""

_BITS = 80


class NormBound(NamedTuple):
    """‖h‖₁ ≤ bound [N/m], by the coefficients of E in ascending powers of z⁻¹."""

    bound: Fraction
    inverse: tuple[int, ...]


def bound_one_norm(loop: LinearLoop) -> NormBound | None:
    """An exact upper bound on ‖h‖₁, tight to about 1e-9; None where 1/D decays too slowly."""
    if len(loop.denominator) == 1:
        return _bound(loop, (1,))
    length = 64
    while length <= LONGEST:
        found = _bound(loop, _series(loop.denominator, length))
        if found is not None:
            return found
        length = length * 2 if length * 2 <= LONGEST or length == LONGEST else LONGEST
    return None


def _series(d: tuple[int, ...], length: int) -> tuple[int, ...]:
    """2^_BITS d₀/D, rounded, first `length` coefficients."""
    scale = 1 << _BITS
    e: list[int] = []
    for k in range(length):
        value = scale * d[0] if k == 0 else 0
        value -= sum(d[i] * e[k - i] for i in range(1, min(k, len(d) - 1) + 1))
        e.append(round(Fraction(value, d[0])))
    return tuple(e)


def _bound(loop: LinearLoop, inverse: tuple[int, ...]) -> NormBound | None:
    e = fmpz_poly(list(inverse))
    head, *tail = (abs(int(c)) for c in (fmpz_poly(list(loop.denominator)) * e).coeffs())
    rest = sum(tail)
    if rest * 10**9 > head:
        return None
    total = sum(abs(int(c)) for c in (fmpz_poly(list(loop.numerator)) * e).coeffs())
    return NormBound(Fraction(total, head - rest), inverse)
