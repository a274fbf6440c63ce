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
from functools import cached_property
from math import pi, sqrt

from flint import fmpq, fmpz_poly

from zwidth.environment import Wall
from zwidth.environment.environment import Environment
from zwidth.passivity.cosines import real_product
from zwidth.passivity.loop import LinearLoop
from zwidth.passivity.one_norm import NormBound, bound_one_norm
from zwidth.passivity.positivity import Positivity, prove_nonnegative
from zwidth.passivity.schur import is_schur

_POINTS = 400
_GOLDEN = (sqrt(5) - 1) / 2
_SLACKS = (Fraction(0), Fraction(1, 10**9), Fraction(1, 10**6), Fraction(1, 10**4), Fraction(1, 100))
"""By how much the maximum is raised, of itself, until its sign is certain."""


@dataclass(frozen=True)
class MultiplierLaw:
    """A one-sided law as the multiplier sees it; `loop` of any damping, `never_pulls` if it is clamped."""

    loop: LinearLoop
    never_pulls: bool

    @cached_property
    def stiffness(self) -> Fraction:
        """K = H(1) [N/m; N·m/rad]."""
        return self.loop.static_stiffness or Fraction(0)

    @cached_property
    def moved(self) -> tuple[int, ...]:
        """N_G, G = N_G/D, ascending in ζ: the running sums of N − K D, times `scale`."""
        running, sums = Fraction(0), []
        for value in self._rest[:-1]:
            running += value
            sums.append(running)
        return tuple(int(v * self.scale) for v in sums) or (0,)

    @property
    def scale(self) -> int:
        """Makes N − K D whole."""
        return self.stiffness.denominator

    @cached_property
    def _rest(self) -> tuple[Fraction, ...]:
        """N − K D."""
        n, d = self.loop.numerator, self.loop.denominator
        size = max(len(n), len(d))
        n, d = ((*c, *[0] * (size - len(c))) for c in (n, d))
        return tuple(x - self.stiffness * y for x, y in zip(n, d, strict=True))

    @cached_property
    def choice(self) -> tuple[Fraction, Fraction] | None:
        """(λ [m/N], κ [N/m]): 4 λ κ ≥ |1 − λ ζ^{d+1} G|² on the circle, κ near its least; None where none is."""
        if not any(self.moved):
            return None
        largest = self._largest()
        size = max(abs(g) for g in self._curve())
        guess = 2.0 ** _lowest(lambda power: largest(2.0**power / size) / 2.0**power, -6.0, 6.0) / size
        for multiplier in (*self._simple(), Fraction(f"{guess:.9e}")):
            level = Fraction(f"{largest(float(multiplier)):.15e}") / (4 * multiplier)
            if abs(largest(float(multiplier)) / float(multiplier) * guess / largest(guess) - 1) > 1e-6:
                continue
            for slack in _SLACKS:
                tried = (self._exact_level(multiplier) or level) if slack == 0 else level * (1 + slack)
                if self.proof(multiplier, tried) is not None:
                    return multiplier, tried
        return None

    def _simple(self) -> tuple[Fraction, ...]:
        """The best λ of one pole in closed form: (1 − p²)/(p g), or (1 + p)/g for p ≤ 1/2."""
        d, moved = self.loop.denominator, self.moved
        if len(d) > 2 or any(moved[1:]) or self.loop.whole_delay or moved[0] <= 0:
            return ()
        pole = Fraction(-d[1], d[0]) if len(d) == 2 else Fraction(0)
        g = Fraction(moved[0], d[0] * self.scale)
        return ((1 + pole) / g if pole <= Fraction(1, 2) else (1 - pole**2) / (pole * g),)

    def _exact_level(self, multiplier: Fraction) -> Fraction | None:
        """max |1 − λ ζ^{d+1} G|²/4λ where it is reached at ζ = −1, as for one pole."""
        sign = -1 if self.loop.whole_delay % 2 == 0 else 1
        top = sum(c * (-1) ** i for i, c in enumerate(self.moved))
        bottom = sum(c * (-1) ** i for i, c in enumerate(self.loop.denominator)) * self.scale
        return (1 - sign * multiplier * Fraction(top, bottom)) ** 2 / (4 * multiplier)

    def proof(self, multiplier: Fraction, level: Fraction) -> Positivity | None:
        """4 λ κ |D|² − |D − λ ζ^{d+1} N_G|² ≥ 0, with what proves its sign."""
        d = [c * multiplier.denominator * self.scale for c in self.loop.denominator]
        late = [0] * (self.loop.whole_delay + 1)
        moved = [*late, *(c * multiplier.numerator for c in self.moved)]
        size = max(len(d), len(moved))
        left = [x - y for x, y in zip(*([*c, *[0] * (size - len(c))] for c in (d, moved)), strict=True)]
        share = 4 * multiplier * level
        total = fmpq(share.numerator, share.denominator) * real_product(d, d) - real_product(left, left)
        polynomial: fmpz_poly = total.numer()
        found = prove_nonnegative(polynomial)
        return None if isinstance(found, Fraction) else found

    @cached_property
    def norm(self) -> NormBound | None:
        """The bound on ‖H − K‖₁."""
        rest = tuple(int(v * self.scale) for v in self._rest)
        denominator = tuple(c * self.scale for c in self.loop.denominator)
        return bound_one_norm(replace(self.loop, numerator=rest, denominator=denominator))

    def required_damping(self, loop: LinearLoop) -> Fraction | None:
        """The device damping that covers contact made and broken; None where no multiplier is found."""
        if self.choice is None:
            return None
        return loop.period * ((2 * loop.whole_delay + 1) * self.stiffness / 2 + self.choice[1])

    def left(self, loop: LinearLoop) -> Fraction:
        """κ that a device has [N/m]: b/T less what the spring takes."""
        return loop.damping / loop.period - (2 * loop.whole_delay + 1) * self.stiffness / 2

    def required_friction(self, resolution: Fraction, period: Fraction) -> Fraction | None:
        """The Coulomb friction that covers an encoder of resolution Δ [N; N·m]."""
        if resolution == 0:
            return Fraction(0)
        return None if self.norm is None else (self.stiffness + self.norm.bound) * resolution / 2

    @cached_property
    def _points(self) -> list[complex]:
        return [exp(-1j * pi * k / _POINTS) for k in range(_POINTS + 1)]

    def _curve(self) -> list[complex]:
        """ζ^{d+1} G on the upper half of the circle."""
        scale, late = self.scale, self.loop.whole_delay + 1
        top, bottom = self.moved, self.loop.denominator
        return [z**late * _at(top, z) / _at(bottom, z) / scale for z in self._points]

    def _largest(self) -> Callable[[float], float]:
        curve = [(2 * g.real, abs(g) ** 2) for g in self._curve()]
        return lambda power: max(1 - power * a + power * power * b for a, b in curve)


def multiplier_law(environment: Environment, loop: LinearLoop) -> MultiplierLaw | None:
    """A wall, if it is stable, with memory, and its delay one of whole samples."""
    static = loop.static_stiffness
    if not isinstance(environment, Wall) or static is None or static < 0 or loop.part_delay:
        return None
    memory = len(loop.numerator) + len(loop.denominator) > 2
    if not (memory and loop.hidden_modes_decay and is_schur(loop.denominator[::-1])):
        return None
    return MultiplierLaw(replace(loop, damping=Fraction(0)), environment.clamped)


def _at(polynomial: tuple[int, ...], z: complex) -> complex:
    value = 0j
    for c in reversed(polynomial):
        value = value * z + c
    return value


def _lowest(f: Callable[[float], float], low: float, high: float) -> float:
    """Where a function with one valley is least."""
    left, right = high - _GOLDEN * (high - low), low + _GOLDEN * (high - low)
    at_left, at_right = f(left), f(right)
    for _ in range(60):
        if at_left < at_right:
            high, right, at_right = right, left, at_left
            left = high - _GOLDEN * (high - low)
            at_left = f(left)
        else:
            low, left, at_left = left, right, at_right
            right = low + _GOLDEN * (high - low)
            at_right = f(right)
    return (low + high) / 2
