"""Are all roots of a polynomial inside the unit circle?  Decided exactly.

Schur–Cohn recursion: p of degree n is Schur exactly if |p(0)| < |lead| and
(lead·p − p(0)·p*)/z is, with p* the reversed polynomial.  In balls of growing
precision that is fast, and a sign that they leave open is decided on integers.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from typing import TypeVar

from flint import arb_poly, fmpz_poly

from zwidth.quantity.balls import precision

Polynomial = TypeVar("Polynomial", fmpz_poly, arb_poly)

_PRECISIONS = (256, 1024, 4096)
"""Bits of the balls, one after the other."""


def is_schur(ascending: Sequence[int]) -> bool:
    """True when every root of Σ a_i zⁱ has modulus < 1."""
    return _is_schur(tuple(ascending))


@lru_cache(maxsize=64)
def _is_schur(ascending: tuple[int, ...]) -> bool:
    """The same; one law is asked about on many devices."""
    p = fmpz_poly(list(ascending))
    if p.degree() < 1:
        return bool(p.degree() == 0)
    if abs(p[0]) >= abs(p[p.degree()]) or p.gcd(_reversed(p)).degree() > 0:
        return False  # roots on the circle, and pairs that mirror each other in it, are common to both
    for bits in _PRECISIONS:
        with precision(bits):
            answer = _in_balls(arb_poly(p))
        if answer is not None:
            return answer
    return _on_integers(p)


def _in_balls(p: arb_poly) -> bool | None:
    """Whether p is Schur; None where the balls are too wide to tell."""
    while p.degree() > 0:
        ratio = p[0] / p[p.degree()]
        if not abs(ratio) < 1:
            return False if abs(ratio) >= 1 else None
        p = arb_poly((p - ratio * _reversed(p)).coeffs()[1:])
    return True


def _on_integers(p: fmpz_poly) -> bool:
    while p.degree() > 0:
        first, last = p[0], p[p.degree()]
        if abs(first) >= abs(last):
            return False
        p = (last * p - first * _reversed(p)).right_shift(1)
        content = p.content()
        if content > 1:
            p = fmpz_poly([c // content for c in p.coeffs()])
    return True


def _reversed(p: Polynomial) -> Polynomial:
    return type(p)(p.coeffs()[::-1])
