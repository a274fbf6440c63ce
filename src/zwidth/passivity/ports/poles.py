"""Where the roots of a polynomial in s or z lie, and whether what they stand for decays."""

from __future__ import annotations

from collections.abc import Sequence

from flint import fmpz_poly

from zwidth.passivity.linear.exact_algebra import is_schur
from zwidth.passivity.ports.circle import Time, in_zeta


def decays(ascending: Sequence[int], time: Time) -> bool:
    """True when every root lies in the open left half plane (inside the circle)."""
    return all_outside(in_zeta(ascending, len(ascending) - 1, time))


def all_outside(in_zeta: Sequence[int]) -> bool:
    """Every root ζ has |ζ| > 1: from rigorous balls about them, or where these touch the circle exactly."""
    if in_zeta[0] == 0:
        return False
    p = fmpz_poly(list(in_zeta))
    sizes = [abs(root) for root, _ in p.complex_roots()] if p.degree() > 0 else []
    if any(size < 1 for size in sizes):
        return False
    return all(size > 1 for size in sizes) or is_schur(in_zeta[::-1])


def places_of(p: fmpz_poly) -> list[complex]:
    """The roots, to rounding: for a message, or for where to look."""
    return [complex(float(r.real), float(r.imag)) for r, _ in p.complex_roots()] if p.degree() > 0 else []


def growing_place(places: Sequence[complex], time: Time) -> str | None:
    """The one of these roots that grows fastest, in words; None if none grows."""
    continuous = time == "continuous"
    excess = [(r.real if continuous else abs(r) - 1, r) for r in places]
    growing = [(e, r) for e, r in excess if e > 1e-9 * abs(r)]
    if not growing:
        return None
    return f"{'s' if continuous else 'z'} = {_text(max(growing, key=lambda pair: pair[0])[1])}"


def _text(pole: complex) -> str:
    if abs(pole.imag) <= 1e-12 * abs(pole):
        return f"{pole.real:.6g}"
    return f"{pole.real:.6g} ± {abs(pole.imag):.6g}j"
