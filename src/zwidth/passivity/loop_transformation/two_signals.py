"""A quadratic form of two sequences, decided exactly: is it ≥ 0 for all of them?

    Q = Σ_k Σ_i cᵢ pᵢ(k) qᵢ(k),    each of pᵢ, qᵢ = (polynomial in z⁻¹) w + (polynomial in z⁻¹) D

By Parseval it is the mean over θ of a Hermitian 2 × 2 form, whose entries are polynomials in cos θ, and
|N₁₂|² too.  It is ≥ 0 for all finite sequences exactly if

    N₁₁ ≥ 0,    N₂₂ ≥ 0,    N₁₁ N₂₂ − |N₁₂|² ≥ 0    for −1 ≤ cos θ ≤ 1.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import lcm

import numpy as np
from flint import fmpq, fmpq_poly, fmpz_poly
from numpy.typing import NDArray

from zwidth.passivity.positivity import Positivity, prove_nonnegative

Polynomial = Sequence[Fraction]
Signal = tuple[Polynomial, Polynomial]
"""What multiplies w and what multiplies D, in ascending powers of z⁻¹."""

Term = tuple[Fraction, Signal, Signal]
"""c, p and q of c p(k) q(k)."""


@dataclass(frozen=True)
class TwoSignalForm:
    """N₁₁, N₂₂ and |N₁₂|² as polynomials in cos θ."""

    first: fmpq_poly
    second: fmpq_poly
    cross: fmpq_poly

    @classmethod
    def of(cls, terms: Iterable[Term]) -> TwoSignalForm:
        """The form of Σ c p q."""
        first: dict[int, Fraction] = {}
        second: dict[int, Fraction] = {}
        mixed: dict[int, Fraction] = {}
        for c, (p1, p2), (q1, q2) in terms:
            _add(first, c, p1, q1)
            _add(second, c, p2, q2)
            _add(mixed, c / 2, p2, q1)
            _add(mixed, c / 2, q2, p1)
        square: dict[int, Fraction] = {}
        for i, a in mixed.items():
            for j, b in mixed.items():
                square[i - j] = square.get(i - j, Fraction(0)) + a * b
        return cls(_in_cosine(first), _in_cosine(second), _in_cosine(square))

    def is_nonnegative(self, more: Fraction = Fraction(0)) -> bool:
        """True when Q + `more` Σ D² ≥ 0 for all sequences: decided exactly."""
        second = self.second + _rational(more)
        minor = self.first * second - self.cross
        return all(_holds(p) for p in (self.first, second, minor))

    def first_is_nonnegative(self) -> bool:
        """True when Q ≥ 0 for D = 0: what no multiple of D² can mend."""
        return _holds(self.first)

    def need(self, cosines: NDArray[np.float64]) -> NDArray[np.float64]:
        """At each cos θ the least `more`: |N₁₂|²/N₁₁ − N₂₂, infinite where N₁₁ ≤ 0 < |N₁₂|²."""
        first, cross = self.first, self.cross
        factor = fmpq_poly([1, -1])  # 1 − cos θ is common to both where the form is one of differences
        while first.degree() > 0 and first(1) == 0 and cross(1) == 0:
            first, cross = first // factor, cross // factor
        below, above = _evaluate(first, cosines), _evaluate(cross, cosines)
        ratio = np.where(above > 0, np.inf, 0.0)
        np.divide(above, below, out=ratio, where=below > 0)
        return np.asarray(ratio - _evaluate(self.second, cosines))


def _add(total: dict[int, Fraction], c: Fraction, p: Polynomial, q: Polynomial) -> None:
    """Adds c p conj(q), by powers of z⁻¹."""
    for i, a in enumerate(p):
        for j, b in enumerate(q):
            total[i - j] = total.get(i - j, Fraction(0)) + c * a * b


def _in_cosine(powers: Mapping[int, Fraction]) -> fmpq_poly:
    """Σ a_n cos nθ as a polynomial in cos θ."""
    total, chebyshev, following = fmpq_poly([0]), fmpq_poly([1]), fmpq_poly([0, 1])
    for n in range(max((abs(n) for n in powers), default=0) + 1):
        both = {n, -n}
        total += chebyshev * _rational(sum((powers.get(m, Fraction(0)) for m in both), Fraction(0)))
        chebyshev, following = following, fmpq_poly([0, 2]) * following - chebyshev
    return total


def _holds(p: fmpq_poly) -> bool:
    """p ≥ 0 on [−1, 1]."""
    coefficients = [Fraction(int(c.p), int(c.q)) for c in p.coeffs()]
    scale = lcm(*(c.denominator for c in coefficients)) if coefficients else 1
    return isinstance(prove_nonnegative(fmpz_poly([int(c * scale) for c in coefficients])), Positivity)


def _evaluate(p: fmpq_poly, x: NDArray[np.float64]) -> NDArray[np.float64]:
    coefficients = [float(Fraction(int(c.p), int(c.q))) for c in p.coeffs()]
    return np.asarray(np.polynomial.polynomial.polyval(x, coefficients or [0.0]))


def _rational(x: Fraction) -> fmpq:
    return fmpq(x.numerator, x.denominator)
