"""Two arms written from nothing, damped about as much as they need, with the polynomials of a proof."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from math import cos
from random import Random

from .judges.pair_arms import Arm, arms_of, friction_for
from .judges.pair_motions import taken_out
from .judges.pairs import least_at
from .polynomials import (
    PERIODS,
    Document,
    Laurent,
    Polynomial,
    close,
    laurent_sum,
    laurent_times,
    over_one_less,
    plus,
    positivity,
    reciprocal,
    short,
    symmetric_in_cosine,
    texts,
    times,
)  # fmt: skip

ONE, HALF = Fraction(1), Fraction(1, 2)
STEP: Laurent = {0: Fraction(1), 1: Fraction(-1)}
"""1 − ζ, ζ = 1/z."""

LOOKED_AT = (1e-3, 0.2, 0.5, 0.8, 1.1, 1.4, 1.7, 2.0, 2.3, 2.6, 2.9, 3.14159)


def loop_of_two(rng: Random) -> tuple[Document, tuple[Arm, Arm], float]:
    """Two arms near the limit of the criterion, as numbers tell it, and the angle where it is nearest."""
    period = Fraction(rng.choice(PERIODS))
    often = rng.choice((1, 1, 1, 2, 3, 4))
    stiffness = short(rng, 1, 1000)
    usual = stiffness * period
    drawn = {
        "virtual_damping": rng.choice((0, 0, 0.2, 0.5, -0.2)),
        "local_damping": rng.choice((0, 0, 0.3, -0.3)),
    }
    loop: Document = {"sample_period_s": str(period)}
    if often > 1:
        loop["own_readings"] = often
    for name in ("leader", "follower"):
        late = period * rng.choice((0, 0, 1, Fraction(rng.randint(1, 39), 20))) if often == 1 else 0
        loop[name] = {
            "damping_N_s_per_m": str(usual * short(rng, 0.5, 3)),
            "coulomb_friction_N": "0",
            "resolution_m": rng.choice(("0", "0", "1/10000")),
            "delay_s": str(late),
            "stiffness_N_per_m": str(
                stiffness if name == "leader" else stiffness * rng.choice((1, 1, Fraction(3, 2)))
            ),
            **{f"{gain}_N_s_per_m": str(usual * Fraction(str(share))) for gain, share in drawn.items()},
            "link_delay_s": str(period * rng.choice((0, 1, 2, Fraction(rng.randint(1, 50), 20)))),
        }
    arms = _arms(loop)
    least, at = min((least_at(arms, angle)[0], angle) for angle in LOOKED_AT)
    # what is lost to viscous friction is 1 of the form, and the rest is in proportion to 1/b
    share = close(rng, Fraction(f"{max(1 - least, 1e-3):.6g}"))
    for name in ("leader", "follower"):
        loop[name]["damping_N_s_per_m"] = str(Fraction(loop[name]["damping_N_s_per_m"]) * share)
    arms = _arms(loop)
    for name, error in zip(
        ("leader", "follower"), (friction_for(*arms), friction_for(*arms[::-1])), strict=True
    ):
        loop[name]["coulomb_friction_N"] = str(close(rng, error) if rng.random() < 0.3 else error)
    return loop, _arms(loop), at


def _arms(loop: Document) -> tuple[Arm, Arm]:
    found = arms_of(loop)
    assert found is not None
    return found


def forms(arms: tuple[Arm, Arm]) -> tuple[Polynomial, Polynomial, Polynomial]:
    """(2 − 2c) M_ll, (2 − 2c) M_ff and (2 − 2c)² det M; with drives the first two times their denominators.

    M as in docs/theory/pairs.md: the work of both hands in whole samples.
    """
    square = laurent_times(STEP, reciprocal(STEP))
    own: list[Laurent] = [{}, {}]
    crossed: Laurent = {}
    for i, arm in enumerate(arms):
        period = arm.often * arm.period
        mixed = {arm.whole + 1: 1 - arm.part, arm.whole + 2: arm.part}
        past, heard = (arm.virtual + arm.local) / period, arm.virtual / period
        mine = {0: arm.stiffness + past, 1: -past}
        its = {arm.age: -arm.stiffness - heard, arm.age + 1: heard}
        gain, lost = arm.weight * period, _inside(arm, period)
        row = laurent_sum((arm.weight * arm.damping, STEP), (gain, laurent_times(mixed, mine)))
        row = laurent_times(row, reciprocal(STEP))
        cross = laurent_times(laurent_times(mixed, its), reciprocal(STEP))
        mix = laurent_times(reciprocal(mine), its)
        own[i] = laurent_sum(
            (ONE, own[i]), (HALF, row), (HALF, reciprocal(row)), (-lost, _square(square, mine))
        )
        own[1 - i] = laurent_sum((ONE, own[1 - i]), (-lost, _square(square, its)))
        terms = ((gain / 2, cross), (-lost, laurent_times(square, mix)))
        crossed = laurent_sum((ONE, crossed), *((v, reciprocal(p) if i else p) for v, p in terms))
    lines = (
        [(symmetric_in_cosine(p), [ONE]) for p in own] if arms[0].often == 1 else [_driven(a) for a in arms]
    )
    (first, below), (second, its_below) = lines
    both = times(symmetric_in_cosine(laurent_times(crossed, reciprocal(crossed))), times(below, its_below))
    return first, second, plus(times(first, second), both, -1)


def _square(square: Laurent, p: Laurent) -> Laurent:
    return laurent_times(square, laurent_times(p, reciprocal(p)))


def _inside(arm: Arm, period: Fraction) -> Fraction:
    """w T² α (1 − α)/(4 b)."""
    part = arm.part * (1 - arm.part)
    return arm.weight * period**2 * part / (4 * arm.damping) if part else Fraction(0)


def _driven(arm: Arm) -> tuple[Polynomial, Polynomial]:
    """(2 − 2c) times the top of M_ii, and the bottom, by the recursion of Chebyshev's polynomials."""
    beta = arm.weight * (arm.damping - arm.stiffness * arm.period / 2)
    gamma = arm.weight * (arm.virtual + arm.local)
    t, u = [ONE, beta], [Fraction(0), ONE]
    for _ in range(arm.often):
        for row in (t, u):
            row.append(2 * beta * row[-1] - gamma**2 * row[-2])
    line = [arm.often * t[arm.often], -arm.often * (-gamma) ** arm.often]
    lost = gamma * u[arm.often]
    top = [(beta + gamma) * c for c in line]
    return times([Fraction(2), Fraction(-2)], top), plus(line, [lost, -lost])


def _pair(rng: Random) -> Document:
    loop, arms, _ = loop_of_two(rng)
    signs = []
    for q, often in zip(forms(arms), (1, 1, 2), strict=True):
        for _ in range(often):
            q = over_one_less(q)
        signs.append({**positivity(q), "at_one": often})
    return {
        "kind": "pair",
        "loop": loop,
        "proof": dict(zip(("leader", "follower", "both"), signs, strict=True)),
    }


def _violation(rng: Random) -> Document:
    loop, _, at = loop_of_two(rng)
    document: Document = {"kind": "pair violation", "loop": loop}
    if rng.random() < 0.1 * loop.get("own_readings", 1):
        return document
    cosine = Fraction(f"{cos(at):.6f}") if rng.random() < 0.7 else Fraction(rng.randint(-99, 99), 100)
    return {**document, "proof": {"cosine": str(min(cosine, Fraction("0.999999")))}}


def _motion(rng: Random) -> Document:
    """Of whole steps, a part of it some times, its own energy told, or nearly."""
    loop, arms, _ = loop_of_two(rng)
    share = short(rng, 0.02, 0.5)
    for name in ("leader", "follower"):
        loop[name]["damping_N_s_per_m"] = str(Fraction(loop[name]["damping_N_s_per_m"]) * share)
        loop[name]["coulomb_friction_N"] = str(
            Fraction(loop[name]["coulomb_friction_N"]) * rng.choice((0, share))
        )
    arms, often = _arms(loop), arms[0].often
    size, unit = often * rng.randint(2, 4), Fraction(1, 10 ** rng.randint(3, 6))
    paths = [[Fraction(0), *(unit * rng.randint(-1, 1) for _ in range(size))] for _ in arms]
    if rng.random() < 0.7:
        paths = [[*path[:-1], Fraction(0)] for path in paths]
    turns = [
        [a + (b - a) * Fraction(rng.randint(-2, 12), 10) for a, b in zip(path, path[1:], strict=False)]
        if arm.part
        else path[:-1]
        for arm, path in zip(arms, paths, strict=True)
    ]
    first = often * rng.randint(0, size // often - 1)
    parts = [(first, size, rng.choice((1, 7, 40, 800)))]
    taken = taken_out(arms, paths, turns, parts) or Fraction(0)
    document: Document = {
        "kind": "pair motion", "loop": loop, "sample_period_s": loop["sample_period_s"],
        "energy_J": str(close(rng, taken) if rng.random() < 0.2 else taken),
        "repeats": [{"first": first, "last": size, "times": parts[0][2]}],
    }  # fmt: skip
    for name, arm, path, turn in zip(("leader", "follower"), arms, paths, turns, strict=True):
        document[f"{name}_positions_m"] = texts(path)
        if arm.part:
            document[f"{name}_switch_positions_m"] = texts(turn)
    return document


FRESH_PAIRS: dict[str, Callable[[Random], Document]] = {
    "pair": _pair,
    "pair violation": _violation,
    "pair motion": _motion,
}
