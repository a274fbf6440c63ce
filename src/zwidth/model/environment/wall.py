"""The virtual wall: a spring and a damper that act inside only.

    f = K x + B v    if x > 0,   0 outside;      H(z) = K + B V(z)

with V(z) the velocity estimator, by default the backward difference (Colgate & Schenkel 1997; Abbott &
Okamura 2005, equation (2)).  A clamped wall never pulls, f = max(0, K x + B v): its damper does not hold back
the hand that leaves quickly.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import Literal, Self

from zwidth.errors import InputError
from zwidth.model.environment.environment import (
    Box,
    DampedSpring,
    Environment,
    RationalFunction,
    add,
    certain,
    clamping,
    multiply,
    never_pulls,
    with_unit,
)
from zwidth.model.environment.velocity import BackwardDifference, OnePole, VelocityEstimator
from zwidth.quantity.exact import Exact, ends, times
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

    unilateral = True

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

    def scaled(self, factor: Fraction) -> Self:
        """The wall factor · f, exactly."""
        return self.replace(stiffness=times(self.stiffness, factor), damping=times(self.damping, factor))

    def describe(self, motion: str = "linear") -> str:
        """The law with its numbers, on one line, in linear or rotary units."""
        parts = [with_unit("stiffness", self.stiffness, motion)]
        if not self.spring:
            parts += [with_unit("virtual_damping", self.damping, motion), self.velocity_filter.describe()]
        return f"wall, {', '.join(parts)}{never_pulls(self.clamped)}"

    @property
    def fed_with(self) -> Literal["position", "penetration"]:
        """The position: the velocity is estimated on every reading, outside too."""
        return "position"

    @property
    def turns(self) -> int:
        """Rotations among its coordinates before an arm: none."""
        return 0

    rests_on_spring = True
    """True: at rest there is no velocity."""

    def damped_spring(self, sample_period: Fraction) -> DampedSpring:
        """K, B and how v is made of the last moves."""
        velocity = self.velocity_filter
        return DampedSpring(
            certain(self.stiffness, "stiffness"),
            certain(self.damping, "damping"),
            velocity.transfer(sample_period),
            velocity.weights(sample_period),
        )

    def decided_by_corners(self, box: Box) -> bool:
        """For every spring, and in four more cases.

        K and B, any filter and delay: they enter H linearly, the required damping is a supremum of convex
        functions of H, and ‖h‖₁ is convex.

        A spring: b* = (KT/4)[2d+1+2α + √((2d+1)² + 8α(d+1))] increases in K, T and the delay, and K Δ/2
        does not depend on them.

        T, without delay, of a filter fixed in samples: the requirement is K T/2 plus a constant, and ‖h‖₁
        is convex in 1/T.

        A one-pole filter and B ≥ 0, without delay: KT/2 + B T/(2τ+T) and K + 2B/(T+τ) are monotone in each.

        Contact made and broken covered at every corner, without delay: the conditions increase in K and the
        size of B, the one for b in T, the one for f_c in 1/T and 1/(T+τ).  What the multiplier asks for is
        never more, and increases as well: K T/2 plus the size of B times a number of the filter, for one
        pole one that falls with τ/T.
        """
        if box.covers_contact and box.is_undelayed:
            return True
        is_certain = "velocity_filter" not in box.of_law
        if self.spring or (is_certain and not box.of_timing):
            return True
        if not box.is_undelayed:
            return False
        return ends(self.damping)[0] >= 0 if isinstance(self.velocity_filter, OnePole) else is_certain

    def least_demanding(self, is_ideal: bool) -> Self | None:
        """The softest spring; with a backward difference on an ideal device the least B as well."""
        exact = is_ideal and isinstance(self.velocity_filter, BackwardDifference) and not self.clamped
        if not (self.spring or exact):
            return None
        low, high = ends(self.damping)
        least = Fraction(0) if low <= 0 <= high else min(low, high, key=abs)
        return self.replace(stiffness=Exact(ends(self.stiffness)[0]), damping=Exact(least))


def wall_of(environment: object) -> Wall | None:
    """The environment, if it is a wall that can be had with another damping or filter; None otherwise."""
    return environment if isinstance(environment, Wall) else None
