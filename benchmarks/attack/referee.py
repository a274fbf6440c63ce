"""The loop as it is programmed, and the linear criterion from its definition; nothing of zwidth is used.

    q_k = Δ (⌊x_k/Δ + φ⌋ or x_k),   f_k = Σ b_i u_{k−i} − Σ a_i f_{k−i}
    u = q                    where the law acts on both sides of the surface
    u = q,  f = 0 if q ≤ 0   where it is fed with the position
    u = max(q, 0),  the same where it is fed with the penetration
    at first it has read q_0 for ever
    taken out: −Σ f Δx − f_c Σ |Δx| − b Σ Δx²/t    over each time t with one force

Arb's balls enclose every number: what is said to be larger than 0 is larger than 0.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property, lru_cache
from math import pi
from typing import Literal

import numpy as np
from flint import acb, arb, ctx, fmpq

Fed = Literal["both", "position", "penetration"]

DIGITS = 600
"""Of the balls, to begin with."""


@dataclass(frozen=True)
class PlainLoop:
    """A law and a device as the referee sees them: numbers only.

    Parameters
    ----------
    numerator, denominator
        H(z) in ascending powers of 1/z, of equal length, denominator[0] = 1.
    fed
        What of the reading the law is given.
    clamped
        Whether a force below 0 is given as 0.
    damping, friction, period, resolution, delay
        b, f_c, T, Δ and the delay in SI units.
    """

    numerator: tuple[Fraction, ...]
    denominator: tuple[Fraction, ...]
    fed: Fed
    clamped: bool
    damping: Fraction
    friction: Fraction
    period: Fraction
    resolution: Fraction = Fraction(0)
    delay: Fraction = Fraction(0)

    @cached_property
    def whole(self) -> int:
        """Whole samples of delay."""
        return int(self.delay // self.period)

    @cached_property
    def part(self) -> Fraction:
        """The rest, as a part of a sample."""
        return self.delay / self.period - self.whole

    @cached_property
    def remembers(self) -> bool:
        """Whether the force depends on more than the last reading."""
        return any(self.numerator[1:]) or any(self.denominator[1:])

    @property
    def linear_inside(self) -> bool:
        """Whether H(z) says all about the law inside: a clamp does not touch a spring."""
        return not self.clamped or not self.remembers

    @cached_property
    def static(self) -> Fraction | None:
        """H(1); None with a pole there."""
        below = sum(self.denominator)
        return Fraction(sum(self.numerator)) / below if below else None

    @cached_property
    def stored(self) -> Fraction:
        """What the spring may hold at rest within the first count, H(1) Δ²/8 [J]; 0 for a spring wall."""
        if self.fed != "both" and not self.remembers:
            return Fraction(0)
        return max(self.static or Fraction(0), Fraction(0)) * self.resolution**2 / 8


@contextmanager
def digits_of(digits: int) -> Iterator[None]:
    """Reckon with so many digits."""
    before, ctx.dps = ctx.dps, digits
    try:
        yield
    finally:
        ctx.dps = before


def ball(value: Fraction) -> arb:
    """A rational as a ball, to no fewer than `DIGITS` digits."""
    return _ball(value.numerator, value.denominator, max(ctx.dps, DIGITS))


@lru_cache(maxsize=4096)
def _ball(numerator: int, denominator: int, digits: int) -> arb:
    with digits_of(digits):
        return arb(fmpq(numerator, denominator))


def differs(value: arb, told: Fraction) -> bool:
    """Whether more is told than came out, by 1e-30 of it, or less by 1e-15.

    Of a law that relaxes the game tells a bound from below.
    """
    with digits_of(DIGITS):
        beyond, size = value - ball(told), abs(ball(told))
        return bool(-beyond > size * ball(Fraction(1, 10**30)) or beyond > size * ball(Fraction(1, 10**15)))


def energies(
    loop: PlainLoop,
    positions: Sequence[Fraction],
    switches: Sequence[Fraction] | None = None,
    phase: Fraction = Fraction(0),
    digits: int = DIGITS,
) -> list[arb]:
    """What was taken out up to each sample [J]; without `switches` the hand does its best inside samples."""
    with digits_of(digits):
        return _energies(loop, positions, switches, phase)


def _energies(
    loop: PlainLoop, positions: Sequence[Fraction], switches: Sequence[Fraction] | None, phase: Fraction
) -> list[arb]:
    b, fc, period = ball(loop.damping), ball(loop.friction), ball(loop.period)
    whole, part = loop.whole, loop.part
    x = [_rational(v) for v in positions]
    first, second = b / (period * ball(part or Fraction(1))), b / (period * ball(1 - part))
    commands = [arb(0)] * (whole + 1) + _commands(loop, x, _rational(phase))
    out, total = [arb(0)], arb(0)
    for k in range(len(x) - 1):
        early, late = commands[k], commands[k + 1]
        legs = [(late, x[k + 1] - x[k], second)]
        if part:
            if switches:
                here = _rational(switches[k])
            else:
                here = _best_switch(loop, x[k], x[k + 1], float(early), float(late))
            legs = [(early, here - x[k], first), (late, x[k + 1] - here, second)]
        for force, moved, drag in legs:
            step = arb(moved)
            total = total - force * step - fc * abs(step) - drag * step * step
        out.append(total)
    return out


def _rational(value: Fraction) -> fmpq:
    return fmpq(value.numerator, value.denominator)


def _commands(loop: PlainLoop, x: Sequence[fmpq], phase: fmpq) -> list[arb]:
    """f of every reading, before it is late."""
    num = [(i, ball(c)) for i, c in enumerate(loop.numerator) if c]
    den = [(i, ball(c)) for i, c in enumerate(loop.denominator) if c and i]
    count, static = _rational(loop.resolution), _rational(loop.static or Fraction(0))
    given: list[arb] = []
    first: fmpq | None = None
    linear: list[arb] = []
    out: list[arb] = []
    for here in x:
        q = count * ((here / count + phase).floor() + phase) if count else here
        u = max(q, fmpq(0)) if loop.fed == "penetration" else q
        first = u if first is None else first  # where the law has been at rest for ever
        given.append(arb(u - first))
        force = arb(0)
        for i, c in num:
            if i < len(given):
                force += c * given[-1 - i]
        for i, c in den:
            if i < len(given):
                force -= c * linear[-i]
        linear.append(force)
        force = force + arb(static * first)
        if loop.fed != "both" and q <= 0:
            force = arb(0)
        if loop.clamped:
            force = force.max(arb(0))
        out.append(force)
    return out


def _best_switch(loop: PlainLoop, here: fmpq, there: fmpq, early: float, late: float) -> fmpq:
    """Where the hand is best when the force changes within a sample, to rounding."""
    part, b, fc = float(loop.part), float(loop.damping), float(loop.friction)
    moved, drag = float(arb(there - here)), b / float(loop.period)
    lean = part * (1 - part) / (2 * drag) if drag else 0.0
    tries = [0.0, moved, *(part * moved - lean * (early - late + s) for s in (0.0, 2 * fc, -2 * fc))]

    def cost(u: float) -> float:
        v = moved - u
        return early * u + late * v + fc * (abs(u) + abs(v)) + drag * (u * u / part + v * v / (1 - part))

    return here + _rational(Fraction(min(tries, key=cost)))


def needed_at(loop: PlainLoop, angle: float, digits: int = 80) -> arb:
    """The damping that the linear criterion asks for at ωT = angle, enclosed [N·s/m].

    ½ [A + √(A² + T² α(1−α) |H|²)],  A = (T/2) Re{(1 − 1/z) z⁻ᵈ (1 − α + α/z) H}/(1 − cos θ).
    """
    with digits_of(digits):
        theta = arb(angle)
        late = acb(0, -theta).exp()
        h = _value(loop.numerator, late) / _value(loop.denominator, late)
        part, period = ball(loop.part), ball(loop.period)
        mixed = (1 - late) * late**loop.whole * (1 - part + part * late) * h
        a = period / 2 * mixed.real / (1 - theta.cos())
        if not loop.part:
            return a
        return (a + (a * a + period**2 * part * (1 - part) * abs(h) ** 2).sqrt()) / 2


def _value(coefficients: Sequence[Fraction], at: acb) -> acb:
    total = acb(0)
    for c in reversed(coefficients):
        total = total * at + ball(c)
    return total


def violated(loop: PlainLoop, angle: float) -> bool:
    """Whether the criterion asks for more than b at or near this angle, towards 0, or at the Nyquist rate."""
    b = ball(loop.damping)
    for at in (angle, *(10.0**-k for k in (2, 4, 6, 9, 12, 15)), pi):
        if needed_at(loop, at) > b:
            return True
    low, high = angle * (1 - 1e-5), min(angle * (1 + 1e-5), pi)
    for _ in range(30):
        third = (high - low) / 3
        left, right = needed_at(loop, low + third), needed_at(loop, high - third)
        if left > b or right > b:
            return True
        low, high = (low + third, high) if right > left else (low, high - third)
    return False


def needed(loop: PlainLoop) -> tuple[float, float]:
    """(the largest damping that the criterion asks for, the angle ωT where), to rounding."""
    return _needed(replace(loop, damping=Fraction(0), friction=Fraction(0), resolution=Fraction(0)))


_GRID = np.concatenate([np.linspace(0, pi, 401)[1:], np.geomspace(1e-6, 1e-2, 60)])
_WIDTH = np.array([0.0, *(s * w for w in np.geomspace(0.05, 20, 12) for s in (1, -1))])
"""Angles at which every law is looked at, and around each root, in distances of it from the circle."""


@lru_cache(maxsize=8)
def _needed(loop: PlainLoop) -> tuple[float, float]:
    """What a law asks for, whatever the device has."""
    theta = _GRID
    roots = np.roots([float(c) for c in loop.denominator]) if len(loop.denominator) > 1 else np.zeros(0)
    near = [abs(np.angle(p)) + abs(1 - abs(p)) * _WIDTH for p in roots if p.imag >= 0 and abs(p) > 0.5]
    theta = np.concatenate([theta, *near]) if near else theta
    theta = np.unique(theta[(theta > 0) & (theta <= pi)])
    values = _needs(loop, theta)
    tops = np.argsort(values)[-4:]
    low, high = theta[np.maximum(tops - 1, 0)], theta[np.minimum(tops + 1, theta.size - 1)]
    rows = np.arange(tops.size)
    for _ in range(6):
        fine = np.linspace(low, high, 41, axis=1)
        asked = _needs(loop, fine)
        at = np.argmax(asked, axis=1)
        low, high = fine[rows, np.maximum(at - 1, 0)], fine[rows, np.minimum(at + 1, 40)]
    top = max(rows, key=lambda k: asked[k, at[k]])
    return float(asked[top, at[top]]), float(fine[top, at[top]])


def _needs(loop: PlainLoop, theta: np.ndarray) -> np.ndarray:
    """(1 − 1/z)/(1 − cos θ) is j e^{−jθ/2}/sin(θ/2), which does not cancel at small θ."""
    late = np.exp(-1j * theta)
    num, den = ([float(c) for c in reversed(side)] for side in (loop.numerator, loop.denominator))
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        h = np.polyval(num, late) / np.polyval(den, late)
        part, period = float(loop.part), float(loop.period)
        mixed = late**loop.whole * (1 - part + part * late) * h
        a = -period / 2 * np.imag(np.exp(-0.5j * theta) * mixed) / np.sin(theta / 2)
        if part:
            a = (a + np.sqrt(a * a + period**2 * part * (1 - part) * abs(h) ** 2)) / 2
    return np.where(np.isfinite(a), a, -np.inf)


def largest_pole(loop: PlainLoop) -> float:
    """|p| of the largest pole of H(z), to rounding."""
    if len(loop.denominator) < 2:
        return 0.0
    return float(max(abs(np.roots([float(c) for c in loop.denominator])), default=0.0))
