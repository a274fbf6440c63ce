"""The characteristic polynomial of the loop, and whether its roots lie inside the unit circle.

    P(z) = zᵉ p(z) D(z) + N(z) H_N(z),    H = H_N/D the law, N/(zᵉ p) the plant

For a wall H = K + B V it is linear in K and B:  P = P_0 + K P_K + B P_B.  Written in ζ = z − 1, and with
z = (1 + w)/(1 − w) in w, its roots lie inside the circle exactly if Routh's first column is positive.
In balls that answers for every number in them at once, or does not answer.
"""

from __future__ import annotations

from fractions import Fraction
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from zwidth.loop.sampled_plant import (
    Coefficients,
    Motion,
    Number,
    SampledPlant,
    ball,
    plus,
    sampled,
    times,
)
from zwidth.model.environment.environment import RationalFunction

PRECISIONS = (128, 512, 2048)
"""Bits, one after the other, until a certain loop is decided."""


class Family(NamedTuple):
    """P = free + K stiff + B damped, descending powers of ζ, at one precision."""

    free: Coefficients
    stiff: Coefficients
    damped: Coefficients

    def at(self, stiffness: Fraction, damping: Fraction) -> Coefficients:
        """P of one wall."""
        k, b = (_beside(self.free[0], value) for value in (stiffness, damping))
        return plus(self.free, plus([k * c for c in self.stiff], [b * c for c in self.damped]))


def family(motion: Motion, velocity: RationalFunction) -> Family:
    """The polynomials of all walls with one velocity estimate V(z)."""
    plant = sampled(motion)
    above, below = (_in_zeta(plant, part) for part in velocity)
    return Family(_open(plant, below), times(plant.numerator, below), times(plant.numerator, above))


def of_law(motion: Motion, law: RationalFunction) -> Coefficients:
    """P of one law H(z)."""
    plant = sampled(motion)
    above, below = (_in_zeta(plant, part) for part in law)
    return plus(_open(plant, below), times(plant.numerator, above))


def _open(plant: SampledPlant, below: Coefficients) -> Coefficients:
    """zᵉ p D: the loop without its force."""
    product = times(plant.denominator, below)
    for _ in range(plant.late):
        product = plus([*product, 0 * product[0]], product)  # times z = ζ + 1
    return product


def decays(polynomial: Coefficients) -> bool | None:
    """True if every root has |z| < 1 for every value in the balls, False if one has not, None if unknown."""
    rows = bilinear(polynomial)
    sign = 1 if polynomial[0] > 0 else -1  # that of the law's denominator: never in doubt
    upper, lower = ([sign * c for c in rows[start::2]] for start in (0, 1))
    while upper:
        if not upper[0] > 0:
            return False if upper[0] <= 0 else None
        if not lower:
            return True
        if not lower[0] > 0:
            return False if lower[0] <= 0 else None
        ratio = upper[0] / lower[0]
        padded = [*lower[1:], *([0 * lower[0]] * (len(upper) - len(lower)))]
        upper, lower = lower, [a - ratio * b for a, b in zip(upper[1:], padded, strict=True)]
    return True


def bilinear(polynomial: Coefficients) -> Coefficients:
    """Σ a_i (2w)ⁱ (1 − w)ⁿ⁻ⁱ, descending powers of w: Σ a_i ζⁱ times (1 − w)ⁿ, ζ = 2w/(1 − w)."""
    result: Coefficients = [polynomial[0]]  # Horner in 2w, the missing factors of 1 − w put in on the way
    power: Coefficients = [_beside(polynomial[0], Fraction(1))]
    one, two = power[0], 2 * power[0]
    for coefficient in polynomial[1:]:
        power = times(power, [-one, one])
        result = plus(times(result, [two, 0 * two]), [coefficient * c for c in power])
    return result


def as_floats(polynomial: Coefficients) -> NDArray[np.float64]:
    """The middles of the coefficients."""
    return np.array([float(c) if isinstance(c, Fraction) else float(c.mid()) for c in polynomial])


def _in_zeta(plant: SampledPlant, values: tuple[Fraction, ...]) -> Coefficients:
    """A polynomial in z, written in ζ = z − 1, in the numbers of the plant."""
    shifted: list[Fraction] = []
    for value in values:  # Horner: times (ζ + 1), plus the next coefficient
        shifted = [*shifted, Fraction(0)]
        shifted = [c + (shifted[i - 1] if i else 0) for i, c in enumerate(shifted)]
        shifted[-1] += value
    return [_beside(plant.denominator[0], c) for c in shifted]


def _beside(sample: Number, value: Fraction) -> Number:
    return value if isinstance(sample, Fraction) else ball(value)
