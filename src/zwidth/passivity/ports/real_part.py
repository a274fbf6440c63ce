"""The least real part of a port of one axis, as the least value of a quotient in c.

    Re F = Re(N D̄)/|D|² = p/w on [−1, 1]

The quotient is least at an end or where p′ w − p w′ = 0: everything that `spectrum` looks for step
by step is in the roots of one polynomial.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property

from flint import fmpq_poly

from zwidth.passivity.linear.exact_algebra import roots_inside
from zwidth.passivity.ports.port import Port
from zwidth.passivity.ports.zeros import has_positive_sign, vanishes
from zwidth.quantity.balls import as_fmpq, as_fraction

_BITS = 320


@dataclass(frozen=True)
class RealPart:
    """power/weight in lowest terms, weight > 0 on [−1, 1] but for its zeros."""

    power: fmpq_poly
    weight: fmpq_poly

    @cached_property
    def least(self) -> tuple[Fraction, Fraction | None]:
        """The least value over [−1, 1], and where, of equals the largest c; None: everywhere."""
        p, w = self.power, self.weight
        slope = (p.derivative() * w - p * w.derivative()).numer()
        places = [Fraction(1), Fraction(-1), *roots_inside(slope, _BITS)]
        values = [(self._at(c), c) for c in places]
        least = min(value for value, _ in values)
        flat = p.degree() <= 0 and w.degree() <= 0
        return least, None if flat else max(c for value, c in values if value == least)

    def reached(self, low: Fraction) -> Fraction:
        """`low` where it is a value; otherwise the least, which is one at its c."""
        return low if vanishes(self.power - as_fmpq(low) * self.weight) else self.least[0]

    def _at(self, c: Fraction) -> Fraction:
        at = as_fmpq(c)
        return as_fraction(self.power(at) / self.weight(at))


def real_part(port: Port) -> RealPart:
    """Re F of one axis."""
    p, w = port.real_part
    common = fmpq_poly(p.numer().gcd(w.numer()))
    p, w = p // common, w // common
    return RealPart(p, w) if has_positive_sign(w) else RealPart(-p, -w)
