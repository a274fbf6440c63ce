"""What the checker finds of two arms, counted a second time: motions, forms at some frequencies, held arms.

Each case draws some at random, and compares what the checker finds.
"""

from __future__ import annotations

import cmath
from collections.abc import Iterator, Sequence
from decimal import Decimal, localcontext
from fractions import Fraction
from importlib import import_module
from itertools import pairwise
from math import acos, ceil, floor
from random import Random
from types import SimpleNamespace
from typing import Any

from . import Case, plain
from .counted_again import read, some
from .pair import DAMPED, ONE_DAMPED, SPRING
from .pair import arm as one_arm

ROUNDS = 12
_ARMS = ("leader", "follower")


def part(name: str) -> Any:
    """Of what the checker knows of pairs, as it is loaded now."""
    return import_module(f"zwidth.checker.pair.{name}")


def document(sort: Any, told: Any) -> Any:
    """What is read of it."""
    return import_module("zwidth.checker.document.file").read_document(sort, plain(told))[0]


def _arm(random: Random, period: Fraction, late: Sequence[Any]) -> dict[str, Any]:
    """Springs and dampers whose sums are whole numbers now and then, where their parts are not."""
    half = Fraction(1, 2)
    return {
        "damping_N_s_per_m": some(random, 1, 4),
        "coulomb_friction_N": some(random, 0, 1),
        "resolution_m": random.choice([0, half, Fraction(2, 3)]),
        "delay_s": period * random.choice(late),
        "stiffness_N_per_m": some(random, 1, 3),
        "virtual_damping_N_s_per_m": random.choice([0, half, -half, half]),
        "local_damping_N_s_per_m": random.choice([0, half, Fraction(1, 3)]),
        "reflection": random.choice([0, 0, 1, half]),
        "link_delay_s": period * random.choice([0, 1, Fraction(3, 2)]),
    }


def _loop(random: Random, period: Fraction) -> dict[str, Any]:
    often = random.choice([1, 1, 2, 4])
    late = [0] if often > 1 else [0, 1, Fraction(1, 4), Fraction(4, 3)]
    loop = {"sample_period_s": period, "own_readings": often}
    for name in _ARMS:
        own = [n for n in (1, 2, 4) if often % n == 0]
        loop[name] = {**_arm(random, period, late), "own_readings": random.choice(own)}
    return loop


def _springs(loop: Any, which: int) -> tuple[list[Fraction], ...]:
    """What an arm makes of its own reading and of the last but one, at its own rate; of the other's and of
    its own that come back, at the rate of the link; and how old both are.
    """
    arm, other, period = loop[_ARMS[which]], loop[_ARMS[1 - which]], loop["sample_period_s"]
    damper, sent = (side["virtual_damping_N_s_per_m"] / period for side in (arm, other))
    sent *= arm["reflection"]
    quick = arm["own_readings"] * (damper + arm["local_damping_N_s_per_m"] / period)
    spring, back = arm["stiffness_N_per_m"], arm["reflection"] * other["stiffness_N_per_m"]
    age, way_back = (ceil(side["link_delay_s"] / period) for side in (arm, other))
    return (
        [spring + quick, -quick],
        [-(spring + back + damper + sent), damper + sent],
        [back + sent, -sent],
        [age, age + way_back],
    )


def _weights(loop: Any) -> list[Fraction]:
    """How often the work of each counts."""
    felt = [-sum(_springs(loop, which)[1]) for which in (0, 1)]
    return [Fraction(1), felt[0] / felt[1]]


def pair_motions() -> str:
    """Step by step, in fractions, every round of it."""
    random = Random(1)
    for turn in range(ROUNDS):
        period = some(random, 1, 3)
        loop = _loop(random, period)
        if turn % 5 == 0:  # of all that is multiplied, what comes back alone is no whole number
            whole = {"stiffness_N_per_m": 2, "local_damping_N_s_per_m": 0, "reflection": 1, "delay_s": 0}
            halves = {"virtual_damping_N_s_per_m": period / 2, "own_readings": 2}
            loop = {**loop, "own_readings": 2, **{n: {**loop[n], **whole, **halves} for n in _ARMS}}
        for name in _ARMS:
            if random.random() < 0.5:
                loop[name]["compensation"] = {
                    "compensated_coulomb_friction_N": some(random, 0, 2),
                    "compensated_damping_N_s_per_m": some(random, 0, 2),
                    "compensation_speed_m_per_s": random.choice([0, 0, 1]),
                }
        often, late = loop["own_readings"], [loop[name]["delay_s"] / period for name in _ARMS]
        first, size = often * random.randrange(3), often * random.randrange(1, 4)
        length, times = first + size + random.randrange(1, 5), random.choice([1, 3, 40 // size])
        paths = [[Fraction(0), *(some(random, -3, 3) for _ in range(length))] for _ in _ARMS]
        turns = [[some(random, -3, 3) for _ in range(length)] if d % 1 else [] for d in late]
        told = {
            "loop": loop,
            "energy_J": 0,
            "repeats": [{"first": first, "last": first + size, "times": times}],
            **{f"{name}_positions_m": x for name, x in zip(_ARMS, paths, strict=True)},
            **{f"{name}_switch_positions_m": v for name, v in zip(_ARMS, turns, strict=True) if v},
        }
        far = [_unrolled(x, first, first + size, times, x[first + size] - x[first]) for x in paths]
        between = [
            _unrolled(v, first, first + size, times, x[first + size] - x[first]) if v else []
            for v, x in zip(turns, paths, strict=True)
        ]
        motion = part("motion")
        found, right = (
            motion.pair_motion_energy(document(motion.PAIR_MOTION, told)),
            _taken(loop, far, between),
        )
        if not 0 <= right - found <= Fraction(1, 10**30):
            return f"{float(right)}, not {float(found)}, of {told}"
    return ""


def _unrolled(
    row: Sequence[Fraction], first: int, last: int, times: int, advance: Fraction
) -> list[Fraction]:
    """Every round stands as much ahead of the one before."""
    rounds = [v + n * advance for n in range(times) for v in row[first:last]]
    return [*row[:first], *rounds, *(v + (times - 1) * advance for v in row[last:])]


def _taken(loop: Any, paths: Sequence[Sequence[Fraction]], turns: Sequence[Sequence[Fraction]]) -> Fraction:
    """What both hands take out, to 40 digits where there is a tanh."""
    often, period, total = loop["own_readings"], loop["sample_period_s"], Fraction(0)
    readings = [
        [read(place, Fraction(loop[name]["resolution_m"])) for place in x]
        for name, x in zip(_ARMS, paths, strict=True)
    ]

    def at(which: int, k: int) -> Fraction:
        return readings[which][k] if k >= 0 else Fraction(0)

    for which, (name, weight) in enumerate(zip(_ARMS, _weights(loop), strict=True)):
        arm, x = loop[name], paths[which]
        own, other, echo, (age, way) = _springs(loop, which)
        step = often // arm["own_readings"]
        forces = []
        for k in range(len(x) - 1):
            newest, sent = k - k % step, k - k % often
            f = sum(c * at(which, newest - i * step) for i, c in enumerate(own))
            f += sum(c * at(1 - which, sent - (age + i) * often) for i, c in enumerate(other))
            f += sum(c * at(which, sent - (way + i) * often) for i, c in enumerate(echo))
            forces.append(f - _help(arm, (at(which, sent) - at(which, sent - often)) / period))
        late = floor(arm["delay_s"] / period)
        share = arm["delay_s"] / period - late
        for k, (here, there) in enumerate(pairwise(x)):
            middle = turns[which][k] if share else here
            for d, move, of in ((late + 1, middle - here, share), (late, there - middle, 1 - share)):
                if of:
                    force = forces[k - d] if k >= d else 0
                    rubbed = arm["damping_N_s_per_m"] * move**2 * often / (of * period)
                    total -= weight * (force * move + rubbed + arm["coulomb_friction_N"] * abs(move))
    return total


def _help(arm: Any, speed: Fraction) -> Fraction:
    """F tanh(v/v_s) + C v."""
    law = arm.get("compensation")
    if not law or not speed:
        return Fraction(0)
    slow, sign = law["compensation_speed_m_per_s"], 1 if speed > 0 else -1
    with localcontext() as context:
        context.prec = 60
        far = (
            (2 * Decimal(abs(speed).numerator) / Decimal(abs(speed).denominator) / slow).exp() if slow else 0
        )
        tanh = Fraction((far - 1) / (far + 1)) if slow else 1
    return law["compensated_coulomb_friction_N"] * sign * tanh + law["compensated_damping_N_s_per_m"] * speed


_COSINES = [Fraction(c, 4) for c in (3, 1, -2, -3)]
_NO_LAW = dict.fromkeys(
    ("compensated_coulomb_friction_N", "compensated_damping_N_s_per_m", "compensation_speed_m_per_s"), 0
)


def _compensated(random: Random) -> Iterator[tuple[Any, list[Any]]]:
    """Pairs and what compensation takes; drives first that have fractions at one place of the form alone."""
    line = part("coupling").Line
    springs = (
        one_arm(Fraction(35, 8), Fraction(3, 4), reflection=1),
        one_arm(8, Fraction(1, 4)),
    )  # in what comes back
    damped = one_arm(
        Fraction(31, 3), 4, local_damping_N_s_per_m=-Fraction(1, 3), own_readings=2
    )  # in the bottoms
    for arms in (springs, (damped, damped)):
        told = {"sample_period_s": Fraction(1), "own_readings": 2}
        for name, one in zip(_ARMS, arms, strict=True):
            told[name] = {"own_readings": 1, "reflection": 0, **one}
            told[name] = {key: Fraction(value) for key, value in told[name].items()}
            told[name]["own_readings"] = int(told[name]["own_readings"])
        yield told, [part("coupling").NO_LINE] * 2
    for _ in range(3 * ROUNDS):
        told = _loop(random, some(random, 1, 3))
        lines = [line(*(some(random, 0, 1) * random.choice([0, 1]) for _ in range(3))) for _ in _ARMS]
        for name, taken in zip(_ARMS, lines, strict=True):
            told[name]["damping_N_s_per_m"] = some(random, 1, 6) + Fraction(1, 5)
            if any(taken):
                told[name]["compensation"] = _NO_LAW
        yield told, lines


def forms_of_pairs() -> str:
    """What both arms lose at some frequencies, with the best way inside each sample: both entries, times what
    is linear in the cosine, and the determinant beside them.
    """
    random, passive = Random(2), part("passive")
    outcomes = set()
    for turn, (loop, lines) in enumerate(_compensated(random)):
        own = [_own(loop, which, lines[which]) for which in (0, 1)]
        least = None
        if loop["own_readings"] > 1 and turn % 2:
            own = [(b - random.choice([0, 1]), g, *more) for b, g, *more in own]
            least = {
                name: {"damping_N_s_per_m": w * b, "local_damping_N_s_per_m": w * g}
                for name, w, (b, g, *_) in zip(_ARMS, _weights(loop), own, strict=True)
            }
        edges = [
            b - abs(g) for name, (b, g, *_) in zip(_ARMS, own, strict=True) if loop[name]["own_readings"] > 1
        ]
        if 0 in edges:
            continue
        told = document(part("coupling").PAIR, loop)
        given = least and document(passive.LOSSES, least)
        more = (lines, given) if given or any(map(any, lines)) else ()
        found = passive.criterion(told, part("coupling").sides_of(told), *more)
        outcomes.add(found is None)
        if (found is None) is not any(edge < 0 for edge in edges):
            return f"{found} of {loop}, {more}"
        if found is not None and not _agrees(found, loop, own):
            return f"another form of {loop}, {more}"
    return "" if len(outcomes) == 2 else "all alike"


def _own(loop: Any, which: int, line: Any) -> tuple[Any, ...]:
    """β and γ of an arm, and what compensation that is computed more seldom takes of both afterwards."""
    arm, period = loop[_ARMS[which]], loop["sample_period_s"]
    quick = arm["virtual_damping_N_s_per_m"] + arm["local_damping_N_s_per_m"]
    often, once = arm["own_readings"], arm["own_readings"] == 1
    beta = arm["damping_N_s_per_m"] - line.still * once - arm["stiffness_N_per_m"] * period / (2 * often)
    return beta, quick - line.moving * once, *(x * (not once) for x in line[1:])


def _agrees(found: Any, loop: Any, own: Any) -> bool:
    """Each entry over what is lost lies on a line above 0; the determinant over both entries is as large."""
    ratios: list[list[float]] = [[], []]
    for c in _COSINES:
        leader, follower, both = (float(sum(a * c**i for i, a in enumerate(p))) for p in found)
        lost = [_lost(loop, own, acos(c), x) for x in ((1, 0), (0, 1), (1, 1), (1, 1j))]
        cross = abs(complex(*(x - lost[0] - lost[1] for x in lost[2:]))) / 2
        rest = cross**2 / (lost[0] * lost[1])
        if abs(both / (leader * follower) - (1 - rest)) > 1e-8 * (1 + abs(rest)):
            return False
        for row, entry, right in zip(ratios, (leader, follower), lost, strict=False):
            row.append(entry / right)
    for row in ratios:
        steps = zip(pairwise(row), pairwise(_COSINES), strict=True)
        slopes = [(b - a) / float(d - c) for (a, b), (c, d) in steps]
        if min(row) <= 0 or max(slopes) - min(slopes) > 1e-6 * max(row):
            return False
    return True


def _lost(loop: Any, own: Any, angle: float, x: Sequence[complex]) -> float:
    """By both arms in a sample, where each goes to and fro as far as x says."""
    back, period, total = cmath.exp(-1j * angle), float(loop["sample_period_s"]), 0.0
    for which, (name, weight) in enumerate(zip(_ARMS, _weights(loop), strict=True)):
        arm, move = loop[name], x[which] * (1 / back - 1)
        beta, gamma, still, moving = map(float, own[which])
        _, other, echo, (age, way) = _springs(loop, which)
        told = back**age * x[1 - which] * (float(other[0]) + float(other[1]) * back)
        told += back**way * x[which] * (float(echo[0]) + float(echo[1]) * back)
        if loop["own_readings"] > 1:
            lost = _least(beta, gamma, back, arm["own_readings"]) * abs(move) ** 2 / period
            lost += (told.conjugate() * move).real - (still + moving * back.real) * abs(move) ** 2 / period
        else:
            spring, late = float(arm["stiffness_N_per_m"]), float(arm["delay_s"]) / period
            damping = beta + spring * period / 2
            force = back ** floor(late) * (told + x[which] * (spring + gamma / period * (1 - back)))
            late -= floor(late)
            lost = damping / period * abs(move) ** 2
            lost += (((1 - late) + late * back) * force * move.conjugate()).real
            lost -= period * late * (1 - late) / (4 * damping) * abs((1 - back) * force) ** 2
        total += float(weight) * lost
    return total


def _least(beta: float, gamma: float, back: complex, often: int) -> float:
    """Of m Σ β |Δᵢ|² + γ Re Δᵢ Δ̄ᵢ₋₁ where the Δ of a sample add up to 1: 1 over the sum of the inverse."""
    rows = [[complex(often * beta * (i == k)) for k in range(often)] + [1] for i in range(often)]
    for i in range(often):
        turned = often * gamma / 2 * (back if i == 0 else 1)
        rows[i][(i - 1) % often] += turned
        rows[(i - 1) % often][i] += turned.conjugate()
    for i in range(often):  # Gauss and Jordan
        rows[i] = [v / rows[i][i] for v in rows[i]]
        for k in range(often):
            if k != i:
                rows[k] = [v - rows[k][i] * p for v, p in zip(rows[k], rows[i], strict=True)]
    return 1 / sum(row[-1].real for row in rows)


def younger_readings_beside_springs() -> str:
    """That they change nothing is said of springs alone: of no damper, delay or compensation."""
    passive = part("passive")
    line = part("coupling").Line
    one = {"own": (4, 0), "other": (-4, 0), "echo": (0, 0), "part": 0}
    beside = [
        ({"own": (5, -1)}, 0), ({"other": (-5, 1)}, 0), ({"echo": (1, -1)}, 0), ({"part": 1}, 0), ({}, 1),
    ]  # fmt: skip
    if passive._beyond_springs(SimpleNamespace(**one), line(1, 1, 0)):
        return "springs alone"
    for more, moving in beside:
        if not passive._beyond_springs(SimpleNamespace(**{**one, **more}), line(0, 0, moving)):
            return f"{more}, {moving}"
    for told, springs in ((SPRING, True), (DAMPED, False), (ONE_DAMPED, False)):
        said = import_module("zwidth.checker").verify(plain(told)).reason
        if ("; younger readings, another in each sample, change nothing" in said) is not springs:
            return said
    return ""


def a_pair_of_thrice_the_forces_has_the_same_form() -> str:
    """To the last digit: of drives that read nine times in a sample, with fractions in the bottoms alone."""
    passive, forms = part("passive"), []
    for factor in (1, 3):
        told: dict[str, Any] = {"sample_period_s": Fraction(1), "own_readings": 9}
        for name in _ARMS:
            one = one_arm(65 + Fraction(9, 18), 9, local_damping_N_s_per_m=Fraction(25, 3))
            told[name] = {
                key: Fraction(value) * (factor if "_N_" in key else 1)
                for key, value in {"reflection": 0, **one}.items()
            }
            told[name]["own_readings"] = 9
        read = document(part("coupling").PAIR, told)
        forms.append(passive.criterion(read, part("coupling").sides_of(read)))
    for one, other in zip(*forms, strict=True):
        if any(a * other[0] != b * one[0] for a, b in zip(one, other, strict=True)) or not one[0]:
            return f"{one} and {other}"
    return ""


CHECKS = [
    pair_motions,
    forms_of_pairs,
    a_pair_of_thrice_the_forces_has_the_same_form,
    younger_readings_beside_springs,
]
CASES = [Case(check.__name__.replace("_", " "), check, "") for check in CHECKS]
