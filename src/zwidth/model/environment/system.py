"""Systems of python-control, scipy.signal and harold, read exactly.

They are recognised by what they have (num and den; A, B, C, D; zeros, poles, gain), so that none of these
libraries is needed here.  A float means its shortest decimal, as everywhere; the transfer function of a state
space is computed in rational arithmetic.  Common factors are kept: a mode that the transfer function hides is
still run by the controller.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from decimal import Decimal
from fractions import Fraction
from types import SimpleNamespace
from typing import Any, Literal, NamedTuple

import flint

from zwidth.errors import InputError
from zwidth.model.environment.discretization import LARGEST_ORDER

Polynomial = tuple[Fraction, ...]


class LinearSystem(NamedTuple):
    """Numerator and denominator in descending powers, and the time they are of."""

    numerator: Polynomial
    denominator: Polynomial
    time: Literal["continuous", "discrete", "unsaid"]
    sample_period: Fraction | None
    """T [s] of a discrete system that says it."""


def is_system(thing: object) -> bool:
    """True for what looks like a system of python-control, scipy.signal or harold."""
    return (hasattr(thing, "dt") and not isinstance(thing, type)) or is_of_harold(thing)


def read_system(system: Any) -> LinearSystem:
    """The transfer function of a single-input single-output linear system."""
    system = renamed(system)
    if all(hasattr(system, name) for name in ("A", "B", "C", "D")):
        num, den = _from_state_space(system)
    elif hasattr(system, "num") and hasattr(system, "den"):
        num, den = (_single(getattr(system, name), name) for name in ("num", "den"))
    elif all(hasattr(system, name) for name in ("zeros", "poles", "gain")):
        gain = number_of(system.gain, "gain")
        num = tuple(gain * c for c in _with_roots(system.zeros, "zeros"))
        den = _with_roots(system.poles, "poles")
    else:
        raise InputError(
            f"a system of type {type(system).__name__} is not read; give a TransferFunction, StateSpace or "
            "ZerosPolesGain system of python-control, scipy.signal or harold, or the coefficients themselves"
            + _of_a_table(system)
        )
    return LinearSystem(num, den, *time_of(system))


def _of_a_table(system: Any) -> str:
    """What to do with a measured response, which python-control has as a system too."""
    if not hasattr(system, "frdata"):
        return ""
    return "; of a measured response zw.ports.response_table says what it shows, and for a proof fit one"


def time_of(system: Any) -> tuple[Literal["continuous", "discrete", "unsaid"], Fraction | None]:
    """Which time a system is of, and its T [s].

    scipy says None for continuous time; python-control says 0, and None for either.
    """
    dt = renamed(system).dt
    if dt is None:
        of_scipy = any(base.__module__.split(".")[0] == "scipy" for base in type(system).__mro__)
        return ("continuous" if of_scipy else "unsaid"), None
    if dt is True:
        return "discrete", None
    if dt == 0:
        return "continuous", None
    return "discrete", number_of(dt, "dt")


def number_of(value: Any, key: str) -> Fraction:
    """A coefficient as the shortest decimal of its double."""
    if getattr(value, "imag", 0) != 0:
        raise InputError(f"{key} has the complex coefficient {value}; a force law is real")
    number = float(getattr(value, "real", value))
    if not math.isfinite(number):
        raise InputError(f"{key} holds {number}; expected finite numbers")
    return Fraction(Decimal(repr(number)))


def _single(coefficients: Any, key: str) -> Polynomial:
    """One polynomial out of the nested lists that hold one for each input and output."""
    inner = coefficients
    while len(inner) == 1 and isinstance(inner[0], Iterable):
        inner = inner[0]
    if any(isinstance(c, Iterable) for c in inner):
        raise InputError(_SEVERAL)
    bounded(len(inner) - 1)
    return tuple(number_of(c, key) for c in inner)


def bounded(order: int) -> None:
    """Refuse what would take too long to read."""
    if order > LARGEST_ORDER:
        raise InputError(f"the system has order {order}; at most {LARGEST_ORDER} is read")


_SEVERAL = (
    "the system has several inputs or outputs; a force law has one position in and one force out: "
    "pick one entry of it, such as system[0, 0]"
)


def _from_state_space(system: Any) -> tuple[Polynomial, Polynomial]:
    """C (zI − A)⁻¹ B + D = (det(zI − A + BC) + (D − 1) det(zI − A))/det(zI − A)."""
    bounded(len(system.A))
    a, b, c, d = (rows_of(getattr(system, name), name) for name in "ABCD")
    order = len(a)
    if len(d) != 1 or len(d[0]) != 1:
        raise InputError(_SEVERAL)
    if order == 0:
        return (d[0][0],), (Fraction(1),)
    closed = [[a[i][j] - b[i][0] * c[0][j] for j in range(order)] for i in range(order)]
    den = characteristic(a)
    num = tuple(x + (d[0][0] - 1) * y for x, y in zip(characteristic(closed), den, strict=True))
    return num, den


def rows_of(matrix: Any, key: str) -> list[list[Fraction]]:
    """A matrix of doubles, exactly."""
    return [[number_of(entry, key) for entry in row] for row in matrix]


def characteristic(matrix: list[list[Fraction]]) -> Polynomial:
    """det(zI − A) in descending powers."""
    entries = [[flint.fmpq(x.numerator, x.denominator) for x in row] for row in matrix]
    coefficients = flint.fmpq_mat(entries).charpoly().coeffs()
    return tuple(Fraction(int(c.p), int(c.q)) for c in coefficients[::-1])


def _with_roots(roots: Any, key: str) -> Polynomial:
    """∏ (z − r), the complex roots in conjugate pairs."""
    bounded(len(roots))
    real, imaginary = [Fraction(1)], [Fraction(0)]
    for root in roots:
        if isinstance(root, Iterable):
            raise InputError(_SEVERAL)
        x, y = number_of(root.real, key), number_of(root.imag, key)
        zero = [Fraction(0)]
        re, im = zero + real, zero + imaginary
        real, imaginary = (
            [p - x * q + y * r for p, q, r in zip(real + zero, re, im, strict=True)],
            [p - x * q - y * r for p, q, r in zip(imaginary + zero, im, re, strict=True)],
        )
    if any(imaginary):
        raise InputError(f"the complex {key} of the system are not in conjugate pairs; a force law is real")
    return tuple(real)


# Systems of harold (Transfer and State), under the names of python-control.
#
#     SamplingPeriod   T [s], None in continuous time        dt
#     num, den         of one axis rows in a matrix, of several a list of rows of such       num[i][j]
#     a, b, c, d       without states empty                                                  A, B, C, D
#
# They are recognised by what they have, so that harold is not needed here.  Source: ilayn/harold,
# harold/_classes.py, version 1.0.2.


def is_of_harold(thing: object) -> bool:
    """True for what looks like a Transfer or a State of harold."""
    return hasattr(thing, "SamplingPeriod") and hasattr(thing, "shape") and not isinstance(thing, type)


def renamed(system: Any) -> Any:
    """A system as python-control would have it; one that is not of harold as it is."""
    if not is_of_harold(system):
        return system
    period = system.SamplingPeriod
    outputs, inputs = (int(size) for size in system.shape)
    own = {"dt": 0 if period is None else period, "noutputs": outputs, "ninputs": inputs}
    if all(hasattr(system, name) for name in "abcd"):
        matrices = {name.upper(): getattr(system, name) for name in "abcd"}
        return SimpleNamespace(**own, **matrices)
    num, den = (_by_entry(getattr(system, name), outputs, inputs) for name in ("num", "den"))
    return SimpleNamespace(**own, num=num, den=den)


def _by_entry(polynomials: Any, outputs: int, inputs: int) -> list[list[list[Any]]]:
    """[output][input] → coefficients."""
    if (outputs, inputs) == (1, 1):
        return [[list(polynomials[0])]]
    return [[list(polynomials[i][j][0]) for j in range(inputs)] for i in range(outputs)]
