"""A one-port F = N/D with Re F ≥ σ in the right half plane or outside the circle.

Continuous ports are taken as they are: even and odd parts at s = jω for the sign, Routh's
table for the roots.
"""

from __future__ import annotations

from fractions import Fraction
from math import comb

from ..document.fields import Number, Read, Record, document
from ..document.number import down
from ..document.refusal import Invalid
from ..exact.polynomial import add, cleared, multiply, square_modulus
from ..exact.positivity import POSITIVITY, require_nonnegative
from ..exact.roots import in_left_half_plane, inside_unit_circle
from .system import CLAIM, SYSTEM, Polynomial, part_of, port_of

POSITIVE_REAL = document(
    {
        "system": SYSTEM,
        **CLAIM,
        "proof": Record({"offset": Number(above=0), "positivity": POSITIVITY}, shown=False),
    }
)


def positive_real(told: Read) -> str:
    """Re(N D̄) ≥ σ |D|² on the boundary, and N + (g − σ) D has its roots inside, g > 0."""
    p, proof = port_of(told), told.proof
    ((n,),), ((d,),) = p.outputs, p.inputs
    excess, total = (add(n, [(share - p.level) * c for c in d]) for share in (0, proof.offset))
    sign = _on_axis if p.continuous else _on_circle
    require_nonnegative(sign(excess, d, p.order), proof.positivity)
    require_inside([*[Fraction(0)] * (p.order + 1 - len(total)), *total[::-1]], p.continuous)
    return f"the {told.index} index is at least {down(p.level)}"


def require_inside(descending: Polynomial, continuous: bool) -> None:
    """Refuse a polynomial with a root that does not decay, or of less than its degree."""
    if continuous:
        inside = in_left_half_plane(descending)
    else:
        inside = descending[0] != 0 and inside_unit_circle(descending)
    if not inside:
        raise Invalid("the port is not positive real: a root lies outside")


def _on_circle(m: Polynomial, d: Polynomial, order: int) -> Polynomial:
    """Re(M D̄) = ¼ (|M + D|² − |M − D|²), in c = cos θ."""
    whole = cleared([*m, *d])
    first, second = whole[: len(m)], whole[len(m) :]
    sides = (add(first, [sign * c for c in second]) for sign in (1, -1))
    sums = (square_modulus(side, order) for side in sides)
    return [Fraction(a - b) for a, b in zip(*sums, strict=True)]


def _on_axis(m: Polynomial, d: Polynomial, order: int) -> Polynomial:
    """Re(M D̄) in x = ω², and x = (1 − c)/(1 + c), times (1 + c)ⁿ."""
    even, odd = (multiply(part_of(m, parity), part_of(d, parity)) for parity in (0, 1))
    total = [Fraction(0)] * (order + 1)
    for power, c in enumerate(add(even, [Fraction(0), *odd])):
        if c:
            factor = multiply(_binomial(power, -1), _binomial(order - power, 1))
            total = add(total, [c * f for f in factor])
    return total


def _binomial(power: int, sign: int) -> Polynomial:
    """(1 ± c)ⁿ."""
    return [Fraction(sign**k * comb(power, k)) for k in range(power + 1)]
