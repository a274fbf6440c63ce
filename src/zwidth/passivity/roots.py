"""The real roots of an integer polynomial, to as many bits as are asked for."""

from __future__ import annotations

from fractions import Fraction

from flint import ctx, fmpq, fmpz_poly


def real_roots(p: fmpz_poly, bits: int = 128) -> list[Fraction]:
    """Rationals within rounding at `bits` of each real root."""
    roots = []
    saved = ctx.prec
    try:
        ctx.prec = bits
        for root, _ in p.complex_roots():
            if abs(float(root.imag)) <= 1e-30:
                roots.append(_fraction(root.real))
    finally:
        ctx.prec = saved
    return roots


def _fraction(ball: object) -> Fraction:
    """The midpoint of a real ball, exactly."""
    middle: fmpq = ball.mid().fmpq()  # type: ignore[attr-defined]
    return Fraction(int(middle.p), int(middle.q))
