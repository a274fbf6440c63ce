"""Walls with virtual damping, touched and left at will: what covers every motion.

    b ≥ (2d + 1) K T/2 + |B| Σ|w_j|          f_c ≥ (K + |B| ‖h_v‖₁) Δ/2

for the force K max(q, 0) + r of the measured position q, applied d samples
later, with any |r| ≤ |B| |v|, v(k) = Σ w_j (q(k−j) − q(k−j−1))/T.  That is the
wall that acts inside only, r = B v there, and the clamped wall max(0, K q + B v);
h_v is the impulse response from q to v.  Applied d + α samples later, 0 < α < 1,

    b (b − Q) ≥ α(1 − α) (K T + 2 |B| Σ|w_j|)²/4,    Q = (2d + 1 + 2α) K T/2 + |B| Σ|w_j| ≤ b

in the place of the first.  The proofs are in the documentation.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from math import isqrt

from zwidth.model.environment.environment import Average, Decay, Environment
from zwidth.passivity.linear.loop import LinearLoop

_FINE = 10**12
"""A root is taken to so many parts of itself, from above."""


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
        """The device damping that covers contact made and broken; None with modes that grow unseen."""
        if not loop.hidden_modes_decay:
            return None
        return enough_damping(loop, self.stiffness, abs(self.damping) * self.estimate.gain)

    def required_friction(self, resolution: Fraction, period: Fraction) -> Fraction:
        """The Coulomb friction that covers an encoder of resolution Δ [N; N·m]."""
        return (self.stiffness + abs(self.damping) * self.estimate.variation / period) * resolution / 2


def enough_damping(loop: LinearLoop, stiffness: Fraction, asked: Fraction = Fraction(0)) -> Fraction:
    """The least b of the two inequalities above, rounded up where it is a root.

    Parameters
    ----------
    loop
        Whose delay and period count.
    stiffness
        K ≥ 0 [N/m; N·m/rad].
    asked
        |B| Σ|w_j| [N·s/m; N·m·s/rad].
    """
    turned, alpha = stiffness * loop.period, loop.part_delay
    linear = turned / 2 * (2 * loop.whole_delay + 1 + 2 * alpha) + asked
    if alpha == 0:
        return linear
    return (linear + root_above(linear**2 + alpha * (1 - alpha) * (turned + 2 * asked) ** 2)) / 2


def root_above(square: Fraction) -> Fraction:
    """√ of a number ≥ 0, rounded up."""
    scaled = square.numerator * square.denominator * _FINE**2
    root = isqrt(scaled)
    return Fraction(root + (root * root < scaled), square.denominator * _FINE)


def damped_wall(environment: Environment, period: Fraction) -> DampedWall | None:
    """The environment at the sample period T [s], if it is a wall whose estimate has such weights."""
    law = environment.damped_spring(period)
    if law is None or law.weights is None:
        return None
    return DampedWall(law.stiffness, law.damping, law.weights)
