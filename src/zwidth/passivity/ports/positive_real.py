"""The largest level σ with F − σ positive real, and the proof at a level.

    Re F(s) ≥ σ  wherever Re s > 0  (|z| > 1)

holds, for F = N/D in lowest terms, exactly if

    Re(N D̄) − σ |D|² ≥ 0 on the axis (circle)     a polynomial in c on [−1, 1]
    N + (g − σ) D has its roots inside, for one g > 0 and then for every

since S = (F − σ − g)/(F − σ + g) has |S| ≤ 1 on the boundary by the first line and
no pole by the second, so |S| ≤ 1 everywhere; and a positive real F − σ plus g > 0
has no zero.  Poles on the axis need no case of their own: a simple one with a
positive residue passes both lines, any other fails one.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction

from flint import fmpq, fmpq_poly, fmpz_poly

from zwidth.passivity.linear.positivity import Positivity, prove_nonnegative
from zwidth.passivity.linear.roots import roots_inside
from zwidth.passivity.ports.port import Port, Time
from zwidth.quantity.balls import as_fmpq, as_fraction

OFFSET = Fraction(1)
"""The g > 0 of every proof."""

_BITS = 320
_TIGHT = Fraction(1, 1 << 80)


@dataclass(frozen=True)
class Largest:
    """low ≤ σ* ≤ high: F − low is proved positive real, and Re F(c) = high at `cosine`.

    `cosine` is None where Re F is the same at every frequency.
    """

    low: Fraction
    high: Fraction
    cosine: Fraction | None


@dataclass(frozen=True)
class NoLevel:
    """No σ will do; `reason` says why."""

    reason: str


def largest_level(port: Port, root: str = "pole") -> Largest | NoLevel:
    """The infimum of Re F over the axis, where F − σ is positive real for some σ.

    `root` is what a pole of F is called in a reason: of 1/G it is a zero of G.
    """
    p, w = _in_lowest_terms(*port.real_part)
    if vanishes(w):
        return NoLevel(without_bound(port.time, root, w(-1) == 0))
    least, cosine = _minimum(p, w)
    flat = p.degree() <= 0 and w.degree() <= 0
    low = proved_below(
        least, lambda level: isinstance(prove_nonnegative(above_level(port, level)), Positivity)
    )
    if not port.is_stable_with(OFFSET - low):
        return NoLevel(_not_stable(port, root))
    if vanishes(p - as_fmpq(low) * w):
        least = low
    return Largest(low, least, None if flat else cosine)


def prove_level(port: Port, level: Fraction) -> Positivity | None:
    """The proof that F − level is positive real; None if it is not."""
    sign = prove_nonnegative(above_level(port, level))
    if isinstance(sign, Fraction) or not port.is_stable_with(OFFSET - level):
        return None
    return sign


def above_level(port: Port, level: Fraction) -> fmpz_poly:
    """Re(N D̄) − level |D|² in c, times a positive integer."""
    p, w = port.real_part
    return (p - as_fmpq(level) * w).numer()


def _in_lowest_terms(p: fmpq_poly, w: fmpq_poly) -> tuple[fmpq_poly, fmpq_poly]:
    """p/w without common factors, w > 0 on [−1, 1] but for its zeros."""
    common = fmpq_poly(p.numer().gcd(w.numer()))
    p, w = p // common, w // common
    if next(v for v in (w(fmpq(k, 997)) for k in range(w.degree() + 2)) if v != 0) < 0:
        p, w = -p, -w
    return p, w


def vanishes(w: fmpq_poly) -> bool:
    """True when w has a zero on [−1, 1]: exactly, by the sign of its squarefree part."""
    q = w.numer()
    if q(1) == 0 or q(-1) == 0:
        return True
    simple = q // q.gcd(q.derivative()) if q.degree() > 0 else q
    return all(isinstance(prove_nonnegative(side), Fraction) for side in (simple, -simple))


def _minimum(p: fmpq_poly, w: fmpq_poly) -> tuple[Fraction, Fraction]:
    """The least p/w over [−1, 1], at its ends or a stationary point, and where: of equals the largest c."""
    slope = (p.derivative() * w - p * w.derivative()).numer()
    places = [Fraction(1), Fraction(-1), *roots_inside(slope, _BITS)]
    values = [(_value(p, w, c), c) for c in places]
    least = min(value for value, _ in values)
    return least, max(c for value, c in values if value == least)


def _value(p: fmpq_poly, w: fmpq_poly, c: Fraction) -> Fraction:
    at = as_fmpq(c)
    value = p(at) / w(at)
    return as_fraction(value)


def proved_below(least: Fraction, holds: Callable[[Fraction], bool]) -> Fraction:
    """A level at most `least` that holds: the same one, its simplest neighbour, or one a little less."""
    simple = least.limit_denominator(10**15)
    near = _TIGHT * max(abs(least), Fraction(1, 10**30))
    candidates = [least] if least.denominator < 10**60 else []
    if abs(simple - least) <= near:
        candidates.append(simple)
    for level in candidates:
        if holds(level):
            return level
    step = near
    while not holds(least - step):
        step *= 1024
    return least - step


def without_bound(time: Time, root: str, at_end: bool) -> str:
    """Why no level holds where the real part has a pole of its own."""
    if time == "discrete":
        return f"the real part is without bound at a {root} on the unit circle"
    where = "as the frequency grows" if at_end else f"at a {root} on the imaginary axis"
    return f"the real part is without bound {where}"


def _not_stable(port: Port, root: str) -> str:
    """Which pole it is that F may not have."""
    continuous = port.time == "continuous"
    if not continuous and len(port.numerator) > len(port.denominator):
        return "the output does not answer the input within the same sample"
    growing = growing_place(pole_places(port), port.time)
    if growing is not None:
        return f"there is an unstable {root} at {growing}"
    if continuous and len(port.numerator) > len(port.denominator):
        return "it grows with the frequency, with a negative sign"
    where = "the imaginary axis" if continuous else "the unit circle"
    return f"a {root} on {where} is multiple, or has a negative residue"


def growing_place(places: Sequence[complex], time: Time) -> str | None:
    """The one of these roots that grows fastest, in words; None if none grows."""
    continuous = time == "continuous"
    excess = [(r.real if continuous else abs(r) - 1, r) for r in places]
    growing = [(e, r) for e, r in excess if e > 1e-9 * abs(r)]
    if not growing:
        return None
    return f"{'s' if continuous else 'z'} = {_text(max(growing, key=lambda pair: pair[0])[1])}"


def pole_places(port: Port) -> list[complex]:
    """The poles of F, to rounding: for a message, or for where to look."""
    return places_of(port.denominator)


def places_of(ascending: Sequence[int]) -> list[complex]:
    """The roots of a polynomial, to rounding."""
    p = fmpz_poly(list(ascending))
    return [complex(float(r.real), float(r.imag)) for r, _ in p.complex_roots()] if p.degree() > 0 else []


def _text(pole: complex) -> str:
    if abs(pole.imag) <= 1e-12 * abs(pole):
        return f"{pole.real:.6g}"
    return f"{pole.real:.6g} ± {abs(pole.imag):.6g}j"
