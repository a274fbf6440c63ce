"""Continuous and discrete time on one circle, and the numbers a(c) + j sin θ · b(c) on it.

    s = (1 − ζ)/(1 + ζ)   continuous: Re s > 0 is |ζ| < 1, ω = tan(θ/2)
    z = 1/ζ               discrete:   |z| > 1 is |ζ| < 1, ωT = θ

On the circle ζ = e^{−jθ}, with c = cos θ: ω² = (1 − c)/(1 + c), and c = −1 is ω = ∞ or the
Nyquist frequency.

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

from zwidth.passivity.linear.exact_algebra import from_cosines

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
