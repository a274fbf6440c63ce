"""A port of several axes from a system: one integer denominator, and the hidden modes decided."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from math import lcm
from typing import Any

from flint import fmpq, fmpq_poly

from zwidth.environment.matrix_system import MatrixSystem, hidden_modes, read_matrix_system, size_of
from zwidth.environment.system import Polynomial
from zwidth.errors import InputError
from zwidth.passivity.ports.multiport.port import MatrixPort
from zwidth.passivity.ports.port import Time, decays, said_time

MOST_AXES = 6
LARGEST_SIZE = 120
"""Axes times the order of the common denominator: the degree of a determinant."""


def read_matrix_port(system: Any) -> MatrixPort:
    """The port of a square system of python-control or scipy.signal.

    Raises
    ------
    InputError
        If it has not as many inputs as outputs, is not causal in discrete time, too large, or
        does not say whether its time is continuous.
    """
    _bounded(size_of(system)[0], len(getattr(system, "A", ())))
    read = read_matrix_system(system)
    time = said_time(read.time, [p for row in read.entries for entry in row for p in entry])
    entries = [[_fraction(*entry, time) for entry in row] for row in read.entries]
    common = fmpq_poly([1])
    for row in entries:
        for _, d in row:
            common = common * (d // fmpq_poly(common.numer().gcd(d.numer())))
    numerators = [[n * (common // d) for n, d in row] for row in entries]
    decay = _hidden_modes_decay(read, common, time)
    port = from_polynomials(numerators, common, time, read.sample_period or Fraction(1), decay)
    _bounded(port.axes, port.order)
    return port


def from_polynomials(
    numerators: list[list[fmpq_poly]],
    denominator: fmpq_poly,
    time: Time,
    period: Fraction,
    hidden_modes_decay: bool = True,
) -> MatrixPort:
    """The port N/d."""
    scale = lcm(*(int(p.denom()) for p in (denominator, *(n for row in numerators for n in row))))

    def whole(p: fmpq_poly) -> tuple[int, ...]:
        return tuple(int(c * scale) for c in p.coeffs()) or (0,)

    size, d = range(len(numerators)), whole(denominator)
    inputs = tuple(tuple(d if i == j else (0,) for j in size) for i in size)
    outputs = tuple(tuple(whole(n) for n in row) for row in numerators)
    return MatrixPort(outputs, inputs, d, time, period, hidden_modes_decay)


def _bounded(axes: int, order: int) -> None:
    if axes > MOST_AXES:
        raise InputError(
            f"the system has {axes} inputs; at most {MOST_AXES} are decided together: where groups of "
            "axes do not act on each other, give each group by itself"
        )
    if axes * order > LARGEST_SIZE:
        raise InputError(
            f"the system has {axes} inputs and order {order}, of its states or of the common denominator of "
            f"its entries; with so many inputs at most {LARGEST_SIZE // axes} is decided: reduce it"
        )


def _fraction(numerator: Polynomial, denominator: Polynomial, time: Time) -> tuple[fmpq_poly, fmpq_poly]:
    """One entry in lowest terms."""
    n, d = (_polynomial(p) for p in (numerator, denominator))
    if d.degree() < 0:
        raise InputError("the denominator of an entry of the system is zero")
    if time == "discrete" and n.degree() > d.degree():
        raise InputError("G(z) has more zeros than poles: it would need samples that are still to come")
    common = fmpq_poly(n.numer().gcd(d.numer()))
    return n // common, d // common


def _hidden_modes_decay(read: MatrixSystem, common: fmpq_poly, time: Time) -> bool:
    """Whether every hidden mode decays: of transfer functions, what cancels within an entry.

    Of a state space, what is not reached or not seen; it is no more than what no entry has as a pole.
    """
    if read.state is not None:
        every = _polynomial(read.entries[0][0][1])
        return _decays(every // common, time) or _decays(_polynomial(hidden_modes(*read.state)), time)
    for row in read.entries:
        for numerator, denominator in row:
            n, d = _polynomial(numerator), _polynomial(denominator)
            if n.degree() >= 0 and not _decays(fmpq_poly(n.numer().gcd(d.numer())), time):
                return False
    return True


def _decays(p: fmpq_poly, time: Time) -> bool:
    return decays([int(c) for c in p.numer().coeffs()], time)


def _polynomial(descending: Sequence[Fraction]) -> fmpq_poly:
    return fmpq_poly([fmpq(c.numerator, c.denominator) for c in reversed(descending)])
