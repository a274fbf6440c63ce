"""A velocity estimate as a weighted mean of the last moves.

    v(k) = Σ w_j (x(k−j) − x(k−j−1))/T,     j = 0, 1, …

The weights of a window and of a finite filter end; those of one pole decay, w_j = (1 − p) pʲ.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from flint import fmpq, fmpq_poly


@dataclass(frozen=True)
class Average:
    """v = Σ w_j (x(k−j) − x(k−j−1))/T over the samples of a window."""

    weights: tuple[Fraction, ...]

    @property
    def gain(self) -> Fraction:
        """Σ|w_j|."""
        return sum((abs(w) for w in self.weights), Fraction(0))

    @property
    def variation(self) -> Fraction:
        """T ‖h_v‖₁ = |w_0| + Σ|w_j − w_{j−1}|, what comes after the last weight included."""
        steps = zip((*self.weights, Fraction(0)), (Fraction(0), *self.weights), strict=True)
        return sum((abs(w - before) for w, before in steps), Fraction(0))

    @property
    def document(self) -> list[str]:
        """As exact data."""
        return [str(w) for w in self.weights]


@dataclass(frozen=True)
class Decay:
    """w_j = (1 − p) pʲ, 0 ≤ p < 1."""

    pole: Fraction

    @property
    def gain(self) -> Fraction:
        """Σ|w_j| = 1."""
        return Fraction(1)

    @property
    def variation(self) -> Fraction:
        """T ‖h_v‖₁ = 2 (1 − p)."""
        return 2 * (1 - self.pole)

    @property
    def document(self) -> dict[str, str]:
        """As exact data."""
        return {"pole": str(self.pole)}


def finite_response(numerator: tuple[Fraction, ...], denominator: tuple[Fraction, ...]) -> Average | None:
    """F(z) = Σ w_j z⁻ʲ, if it ends; coefficients in descending powers of z, F proper."""
    late = (Fraction(0),) * (len(denominator) - len(numerator))
    n, d = (
        fmpq_poly([fmpq(c.numerator, c.denominator) for c in part])
        for part in ((*late, *numerator), denominator)
    )
    if n % d != 0:
        return None
    return Average(tuple(Fraction(int(c.p), int(c.q)) for c in (n // d).coeffs()))
