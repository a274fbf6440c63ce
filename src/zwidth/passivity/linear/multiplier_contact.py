"""Laws fed with the position, touched and left at will: a multiplier that covers every motion.

    H = K + (1 − ζ) G,  K = H(1) ≥ 0,  H stable, the force d whole samples late

Inside the force is K q + y, y = G Δq, outside it is 0, and a clamp makes it K q: with a law of any
kind between, it is K max(q, 0) + θ y, 0 ≤ θ ≤ 1.  For one λ > 0

    b ≥ (2d + 1) K T/2 + (T/4λ) max |1 − λ ζ^{d+1} G|²        f_c ≥ (K + ‖H − K‖₁) Δ/2

on the circle, cover contact made and broken.  The proof is in the documentation.
"""

from __future__ import annotations

from cmath import exp
from collections.abc import Callable
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property, lru_cache
from itertools import accumulate
from math import gcd, pi, sqrt
from typing import NamedTuple

from flint import fmpq

from zwidth.model.environment.environment import Environment
from zwidth.passivity.linear.cosines import real_product
from zwidth.passivity.linear.loop import LinearLoop
from zwidth.passivity.linear.one_norm import NormBound, bound_one_norm
from zwidth.passivity.linear.positivity import Positivity, TooClose, prove_nonnegative
from zwidth.passivity.linear.schur import is_schur

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
    """A one-sided law as the multiplier sees it; `never_pulls` if it is clamped.

    Parameters
    ----------
    stiffness
        K = H(1) [N/m; N·m/rad].
    rest
        H − K, without damping.
    """

    stiffness: Fraction
    rest: LinearLoop
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
