"""Continuous and discrete time on one circle: numbers on it, and where roots and signs lie.

    s = (1 − ζ)/(1 + ζ)   continuous: Re s > 0 is |ζ| < 1, ω = tan(θ/2)
    z = 1/ζ               discrete:   |z| > 1 is |ζ| < 1, ωT = θ

On the circle ζ = e^{−jθ}, with c = cos θ: ω² = (1 − c)/(1 + c), and c = −1 is ω = ∞ or the Nyquist frequency.

    sin²θ = 1 − c²   makes the numbers a ring; the conjugate is a − j sin θ · b

Every product a(ζ) b̄(ζ) of real polynomials is one.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import acos, inf, pi, sqrt
from typing import Literal

from flint import fmpq, fmpq_poly, fmpz_poly

from zwidth.passivity.linear.exact_algebra import from_cosines, is_schur
from zwidth.passivity.linear.positivity import prove_nonnegative

Time = Literal["continuous", "discrete"]

_SINE_SQUARED = fmpq_poly([1, 0, -1])
_ZERO = fmpq_poly([])


def in_zeta(ascending: Sequence[int], order: int, time: Time) -> tuple[int, ...]:
    """p(z) ζⁿ, or p(s) (1 + ζ)ⁿ, as a polynomial in ζ with n = order."""
    if time == "discrete":
        padded = [*ascending, *[0] * (order + 1 - len(ascending))]
        return tuple(padded[::-1])
    total, minus, plus = fmpz_poly([]), fmpz_poly([1, -1]), fmpz_poly([1, 1])
    for power, coefficient in enumerate(ascending):
        if coefficient:
            total += coefficient * minus**power * plus ** (order - power)
    return tuple(int(total[i]) for i in range(order + 1))


def frequency_of(cosine: Fraction, time: Time, period: Fraction) -> float:
    """ω/2π [Hz] of c = cos θ; inf in continuous time at c = −1."""
    if time == "discrete":
        return acos(max(-1.0, min(1.0, float(cosine)))) / (2 * pi * float(period))
    if cosine == -1:
        return inf
    return sqrt((1 - cosine) / (1 + cosine)) / (2 * pi)


@dataclass(frozen=True)
class OnCircle:
    """real + j sin θ · imaginary, both polynomials in c."""

    real: fmpq_poly
    imaginary: fmpq_poly

    def __add__(self, other: OnCircle) -> OnCircle:
        return OnCircle(self.real + other.real, self.imaginary + other.imaginary)

    def __sub__(self, other: OnCircle) -> OnCircle:
        return OnCircle(self.real - other.real, self.imaginary - other.imaginary)

    def __mul__(self, other: OnCircle | fmpq | int) -> OnCircle:
        if not isinstance(other, OnCircle):
            return OnCircle(self.real * other, self.imaginary * other)
        real = self.real * other.real
        if self.imaginary.degree() >= 0 and other.imaginary.degree() >= 0:
            real -= _SINE_SQUARED * self.imaginary * other.imaginary
        return OnCircle(real, self.real * other.imaginary + self.imaginary * other.real)

    def __truediv__(self, divisor: int) -> OnCircle:
        return OnCircle(self.real / divisor, self.imaginary / divisor)

    def conjugate(self) -> OnCircle:
        """At −θ."""
        return OnCircle(self.real, -self.imaginary)


ONE = OnCircle(fmpq_poly([1]), _ZERO)


def product(a: Sequence[int], b: Sequence[int]) -> OnCircle:
    """a(ζ) b̄(ζ) = Σ r_l ζ^l of two integer polynomials of the same length, ascending in ζ."""
    middle = len(a) - 1
    lags = fmpz_poly(list(a)) * fmpz_poly(list(b)[::-1])
    pairs = [(lags[middle + lag], lags[middle - lag]) for lag in range(1, len(a))]
    real = from_cosines([fmpq(lags[middle]), *(fmpq(x + y) for x, y in pairs)])
    imaginary = fmpq_poly([])
    for lag, (x, y) in enumerate(pairs):
        if x != y:  # ζ^l = cos lθ − j sin lθ, and sin (l + 1)θ = sin θ U_l(c)
            imaginary += fmpq_poly(fmpz_poly.chebyshev_u(lag)) * fmpq(y - x)
    return OnCircle(real, imaginary)


def decays(ascending: Sequence[int], time: Time) -> bool:
    """True when every root lies in the open left half plane (inside the circle)."""
    return all_outside(in_zeta(ascending, len(ascending) - 1, time))


def all_outside(in_zeta: Sequence[int]) -> bool:
    """Every root ζ has |ζ| > 1, decided exactly."""
    return in_zeta[0] != 0 and is_schur(in_zeta[::-1])


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
    return f"{'s' if continuous else 'z'} = {_spoken(max(growing, key=lambda pair: pair[0])[1])}"


def _spoken(pole: complex) -> str:
    if abs(pole.imag) <= 1e-12 * abs(pole):
        return f"{pole.real:.6g}"
    return f"{pole.real:.6g} ± {abs(pole.imag):.6g}j"


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
