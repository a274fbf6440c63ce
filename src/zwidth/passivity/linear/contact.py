"""Walls with virtual damping, touched and left at will: what covers every motion.

    b ≥ (2d + 1) K T/2 + |B| Σ|w_j|          f_c ≥ (K + |B| ‖h_v‖₁) Δ/2

for the force K max(q, 0) + r of the measured position q, applied d samples
later, with any |r| ≤ |B| |v|, v(k) = Σ w_j (q(k−j) − q(k−j−1))/T.  That is the
wall that acts inside only, r = B v there, and the clamped wall max(0, K q + B v);
h_v is the impulse response from q to v.  The proof is in the documentation.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from flint import fmpq, fmpq_poly

from zwidth.environment import BackwardDifference, OnePole, VelocityFilter, Wall, Window
from zwidth.environment.environment import Environment, certain
from zwidth.environment.velocity import VelocityEstimator
from zwidth.passivity.linear.loop import LinearLoop
from zwidth.quantity.exact import Exact


@dataclass(frozen=True)
class Average:
    """v = Σ w_j (q(k−j) − q(k−j−1))/T over the samples of a window."""

    weights: tuple[Fraction, ...]

    @property
    def gain(self) -> Fraction:
        """Σ|w_j|."""
        return sum((abs(w) for w in self.weights), Fraction(0))

    @property
    def variation(self) -> Fraction:
        """T ‖h_v‖₁ = |w_0| + Σ|w_j − w_{j−1}|, what comes after the last weight included."""
        steps = zip((*self.weights, Fraction(0)), (Fraction(0), *self.weights), strict=True)
        return sum((abs(w - before) for w, before in steps), Fraction(0))


@dataclass(frozen=True)
class Decay:
    """w_j = (1 − p) pʲ, 0 ≤ p < 1."""

    pole: Fraction

    @property
    def gain(self) -> Fraction:
        """Σ|w_j| = 1."""
        return Fraction(1)

    @property
    def variation(self) -> Fraction:
        """T ‖h_v‖₁ = 2 (1 − p)."""
        return 2 * (1 - self.pole)


@dataclass(frozen=True)
class DampedWall:
    """A wall as the two conditions see it: K ≥ 0, B and the weights of its velocity estimate.

    Parameters
    ----------
    stiffness, damping
        K [N/m; N·m/rad] and B [N·s/m; N·m·s/rad].
    estimate
        How v is made of the last moves.
    """

    stiffness: Fraction
    damping: Fraction
    estimate: Average | Decay

    def required_damping(self, loop: LinearLoop) -> Fraction | None:
        """The device damping that covers contact made and broken; None with a delay of part of a sample."""
        if loop.part_delay or not loop.hidden_modes_decay:
            return None
        hold = (2 * loop.whole_delay + 1) * self.stiffness * loop.period / 2
        return hold + abs(self.damping) * self.estimate.gain

    def required_friction(self, resolution: Fraction, period: Fraction) -> Fraction:
        """The Coulomb friction that covers an encoder of resolution Δ [N; N·m]."""
        return (self.stiffness + abs(self.damping) * self.estimate.variation / period) * resolution / 2


def damped_wall(environment: Environment, period: Fraction) -> DampedWall | None:
    """The environment at the sample period T [s], if it is a wall whose estimate has such weights."""
    if not isinstance(environment, Wall):
        return None
    found = _estimate(environment.velocity_filter, period)
    if found is None:
        return None
    return DampedWall(
        certain(environment.stiffness, "stiffness"), certain(environment.damping, "damping"), found
    )


def _estimate(velocity: VelocityEstimator, period: Fraction) -> Average | Decay | None:
    if isinstance(velocity, BackwardDifference):
        return Average((Fraction(1),))
    if isinstance(velocity, Window):
        return Average((Fraction(1, velocity.samples),) * velocity.samples)
    if isinstance(velocity, OnePole):
        tau = certain(velocity.time_constant, "time_constant")
        return Decay(tau / (period + tau))
    return _finite(velocity)


def _finite(velocity: VelocityFilter) -> Average | None:
    """F(z) = Σ w_j z⁻ʲ, if it ends."""
    late = (Exact(0),) * (len(velocity.denominator) - len(velocity.numerator))
    n, d = (
        fmpq_poly([fmpq(c.fraction.numerator, c.fraction.denominator) for c in part])
        for part in ((*late, *velocity.numerator), velocity.denominator)
    )
    if n % d != 0:
        return None
    return Average(tuple(Fraction(int(c.p), int(c.q)) for c in (n // d).coeffs()))
