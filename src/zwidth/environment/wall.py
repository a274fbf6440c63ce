"""The virtual wall: a spring and a damper that act inside only.

    f = K x + B v    if x > 0,   0 outside;      H(z) = K + B V(z)

with V(z) the velocity estimator, by default the backward difference
(Colgate & Schenkel 1997; Abbott & Okamura 2005, equation (2)).  A clamped wall
never pulls, f = max(0, K x + B v): its damper does not hold back the hand that
leaves quickly.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from zwidth.environment.environment import Environment, RationalFunction, add, certain, clamping, multiply
from zwidth.environment.velocity import BackwardDifference, VelocityEstimator
from zwidth.environment.wording import never_pulls, with_unit
from zwidth.errors import InputError
from zwidth.quantity.exact import ends
from zwidth.quantity.parameter import Reads, Uncertain, parameter, part

NEGATIVE_SPRING = "a negative spring pulls the hand in and gives out energy without end"


def _filter(given: VelocityEstimator | None, name: str) -> VelocityEstimator:
    velocity = BackwardDifference() if given is None else given
    if not isinstance(velocity, VelocityEstimator):
        raise InputError(
            f"{name} is BackwardDifference(), Window(samples), OnePole(time_constant) or "
            f"VelocityFilter(numerator, denominator), got {type(velocity).__name__}"
        )
    return velocity


@dataclass(frozen=True)
class Wall(Environment):
    """A unilateral spring–damper wall, ``f = K x + B v if x > 0``.

    A number may be an interval, a pair of ends, or a text with its unit, such as "0.3 N/mm".

    Parameters
    ----------
    stiffness
        K ≥ 0 [N/m; N·m/rad].
    damping
        B, of either sign [N·s/m; N·m·s/rad]. Default 0.
    velocity_filter
        `BackwardDifference()` (default), `Window(samples)`, `OnePole(time_constant)`
        or `VelocityFilter(numerator, denominator)`.
    clamped
        True for a wall that never pulls, ``f = max(0, K x + B v)`` inside. Default False.

    Raises
    ------
    InputError
        If K < 0: a negative spring pulls the hand in and its energy has no floor; or
        if velocity_filter is none of these, or clamped is not a bool.
    """

    stiffness: Uncertain = parameter("stiffness", bound="≥ 0", why=NEGATIVE_SPRING)
    damping: Uncertain = parameter("virtual_damping", 0)
    velocity_filter: Reads[VelocityEstimator, VelocityEstimator | None] = part(
        "velocity filter", _filter, None, meaning="backward-difference, window N, one-pole τ or f, filter"
    )
    clamped: bool = clamping()

    @property
    def unilateral(self) -> bool:
        return True

    @property
    def spring(self) -> bool:
        return ends(self.damping) == (0, 0)

    def pulse_transfer_function(self, sample_period: Fraction) -> RationalFunction:
        """K + B V(z) [N/m]."""
        k = certain(self.stiffness, "stiffness")
        if self.spring:
            return RationalFunction((k,), (Fraction(1),))
        b = certain(self.damping, "damping")
        num, den = self.velocity_filter.transfer(sample_period)
        return RationalFunction(add(multiply((k,), den), multiply((b,), num)), den)

    def describe(self, motion: str = "linear") -> str:
        """The law with its numbers, on one line, in linear or rotary units."""
        parts = [with_unit("stiffness", self.stiffness, motion)]
        if not self.spring:
            parts += [with_unit("virtual_damping", self.damping, motion), self.velocity_filter.describe()]
        return f"wall, {', '.join(parts)}{never_pulls(self.clamped)}"
