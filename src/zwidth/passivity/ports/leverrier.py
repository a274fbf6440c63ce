"""Determinant, principal minors and adjugate of a square matrix of polynomials (Leverrier & Faddeev).

    det(λ + A) = Σ λ^{m−k} e_k,   M_1 = 1,  e_k = ± tr(A M_k)/k,  M_{k+1} = A M_k ∓ e_k

needs sums, products and division by whole numbers only, so the entries may be of any ring
that has them.  e_k is the sum of the principal minors of size k; of a Hermitian A it is the
k-th elementary symmetric function of the eigenvalues.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

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
            trace = _trace_of_product(matrix, step) if k > 1 else matrix[0][0]
            minors.append(trace * sign / k)
            break
        product = multiplied(matrix, step) if k > 1 else matrix
        minors.append(_trace(product) * sign / k)
        step = _less_on_diagonal(product, minors[-1] * sign)
    last = 1 if size % 2 else -1
    return Leverrier(minors, [[entry * last for entry in row] for row in step])


def _trace(matrix: Matrix) -> Any:
    total = matrix[0][0]
    for i in range(1, len(matrix)):
        total = total + matrix[i][i]
    return total


def _trace_of_product(a: Matrix, b: Matrix) -> Any:
    terms = [_dot(row, [other[i] for other in b]) for i, row in enumerate(a)]
    total = terms[0]
    for term in terms[1:]:
        total = total + term
    return total


def _less_on_diagonal(matrix: Matrix, value: Any) -> list[list[Any]]:
    return [[x - value if i == j else x for j, x in enumerate(row)] for i, row in enumerate(matrix)]


def multiplied(a: Matrix, b: Matrix) -> list[list[Any]]:
    """A B."""
    columns = list(zip(*b, strict=True))
    return [[_dot(row, column) for column in columns] for row in a]


def _dot(row: Sequence[Any], column: Sequence[Any]) -> Any:
    total = row[0] * column[0]
    for x, y in zip(row[1:], column[1:], strict=True):
        total = total + x * y
    return total
