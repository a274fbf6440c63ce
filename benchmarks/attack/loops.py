"""Random loops near their limits, once for the package and once, by formulas of its own, for the referee.

Numbers have few digits, as a person types them, over decades of scale; damping and Coulomb
friction are within 1e-9 to 0.3 of what one of the conditions asks for, or anywhere.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from fractions import Fraction
from math import pi
from typing import Any

import numpy as np

import zwidth as zw

from .referee import PlainLoop, needed

Rng = np.random.Generator
Polynomial = list[Fraction]


@dataclass(frozen=True)
class Case:
    """A loop as the package gets it and as the referee sees it.

    Parameters
    ----------
    points
        Loops within the intervals of device and law; empty where there are no intervals.
    full
        True to let the package play its game.
    """

    kind: str
    device: zw.Device
    law: Any
    loop: PlainLoop
    points: tuple[tuple[zw.Device, Any], ...] = ()
    full: bool = False


def typed(value: float | Fraction, digits: int = 4) -> Fraction:
    """A number as a person types it."""
    return Fraction(f"{float(value):.{digits}g}")


def decades(rng: Rng, low: float, high: float) -> float:
    """Anything from 10^low to 10^high."""
    return float(10 ** rng.uniform(low, high))


def near(rng: Rng, value: Fraction | float) -> Fraction:
    """A number near another: off by 1e-9 to 0.3 of it, exactly it, or anywhere from 0 to thrice."""
    exact = Fraction(value) if isinstance(value, Fraction) else Fraction(repr(float(value)))
    way = rng.random()
    if way < 0.1:
        return exact
    if way < 0.25:
        return typed(float(exact) * 3 * rng.random())
    off = Fraction(f"{decades(rng, -9, -0.5):.3g}")
    return exact * (1 + off if rng.random() < 0.5 else 1 - off)


# -- laws -----------------------------------------------------------------------------------------------


def product(a: Polynomial, b: Polynomial) -> Polynomial:
    """a b, any order of powers."""
    out = [Fraction(0)] * (len(a) + len(b) - 1)
    for i, x in enumerate(a):
        for j, y in enumerate(b):
            out[i + j] += x * y
    return out


def total(a: Polynomial, b: Polynomial) -> Polynomial:
    """a + b in ascending powers."""
    size = max(len(a), len(b))
    padded = ([*p, *([Fraction(0)] * (size - len(p)))] for p in (a, b))
    return [x + y for x, y in zip(*padded, strict=True)]


def transfer(numerator: Polynomial, denominator: Polynomial) -> tuple[tuple[Fraction, ...], ...]:
    """Both sides of equal length, the first coefficient below 1."""
    size = max(len(numerator), len(denominator))
    n, d = ([*p, *([Fraction(0)] * (size - len(p)))] for p in (numerator, denominator))
    return tuple(c / d[0] for c in n), tuple(c / d[0] for c in d)


@dataclass(frozen=True)
class Drawn:
    """A law, its H(z) in ascending powers of 1/z, and what is enough with contact made and broken.

    Parameters
    ----------
    damping, friction
        Enough without delay: b, and f_c over Δ; None where nothing is known.
    spring
        The part of `damping` that a sample of delay asks for again, twice over.
    """

    law: Any
    fed: str
    numerator: tuple[Fraction, ...]
    denominator: tuple[Fraction, ...]
    damping: Fraction | None = None
    friction: Fraction | None = None
    spring: Fraction = Fraction(0)


def spring_wall(rng: Rng, period: Fraction) -> Drawn:
    """f = K x inside."""
    k = typed(decades(rng, 0, 4.5))
    half = k * period / 2
    one = transfer([k], [Fraction(1)])
    return Drawn(zw.Wall(k, clamped=bool(rng.random() < 0.2)), "position", *one, half, k / 2, half)


def damped_wall(rng: Rng, period: Fraction) -> Drawn:
    """A wall with virtual damping on one of the estimates of velocity, fed with the position."""
    k = Fraction(0) if rng.random() < 0.08 else typed(decades(rng, 0, 4))
    scale = float(k * period / 2) or decades(rng, -3, 0)
    b = typed(scale * decades(rng, -2, 2)) * (-1 if rng.random() < 0.12 else 1)
    weights, velocity, estimate = _velocity(rng, period)
    num, den = velocity  # of v over q
    law = zw.Wall(k, b, estimate, clamped=bool(rng.random() < 0.35))
    force = total(product([k], den), product([b], num))
    enough = k * period / 2 + abs(b) * weights[0]
    count = (k + abs(b) * weights[1] / period) / 2
    return Drawn(law, "position", *transfer(force, den), enough, count, k * period / 2)


def _velocity(
    rng: Rng, period: Fraction
) -> tuple[tuple[Fraction, Fraction], tuple[Polynomial, Polynomial], Any]:
    """((Σ|w|, T ‖h_v‖₁), v/q as (numerator, denominator), the estimator)."""
    one, way = Fraction(1), rng.random()
    if way < 0.2:
        return (one, Fraction(2)), ([1 / period, -1 / period], [one]), zw.rendering.BackwardDifference()
    if way < 0.35:
        n = int(rng.integers(2, 9))
        taps = [one, *[Fraction(0)] * (n - 1), -one]
        return (one, Fraction(2, n)), ([c / (n * period) for c in taps], [one]), zw.rendering.Window(n)
    if way < 0.85:
        tau = typed(float(period) * decades(rng, -2, 3))
        both = (one, 2 * period / (period + tau))
        return both, ([one, -one], [period + tau, -tau]), zw.rendering.OnePole(tau)
    taps = [typed(c, 2) for c in rng.normal(size=int(rng.integers(2, 4)))]
    difference = product(taps, [1 / period, -1 / period])
    steps = [taps[0], *(x - y for x, y in zip(taps[1:], taps, strict=False)), -taps[-1]]
    gains = sum(map(abs, taps), Fraction(0)), sum(map(abs, steps), Fraction(0))
    estimate = zw.rendering.VelocityFilter(taps, [1, *[0] * (len(taps) - 1)])
    return gains, (difference, [one]), estimate


def solid(rng: Rng, period: Fraction) -> Drawn:
    """A viscoelastic solid, fed with the penetration."""
    how = str(rng.choice(["backward", "tustin", "forward"], p=[0.7, 0.2, 0.1]))
    way = rng.random()
    count = 1 if way < 0.75 else int(rng.integers(2, 4))
    k = Fraction(0) if 0.5 < way < 0.75 else typed(decades(rng, 0, 4))
    scale = float(k) or decades(rng, 0, 4)
    branches = []
    for _ in range(count):
        mu = typed(scale * decades(rng, -1.5, 1.5))
        tau = float(period) * decades(rng, 0.5 if how == "forward" else -1.5, 3)
        eta = typed(float(mu) * tau) * (-1 if rng.random() < 0.03 else 1)
        branches.append((mu, eta))
    num, den = [k], [Fraction(1)]
    for mu, eta in branches:
        n, d = _branch(mu, eta, period, how)
        num, den = total(product(num, d), product(n, den)), product(den, d)
    clamped = bool(rng.random() < 0.35)
    if way >= 0.75:
        law: Any = zw.GeneralizedMaxwell(k, branches, how, clamped=clamped)
    elif k == 0:
        law = zw.Maxwell(*branches[0], how, clamped=clamped)
    else:
        law = zw.StandardLinearSolid(k, *branches[0], how, clamped=clamped)
    return Drawn(law, "penetration", *transfer(num, den))


def _branch(mu: Fraction, eta: Fraction, period: Fraction, how: str) -> tuple[Polynomial, Polynomial]:
    """μ η s/(μ + η s) in ascending powers of 1/z."""
    if how == "backward":
        return [mu * eta, -mu * eta], [mu * period + eta, -eta]
    if how == "tustin":
        return [2 * mu * eta, -2 * mu * eta], [mu * period + 2 * eta, mu * period - 2 * eta]
    return [mu * eta, -mu * eta], [eta, mu * period - eta]


def filtered(rng: Rng, most: int = 6) -> Drawn:
    """Any H(z), on both sides of x = 0: narrow resonances, slow poles and a few unstable ones among them."""
    order = int(rng.integers(1, most + 1))
    radius = 1 - decades(rng, -4, -0.3) if rng.random() < 0.85 else 1 - decades(rng, -6, -3)
    if rng.random() < 0.04:
        radius = 1 + decades(rng, -3, -1)
    poles: list[complex] = []
    while len(poles) < order:
        size = radius * np.sqrt(rng.random()) if poles else radius
        if order - len(poles) >= 2 and rng.random() < 0.75:
            pole = size * np.exp(1j * pi * rng.random())
            poles += [pole, np.conj(pole)]
        else:
            poles.append(float(size * rng.choice([1, -1])))
    den = [Fraction(repr(float(c))) for c in np.real(np.poly(poles))]
    gain = decades(rng, -1, 4)
    num = [typed(gain * c, 6) for c in rng.normal(size=order + 1)]
    if sum(num) * sum(den) < 0 and rng.random() < 0.9:
        num = [-c for c in num]
    return Drawn(zw.PulseTransferFunction(num, den), "both", *transfer(num, den))


# -- loops ----------------------------------------------------------------------------------------------


def period_of(rng: Rng) -> Fraction:
    """T [s]."""
    return Fraction(1, 1000) if rng.random() < 0.5 else typed(decades(rng, -4.3, -1.7), 2)


def built(
    rng: Rng, kind: str, drawn: Drawn, period: Fraction, counts: bool, delay: Fraction, motion: str = "linear"
) -> Case:
    """A device near one of the limits of a law."""
    plain = PlainLoop(
        drawn.numerator, drawn.denominator, drawn.fed, drawn.law.clamped, Fraction(0), Fraction(0), period,
        delay=delay,
    )  # fmt: skip
    asked, _ = needed(plain)
    enough = drawn.damping
    if enough is not None:
        enough = enough + 2 * plain.whole * drawn.spring
    if enough is None or (rng.random() < 0.5 and asked > 0):
        damping = near(rng, asked) if 0 < asked < 1e9 else typed(decades(rng, -4, 1))
    else:
        damping = near(rng, enough)
    if rng.random() < 0.1:
        damping = typed(decades(rng, -5, 2))
    resolution = typed(decades(rng, -6, -2.5)) if counts else Fraction(0)
    friction = _friction(rng, drawn, plain, resolution)
    if rng.random() < 0.02:
        damping = Fraction(0)
    device = zw.Device(
        damping=damping, coulomb_friction=friction, resolution=resolution, sample_period=period, delay=delay,
        motion=motion,
    )  # fmt: skip
    loop = replace(plain, damping=damping, friction=friction, resolution=resolution)
    return Case(kind, device, drawn.law, loop)


def _friction(rng: Rng, drawn: Drawn, loop: PlainLoop, resolution: Fraction) -> Fraction:
    if not resolution:
        return Fraction(0) if rng.random() < 0.5 else typed(decades(rng, -4, 0))
    sums = _norm(loop)
    if drawn.friction is not None and (rng.random() < 0.5 or sums is None):
        return near(rng, drawn.friction * resolution)
    if sums is None:
        return typed(decades(rng, -4, 1))
    return near(rng, typed(sums, 12) * resolution / 2)


def _norm(loop: PlainLoop) -> float | None:
    """Σ|h| of the first samples, to rounding; None where it does not end soon."""
    num, den = ([float(c) for c in side] for side in (loop.numerator, loop.denominator))
    past: list[float] = []
    for k in range(400):
        value = num[k] if k < len(num) else 0.0
        value -= sum(den[i] * past[-i] for i in range(1, min(len(den), len(past) + 1)))
        past.append(value)
        if k > len(num) and max(map(abs, past[-len(den) :])) < 1e-13 * max(map(abs, past)):
            return sum(map(abs, past))
        if abs(value) > 1e30:
            return None
    return None


def linear(rng: Rng) -> Case:
    """Any H(z), ideal encoder, no delay."""
    return built(rng, "linear", filtered(rng), period_of(rng), False, Fraction(0))


def contact(rng: Rng) -> Case:
    """One-sided laws with memory, ideal encoder."""
    period = period_of(rng)
    drawn = damped_wall(rng, period) if rng.random() < 0.55 else solid(rng, period)
    delay = period * int(rng.integers(1, 3)) if rng.random() < 0.12 else Fraction(0)
    return built(rng, "contact", drawn, period, False, delay)


def counts(rng: Rng) -> Case:
    """Any law with an encoder and Coulomb friction."""
    period, way = period_of(rng), rng.random()
    if way < 0.15:
        drawn = spring_wall(rng, period)
    elif way < 0.6:
        drawn = damped_wall(rng, period)
    elif way < 0.8:
        drawn = solid(rng, period)
    else:
        drawn = filtered(rng, 3)
    delay = period * int(rng.integers(1, 3)) if rng.random() < 0.15 else Fraction(0)
    return built(rng, "counts", drawn, period, True, delay)


def game(rng: Rng) -> Case:
    """The same with laws that remember a little, decided by the whole of `zw.check`, its game included."""
    period = period_of(rng)
    drawn = damped_wall(rng, period) if rng.random() < 0.7 else solid(rng, period)
    return replace(built(rng, "game", drawn, period, True, Fraction(0)), full=True)


def delayed(rng: Rng) -> Case:
    """A delay of whole samples or of any length."""
    period, way = period_of(rng), rng.random()
    if way < 0.35:
        drawn = spring_wall(rng, period)
    elif way < 0.5:
        drawn = damped_wall(rng, period)
    elif way < 0.6:
        drawn = solid(rng, period)
    else:
        drawn = filtered(rng, 4)
    whole = int(rng.integers(0, 4))
    part = Fraction(int(rng.integers(1, 100)), 100) if rng.random() < 0.7 else Fraction(whole == 0)
    return built(rng, "delay", drawn, period, bool(rng.random() < 0.35), (whole + part) * period)


def rotary(rng: Rng) -> Case:
    """A wheel, with counts per turn or an ideal encoder."""
    period = period_of(rng)
    make: Callable[[Rng, Fraction], Drawn] = (spring_wall, damped_wall, solid)[int(rng.integers(0, 3))]
    case = built(rng, "rotary", make(rng, period), period, False, Fraction(0), "rotary")
    if rng.random() < 0.5:
        return case
    turn = zw.rotary(
        damping=case.loop.damping, sample_period=period, counts_per_turn=int(rng.integers(100, 70_000)),
        coulomb_friction=0, delay=0,
    )  # fmt: skip
    size = turn.exact("resolution")
    sums = _norm(case.loop)
    friction = near(rng, typed((sums or 1.0) * float(size) / 2, 12))
    loop = replace(case.loop, resolution=size, friction=friction)
    return replace(case, device=turn.replace(coulomb_friction=friction), loop=loop)


def intervals(rng: Rng) -> Case:
    """Some numbers within intervals, and loops at random points within them."""
    period, way = period_of(rng), rng.random()
    if way < 0.3:
        drawn = spring_wall(rng, period)
    elif way < 0.6:
        drawn = damped_wall(rng, period)
    elif way < 0.8:
        drawn = solid(rng, period)
    else:
        drawn = filtered(rng, 3)
    late = typed(float(period) * rng.random() * 2, 2) if rng.random() < 0.3 else Fraction(0)
    case = built(rng, "intervals", drawn, period, bool(rng.random() < 0.4), late)
    width = decades(rng, -4, -0.5)
    names = [
        n
        for n in ("damping", "coulomb_friction", "resolution", "sample_period", "delay")
        if rng.random() < 0.4
    ]
    if drawn.fed == "both" and case.law.sample_period is not None:
        names = [n for n in names if n != "sample_period"]
    spans = {n: _span(rng, case.device.exact(n), width) for n in names}
    fields = [
        n for n in ("stiffness", "damping", "branch_damping") if hasattr(case.law, n) and rng.random() < 0.4
    ]
    laws = {n: _span(rng, getattr(case.law, n).fraction, width) for n in fields}
    points = []
    for _ in range(3):
        device = case.device.replace(**{n: _point(rng, s) for n, s in spans.items()})
        points.append((device, case.law.replace(**{n: _point(rng, s) for n, s in laws.items()})))
    device = case.device.replace(**spans) if spans else case.device
    law = case.law.replace(**laws) if laws else case.law
    return replace(case, device=device, law=law, points=tuple(points))


def _span(rng: Rng, value: Fraction, width: float) -> tuple[Fraction, Fraction]:
    low, high = (typed(width * rng.random()) for _ in range(2))
    ends = value * (1 - low), value * (1 + high)
    return min(ends), max(ends)


def _point(rng: Rng, span: tuple[Fraction, Fraction]) -> Fraction:
    way = rng.random()
    share = Fraction(way < 0.25) if way < 0.5 else typed(rng.random(), 3)
    return span[0] + share * (span[1] - span[0])


KINDS: dict[str, Callable[[Rng], Any]] = {
    "linear": linear,
    "contact": contact,
    "counts": counts,
    "delay": delayed,
    "intervals": intervals,
    "rotary": rotary,
    "game": game,
}
"""How a loop of each kind is drawn."""

SHARES = {
    "linear": 0.3,
    "contact": 0.25,
    "counts": 0.2,
    "delay": 0.1,
    "rows": 0.05,
    "intervals": 0.0498,
    "rotary": 0.05,
    "game": 0.0002,
}
"""Of the loops drawn; those decided with the game take seconds each."""
