"""A linear port of m axes, u = D φ and y = N φ with square polynomial matrices, in either time.

    given as G = N/d, one denominator d for all:   D = d·1
    from output to input:                          D and N exchanged

Any signals φ that begin at rest make a pair u, y that answer each other, and every smooth pair
is made so.  What the port absorbs above a level σ is a form of φ; on the `circle` it is

    Π_σ = ½(Dᴴ N + Nᴴ D) − σ Dᴴ D

Of one axis that is Re(N D̄) − σ |D|², one polynomial in c.  Everything is rational.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property, reduce
from math import cos, inf, nan, nextafter, pi
from operator import add, mul
from typing import Any, NamedTuple

import numpy as np
from flint import fmpq, fmpq_poly, fmpz_poly

from zwidth.passivity.linear.exact_algebra import real_product
from zwidth.passivity.ports.circle import ONE, OnCircle, Time, frequency_of, in_zeta, product
from zwidth.quantity.balls import as_fmpq, as_fraction

Polynomials = tuple[tuple[tuple[int, ...], ...], ...]
"""Rows of integer polynomials in ascending powers of s or z."""


@dataclass(frozen=True)
class Port:
    """u = D φ and y = N φ, see the module.

    Parameters
    ----------
    outputs, inputs
        N and D; of one axis coprime.
    denominator
        d in ascending powers of s or z.
    time
        "continuous" or "discrete".
    period
        T [s] of a discrete port; 1 where it does not say.
    hidden_modes_decay
        False when a mode that no input reaches or no output sees does not decay.
    """

    outputs: Polynomials
    inputs: Polynomials
    denominator: tuple[int, ...]
    time: Time
    period: Fraction
    hidden_modes_decay: bool = True

    @property
    def axes(self) -> int:
        """m."""
        return len(self.outputs)

    @cached_property
    def order(self) -> int:
        """The largest degree of an entry."""
        return max(len(p) for side in (self.outputs, self.inputs) for row in side for p in row) - 1

    @cached_property
    def is_direct(self) -> bool:
        """True for D = d·1, from inputs to outputs."""
        size, nothing = range(self.axes), (0,)
        return all(self.inputs[i][j] == (self.denominator if i == j else nothing) for i in size for j in size)

    @property
    def is_zero(self) -> bool:
        """True for D = 0: of the inverse of G = 0."""
        return not any(any(p) for row in self.inputs for p in row)

    def inverse(self) -> Port:
        """What the port is from its outputs to its inputs."""
        own = (self.denominator, self.time, self.period, self.hidden_modes_decay)
        return Port(self.inputs, self.outputs, *own)

    @cached_property
    def on_circle(self) -> tuple[list[list[tuple[int, ...]]], list[list[tuple[int, ...]]]]:
        """N and D as polynomials in ascending powers of ζ, all of length order + 1."""
        n, d = (
            [[in_zeta(p, self.order, self.time) for p in row] for row in side]
            for side in (self.outputs, self.inputs)
        )
        return n, d

    @cached_property
    def forms(self) -> tuple[list[list[OnCircle]], list[list[OnCircle]]]:
        """½(Dᴴ N + Nᴴ D) and Dᴴ D on the circle, times the same positive factor."""
        n, d = self.on_circle
        size = range(self.axes)

        def pairing(a: Any, b: Any, i: int, j: int) -> OnCircle:
            """(Aᴴ B)_ij."""
            return reduce(add, (product(b[k][j], a[k][i]) for k in size))

        crossed = [[pairing(d, n, i, j) for j in size] for i in size]
        power = [[(crossed[i][j] + crossed[j][i].conjugate()) / 2 for j in size] for i in size]
        return power, [[pairing(d, d, i, j) for j in size] for i in size]

    @cached_property
    def real_part(self) -> tuple[fmpq_poly, fmpq_poly]:
        """Of one axis the same: Re(N D̄) and |D|² in c, times the same positive factor."""
        ((n,),), ((d,),) = self.on_circle
        return real_product(n, d), real_product(d, d)

    @cached_property
    def minors_at_zero(self) -> list[fmpq_poly]:
        """e_1 … e_m of Π_0, in c."""
        return [minor.real for minor in leverrier(self.forms[0], ONE).minors]

    @cached_property
    def rank(self) -> int:
        """The rank of D at all but some frequencies."""
        found = leverrier(self.forms[1], ONE).minors
        return max((k + 1 for k, minor in enumerate(found) if minor.real.degree() >= 0), default=0)

    def form(self, level: fmpq | int) -> list[list[OnCircle]]:
        """Π_σ at the level σ."""
        return [
            [p - q * level for p, q in zip(first, second, strict=True)]
            for first, second in zip(*self.forms, strict=True)
        ]

    @cached_property
    def weight(self) -> fmpq_poly:
        """|d|² in c, up to a positive factor."""
        d = in_zeta(self.denominator, self.order, self.time)
        return real_product(d, d)

    def resolvent(self, gain: fmpq) -> tuple[fmpq_poly, list[list[fmpq_poly]]] | None:
        """(π, R) in lowest terms with D (N + gain·D)⁻¹ = R/π; None where nothing is inverse."""
        n, d = (as_polynomials(side) for side in (self.outputs, self.inputs))
        total = [[x + gain * y for x, y in zip(*rows, strict=True)] for rows in zip(n, d, strict=True)]
        return _quotient(d, total)

    def fraction(self) -> tuple[fmpq_poly, list[list[fmpq_poly]]] | None:
        """(π, R) in lowest terms with N D⁻¹ = R/π; None where D is not invertible."""
        return _quotient(as_polynomials(self.outputs), as_polynomials(self.inputs))

    def poles(self) -> fmpq_poly | None:
        """The least common denominator of N D⁻¹; None where D is not invertible."""
        fraction = self.fraction()
        return None if fraction is None else fraction[0]

    def eigenvalues(self, frequencies: Sequence[float]) -> list[list[float]]:
        """Of the Hermitian part of N D⁻¹ at these frequencies [Hz], ascending, to rounding; nan at a pole.

        Where D is not invertible, of what it reaches.  Of one axis Re N/D, ±inf at a pole of one sign.
        """
        if self.axes == 1:
            return [[self._real_part(f)] for f in frequencies]
        found, rank = [], self.rank
        for f in frequencies:
            omega = 2 * pi * f
            point = np.exp(1j * omega * float(self.period)) if self.time == "discrete" else 1j * omega
            n, d = (_at(side, point) for side in (self.outputs, self.inputs))
            left, sizes, right = np.linalg.svd(d)
            if rank and sizes[rank - 1] > 0:
                reached = left[:, :rank].conj().T @ n @ (right[:rank].conj().T / sizes[:rank])
                found.append([float(x) for x in np.linalg.eigvalsh((reached + reached.conj().T) / 2)])
            else:
                found.append([float("nan")] * max(rank, 1))
        return found

    def frequency(self, cosine: Fraction) -> float:
        """ω/2π [Hz] of c = cos θ; inf for a continuous port at c = −1."""
        return frequency_of(cosine, self.time, self.period)

    def _real_part(self, frequency: float) -> float:
        """Re N/D of one axis at a frequency [Hz], exactly; ±inf or nan at a pole."""
        p, w = (part(as_fmpq(self._cosine(frequency))) for part in self.real_part)
        if w != 0:
            try:
                return float(as_fraction(p / w))
            except OverflowError:
                pass
        return inf if p > 0 else -inf if p < 0 else nan

    def _cosine(self, frequency: float) -> Fraction:
        """c = cos θ of a frequency [Hz]."""
        if self.time == "discrete":
            return Fraction(cos(2 * pi * frequency * float(self.period)))
        square = Fraction(2 * pi * frequency) ** 2
        return (1 - square) / (1 + square)


def typed_at_most(value: Fraction) -> float:
    """The largest double that is typed for a number of at most this value."""
    double = float(value)
    while Fraction(repr(double)) > value:
        double = nextafter(double, -inf)
    return double


def common_factor(polynomials: Iterable[fmpq_poly]) -> fmpq_poly:
    """The greatest, with whole coefficients."""
    return fmpq_poly(reduce(fmpz_poly.gcd, (p.numer() for p in polynomials)))


def in_lowest_terms(
    numerators: list[list[fmpq_poly]], denominator: fmpq_poly
) -> tuple[fmpq_poly, list[list[fmpq_poly]]] | None:
    """(π, R) with R/π the same matrix and no factor common to π and all of R; None over 0."""
    if denominator.degree() < 0:
        return None
    shared = common_factor([denominator, *(entry for row in numerators for entry in row)])
    return denominator // shared, [[entry // shared for entry in row] for row in numerators]


def _quotient(
    top: list[list[fmpq_poly]], bottom: list[list[fmpq_poly]]
) -> tuple[fmpq_poly, list[list[fmpq_poly]]] | None:
    found = leverrier(bottom, fmpq_poly([1]))
    return in_lowest_terms(multiplied(top, found.adjugate), found.minors[-1])


def as_polynomials(side: Polynomials) -> list[list[fmpq_poly]]:
    """N or D in flint's numbers."""
    return [[fmpq_poly(list(p)) for p in row] for row in side]


def _at(side: Polynomials, point: complex) -> Any:
    return np.array([[np.polyval([float(c) for c in p[::-1]], point) for p in row] for row in side])


# Determinant, principal minors and adjugate of a square matrix of polynomials (Leverrier & Faddeev).
#
#     det(λ + A) = Σ λ^{m−k} e_k,   M_1 = 1,  e_k = ± tr(A M_k)/k,  M_{k+1} = A M_k ∓ e_k
#
# needs sums, products and division by whole numbers only, so the entries may be of any ring
# that has them.  e_k is the sum of the principal minors of size k; of a Hermitian A it is the
# k-th elementary symmetric function of the eigenvalues.


Matrix = Sequence[Sequence[Any]]


class Leverrier(NamedTuple):
    """e_1 … e_m of a matrix, the last its determinant, and its adjugate."""

    minors: list[Any]
    adjugate: list[list[Any]]


def leverrier(matrix: Matrix, one: Any) -> Leverrier:
    """The minors and the adjugate; `one` is the ring's 1."""
    size, zero = len(matrix), one - one
    step = [[one if i == j else zero for j in range(size)] for i in range(size)]
    minors: list[Any] = []
    for k in range(1, size + 1):
        sign = 1 if k % 2 else -1
        if k == size:
            trace = reduce(add, map(_dotted, matrix, zip(*step, strict=True))) if k > 1 else matrix[0][0]
            minors.append(trace * sign / k)
            break
        product = multiplied(matrix, step) if k > 1 else matrix
        minors.append(reduce(add, (row[i] for i, row in enumerate(product))) * sign / k)
        less = minors[-1] * sign
        step = [[x - less if i == j else x for j, x in enumerate(row)] for i, row in enumerate(product)]
    last = 1 if size % 2 else -1
    return Leverrier(minors, [[entry * last for entry in row] for row in step])


def multiplied(a: Matrix, b: Matrix) -> list[list[Any]]:
    """A B."""
    columns = list(zip(*b, strict=True))
    return [[_dotted(row, column) for column in columns] for row in a]


def _dotted(row: Sequence[Any], column: Sequence[Any]) -> Any:
    return reduce(add, map(mul, row, column))
