"""A one-port F = N/D with Re F ≥ σ in the right half plane or outside the circle: proved or refuted.

Continuous ports are taken as they are: even and odd parts at s = jω for the sign, Routh's
table for the roots.  A motion is run from rest and what it takes out is summed.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from math import comb
from typing import NamedTuple

from ..document.fields import Choice, Number, Read, Record, document, numbers
from ..document.number import common_scale, down
from ..document.refusal import Invalid
from ..exact.polynomial import add, cleared, multiply, square_modulus
from ..exact.positivity import POSITIVITY, require_nonnegative
from ..exact.roots import in_left_half_plane, inside_unit_circle

MOST_ORDER = 400

TIME = Choice("continuous", "discrete")
CLAIM = {"index": Choice("input", "output"), "level": Number()}
SYSTEM = Record({"time": TIME, "numerator": numbers(least=1), "denominator": numbers(least=1)})
"""G in descending powers of s or z."""

POSITIVE_REAL = document(
    {
        "system": SYSTEM,
        **CLAIM,
        "proof": Record({"offset": Number(above=0), "positivity": POSITIVITY}, shown=False),
    }
)


class Port(NamedTuple):
    numerator: list[Fraction]  # of F, ascending in s or z
    denominator: list[Fraction]
    continuous: bool
    level: Fraction
    order: int


def port_of(told: Read) -> Port:
    """F is G for the input index and 1/G for the output index."""
    system = told.system
    n, d = (trimmed(side) for side in (system.numerator, system.denominator))
    if not d:
        raise Invalid("the denominator is zero")
    if system.time == "discrete" and len(n) > len(d):
        raise Invalid("G(z) has more zeros than poles")
    if told.index == "output":
        n, d = d, n
    if not d:
        raise Invalid("G is zero and has no inverse")
    common_scale((*n, *d))
    order = max(len(n), len(d)) - 1
    if order > MOST_ORDER:
        raise Invalid(f"the order is {order}, more than {MOST_ORDER}")
    return Port(n, d, system.time == "continuous", told.level, order)


def trimmed(descending: list[Fraction]) -> list[Fraction]:
    """In ascending powers, without zeros in front."""
    start = next((i for i, c in enumerate(descending) if c), len(descending))
    return descending[start:][::-1]


def positive_real(told: Read) -> str:
    """Re(N D̄) ≥ σ |D|² on the boundary, and N + (g − σ) D has its roots inside, g > 0."""
    p, proof = port_of(told), told.proof
    excess = _combined(p, -p.level)
    require_nonnegative(_on_axis(excess, p) if p.continuous else _on_circle(excess, p), proof.positivity)
    total = _combined(p, proof.offset - p.level)
    require_inside([*[Fraction(0)] * (p.order + 1 - len(total)), *total[::-1]], p.continuous)
    return f"the {told.index} index is at least {down(p.level)}"


def require_inside(descending: list[Fraction], continuous: bool) -> None:
    """Refuse a polynomial with a root that does not decay, or of less than its degree."""
    if continuous:
        inside = in_left_half_plane(descending)
    else:
        inside = descending[0] != 0 and inside_unit_circle(descending)
    if not inside:
        raise Invalid("the port is not positive real: a root lies outside")


def _combined(p: Port, share: Fraction) -> list[Fraction]:
    return add(p.numerator, [share * c for c in p.denominator])


def _on_circle(m: list[Fraction], p: Port) -> list[Fraction]:
    """Re(M D̄) = ¼ (|M + D|² − |M − D|²), in c = cos θ."""
    whole = cleared([*m, *p.denominator])
    first, second = whole[: len(m)], whole[len(m) :]
    sides = (add(first, [sign * c for c in second]) for sign in (1, -1))
    sums = (square_modulus(side, p.order) for side in sides)
    return [Fraction(a - b) for a, b in zip(*sums, strict=True)]


def _on_axis(m: list[Fraction], p: Port) -> list[Fraction]:
    """Re(M D̄) in x = ω², and x = (1 − c)/(1 + c), times (1 + c)ⁿ."""
    parts = [(part_of(side, 0), part_of(side, 1)) for side in (m, p.denominator)]
    even = multiply(parts[0][0], parts[1][0])
    odd = [Fraction(0), *multiply(parts[0][1], parts[1][1])]
    total = [Fraction(0)] * (p.order + 1)
    for power, c in enumerate(add(even, odd)):
        if c:
            factor = multiply(_binomial(power, -1), _binomial(p.order - power, 1))
            total = add(total, [c * f for f in factor])
    return total


def part_of(ascending: Sequence[Fraction], parity: int) -> list[Fraction]:
    """The even or odd part at s = jω, over (jω)^parity, in x = ω²."""
    return [c if i % 2 == 0 else -c for i, c in enumerate(ascending[parity::2])] or [Fraction(0)]


def _binomial(power: int, sign: int) -> list[Fraction]:
    """(1 ± c)ⁿ."""
    return [Fraction(sign**k * comb(power, k)) for k in range(power + 1)]
