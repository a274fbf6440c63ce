"""Laws touched and left at will: what covers every motion.  The proofs are in the documentation.

Walls with virtual damping:

    b ≥ (2d + 1) K T/2 + |B| Σ|w_j|          f_c ≥ (K + |B| ‖h_v‖₁) Δ/2

for the force K max(q, 0) + r of the measured position q, applied d samples later, with any |r| ≤ |B| |v|,
v(k) = Σ w_j (q(k−j) − q(k−j−1))/T.  That is the wall that acts inside only, r = B v there, and the clamped
wall max(0, K q + B v); h_v is the impulse response from q to v.  Applied d + α samples later, 0 < α < 1,

    b (b − Q) ≥ α(1 − α) (K T + 2 |B| Σ|w_j|)²/4,    Q = (2d + 1 + 2α) K T/2 + |B| Σ|w_j| ≤ b

in the place of the first.
"""

from __future__ import annotations

from cmath import exp
from collections.abc import Callable
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property, lru_cache
from itertools import accumulate
from math import gcd, isqrt, pi, sqrt
from typing import NamedTuple

from flint import fmpq, fmpq_poly, fmpz_poly

from zwidth.model.environment.environment import Average, Decay, Environment
from zwidth.passivity.linear.exact_algebra import is_schur, rational_roots_inside, real_product
from zwidth.passivity.linear.loop import LinearLoop
from zwidth.passivity.linear.one_norm import NormBound, bound_one_norm
from zwidth.passivity.linear.positivity import Positivity, TooClose, prove_nonnegative
from zwidth.quantity.balls import as_fmpq, as_fraction

_FINE = 10**12  # a root is taken to so many parts of itself, from above


@dataclass(frozen=True)
class DampedWall:
    """A wall as the two conditions see it: K ≥ 0, B and the weights of its velocity estimate."""

    # K [N/m; N·m/rad] and B [N·s/m; N·m·s/rad]
    stiffness: Fraction
    damping: Fraction
    estimate: Average | Decay  # how v is made of the last moves

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

    `loop`: whose delay and period count; `stiffness`: K ≥ 0 [N/m; N·m/rad]; `asked`: |B| Σ|w_j|
    [N·s/m; N·m·s/rad].
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


# Laws that relax:
#     H = K + Σ g_i (1 − ζ)/(1 − p_i ζ),     ζ = 1/z,  K ≥ 0,  |p_i| < 1
#
# Fed with the penetration, without delay, every g_i > 0 and 0 ≤ p_i < 1, and if the law
# never pulls one part at most:
#
#     b ≥ K T/2 + Σ g_i T/(1 + p_i)                    f_c ≥ (K + 2 Σ g_i) Δ/2
#
# which is what sustained contact asks for.  However it is fed, d samples late, clamped or not:
#
#     b ≥ (2d + 1) K T/2 + T Σ |g_i|/(1 − |p_i|)        f_c ≥ (K + Σ |g_i| n_i) Δ/2
#
# with n = 2 for p ≥ 0 and 2/(1 − |p|) for p < 0.


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
    """A spring and parts that relax, as the conditions for contact made and broken see them."""

    stiffness: Fraction  # K ≥ 0 [N/m; N·m/rad]
    parts: tuple[Part, ...]  # all that H(z) has besides
    penetration: bool  # True if fed with the penetration max(q, 0), False if with the position q
    never_pulls: bool  # True if a force below 0 is given as 0

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


# Laws fed with the position, covered by a multiplier:
#     H = K + (1 − ζ) G,  K = H(1) ≥ 0,  H stable, the force d whole samples late
#
# Inside the force is K q + y, y = G Δq, outside it is 0, and a clamp makes it K q: with a law of any
# kind between, it is K max(q, 0) + θ y, 0 ≤ θ ≤ 1.  For one λ > 0
#
#     b ≥ (2d + 1) K T/2 + (T/4λ) max |1 − λ ζ^{d+1} G|²        f_c ≥ (K + ‖H − K‖₁) Δ/2
#
# on the circle, cover contact made and broken.


_POINTS = 256
_GOLDEN = (sqrt(5) - 1) / 2
_SLACKS = (Fraction(0), Fraction(1, 10**9), Fraction(1, 10**6), Fraction(1, 10**4), Fraction(1, 100))
"""By how much the maximum is raised, of itself, until its sign is certain."""


class Choice(NamedTuple):
    """λ [m/N] and κ [N/m] with 4 λ κ ≥ |1 − λ ζ^{d+1} G|² on the circle, κ near its least."""

    multiplier: Fraction
    level: Fraction


@dataclass(frozen=True)
class Memory:
    """G = moved/bottom, ascending in ζ, `late` samples late: what a wall has besides its spring."""

    moved: tuple[int, ...]
    bottom: tuple[int, ...]
    late: int

    def proof(self, multiplier: Fraction, level: Fraction) -> Positivity | None:
        """4 λ κ |D|² − |D − λ ζ^{d+1} N_G|² ≥ 0, with what proves its sign."""
        d = [c * multiplier.denominator for c in self.bottom]
        moved = [*[0] * (self.late + 1), *(c * multiplier.numerator for c in self.moved)]
        size = max(len(d), len(moved))
        left = [x - y for x, y in zip(*([*c, *[0] * (size - len(c))] for c in (d, moved)), strict=True)]
        share = 4 * multiplier * level
        total = fmpq(share.numerator, share.denominator) * real_product(d, d) - real_product(left, left)
        try:
            found = prove_nonnegative(total.numer())
        except TooClose:
            return None
        return None if isinstance(found, Fraction) else found

    def choice(self) -> Choice | None:
        """λ and κ; None where no κ near the least that was found is proved."""
        exact = self._one_pole()
        if exact is not None and self.proof(*exact) is not None:
            return exact
        curve = list[tuple[float, float]]()
        for a, b in sorted((2 * g.real, abs(g) ** 2) for g in self._curve()):
            if not curve or b > curve[-1][1]:  # another with less a and more b is above it for every λ > 0
                curve.append((a, b))

        def level(multiplier: float) -> float:
            return max(1 - multiplier * a + multiplier**2 * b for a, b in curve) / (4 * multiplier)

        size = max(b for _, b in curve) ** 0.5
        power = _lowest(lambda e: level(2.0**e / size), -6.0, 6.0)
        best = Fraction(f"{2.0**power / size:.9e}")
        for slack in _SLACKS:
            tried = Choice(best, Fraction(f"{level(float(best)):.12e}") * (1 + slack))
            if self.proof(*tried) is not None:
                return tried
        return None

    def _one_pole(self) -> Choice | None:
        """λ = (1 + p)/g, κ = g/(1 + p) up to p = 1/2; then λ = (1 − p²)/(p g), κ = g/(4p (1 − p²))."""
        if len(self.bottom) > 2 or len(self.moved) > 1 or self.late or self.moved[0] <= 0:
            return None
        pole = Fraction(-self.bottom[1], self.bottom[0]) if len(self.bottom) == 2 else Fraction(0)
        g = Fraction(self.moved[0], self.bottom[0])
        if pole <= Fraction(1, 2):
            return Choice((1 + pole) / g, g / (1 + pole))
        return Choice((1 - pole**2) / (pole * g), g / (4 * pole * (1 - pole**2)))

    def _curve(self) -> list[complex]:
        """ζ^{d+1} G on the upper half of the circle."""
        points = (exp(-1j * pi * k / _POINTS) for k in range(_POINTS + 1))
        return [z ** (self.late + 1) * _at(self.moved, z) / _at(self.bottom, z) for z in points]


_choice = lru_cache(maxsize=256)(Memory.choice)


@dataclass(frozen=True)
class MultiplierLaw:
    """A one-sided law as the multiplier sees it; `never_pulls` if it is clamped."""

    stiffness: Fraction  # K = H(1) [N/m; N·m/rad]
    rest: LinearLoop  # H − K, without damping
    never_pulls: bool

    @cached_property
    def memory(self) -> Memory:
        """G = (H − K)/(1 − ζ): the running sums of its numerator."""
        size = max(len(self.rest.numerator), len(self.rest.denominator))
        moved = list(accumulate((*self.rest.numerator, *[0] * (size - len(self.rest.numerator)))))[:-1]
        while len(moved) > 1 and moved[-1] == 0:
            moved.pop()
        content = gcd(*moved, *self.rest.denominator)
        bottom = tuple(c // content for c in self.rest.denominator)
        return Memory(tuple(c // content for c in moved), bottom, self.rest.whole_delay)

    @property
    def choice(self) -> Choice | None:
        """The multiplier and what it asks for, the same for every K and b."""
        return _choice(self.memory)

    @cached_property
    def norm(self) -> NormBound | None:
        """The bound on ‖H − K‖₁."""
        return bound_one_norm(self.rest)

    def required_damping(self, loop: LinearLoop) -> Fraction | None:
        """The device damping that covers contact made and broken; None where no multiplier is found."""
        if self.choice is None:
            return None
        return loop.period * ((2 * loop.whole_delay + 1) * self.stiffness / 2 + self.choice.level)

    def left(self, loop: LinearLoop) -> Fraction:
        """κ that a device has [N/m]: b/T less what the spring takes."""
        return loop.damping / loop.period - (2 * loop.whole_delay + 1) * self.stiffness / 2

    def required_friction(self, resolution: Fraction, period: Fraction) -> Fraction | None:
        """The Coulomb friction that covers an encoder of resolution Δ [N; N·m]."""
        if resolution == 0:
            return Fraction(0)
        return None if self.norm is None else (self.stiffness + self.norm.bound) * resolution / 2


def multiplier_law(environment: Environment, loop: LinearLoop) -> MultiplierLaw | None:
    """A law fed with the position, if it is stable, with memory, and its delay one of whole samples."""
    static = loop.static_stiffness
    if environment.surface != "position" or static is None or static < 0 or loop.part_delay:
        return None
    memory = len(loop.numerator) + len(loop.denominator) > 2
    if not (memory and loop.hidden_modes_decay and is_schur(loop.denominator[::-1])):
        return None
    size = max(len(loop.numerator), len(loop.denominator))
    n, d = ((*c, *[0] * (size - len(c))) for c in (loop.numerator, loop.denominator))
    scale = static.denominator
    rest = tuple(int((x - static * y) * scale) for x, y in zip(n, d, strict=True))
    if not any(rest):
        return None
    bottom = tuple(c * scale for c in loop.denominator)
    moved = replace(loop, numerator=rest, denominator=bottom, damping=Fraction(0))
    return MultiplierLaw(static, moved, environment.clamped)


def _at(polynomial: tuple[int, ...], z: complex) -> complex:
    value = 0j
    for c in reversed(polynomial):
        value = value * z + c
    return value


def _lowest(f: Callable[[float], float], low: float, high: float) -> float:
    """Where a function with one valley is least."""
    left, right = high - _GOLDEN * (high - low), low + _GOLDEN * (high - low)
    at_left, at_right = f(left), f(right)
    for _ in range(36):
        if at_left < at_right:
            high, right, at_right = right, left, at_left
            left = high - _GOLDEN * (high - low)
            at_left = f(left)
        else:
            low, left, at_left = left, right, at_right
            right = low + _GOLDEN * (high - low)
            at_right = f(right)
    return (low + high) / 2
