"""Systems of several inputs and outputs, of python-control, scipy.signal and harold, read exactly.

    G = (n_ij/d_ij)      y_i = Σ_j G_ij u_j

A state space gives every entry as in `system`, over det(sI − A); what of that polynomial belongs
to modes that no input reaches or no output sees, `hidden_modes` finds.
"""

from __future__ import annotations

from fractions import Fraction
from typing import Any, Literal, NamedTuple

from flint import fmpq, fmpq_mat, fmpq_poly

from zwidth.errors import InputError
from zwidth.model.environment.system import (
    Polynomial,
    bounded,
    characteristic,
    number_of,
    renamed,
    rows_of,
    time_of,
)

Rows = list[list[Fraction]]
Entries = tuple[tuple[tuple[Polynomial, Polynomial], ...], ...]


class MatrixSystem(NamedTuple):
    """Numerators and denominators in descending powers, row by row, and the time they are of."""

    entries: Entries
    time: Literal["continuous", "discrete", "unsaid"]
    sample_period: Fraction | None
    state: tuple[Rows, Rows, Rows] | None
    """A, B and C of a state space with states."""


def size_of(system: Any) -> tuple[int, int]:
    """(outputs, inputs) of a system of python-control, scipy.signal or harold."""
    system = renamed(system)
    if hasattr(system, "noutputs"):
        return int(system.noutputs), int(system.ninputs)
    if hasattr(system, "D"):
        shape = getattr(system.D, "shape", (1, 1))
        return int(shape[0]), int(shape[1])
    num = getattr(system, "num", None)
    several = getattr(num, "ndim", 1) == 2  # scipy: one row for each output
    return (len(num) if several and num is not None else 1), 1


def read_matrix_system(system: Any) -> MatrixSystem:
    """A square system, entry by entry."""
    system = renamed(system)
    outputs, inputs = size_of(system)
    if outputs != inputs:
        raise InputError(
            f"the system has {_count(inputs, 'input')} and {_count(outputs, 'output')}; a port has as many "
            "of both, each output times its own input a power: leave out what is not part of the port"
        )
    if all(hasattr(system, name) for name in ("A", "B", "C", "D")):
        entries, state = _from_state_space(system)
        return MatrixSystem(entries, *time_of(system), state)
    if not (hasattr(system, "num") and hasattr(system, "den")):
        raise InputError(
            f"a system of type {type(system).__name__} with several inputs is not read; give a "
            "TransferFunction or StateSpace of python-control or harold, or a StateSpace of scipy.signal"
        )
    return MatrixSystem(_from_transfer_functions(system), *time_of(system), None)


def _count(number: int, what: str) -> str:
    return f"{number} {what}" + ("" if number == 1 else "s")


def _from_transfer_functions(system: Any) -> Entries:
    def polynomial(key: str, i: int, j: int) -> Polynomial:
        coefficients = getattr(system, key)[i][j]
        bounded(len(coefficients) - 1)
        return tuple(number_of(c, key) for c in coefficients)

    size = range(len(system.num))
    return tuple(tuple((polynomial("num", i, j), polynomial("den", i, j)) for j in size) for i in size)


def _from_state_space(system: Any) -> tuple[Entries, tuple[Rows, Rows, Rows] | None]:
    """C (sI − A)⁻¹ B + D: (det(sI − A + b_j c_i) + (d_ij − 1) det(sI − A))/det(sI − A)."""
    bounded(len(system.A))
    a, b, c, d = (rows_of(getattr(system, name), name) for name in "ABCD")
    order, size = range(len(a)), range(len(d))
    den = characteristic(a) if a else (Fraction(1),)

    def numerator(i: int, j: int) -> Polynomial:
        if not a:
            return (d[i][j],)
        closed = [[a[k][m] - b[k][j] * c[i][m] for m in order] for k in order]
        return tuple(x + (d[i][j] - 1) * y for x, y in zip(characteristic(closed), den, strict=True))

    entries = tuple(tuple((numerator(i, j), den) for j in size) for i in size)
    return entries, (a, b, c) if a else None


def hidden_modes(a: Rows, b: Rows, c: Rows) -> Polynomial:
    """det(sI − A) over that of the part that is reached and seen, in descending powers."""
    all_modes = _matrix(a)
    reached, inputs_to, outputs_of = _reached(all_modes, _matrix(b), _matrix(c))
    seen = (
        _reached(reached.transpose(), outputs_of.transpose(), inputs_to.transpose())[0]
        if reached.nrows()
        else reached
    )
    rest = all_modes.charpoly() // seen.charpoly() if seen.nrows() else all_modes.charpoly()
    return tuple(Fraction(int(x.p), int(x.q)) for x in fmpq_poly(rest).coeffs()[::-1])


def _reached(a: fmpq_mat, b: fmpq_mat, c: fmpq_mat) -> tuple[fmpq_mat, fmpq_mat, fmpq_mat]:
    """A, B and C on the space that B, AB, A²B … span, in coordinates of that space."""
    basis = _independent(b.transpose().tolist())
    while True:
        grown = _independent(basis.tolist() + (basis * a.transpose()).tolist()) if basis.nrows() else basis
        if grown.nrows() == basis.nrows():
            break
        basis = grown
    if not basis.nrows():
        return fmpq_mat(0, 0), fmpq_mat(0, b.ncols()), fmpq_mat(c.nrows(), 0)
    v = basis.transpose()
    gram = basis * v
    return gram.solve(basis * a * v), gram.solve(basis * b), c * v


def _independent(rows: list[list[fmpq]]) -> fmpq_mat:
    """The rows that are not zero of their reduced echelon form."""
    reduced, rank = fmpq_mat(rows).rref()
    return fmpq_mat(reduced.tolist()[:rank]) if rank else fmpq_mat(0, reduced.ncols())


def _matrix(rows: Rows) -> fmpq_mat:
    return fmpq_mat([[fmpq(x.numerator, x.denominator) for x in row] for row in rows])
