"""Device, known hand and wall: does a disturbance die out?  `stability` and `instability`.

A free mass M = 1, T = 1, under K + B (1 − 1/z):  z³ + ((K + B)/2 − 2) z² + (1 + K/2) z − B/2,  which has
all roots inside
exactly if 0 < K < 2B (2 − B)/(2 + B) and B < 2: K = 2/3 for B = 1.
A damper alone, force B (x(j) − x(j−1)) and a free mass that drifts: the root at z = 1 stays.
With a hand of spring and damper the limits were bisected on the poles of the exact hold, in 30 digits.
"""

from __future__ import annotations

from importlib import import_module
from itertools import product
from typing import Any

from . import TINY, Case, Fraction, accepted, put, refused, without
from .arithmetic import expanded, in_zeta


def hand(kind: str, numerator: Any, denominator: Any, **motion: Any) -> Any:
    """M = T = 1 without spring and damper if nothing else is said."""
    loop = {
        "mass_kg": 1,
        "damping_N_s_per_m": 0,
        "stiffness_N_per_m": 0,
        "sample_period_s": 1,
        "delay_s": 0,
        **motion,
    }
    return {"kind": kind, "loop": {**loop, "numerator": list(numerator), "denominator": list(denominator)}}


def both(name: str, stable: Any, unstable: Any, **motion: Any) -> Any:
    """N and D of a law just inside the limit and of one just outside: each holds, and the other's
    claim does not.
    """
    rests, moves = (hand("stability", *law, **motion) for law in (stable, unstable))
    return [
        accepted(f"{name}, inside", rests, "come to rest after every disturbance"),
        refused(f"{name}, outside", moves, "could not be confirmed"),
        accepted(f"{name}, outside and said so", {**moves, "kind": "instability"}, "do not come to rest"),
        refused(f"{name}, inside and said not", {**rests, "kind": "instability"}, "could not be confirmed"),
    ]


def law(k: Any, b: Any) -> Any:
    return [Fraction(k) + Fraction(b), -Fraction(b)], [1, 0]


def spring(k: Any) -> Any:
    return [k], [1]


EDGE = Fraction(2, 3)
LAW = law(EDGE - TINY, 1)
RESTS, MOVES = hand("stability", *LAW), hand("instability", *law(EDGE, 1))
HELD = {"damping_N_s_per_m": "1/2", "stiffness_N_per_m": 1}
# M, D, k, T and the delay: the K at which a pole of the exact hold meets the circle
LIMITS = {
    (1, "1/2", 1, 1, 0): Fraction("1.189370146557"),
    (1, "1/2", 1, 1, 1): Fraction("0.529608069249"),
    (1, "1/2", 1, 1, "1/4"): Fraction("0.819805574943"),
    (1, "1/2", 1, 1, "5/4"): Fraction("0.510244196816"),
    (2, "1/4", 3, "1/2", "1/8"): Fraction("0.708571182600"),
    (1, 1, 0, 1, 0): Fraction("2.392211191177"),
    (1, 1, 0, 1, "1/3"): Fraction("1.387849461396"),
    (1, 3, 12, 1, 0): Fraction("7.655791537445"),
}
# its worst value is without hand, limit 1.189…: M = 1, D = 1/2, k = 1
NEAR = LIMITS[1, "1/2", 1, 1, 0]
WIDE = {"mass_kg": [1, 1], "damping_N_s_per_m": ["1/2", 2], "stiffness_N_per_m": 1}
BOX = hand("stability", *spring("0.4"), damping_N_s_per_m=["1/2", "3/5"], stiffness_N_per_m=[1, "6/5"])

# unit T²/M = ⅓: a pair of roots at 3/5 ± 4j/5, 4/5 ± 3j/5 or 12/13 ± 5j/13, by the linear equations for
# N = h₁ z + h₀; the others lie inside.  The pole of H(z) is −d
ON_CIRCLE = {
    ("0", 0): ("33/10", "-3/2"),
    ("0", "-1/3"): ("14/5", -2),
    ("1/3", 0): ("13527/4090", "-1917/818"),
    ("1/3", "1/3"): ("8361/2045", "-891/409"),
    ("1/7", "-1/3"): ("163366/60205", "-27146/12041"),
    ("1", "1/3"): ("604/225", "-88/45"),
    ("5/3", 0): ("5167098/4450277", "-316062/342329"),
}

# less than any number of bits tells: h₁ smaller by it moves the pair inside, larger outside
HAIR = Fraction(1, 10**700)


def near_circle(late: str, pole: Any, by: Fraction, sign: int = 1) -> Any:
    """A law whose pair of roots is off the circle by little, h₁ times a factor; T = 3 s."""
    first, second = map(Fraction, ON_CIRCLE[late, pole])
    law_ = [sign * first * by, sign * second], [sign, sign * Fraction(pole)]
    return hand("stability", *law_, mass_kg=27, sample_period_s=3, delay_s=3 * Fraction(late))


def the_polynomial_is_enclosed() -> str:
    """P of a free mass of 3 kg, T = 2 s, beside its coefficients without rounding."""
    rest, motions = (import_module(f"zwidth.checker.known_hand.{name}") for name in ("rest", "held_motion"))
    unit = Fraction(4, 3)
    for part, whole in ((0, 0), (0, 3), (Fraction(1, 3), 0), (Fraction(1, 4), 2)):
        late, rest_of = whole + (part > 0), 1 - Fraction(part)
        plant = [unit / 2, unit]
        if part:
            plant = [unit * rest_of**2 / 2, unit * rest_of + unit / 2, unit]
        for above, below in (([3], [2]), ([5, -4], [3, 0]), ([2, 1, -1], [1, 3, 7, 1])):
            free = expanded([1, 0, 0], in_zeta(below), *[[1, 1]] * late)
            force = expanded(plant, in_zeta(above))
            sums = [x + y for x, y in zip(free, [0] * (len(free) - len(force)) + force, strict=True)]
            zero = (Fraction(0),) * 2
            motion = motions.motion_of(
                (Fraction(3),) * 2, zero, zero, Fraction(2), 2 * (whole + Fraction(part))
            )
            loop = rest.Loop(motion, in_zeta(above), in_zeta(below))
            for bits in (20, 128):
                found = rest._characteristic(loop, bits)
                off = [
                    abs(Fraction(c, below[0]) * 2**bits - x.middle) for c, x in zip(sums, found, strict=True)
                ]
                if any(o > x.radius for o, x in zip(off, found, strict=True)):
                    return f"{above}/{below}, {whole} + {part} samples late, {bits} bits"
    return ""


def a_box_encloses_its_values() -> str:
    """P of values in a box, times M/M₀, beside what is told of all of them at once."""
    rest, motions = (import_module(f"zwidth.checker.known_hand.{name}") for name in ("rest", "held_motion"))

    def told(ends: Any, late: Any) -> Any:
        ranges = [tuple(map(Fraction, pair)) for pair in ends]
        motion = motions.motion_of(*ranges, Fraction(1), Fraction(late))
        return rest._characteristic(rest.Loop(motion, [3, 1], [1, 1]), 128)

    for ends in (((1, 2), (0, 3), (0, 1)), ((1, 2), (1, 1), (0, 0)), ((3, 3), (1, 2), (2, 5))):
        boxes = {late: told(ends, late) for late in (0, Fraction(1, 3))}
        for late, shares in product(boxes, product((0, Fraction(1, 3), 1), repeat=3)):
            if any(s and a == b for (a, b), s in zip(ends, shares, strict=True)):
                continue  # what is certain lies nowhere else
            values = [a + (b - a) * s for (a, b), s in zip(ends, shares, strict=True)]
            heavy = 2 * values[0] / Fraction(sum(ends[0]))
            one = told([(v, v) for v in values], late)
            for x, y in zip(boxes[late], one, strict=True):
                shared, own = x.slopes[:3], x.slopes[3:]
                moved = sum(s * (2 * share - 1) for s, share in zip(shared, shares, strict=bool(shared)))
                off = abs(y.middle * heavy - x.middle - moved)
                if off > x.radius + sum(map(abs, own)) + y.radius * heavy + 1:
                    return f"{ends}, {late}, {shares}"
    return ""


def within(k: Any, wide: Any) -> Any:
    """A spring before a held device, some of it within bounds."""
    return hand("stability", *spring(k), **{**HELD, **wide})


CASES = [
    *(
        refused(
            f"a damped mass under less spring than any bits tell, {kind}",
            hand(kind, [HAIR], [1], damping_N_s_per_m=1),
            "could not be confirmed",
        )
        for kind in ("stability", "instability")
    ),
    Case("the polynomial is enclosed", the_polynomial_is_enclosed, ""),
    Case("a box encloses its values", a_box_encloses_its_values, ""),
    accepted(
        "a free mass",
        RESTS,
        "come to rest after every disturbance, contact kept",
        shows="stable",
        hands="known",
        contact="kept",
        encoder="ideal",
        force_limit=False,
        force_steps=False,
        fed_with="",
    ),
    accepted("on the circle", MOVES, "do not come to rest", shows="unstable", hands="known", contact="kept"),
    refused("on the circle is not at rest", {**MOVES, "kind": "stability"}, "could not be confirmed"),
    *both("K of a free mass", law(EDGE - TINY, 1), law(EDGE + TINY, 1)),
    *both("B = 1/6", law(Fraction(11, 39) - TINY, "1/6"), law(Fraction(11, 39) + TINY, "1/6")),
    *both("B = 3/2", law(Fraction(3, 7) - TINY, "3/2"), law(Fraction(3, 7) + TINY, "3/2")),
    *(
        case
        for (m, d, k, t, late), limit in LIMITS.items()
        for case in both(
            f"M, D, k, T, delay = {m}, {d}, {k}, {t}, {late}",
            spring(limit - TINY),
            spring(limit + TINY),
            mass_kg=m,
            damping_N_s_per_m=d,
            stiffness_N_per_m=k,
            sample_period_s=t,
            delay_s=late,
        )
    ),
    *both("K > 0", law(TINY, 1), law(0, 1)),
    *both("K < 0", law(TINY, 1), law(-TINY, 1)),
    *both("M = 2 kg takes twice as much", law(2 * EDGE - TINY, 2), law(2 * EDGE + TINY, 2), mass_kg=2),
    *both(
        "T = 2 s takes a quarter", law(EDGE / 4 - TINY, "1/4"), law(EDGE / 4 + TINY, "1/4"), sample_period_s=2
    ),
    *both(
        "D turned with N", ([-x for x in LAW[0]], [-1, 0]), ([-x for x in law(EDGE + TINY, 1)[0]], [-1, 0])
    ),
    *both("a law that has a pole at 2", law(EDGE - TINY, 1), ([1, -1], [1, -2])),
    # P(1) = 0 with K = 0, whatever the delay: the exact numbers say it
    *both("K > 0, part of a sample late", law(TINY, "1/2"), law(0, "1/2"), delay_s="1/2"),
    *both("K > 0, one and a half late", law(TINY, "1/4"), law(0, "1/4"), delay_s="3/2"),
    *(
        case(
            f"a pair just on the circle, {late} samples of {period} s late, a pole at {pole}, {words}",
            {**told, "kind": kind},
            words,
        )
        for (late, pole), law_ in ON_CIRCLE.items()
        for period in (2, Fraction(1, 2))
        for told in [
            hand(
                "",
                law_,
                [1, pole],
                mass_kg=3 * period**2,
                sample_period_s=period,
                delay_s=period * Fraction(late),
            )
        ]
        for case, kind, words in (
            (accepted, "instability", "do not come to rest"),
            (refused, "stability", "could not be confirmed"),
        )
    ),
    *(
        accepted(
            f"a pair just {side} the circle, {late} samples late, a pole at {pole}",
            {**near_circle(late, pole, by), "kind": kind},
            words,
        )
        for late, pole in ON_CIRCLE
        for side, by, kind, words in (
            ("inside", 1 - HAIR, "stability", "come to rest"),
            ("outside", 1 + HAIR, "instability", "do not come to rest"),
        )
    ),
    accepted("a pair just inside the circle, N and D turned", near_circle("1/3", "1/3", 1 - HAIR, -1)),
    *(
        case
        for name, wide, less, more in (
            ("the mass", {"mass_kg": ["4/5", "6/5"]}, "1.12", "1.18"),
            ("the damping", {"damping_N_s_per_m": ["2/5", 1]}, "0.85", "0.97"),
            ("the stiffness", {"stiffness_N_per_m": ["1/2", 2]}, "1.1", "1.16"),
            (
                "all, late",
                {
                    "mass_kg": [1, "6/5"],
                    "damping_N_s_per_m": ["2/5", "1/2"],
                    "stiffness_N_per_m": [1, "7/5"],
                    "delay_s": "1/4",
                },
                "0.55",
                "0.65",
            ),
        )
        for case in (
            accepted(f"wide bounds of {name}", within(less, wide), "for every value in the intervals"),
            refused(
                f"wider than it rests, {name}",
                within(more, wide),
                "every value comes to rest was not confirmed",
            ),
        )
    ),
    refused(
        "uncertain numbers do not show that it moves",
        put(MOVES, {"loop.mass_kg": [1, "1.1"]}),
        "not of intervals",
    ),
    accepted("every value of a box", BOX, "for every value in the intervals"),
    accepted(
        "a box whose worst value is a millionth below its limit",
        hand("stability", *spring(NEAR * (1 - Fraction(1, 10**6))), **WIDE),
        "for every value in the intervals",
    ),
    refused(
        "a box whose worst value is a billionth above its limit",
        hand("stability", *spring(NEAR * (1 + Fraction(1, 10**9))), **WIDE),
        "was not confirmed",
    ),
    accepted("an interval of one number", put(RESTS, {"loop.mass_kg": [1, 1]}), "after every disturbance"),
    refused(
        "an interval turned round",
        put(BOX, {"loop.stiffness_N_per_m": ["6/5", 1]}),
        "stiffness_N_per_m must be",
    ),
    refused(
        "an interval of three", put(BOX, {"loop.stiffness_N_per_m": [1, 1, 1]}), "stiffness_N_per_m must be"
    ),
    refused("T is uncertain", put(BOX, {"loop.sample_period_s": [1, "1.1"]}), "expected a number"),
    refused("the delay is uncertain", put(BOX, {"loop.delay_s": [0, "0.1"]}), "expected a number"),
    *(
        refused(f"{key} is {value}", put(RESTS, {f"loop.{key}": value}), "must be")
        for key, value in (
            ("mass_kg", 0),
            ("mass_kg", -1),
            ("sample_period_s", 0),
            ("sample_period_s", -1),
            ("damping_N_s_per_m", -1),
            ("stiffness_N_per_m", -1),
            ("delay_s", -1),
        )
    ),
    accepted(
        "a pair just on the circle, N and D turned",
        put(
            hand("instability", [-Fraction(x) for x in ON_CIRCLE["0", "-1/3"]], [-1, "1/3"]),
            {"loop.mass_kg": 12, "loop.sample_period_s": 2},
        ),
    ),
    refused(
        "what moves too far within a sample where it is damped most",
        hand("stability", *spring("0.1"), damping_N_s_per_m=[1, 900], stiffness_N_per_m=1),
        "move too far within one sample",
    ),
    # δ + η is 500 and a hair at one end only
    refused(
        "what moves just too far within a sample where it is damped most",
        hand(
            "stability",
            *spring("0.1"),
            damping_N_s_per_m=[1, 499 + Fraction(1, 10**20)],
            stiffness_N_per_m=1,
        ),
        "move too far within one sample",
    ),
    refused("301 samples late", put(RESTS, {"loop.delay_s": 301}), "more than 300 samples"),
    refused("N is longer than D", hand("stability", [1, 1, 1], [1, 0]), "must be proper"),
    refused("no N", hand("stability", [], [1, 0]), "numerator must have 1"),
    refused("no D", hand("stability", [1], []), "denominator must have 1"),
    refused("D begins with 0", hand("stability", [1, 1], [0, 1]), "must be proper"),
    *(
        refused(f"without {key}", without(RESTS, f"loop.{key}"), phrase)
        for key, phrase in (
            ("mass_kg", "mass_kg is missing"),
            ("numerator", "numerator is missing"),
            ("delay_s", "delay_s is missing"),
        )
    ),
]
