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
from itertools import accumulate

import numpy as np
from flint import fmpq_poly
from numpy.typing import NDArray

from zwidth.passivity.linear.exact_algebra import from_cosines
from zwidth.passivity.linear.positivity import Positivity, prove_nonnegative
from zwidth.quantity.balls import as_fmpq

Polynomial = Sequence[Fraction]
Signal = tuple[Polynomial, Polynomial]
"""What multiplies w and what multiplies D, in ascending powers of z⁻¹."""

Term = tuple[Fraction, Signal, Signal]
"""c, p and q of c p(k) q(k)."""

Cosines = tuple[Fraction, ...]


@dataclass(frozen=True)
class TwoSignalForm:
    """N₁₁, N₂₂ and |N₁₂|² as coefficients a_n of Σ a_n cos nθ."""

    first: Cosines
    second: Cosines
    cross: Cosines

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
        return cls(_real(first), _real(second), _real(square))

    def is_nonnegative(self, more: Fraction = Fraction(0)) -> bool:
        """True when Q + `more` Σ D² ≥ 0 for all sequences: decided exactly."""
        first, second, cross = (_polynomial(a) for a in (self.first, self.second, self.cross))
        second += as_fmpq(more)
        return all(_holds(p) for p in (first, second, first * second - cross))

    def first_is_nonnegative(self) -> bool:
        """True when Q ≥ 0 for D = 0: what no multiple of D² can mend."""
        return _holds(_polynomial(self.first))

    def need(self, cosines: NDArray[np.float64]) -> NDArray[np.float64]:
        """At each cos θ the least `more`: |N₁₂|²/N₁₁ − N₂₂, infinite where N₁₁ ≤ 0 < |N₁₂|²."""
        first, cross = self.first, self.cross
        while (
            any(first) and sum(first) == 0 and sum(cross) == 0
        ):  # a form of differences: 1 − cos θ is in both
            first, cross = _reduced(first), _reduced(cross)
        below, above = _evaluate(first, cosines), _evaluate(cross, cosines)
        ratio = np.where(above > 0, np.inf, 0.0)
        np.divide(above, below, out=ratio, where=below > 0)
        return np.asarray(ratio - _evaluate(self.second, cosines))


def _add(total: dict[int, Fraction], c: Fraction, p: Polynomial, q: Polynomial) -> None:
    """Adds c p conj(q), by powers of z⁻¹."""
    for i, a in enumerate(p):
        for j, b in enumerate(q):
            total[i - j] = total.get(i - j, Fraction(0)) + c * a * b


def _real(powers: Mapping[int, Fraction]) -> Cosines:
    """The real part of Σ a_n z⁻ⁿ."""
    top = max((abs(n) for n in powers), default=0)
    return tuple(sum((powers.get(m, Fraction(0)) for m in {n, -n}), Fraction(0)) for n in range(top + 1))


def _reduced(cosines: Cosines) -> Cosines:
    """The quotient by 1 − cos θ = −½ z⁻¹ (z − 1)²: two running sums of the powers of z."""
    powers = [*(a / 2 for a in cosines[:0:-1]), cosines[0], *(a / 2 for a in cosines[1:])]
    twice = [2 * a for a in accumulate(accumulate(-a for a in powers))]
    middle = len(cosines) - 2  # of the quotient, whose highest power is one lower
    half = twice[middle : 2 * middle + 1] if middle >= 0 else []
    return (half[0], *(2 * a for a in half[1:])) if half else (Fraction(0),)


def _polynomial(cosines: Cosines) -> fmpq_poly:
    """Σ a_n cos nθ as a polynomial in cos θ."""
    return from_cosines([as_fmpq(a) for a in cosines])


def _holds(p: fmpq_poly) -> bool:
    """p ≥ 0 on [−1, 1]."""
    return isinstance(prove_nonnegative(p.numer()), Positivity)


def _evaluate(cosines: Cosines, x: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.asarray(np.polynomial.chebyshev.chebval(x, [float(a) for a in cosines]))
