"""Motions of two hands run again from the definitions, reading by reading, in fractions."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
from fractions import Fraction
from math import lcm
from typing import Any

import numpy as np
from flint import arb, ctx, fmpq

from ..opinion import Opinion, false
from ..plain import entry, exact, exacts, quantity
from .motions import compared, parts_of, unrolled
from .pair_arms import Arm, Law, arms_of

Document = dict[str, Any]

LONGEST = 4_000
"""Readings of a motion that are run."""

ROUNDS = 12


def _motion(document: Document, rng: np.random.Generator) -> Opinion:
    loop = document["loop"]
    arms = arms_of(loop)
    if arms is None:
        return false("there is no pair with such numbers")
    paths = [exacts(entry(document, f"{name}_positions")) for name in ("leader", "follower")]
    turns = [entry(document, f"{name}_switch_positions") for name in ("leader", "follower")]
    parts = parts_of(document, len(paths[0]))
    own = entry(document, "sample_period")
    often = arms[0].often
    if (
        parts is None
        or len({len(path) for path in paths}) > 1
        or any(path[0] for path in paths)
        or (own is not None and exact(own) != quantity(loop, "sample_period"))
        or any((last - first) % often for first, last, _ in parts)
        or any(bool(arm.part) != bool(turn) for arm, turn in zip(arms, turns, strict=True))
    ):
        return false("parts that do not follow one another, another period, or no start at rest at 0")
    given = [exacts(turn) if turn else path[:-1] for turn, path in zip(turns, paths, strict=True)]
    stored = (arms[0].stiffness + arms[0].sent) * sum(arm.resolution for arm in arms) ** 2 / 8
    return compared(taken_out(arms, paths, given, parts), exact(document["energy_J"]), stored)


def taken_out(arms: Sequence[Arm], paths: Any, turns: Any, parts: Any) -> Fraction | None:
    """By all rounds; of very many by four smaller numbers of them, between which it is a quadratic."""
    size = len(paths[0]) + sum((last - first) * (times - 1) for first, last, times in parts)
    if size <= LONGEST:
        return _of_all_readings(arms, paths, turns, parts)
    rounds = {times for *_, times in parts if times > 1}
    most = (LONGEST // 4 - len(paths[0])) // sum(last - first for first, last, times in parts if times > 1)
    if len(rounds) > 1 or most < 15:
        return None
    times = rounds.pop()
    most -= (most - times) % 3
    counts = [most - 3 * k for k in range(4)]
    fewer = [[(first, last, min(own, n)) for first, last, own in parts] for n in counts]
    e0, e1, e2, e3 = (_of_all_readings(arms, paths, turns, some) for some in fewer)
    if e0 - 2 * e1 + e2 != e1 - 2 * e2 + e3:
        return None  # what is remembered is older, or counts do not come again
    n = Fraction(times - most, 3)
    return e0 + n * (e0 - e1) + n * (n + 1) / 2 * (e0 - 2 * e1 + e2)


def _of_all_readings(arms: Sequence[Arm], paths: Any, turns: Any, parts: Any) -> Fraction:
    """−Σ w (f Δx + f_c |Δx| + b Δx²/t) of a motion from rest, in fractions."""
    scale = lcm(*(v.denominator for some in (*paths, *turns) for v in some))
    scale = lcm(scale, *(arm.resolution.denominator for arm in arms))
    motions, read = [], []
    for arm, path, turn in zip(arms, paths, turns, strict=True):
        x, y = ([int(v * scale) for v in some] for some in (path, turn))
        motion, places = unrolled(x, parts)  # type: ignore[arg-type]
        motions.append((motion, [motion[k] + y[at] - x[at] for k, at in enumerate(places)]))
        step = int(arm.resolution * scale)
        read.append([step * (v // step) if step else v for v in motion])
    total = Fraction(0)
    for i, arm in enumerate(arms):
        taps = [arm.force(*(Fraction(j == n) for n in range(6))) for j in range(6)]
        common = lcm(*(c.denominator for c in taps))
        whole = [int(c * common) for c in taps]
        total += arm.weight * _lost(arm, motions[i], (read[i], read[1 - i]), whole, common, scale)
        if arm.law is not None:
            total -= arm.weight * _helped(arm, arm.law, motions[i], read[i], scale)
    return -total


def _lost(arm: Arm, motion: Any, read: Any, taps: Sequence[int], common: int, scale: int) -> Fraction:
    """What one hand gives, its positions `scale` times as large, its taps `common` times."""
    (x, y), (own, its) = motion, read
    forces = [0] * (arm.whole + 1)
    for k in range(len(x) - 1):
        seen = [(own if mine else its)[max(at, 0)] for mine, at in arm.readings(k)]
        forces.append(sum(c * v for c, v in zip(taps, seen, strict=True)))
    work = path = early = late = 0
    for k in range(len(x) - 1):
        first, then = (y[k] - x[k], x[k + 1] - y[k]) if arm.part else (0, x[k + 1] - x[k])
        work += forces[k] * first + forces[k + 1] * then
        path += abs(first) + abs(then)
        early, late = early + first * first, late + then * then
    squares = late / (1 - arm.part) + (early / arm.part if arm.part else 0)
    paid = arm.damping / arm.period * squares
    return (Fraction(work, common) + paid) / scale**2 + arm.friction * Fraction(path, scale)


def _helped(arm: Arm, law: Law, motion: Any, own: Sequence[int], scale: int) -> Fraction:
    """What compensation gives: F tanh(v/v_s) + C v of the move over the last sample, as late as the force."""
    x, y = motion
    moves = [0] * (arm.whole + 1)
    for k in range(len(x) - 1):
        last = arm.often * (k // arm.often)
        moves.append(own[last] - own[max(last - arm.often, 0)])
    period = arm.often * arm.period
    ways: Counter[int] = Counter()
    for k in range(len(x) - 1):
        first, then = (y[k] - x[k], x[k + 1] - y[k]) if arm.part else (0, x[k + 1] - x[k])
        ways[moves[k]] += first
        ways[moves[k + 1]] += then
    total = Fraction(0)
    for move, way in ways.items():
        v = Fraction(move, scale) / period
        total += (law.coulomb * _tanh(v, law.speed) + law.viscous * v) * Fraction(way, scale)
    return total


def _tanh(v: Fraction, speed: Fraction) -> Fraction:
    """tanh v/v_s to 300 bits; the sign of v where v_s is 0."""
    if not speed or not v:
        return Fraction((v > 0) - (v < 0))
    with ctx.workprec(300):
        x = v / speed
        mantissa, exponent = arb(fmpq(x.numerator, x.denominator)).tanh().mid().man_exp()
        return int(mantissa) * Fraction(2) ** int(exponent)


def gaining_round(arms: tuple[Arm, Arm], rng: np.random.Generator) -> str:
    """A round of both hands that takes something out each time, in words; of about the sizes of the laws."""
    often = arms[0].often
    sizes = [a.resolution for a in arms] + [a.law.speed * a.often * a.period for a in arms if a.law]
    sizes = [v for v in sizes if v] or [Fraction(1)]
    for _ in range(ROUNDS):
        size = often * int(rng.integers(1, 4))
        unit = Fraction(rng.choice([float(v) for v in sizes]) * 10 ** rng.uniform(-3, 2))
        paths = [
            [Fraction(0), *(unit * int(v) for v in rng.integers(-3, 4, size - 1)), Fraction(0)] for _ in arms
        ]
        turns = [
            [a + arm.part * (b - a) for a, b in zip(path, path[1:], strict=False)]
            for arm, path in zip(arms, paths, strict=True)
        ]
        settled = 3 + max(a.whole + max(a.age, a.back) for a in arms)
        less, more = (taken_out(arms, paths, turns, [(0, size, n)]) for n in (settled, settled + 1))
        if less is not None and more is not None and more > less:
            return f"a round of {size} readings takes {float(more - less):.6g} J out again and again"
    return ""


JUDGES: dict[str, Callable[[Document, np.random.Generator], Opinion]] = {"pair motion": _motion}
