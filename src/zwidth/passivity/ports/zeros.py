"""Zeros and signs of polynomials in c = cos θ on the circle, and which levels count as equal."""

from __future__ import annotations

from fractions import Fraction

from flint import fmpq, fmpq_poly

from zwidth.passivity.linear.positivity import prove_nonnegative

_TIGHT = Fraction(1, 1 << 80)
_SMALLEST = Fraction(1, 10**30)


def near(value: Fraction) -> Fraction:
    """How far from a level another one counts as equal while the least is looked for."""
    return _TIGHT * max(abs(value), _SMALLEST)


def vanishes(w: fmpq_poly) -> bool:
    """True when w has a zero on [−1, 1]: exactly, by the sign of its squarefree part."""
    q = w.numer()
    if q(1) == 0 or q(-1) == 0:
        return True
    simple = q // q.gcd(q.derivative()) if q.degree() > 0 else q
    return all(isinstance(prove_nonnegative(side), Fraction) for side in (simple, -simple))


def has_positive_sign(w: fmpq_poly) -> bool:
    """True when w, which has one sign on [−1, 1], is positive where it is not zero."""
    return bool(next(v for v in (w(fmpq(k, 997)) for k in range(w.degree() + 2)) if v != 0) > 0)
