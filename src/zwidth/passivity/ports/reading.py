"""A port from a system or an environment: integer polynomials, and the hidden modes decided."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from fractions import Fraction
from math import lcm
from typing import Any, Literal

from flint import fmpq, fmpq_poly, fmpz_poly

from zwidth.errors import InputError
from zwidth.model.environment.environment import Environment
from zwidth.model.environment.matrix_system import MatrixSystem, hidden_modes, read_matrix_system, size_of
from zwidth.model.environment.system import LinearSystem, Polynomial, is_system, read_system, time_of
from zwidth.passivity.linear.loop import LARGEST_DEGREE
from zwidth.passivity.ports.circle import Time, decays
from zwidth.passivity.ports.port import Port, common_factor

MOST_AXES = 6
LARGEST_SIZE = 120
"""Axes times the order of the common denominator: the degree of a determinant."""

_NOT_CAUSAL = "G(z) has more zeros than poles: it would need samples that are still to come"


def read_port(thing: Environment | Any, period: Fraction | None = None) -> Port:
    """A port from a square system of python-control, scipy.signal or harold, or from an environment's H(z).

    `period` is that of an environment, and of a discrete system that says none.
    """
    if isinstance(thing, Environment):
        if period is None:
            raise InputError("an environment has an H(z) at a sample period only; give the device it runs on")
        h = thing.pulse_transfer_function(period)
        return _of_one_axis(h.numerator, h.denominator, "discrete", period)
    if not is_system(thing):
        raise InputError(
            f"a port is a system of python-control, scipy.signal or harold, or an environment; got {thing!r}"
        )
    if size_of(thing) != (1, 1):
        return _of_several_axes(thing, period)
    system = read_system(thing)
    time = _said_time(system.time, (system.numerator, system.denominator))
    return _of_one_axis(system.numerator, system.denominator, time, _period(system, period))


def _period(system: LinearSystem | MatrixSystem, period: Fraction | None) -> Fraction:
    """T [s]; 1 where nobody says it, or there is none."""
    other = None if system.time == "continuous" else period
    return system.sample_period or other or Fraction(1)


def assumed_period(thing: Environment | Any, period: Fraction | None = None) -> tuple[str, ...]:
    """What is assumed of the sample period where neither a discrete system nor anything else says it."""
    if period is not None or not is_system(thing) or time_of(thing) != ("discrete", None):
        return ()
    return ("samples of 1 s, for the system does not say how long they are: frequencies are about that",)


def _of_one_axis(numerator: Polynomial, denominator: Polynomial, time: Time, period: Fraction) -> Port:
    """The port of two polynomials in descending powers, in lowest terms."""
    scale = lcm(*(c.denominator for c in (*numerator, *denominator)))
    n, d = (fmpz_poly([int(c * scale) for c in reversed(p)]) for p in (numerator, denominator))
    if d.degree() < 0:
        raise InputError("the denominator of the transfer function is zero")
    if time == "discrete" and n.degree() > d.degree():
        raise InputError(_NOT_CAUSAL)
    order = max(n.degree(), d.degree())
    if order > LARGEST_DEGREE:
        raise InputError(f"the system has order {order}; at most {LARGEST_DEGREE} is decided")
    common = n.gcd(d)
    decay = n.degree() < 0 or decays([int(c) for c in common.coeffs()], time)
    own, below = (tuple(int(c) for c in (p // common).coeffs()) or (0,) for p in (n, d))
    return Port(((own,),), ((below,),), below, time, period, decay)


def _said_time(time: Time | Literal["unsaid"], polynomials: Iterable[Polynomial]) -> Time:
    """The time that a system says, or any of a constant one."""
    if time == "unsaid" and any(any(p[:-1]) for p in polynomials):
        raise InputError(
            "the system has dt=None and so does not say whether it is G(s) or G(z); give it a dt: 0 for "
            "continuous time, the sample period or True for discrete time"
        )
    return "discrete" if time == "discrete" else "continuous"


def _of_several_axes(system: Any, period: Fraction | None) -> Port:
    _bounded(size_of(system)[0], len(getattr(system, "A", ())))
    read = read_matrix_system(system)
    time = _said_time(read.time, [p for row in read.entries for entry in row for p in entry])
    entries = [[_fraction(*entry, time) for entry in row] for row in read.entries]
    common = fmpq_poly([1])
    for row in entries:
        for _, d in row:
            common = common * (d // common_factor((common, d)))
    numerators = [[n * (common // d) for n, d in row] for row in entries]
    decay = _hidden_modes_decay(read, common, time)
    port = from_polynomials(numerators, common, time, _period(read, period), decay)
    _bounded(port.axes, port.order)
    return port


def from_polynomials(
    numerators: list[list[fmpq_poly]],
    denominator: fmpq_poly,
    time: Time,
    period: Fraction,
    hidden_modes_decay: bool = True,
) -> Port:
    """The port N/d."""
    scale = lcm(*(int(p.denom()) for p in (denominator, *(n for row in numerators for n in row))))

    def whole(p: fmpq_poly) -> tuple[int, ...]:
        return tuple(int(c * scale) for c in p.coeffs()) or (0,)

    size, d = range(len(numerators)), whole(denominator)
    inputs = tuple(tuple(d if i == j else (0,) for j in size) for i in size)
    outputs = tuple(tuple(whole(n) for n in row) for row in numerators)
    return Port(outputs, inputs, d, time, period, hidden_modes_decay)


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
        raise InputError(_NOT_CAUSAL)
    common = common_factor((n, d))
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
            if n.degree() >= 0 and not _decays(common_factor((n, d)), time):
                return False
    return True


def _decays(p: fmpq_poly, time: Time) -> bool:
    return decays([int(c) for c in p.numer().coeffs()], time)


def _polynomial(descending: Sequence[Fraction]) -> fmpq_poly:
    return fmpq_poly([fmpq(c.numerator, c.denominator) for c in reversed(descending)])
