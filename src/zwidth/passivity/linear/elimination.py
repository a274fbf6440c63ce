"""Is a symmetric rational matrix positive semidefinite?  If not, a vector that says so."""

from __future__ import annotations

from collections.abc import Sequence

from flint import fmpq


def negative_direction(matrix: Sequence[Sequence[fmpq]]) -> list[fmpq] | None:
    """x with xᵀ M x < 0; None where M ≥ 0.

    Gaussian elimination of rows and columns alike: the first negative pivot is
    xᵀ M x of the row of the transformation that has led to it.
    """
    m = [list(row) for row in matrix]
    size = len(m)
    path = [[fmpq(int(i == k)) for i in range(size)] for k in range(size)]
    for i in range(size):
        pivot = m[i][i]
        if pivot < 0:
            return path[i]
        if pivot == 0:
            j = next((j for j in range(i + 1, size) if m[i][j] != 0), None)
            if j is None:
                continue
            share = -(m[j][j] + 1) / (2 * m[i][j])  # (share e_i + e_j) gives −1
            return [share * a + b for a, b in zip(path[i], path[j], strict=True)]
        for j in range(i + 1, size):
            ratio = m[i][j] / pivot
            if ratio != 0:
                path[j] = [b - ratio * a for a, b in zip(path[i], path[j], strict=True)]
                for k in range(j, size):
                    m[j][k] -= ratio * m[i][k]
                    m[k][j] = m[j][k]
    return None
