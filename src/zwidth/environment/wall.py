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

from zwidth.environment.environment import Environment, RationalFunction, add, as_clamped, certain, multiply
from zwidth.environment.velocity import BackwardDifference, VelocityEstimator
from zwidth.environment.wording import never_pulls, with_unit
from zwidth.errors import InputError
from zwidth.quantity.exact import Exact, Interval, RealLike, as_parameter, ends

Parameter = RealLike | Interval | tuple[RealLike, RealLike]


@dataclass(frozen=True, init=False, kw_only=True)
class Wall(Environment):
    """A unilateral spring–damper wall, ``f = K x + B v if x > 0``.

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

    stiffness: Exact | Interval
    damping: Exact | Interval
    velocity_filter: VelocityEstimator
    clamped: bool = False

    def __init__(
        self,
        stiffness: Parameter,
        damping: Parameter = 0,
        velocity_filter: VelocityEstimator | None = None,
        clamped: bool = False,
    ) -> None:
        k, b = as_parameter(stiffness), as_parameter(damping)
        if ends(k)[0] < 0:
            raise InputError(
                f"stiffness must be ≥ 0, got {k}: a negative spring pulls the hand in "
                "and gives out energy without end"
            )
        velocity = BackwardDifference() if velocity_filter is None else velocity_filter
        if not isinstance(velocity, VelocityEstimator):
            raise InputError(
                f"velocity_filter is BackwardDifference(), Window(samples), OnePole(time_constant) or "
                f"VelocityFilter(numerator, denominator), got {type(velocity).__name__}"
            )
        object.__setattr__(self, "stiffness", k)
        object.__setattr__(self, "damping", b)
        object.__setattr__(self, "velocity_filter", velocity)
        object.__setattr__(self, "clamped", as_clamped(clamped))

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
