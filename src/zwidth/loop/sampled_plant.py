"""Device and hand behind the hold, sampled exactly.

    M ẍ + D ẋ + k x = −f,    M = m + m_h,  D = b + c

In periods and scaled speeds, s = (x, ẋ T), with η = k T²/M, δ = D T/M, g = T²/M:

    e^{A τ} of A = [[0, 1, 0], [−η, −δ, 1], [0, 0, 0]]  holds  Φ(τ) and Γ(τ)
    s(n+1) = Φ(1) s(n) − g [Γ(1−α) f(n−d) + Φ(1−α) Γ(α) f(n−d−1)]

for a delay (d + α) T.  Polynomials are in ζ = z − 1, where those of slow motions do not cancel:

    det(zI − Φ) = ζ² + (2ηΓ₁ + δΓ₂) ζ + η n(Γ),   C adj(zI − Φ) γ = γ₁ ζ + n(γ)
    n(γ) = (ηΓ₁ + δΓ₂) γ₁ + Γ₂ γ₂

Without spring and damper all is rational; otherwise every number is a ball that holds the true
one (python-flint), also where the parameters are intervals.
"""

from __future__ import annotations

from fractions import Fraction
from itertools import product
from math import floor
from typing import Any, NamedTuple

import flint

from zwidth.quantity import balls
from zwidth.quantity.glossary import GLOSSARY
from zwidth.quantity.text import exact_text

Number = Any
"""A Fraction or a `flint.arb`."""

Coefficients = list[Number]
"""Of a polynomial in ζ = z − 1, descending powers."""

Range = tuple[Fraction, Fraction]
"""Smallest and largest value of a parameter, ends included."""


class Motion(NamedTuple):
    """What moves: mass M, damping D, stiffness k, and the clock, T and the delay [s]."""

    mass: Range
    damping: Range
    stiffness: Range
    period: Fraction
    delay: Fraction

    @property
    def is_certain(self) -> bool:
        """True when none of the three is an interval."""
        return all(low == high for low, high in self[:3])

    def grid(self, on_a_side: int) -> list[Motion]:
        """Certain motions at equal distances along the sides of the box; of 2 its corners."""
        last = on_a_side - 1
        sides = [
            dict.fromkeys(low + (high - low) * i / last for i in range(on_a_side)) for low, high in self[:3]
        ]
        return [Motion((m, m), (d, d), (k, k), *self[3:]) for m, d, k in product(*sides)]

    def told(self, units: str) -> dict[str, str | list[str]]:
        """Mass, damping and stiffness as a document has them, exact: a number, or both ends."""
        names = ("mass", "damping", "stiffness")
        both = [[exact_text(end) for end in ends] for ends in self[:3]]
        return {
            GLOSSARY[name].key_for(units): low if low == high else [low, high]
            for name, (low, high) in zip(names, both, strict=True)
        }


class SampledPlant(NamedTuple):
    """−force → position: ``numerator / (z^late · denominator)``, polynomials in ζ."""

    numerator: Coefficients
    denominator: Coefficients
    late: int


def sampled(motion: Motion) -> SampledPlant:
    """The exact zero-order hold of the plant, in balls at the current precision of flint."""
    late = floor(motion.delay / motion.period)
    part = motion.delay / motion.period - late
    eta, delta, gain = _scaled(motion)
    whole = _flow(eta, delta, Fraction(1))

    def row(first: Number, second: Number) -> Coefficients:
        slow = (eta * whole.first + delta * whole.second) * first + whole.second * second
        return [gain * first, gain * slow]

    constant = eta * (eta * whole.first**2 + delta * whole.first * whole.second + whole.second**2)
    denominator = [one_like(eta), 2 * eta * whole.first + delta * whole.second, constant]
    if part == 0:
        return SampledPlant(row(whole.first, whole.second), denominator, late)
    rest, start = _flow(eta, delta, 1 - part), _flow(eta, delta, part)
    now = row(rest.first, rest.second)
    old = row(*rest.moved(eta, delta, start))
    return SampledPlant(plus(times(now, [one_like(eta)] * 2), old), denominator, late + 1)


def _scaled(motion: Motion) -> tuple[Number, Number, Number]:
    """η, δ and g."""
    square = motion.period**2
    if motion.is_certain and motion.damping[0] == 0 and motion.stiffness[0] == 0:
        return Fraction(0), Fraction(0), square / motion.mass[0]
    mass = ball(motion.mass)
    return tuple(
        top / mass
        for top in (
            ball(motion.stiffness) * ball(square),
            ball(motion.damping) * ball(motion.period),
            ball(square),
        )
    )


class _Flow(NamedTuple):
    """Γ(τ), from which Φ(τ) follows."""

    first: Number
    second: Number

    def moved(self, eta: Number, delta: Number, state: _Flow) -> tuple[Number, Number]:
        """Φ(τ) times a state."""
        return (
            (1 - eta * self.first) * state.first + self.second * state.second,
            -eta * self.second * state.first + (1 - eta * self.first - delta * self.second) * state.second,
        )


def _flow(eta: Number, delta: Number, periods: Fraction) -> _Flow:
    """Γ after so many periods."""
    if isinstance(eta, Fraction):
        return _Flow(periods**2 / 2, periods)
    t = ball(periods)
    flow = flint.arb_mat([[0, t, 0], [-eta * t, -delta * t, t], [0, 0, 0]]).exp()
    return _Flow(flow[0, 2], flow[1, 2])


def ball(value: Fraction | Range) -> Number:
    """A ball that holds a number, or every number between two."""
    if isinstance(value, tuple):
        low, high = value
        return ball(low) if low == high else ball(low).union(ball(high))
    return balls.ball(value)


def one_like(value: Number) -> Number:
    """1, as a ball beside balls and a Fraction beside Fractions."""
    return flint.arb(1) if isinstance(value, flint.arb) else Fraction(1)


def times(a: Coefficients, b: Coefficients) -> Coefficients:
    """The product of two polynomials."""
    return [
        sum((a[i] * b[n - i] for i in range(max(0, n - len(b) + 1), min(len(a), n + 1))), 0 * a[0] * b[0])
        for n in range(len(a) + len(b) - 1)
    ]


def plus(a: Coefficients, b: Coefficients) -> Coefficients:
    """The sum of two polynomials."""
    if len(a) < len(b):
        a, b = b, a
    ahead = len(a) - len(b)
    return [*a[:ahead], *(x + y for x, y in zip(a[ahead:], b, strict=True))]
