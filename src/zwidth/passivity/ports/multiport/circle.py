"""Numbers a(c) + j sin θ · b(c) on the unit circle, ζ = e^{−jθ}, c = cos θ.

    sin²θ = 1 − c²   makes them a ring; the conjugate is a − j sin θ · b

Every product a(ζ) b̄(ζ) of real polynomials is one.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from flint import fmpq, fmpq_poly, fmpz_poly

from zwidth.passivity.linear.cosines import from_cosines

_SINE_SQUARED = fmpq_poly([1, 0, -1])
_ZERO = fmpq_poly([])


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
