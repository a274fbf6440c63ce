"""Waves into a port and out of it, and the port that takes in what they carry.

    a = y + z u,  b = y − z u      of a port u → y at the reference z > 0
    u' = R a − Σb,  y' = R a + Σb,  u'ᵀy' = R² |a|² − |b|²      Σ of signs

b = S a with ‖S‖ ≤ R if and only if u' → y' is positive real, whatever Σ, as long as there is such a port.
det(R a − Σb) = det a · det(R − ΣS), and R − ΣD is invertible for some Σ, whatever D = S(∞): of all Σ one with
the highest degree is taken, so that y' answers u' as soon as b answers a.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from itertools import product

from flint import fmpq_poly

from zwidth.passivity.ports.leverrier import leverrier, multiplied
from zwidth.passivity.ports.port import Polynomials, Port, in_lowest_terms
from zwidth.passivity.ports.reading import from_polynomials

Signs = tuple[int, ...]


def waves_of(port: Port, reference: Fraction) -> Port:
    """b from a, of a port from u to y."""
    own, other = reference.denominator, reference.numerator
    back, into = (_mixed(port, own, sign * other) for sign in (-1, 1))
    return _with(port, back, into)


def power_of(waves: Port, level: Fraction, signs: Sequence[int] | None = None) -> Port:
    """u' = R a − Σb and y' = R a + Σb at R = level; Σ = 1 where no signs are given."""
    top, bottom = level.numerator, level.denominator
    signs = signs or (1,) * waves.axes
    outputs, inputs = (_mixed(waves, [way * sign * bottom for sign in signs], top) for way in (1, -1))
    return _with(waves, outputs, inputs)


def direct_power_of(waves: Port, level: Fraction) -> tuple[Signs, Port]:
    """Σ, and y' as N/d times u', for a document."""
    highest = _degree(waves.inputs)
    best, chosen = -1, (1,) * waves.axes
    for signs in product((1, -1), repeat=waves.axes):
        degree = _degree(power_of(waves, level, signs).inputs)
        if degree > best:
            best, chosen = degree, signs
        if degree == highest:
            break
    assert best >= 0, "R − ΣS is invertible for some signs Σ"
    return chosen, _direct(power_of(waves, level, chosen))


def _direct(port: Port) -> Port:
    if port.axes == 1:
        return port
    n, d = ([[fmpq_poly(list(p)) for p in row] for row in side] for side in (port.outputs, port.inputs))
    found = leverrier(d, fmpq_poly([1]))
    fraction = in_lowest_terms(multiplied(n, found.adjugate), found.minors[-1])
    assert fraction is not None, "u' has an inverse"
    return from_polynomials(fraction[1], fraction[0], port.time, port.period, port.hidden_modes_decay)


def _with(port: Port, outputs: Polynomials, inputs: Polynomials) -> Port:
    """Other sides of the same signals."""
    denominator = inputs[0][0] if port.axes == 1 else port.denominator
    return Port(outputs, inputs, denominator, port.time, port.period, port.hidden_modes_decay)


def _mixed(port: Port, of_outputs: int | Sequence[int], of_inputs: int) -> Polynomials:
    """Rows of N and D, added so many times."""
    times = [of_outputs] * port.axes if isinstance(of_outputs, int) else of_outputs
    return tuple(
        tuple(_sum(n, of_n, d, of_inputs) for n, d in zip(*rows, strict=True))
        for of_n, *rows in zip(times, port.outputs, port.inputs, strict=True)
    )


def _sum(n: tuple[int, ...], of_n: int, d: tuple[int, ...], of_d: int) -> tuple[int, ...]:
    size = max(len(n), len(d))
    first, second = ((*p, *(0,) * (size - len(p))) for p in (n, d))
    total = [x * of_n + y * of_d for x, y in zip(first, second, strict=True)]
    while len(total) > 1 and not total[-1]:
        total.pop()
    return tuple(total)


def _degree(side: Polynomials) -> int:
    """Of the determinant; −1 where it vanishes."""
    if len(side) == 1:
        return len(side[0][0]) - 1 if any(side[0][0]) else -1
    matrix = [[fmpq_poly(list(p)) for p in row] for row in side]
    return int(leverrier(matrix, fmpq_poly([1])).minors[-1].degree())
