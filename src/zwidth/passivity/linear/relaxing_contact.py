"""Laws that relax, touched and left at will: what covers every motion.

    H = K + Σ g_i (1 − ζ)/(1 − p_i ζ),     ζ = 1/z,  K ≥ 0,  |p_i| < 1

Fed with the penetration, without delay, every g_i > 0 and 0 ≤ p_i < 1, and if the law
never pulls one part at most:

    b ≥ K T/2 + Σ g_i T/(1 + p_i)                    f_c ≥ (K + 2 Σ g_i) Δ/2

which is what sustained contact asks for.  However it is fed, d samples late, clamped or not:

    b ≥ (2d + 1) K T/2 + T Σ |g_i|/(1 − |p_i|)        f_c ≥ (K + Σ |g_i| n_i) Δ/2

with n = 2 for p ≥ 0 and 2/(1 − |p|) for p < 0.  The proofs are in the documentation.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from flint import fmpq, fmpq_poly, fmpz_poly

from zwidth.model.environment.environment import Environment
from zwidth.passivity.linear.loop import LinearLoop
from zwidth.passivity.linear.roots import rational_roots_inside
from zwidth.quantity.balls import as_fmpq, as_fraction

MOST_PARTS = 60


@dataclass(frozen=True)
class Part:
    """g (1 − ζ)/(1 − p ζ): answers a step with g at once and forgets it as pᵏ."""

    pole: Fraction
    stiffness: Fraction

    @property
    def relaxes(self) -> bool:
        """True where the force only falls after a step inward, g > 0 and 0 ≤ p < 1."""
        return self.stiffness > 0 and 0 <= self.pole < 1

    @property
    def gain(self) -> Fraction:
        """Σ|g pᵏ|."""
        return abs(self.stiffness) / (1 - abs(self.pole))

    @property
    def variation(self) -> Fraction:
        """‖h‖₁."""
        return 2 * abs(self.stiffness) if self.pole >= 0 else 2 * self.gain


@dataclass(frozen=True)
class RelaxingLaw:
    """A spring and parts that relax, as the conditions for contact made and broken see them.

    Parameters
    ----------
    stiffness
        K ≥ 0 [N/m; N·m/rad].
    parts
        All that H(z) has besides.
    penetration
        True if fed with the penetration max(q, 0), False if with the position q.
    never_pulls
        True if a force below 0 is given as 0.
    """

    stiffness: Fraction
    parts: tuple[Part, ...]
    penetration: bool
    never_pulls: bool

    @property
    def fed_with(self) -> str:
        """What the law is fed with, in a word."""
        return "penetration" if self.penetration else "position"

    def only_relaxes(self, loop: LinearLoop) -> bool:
        """True where what is enough in sustained contact is enough."""
        parts = not self.never_pulls or len(self.parts) <= 1
        return self.penetration and parts and not loop.whole_delay and all(p.relaxes for p in self.parts)

    def required_damping(self, loop: LinearLoop) -> Fraction | None:
        """The device damping that covers contact made and broken; None with a delay of part of a sample."""
        if loop.part_delay or not loop.hidden_modes_decay:
            return None
        if self.only_relaxes(loop):
            shares = (p.stiffness / (1 + p.pole) for p in self.parts)
            return loop.period * (self.stiffness / 2 + sum(shares, Fraction(0)))
        hold = (2 * loop.whole_delay + 1) * self.stiffness / 2
        return loop.period * (hold + sum((p.gain for p in self.parts), Fraction(0)))

    def required_friction(self, resolution: Fraction, period: Fraction) -> Fraction:
        """The Coulomb friction that covers an encoder of resolution Δ [N; N·m]."""
        norm = self.stiffness + sum((p.variation for p in self.parts), Fraction(0))
        return norm * resolution / 2


def relaxing_law(environment: Environment, loop: LinearLoop) -> RelaxingLaw | None:
    """A one-sided law, if H(z) is a spring and parts with rational poles."""
    if not environment.unilateral:
        return None
    found = _parts(loop)
    static = loop.static_stiffness
    if found is None or static is None or static < 0:
        return None
    return RelaxingLaw(static, found, environment.surface == "penetration", environment.clamped)


def _parts(loop: LinearLoop) -> tuple[Part, ...] | None:
    """H − H(1) in partial fractions; None unless every pole is simple, rational and inside the circle."""
    bottom = fmpz_poly(list(loop.denominator))
    if not bottom.degree() <= MOST_PARTS or len(loop.numerator) > len(loop.denominator) + 1:
        return None
    poles = rational_roots_inside(fmpz_poly(bottom.coeffs()[::-1]))
    if len(poles) < bottom.degree():
        return None
    parts = [_part(loop, as_fmpq(pole)) for pole in poles]
    at_once = Fraction(loop.numerator[0], loop.denominator[0]) - (loop.static_stiffness or 0)
    rest = at_once - sum((part.stiffness for part in parts), Fraction(0))
    return (*parts, Part(Fraction(0), rest)) if rest else tuple(parts)


def _part(loop: LinearLoop, pole: fmpq) -> Part:
    """g from the residue g (p − 1)/p at ζ = 1/p."""
    others = fmpq_poly(list(loop.denominator)) // fmpq_poly([fmpq(1), -pole])
    residue = fmpq_poly(list(loop.numerator))(1 / pole) / others(1 / pole)
    stiffness = residue * pole / (pole - 1)
    return Part(*(as_fraction(c) for c in (pole, stiffness)))
