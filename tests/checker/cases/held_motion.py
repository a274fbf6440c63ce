"""What the checker computes of a device in a known hand, computed by another road.

Quick checks of single functions: the motion by a power series of its own, its transfer function from the
samples of what an impulse does; the rest in fractions.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from importlib import import_module
from itertools import product
from types import SimpleNamespace
from typing import Any

from . import Case
from .arithmetic import at, in_zeta, refuses
from .few_bits import limited, number, refusal

FINE = 120


def module(name: str) -> Any:
    """Of the known hand, as it is loaded now."""
    return import_module(f"zwidth.checker.known_hand.{name}")


def moved(loss: Fraction, spring: Fraction, start: Sequence[int], push: Fraction, time: Fraction) -> Any:
    """y'' = push − loss y' − spring y from y, y' on: both after a time, by powers of it."""
    loss, spring, push, time = ((c.numerator << FINE) // c.denominator for c in (loss, spring, push, time))
    a, b = (s << FINE for s in start)
    value, rate, power = a + (b * time >> FINE), b, time
    for n in range(1, 50):
        a, b = b, -((loss * n * b + spring * a >> FINE) - push) // (n * (n + 1))
        push = 0
        rate += (n + 1) * b * power >> FINE
        power = power * time >> FINE
        value += b * power >> FINE
    return Fraction(value, 1 << FINE), Fraction(rate, 1 << FINE)


def answer(values: Sequence[Fraction], period: Fraction, part: Fraction) -> tuple[Any, Any]:
    """Above and below, in powers of ζ: what M, D and k make of a force that is a part of a sample late."""
    mass, damping, stiffness = values
    loss, spring = damping * period / mass, stiffness * period**2 / mass
    (p, p_rate), (q, q_rate) = (moved(loss, spring, s, Fraction(0), Fraction(1)) for s in ((1, 0), (0, 1)))
    below = [Fraction(1), -p - q_rate, p * q_rate - q * p_rate]
    steps = [Fraction(0)]
    for k in range(2 if not part else 3):
        steps.append(moved(loss, spring, (0, 0), period**2 / mass, k + 1 - part)[0])
    impulse = [y - x for x, y in zip(steps, steps[1:], strict=False)]
    above = [
        sum((below[i] * impulse[k - i] for i in range(min(k, 2) + 1)), Fraction(0))
        for k in range(len(impulse))
    ]
    return in_zeta(above), in_zeta(below)


def every_motion_of_a_box_is_enclosed() -> str:
    """Of narrow ones and wide ones, at the ends and in the middle, times M over the middle of M."""
    motions = module("held_motion")
    for ends, period, late in (
        (((2, 3), (1, 2), (1, 4)), 1, 0),
        (((2, "2.01"), (1, "1.01"), (2, "2.01")), 1, "5/4"),
        (((2, "2.01"), (3, 3), (0, 0)), "1/2", "2/3"),
        (((1, 1), (1, "1.01"), (2, "2.01")), "3/2", 3),
    ):
        box = [tuple(map(Fraction, pair)) for pair in ends]
        t = Fraction(period)
        told = motions.motion_of(*box, t, Fraction(late) * t)
        found = motions.sampled(told, 40)
        part = Fraction(late) % 1
        if found.late != int(Fraction(late)) + (part > 0):
            return f"{late} samples late"
        for shares in ((0, 0, 1), (0, 1, 0), (1, 0, 0), (1, 1, 1), (0, Fraction(1, 2), 0)):
            values = [a + (b - a) * s for (a, b), s in zip(box, shares, strict=True)]
            right = answer(values, t, part)
            for told_, true in zip((found.numerator, found.denominator), right, strict=True):
                for x, y in zip(told_, true, strict=True):
                    here = at(x, [2 * s - 1 for s in shares] if x.slopes else (), 0)
                    own = sum(map(abs, x.slopes[3:])) + x.radius
                    away = abs(2 * values[0] / sum(box[0]) * y - here) * (1 << 40)
                    if away > own:
                        return f"{values}, {late}: {float(away)} off, {own} said"
    return ""


def what_is_near_1_is_enclosed() -> str:
    """With its inverse, which is off its tangent by ρ²/(1 − ρ) at most: half of it is what is open."""
    for part in (Fraction(1, 3), Fraction(1, 100), Fraction(3, 4)):
        found = module("held_motion")._near_1(1 - part, 1 + part, 20)
        for x, sign, room in zip(found, (1, -1), (0, part**2 / (1 - part) / 2), strict=True):
            if len(x.slopes) != 3 or any(x.slopes[1:]):
                return f"{part}: what it shares"
            away = max(abs((1 + part * e) ** sign - at(x, (e, 0, 0), 0)) for e in (-1, 0, 1)) * (1 << 20)
            if not away <= x.radius <= room * (1 << 20) + 3:
                return f"1 ± {part} to the power {sign}: {float(away)} off, {x.radius} said"
    return ""


def what_moves_too_far_is_not_summed() -> str:
    """500 is the most: whether by the middle or by what may be more, of the spring or of the loss."""
    pushed = module("held_motion")._pushed
    for spring, loss in (((501, 0), (0, 0)), ((300, 201), (0, 0)), ((0, 0), (501, 0)), ((0, 0), (300, 201))):
        told = [number(4, middle << 4, (), reach << 4) for middle, reach in (spring, loss)]
        if not refuses(lambda t: pushed(*t, Fraction(1), 4), told, refusal()):
            return f"{spring}, {loss}"
    return ""


def what_is_damped_or_held_is_not_free() -> str:
    """At the upper end of what is known."""
    motions = module("held_motion")
    for damping, stiffness in product((0, 1), repeat=2):
        low = (Fraction(0), Fraction(damping)), (Fraction(0), Fraction(stiffness))
        told = motions.Motion((Fraction(1),) * 2, *low, Fraction(1), Fraction(0))
        if told.is_free is bool(damping or stiffness):
            return f"{damping}, {stiffness}"
    return ""


def a_mass_twice_as_large_moves_half_as_far() -> str:
    """Free, however late its force is."""
    motions, none = module("held_motion"), (Fraction(0),) * 2
    for late in (Fraction(0), Fraction(1, 2), Fraction(7, 3)):
        light, heavy = (
            motions.sampled_free(motions.Motion((Fraction(m),) * 2, none, none, Fraction(1), late))
            for m in (1, 2)
        )
        if (light[0], *light[1:]) != ([2 * x for x in heavy[0]], *heavy[1:]):
            return f"{late} samples late: {light}, {heavy}"
    return ""


def every_term_of_a_cosine_sum_counts() -> str:
    """But for those that are 0; a unit of the last digit as well as any."""
    positive = module("wall")._require_positive
    for sums, right in (
        ([1, 0, 0], True), ([3, 0, -2], True), ([1, 0, -2], False), ([2, 1], True), ([1, 1], False),
        ([1, -1], False), ([2, -1], True), ([0, 0], False), ([0], False),
    ):  # fmt: skip
        if refuses(positive, [number(4, x) for x in sums], refusal()) is right:
            return f"{sums}"
    return ""


def halves_make_the_whole() -> str:
    """Cut at the middle of what is not certain; all else as it was."""
    motions = module("held_motion")
    for name in ("mass", "damping", "stiffness"):
        told = {key: (Fraction(3),) * 2 for key in ("mass", "damping", "stiffness")}
        told[name] = (Fraction(2), Fraction(5))
        box = motions.Motion(**told, period=Fraction(1), late=Fraction(0))
        middle = Fraction(7, 2)
        right = [box._replace(**{name: (Fraction(2), middle)}), box._replace(**{name: (middle, Fraction(5))})]
        if box.halves(box, Fraction(1)) != right:
            return name
    return ""


def hand(late: Any = 0, **more: Any) -> Any:
    told = {"mass": 2, "hand_mass": 1, "damping": 1, "hand_damping": 2, "hand_stiffness": 3, **more}
    loop = {**{key: Fraction(v) for key, v in told.items()}, "sample_period": Fraction(1)}
    return SimpleNamespace(plant=None, loop=SimpleNamespace(**loop, delay=Fraction(late)))


def plants_are_padded_with_what_is_0() -> str:
    """Below for every sample of delay, above to the same length; what is not certain stays so."""
    for late, zeros in ((0, 0), (2, 2), (Fraction(1, 2), 1), (Fraction(7, 3), 3)):
        told = hand(late)
        found = module("wall").plant_of(told, 40)
        if len(found.denominator) != 3 + zeros or not all(
            x.is_zero for x in found.denominator[len(found.denominator) - zeros :]
        ):
            return f"below, {late} samples late"
        above, below = module("wall")._plant(told, 40)
        extra = len(above) - len(found.numerator)
        if len(above) != len(below) or not all(x.is_zero for x in above[len(found.numerator) :]):
            return f"above, {late} samples late: {extra} more"
        kept = zip([*above, *below], [*found.numerator[::-1], *found.denominator[:0:-1]], strict=False)
        if late == 0 and any((x.middle, x.reach) != (y.middle, y.reach) for x, y in kept):
            return "what is not certain"
    return ""


def what_is_damped_nowhere_is_not_stable() -> str:
    """A spring, and a damper of device or of hand."""
    for stiffness, damping, by_hand in product((0, 1), repeat=3):
        told = hand(hand_stiffness=stiffness, damping=damping, hand_damping=by_hand)
        right = bool(stiffness and (damping or by_hand))
        if refuses(module("wall")._require_stable, told, refusal()) is right:
            return f"{stiffness}, {damping}, {by_hand}"
    return ""


def what_is_uncertain_is_taken_off() -> str:
    """Of a + b cos θ, each within its bound."""
    for a, b, reach, right in ((9, 4, 2, True), (9, 4, 3, False), (9, -4, 2, True), (9, -4, 3, False)):
        told = [number(8, a, (), reach), number(8, b, (reach - 1,), 1)]
        if refuses(module("wall")._require_positive, told, refusal()) is right:
            return f"{a} + {b} cos θ, each ± {reach}"
    return ""


def whole_polynomials_begin_above_0() -> str:
    """With N and D of either sign."""
    rest, one = module("rest"), (Fraction(1),) * 2
    motion = module("held_motion").Motion(one, *((Fraction(0),) * 2,) * 2, Fraction(1), Fraction(1, 2))
    for above, below in product(([3, 1], [-3, 1], [0, 1]), ([2, 1], [-2, 1])):
        if rest._exactly(rest.Loop(motion, above, below))[0].middle <= 0:
            return f"{above}, {below}"
    return ""


def boxes_cover_what_is_told() -> str:
    """One where little varies, several where much does, none where a root meets the circle within."""
    rest, motions = module("rest"), module("held_motion")

    def covered(low: Any, high: Any) -> Any:
        box = ((Fraction(1),) * 2, (Fraction(low), Fraction(high)), (Fraction(1),) * 2)
        return rest._covered(rest.Loop(motions.Motion(*box, Fraction(1), Fraction(0)), [1], [1]))

    with limited(rest, MOST_BOXES=9):
        few, several = covered("1", "1.001"), covered("0.8", 2)
        if few != 1 or type(few) is not int or not 1 < several < 9:
            return f"{few} and {several} boxes"
        return "" if refuses(lambda low: covered(low, 2), "0.1", refusal()) else "a root on the circle"


def positions_follow_from_the_first() -> str:
    """Of a plant of two poles, each sample inside or not, in fractions; the first stand for themselves."""
    above, below = (Fraction(1, 2), Fraction(1, 4)), (Fraction(1, 4), Fraction(-1, 2))
    gap, slope, inside = Fraction(-3, 4), Fraction(5, 4), [True, False, True]
    rows = module("wall")._positions(
        *([number(20, int(c * 2**20)) for c in part] for part in (above, below)),
        SimpleNamespace(gap=gap, slope=slope, inside=inside),
        20,
    )
    if [[(c.middle >> 20, c.radius) for c in row] for row in rows[:2]] != [
        [(1, 0), (0, 0), (0, 0)],
        [(0, 0), (1, 0), (0, 0)],
    ] or any(c.middle % (1 << 20) for row in rows[:2] for c in row):
        return "the first"
    first = [Fraction(1, 3), Fraction(-2)]
    x = list(first)
    for j in range(3):
        force = [slope * (x[j + i] - gap) if inside[(j + i) % 3] else Fraction(0) for i in range(2)]
        x.append(-sum(below[i] * x[j + i] + above[i] * force[i] for i in range(2)))
    for row, right in zip(rows, x, strict=True):
        parts = list(zip(row, (*first, 1), strict=True))
        away = abs(sum(Fraction(c.middle, 1 << 20) * v for c, v in parts) - right) * (1 << 20)
        if away > sum(c.reach * abs(v) for c, v in parts):
            return f"{right}"
    return ""


CHECKS = (
    every_motion_of_a_box_is_enclosed,
    what_is_near_1_is_enclosed,
    what_moves_too_far_is_not_summed,
    what_is_damped_or_held_is_not_free,
    a_mass_twice_as_large_moves_half_as_far,
    every_term_of_a_cosine_sum_counts,
    halves_make_the_whole,
    plants_are_padded_with_what_is_0,
    what_is_damped_nowhere_is_not_stable,
    what_is_uncertain_is_taken_off,
    whole_polynomials_begin_above_0,
    boxes_cover_what_is_told,
    positions_follow_from_the_first,
)

CASES = [Case(check.__name__.replace("_", " "), check, "") for check in CHECKS]
