"""Ports of one axis, Re F ≥ σ, and motions that take out more.

(s + 2)/(s + 1): Re = (2 + ω²)/(1 + ω²), least 1 at high frequencies; its inverse (2 + ω²)/(4 + ω²), least
½ at 0.
z/(z − ½): Re = (1 − c/2)/(5/4 − c), least 2/3 at z = −1; its inverse 1 − c/2, least ½.
(s² + 1)/(s² + s + 1), by x = ω²: (1 − x)²/((1 − x)² + x), which is 0 at x = 1, c = 0.
"""

from __future__ import annotations

import math
from typing import Any

from . import TINY, Fraction, accepted, put, refused, without
from .linear import AT_MINUS_ONE, AT_ONE, CONSTANT, signs

WORK = Fraction(math.pi)
"""Bursts are summed in units of π, and told with this."""


def port(
    numerator: Any,
    denominator: Any,
    level: Any = 0,
    index: str = "input",
    time: str = "continuous",
    **more: Any,
) -> Any:
    return {
        "index": index,
        "level": level,
        "system": {"time": time, "numerator": list(numerator), "denominator": list(denominator)},
        **more,
    }


def proved(positivity: Any, *of: Any, offset: Any = 1, **more: Any) -> Any:
    return port(*of, kind="positive real", proof={"offset": offset, "positivity": positivity}, **more)


def drawn(motion: Any, *of: Any, **more: Any) -> Any:
    return port(*of, kind="extraction", motion=motion, **more)


def pair(name: str, true: Any, words: str = "") -> Any:
    """At its level, and a hair above."""
    return [
        accepted(name, true, words, shows="index at least"),
        refused(
            f"{name}, a hair more", put(true, {"level": Fraction(true["level"]) + TINY}), "do not multiply"
        ),
    ]


def taken(name: str, energy: Any, told: Any, words: str = "", **facts: Any) -> Any:
    return accepted(name, told, words, energy, **{"shows": "index below", **facts})


LEAD, BACK = ([1, 2], [1, 1]), ([1, 1], [1, 2])
DISCRETE = {"time": "discrete"}
OUTPUT = {"index": "output"}
FOURTH = [1, 4, 6, 4, 1]
ALL = proved(AT_MINUS_ONE, *LEAD, 1)
SEQUENCE = {"kind": "sequence", "latent": [1, -1]}
DELAY = drawn(SEQUENCE, [1], [1, 0], **DISCRETE)
"""u = 1, −1 and y = 0, 1: Σ u y = −1."""
BURST = {"kind": "burst", "step_rad_per_s": 1, "cycles": 2, "power": 1}
FAST = drawn(BURST, [1, -1], [1, 1], 2)
"""Lines at 1, 2, 3 rad/s of weights ¼, 1, ¼: Re F |D|² − 2 |D|² = ω² − 1 − 2 (1 + ω²)."""
POLYNOMIAL = {"kind": "polynomial", "duration_s": 3, "lowest_power": 1, "coefficients": [3]}
GROWS = drawn(POLYNOMIAL, [1, -1], [1, 1])
"""φ = t: u = 1 + t, y = 1 − t: ∫ (1 + t)(1 − t) = 3 − 9, and ∫ (1 + t)² = 21."""
SMOOTH = drawn({**BURST, "step_rad_per_s": "1/2", "cycles": 3, "power": 2}, [1, 0, -1], [1, 1, 1], 1)


def smooth(level: int) -> Fraction:
    """(s² − 1)/(s² + s + 1): lines at 1/2 … 5/2 rad/s, Re N D̄ = ω⁴ − 1, |D|² = (1 − ω²)² + ω²."""
    lines = ((Fraction(1, 16), 1), (1, 2), (Fraction(9, 4), 3), (1, 4), (Fraction(1, 16), 5))
    squares = [(weight, Fraction(n * n, 4)) for weight, n in lines]
    return -2 * WORK * sum(w * (x * x - 1 - level * ((1 - x) ** 2 + x)) for w, x in squares)


# −1/(s + 1) ≥ −1: N + D = s, and with g = 1 2s + 1; N − σ D = ω² on the axis
BELOW = proved(AT_ONE, [-1], [1, 1], -1)

CASES = [
    accepted("a level below 0", BELOW, "the input index is at least -1"),
    accepted(
        "the input index",
        ALL,
        "the input index is at least 1",
        shows="index at least",
        hands="every",
        contact="both sides",
        encoder="ideal",
        force_limit=False,
        force_steps=False,
        fed_with="",
    ),
    *pair("continuous, at high frequencies", ALL),
    *pair("continuous, at 0", proved(AT_ONE, *BACK, "1/2")),
    *pair("the output index", proved(AT_ONE, *LEAD, "1/2", **OUTPUT), "the output index is at least 0.5"),
    *pair("discrete, at −1", proved(AT_MINUS_ONE, [1, 0], [1, "-1/2"], "2/3", **DISCRETE)),
    *pair("discrete, the output index", proved(AT_ONE, [1, 0], [1, "-1/2"], "1/2", **OUTPUT, **DISCRETE)),
    *pair("a constant", proved(signs(square=()), [-3], [2], "-3/2")),
    accepted("less than it is", proved(signs([3, 1]), *LEAD, 0)),
    # (1 − x)² with x = (1 − c)/(1 + c): 4c²
    *pair("of order 2", proved(signs(square=[0, 1]), [1, 0, 1], [1, 1, 1])),
    # 1/s: Re = 0, and s + (g − σ) has its root inside
    *pair("an integrator", proved(signs(square=()), [1], [1, 0])),
    *pair("a derivative", proved(signs(square=()), [1, 0], [1])),
    *pair("nothing", proved(signs(square=()), [0], [1])),
    # (z + ¼)/(z − ¼): Re(N D̄) = 15/16, and N + D = 2z
    *(  # with an offset of 1/2 what is left is 1, or −1
        accepted(f"a half, over {d}", proved(CONSTANT, [f"{d}/2"], [d], offset="1/2", **DISCRETE))
        for d in (1, -1)
    ),
    accepted("a root at 0", proved(CONSTANT, [1, "1/4"], [1, "-1/4"], **DISCRETE)),
    # N = D = (s + 1)⁴: half of |D|² = (1 + x)⁴, which is 16/(1 + c)⁴
    accepted("of order 4", proved(CONSTANT, FOURTH, FOURTH, "1/2")),
    refused("of order 4, more than it is", proved(CONSTANT, FOURTH, FOURTH, 1 + TINY), "do not multiply"),
    accepted("zeros before N and D", proved(AT_MINUS_ONE, [0, 1, 2], [0, 0, 1, 1], 1)),
    refused(
        "−1/s: Re = 0, its root outside",
        proved(signs(square=()), [-1], [1, 0], offset="1/2"),
        "a root lies outside",
    ),
    refused(
        "−1/(z − 2): Re > 0, its root outside",
        proved(signs([2, -1]), [0, -1], [1, -2], **DISCRETE),
        "a root lies outside",
    ),
    refused("offset 0", put(ALL, {"proof.offset": 0}), "proof.offset must be > 0"),
    refused("offset below 0", put(ALL, {"proof.offset": -1}), "proof.offset must be > 0"),
    accepted("a small offset", put(ALL, {"proof.offset": "1/1000"})),
    refused("D is 0", proved(CONSTANT, [1], [0]), "denominator is zero"),
    refused("G is 0 and inverted", proved(CONSTANT, [0], [1], **OUTPUT), "has no inverse"),
    refused("more zeros than poles", proved(CONSTANT, [1, 0], [1], **DISCRETE), "more zeros than poles"),
    refused("another time", put(ALL, {"system.time": "both"}), "time must be"),
    refused("another index", put(ALL, {"index": "both"}), "index must be input or output"),
    *(
        refused(f"without {key}", without(ALL, key), "is missing")
        for key in (
            "system",
            "system.time",
            "system.numerator",
            "system.denominator",
            "index",
            "level",
            "proof",
            "proof.offset",
            "proof.positivity",
        )
    ),
    # motions
    taken(
        "a sequence",
        1,
        DELAY,
        "the input index is less than 0",
        hands="every",
        contact="both sides",
        encoder="ideal",
        force_limit=False,
        force_steps=False,
        fed_with="",
    ),
    taken("a sequence, a level below 0", "1/2", put(DELAY, {"level": "-1/4"})),
    refused("a sequence, at its level", put(DELAY, {"level": "-1/2"}), "none comes out"),
    taken("a sequence, the output index", 1, put(DELAY, {"index": "output"})),
    # u = 1, −9/2, 2 and y = 1, −2, −8: Σ u y = −6, Σ u² = 101/4
    taken(
        "a sequence of a pole",
        "113/2",
        drawn({"kind": "sequence", "latent": [1, -4, 0]}, [1, 2], [1, "-1/2"], 2, **DISCRETE),
    ),
    refused(
        "an order of 401", put(DELAY, {"system.denominator": [1, *[0] * 401]}), "order is 401, more than 400"
    ),
    refused("a sequence of no samples", put(DELAY, {"motion.latent": []}), "none comes out"),
    refused("a sequence that takes nothing out", put(DELAY, {"motion.latent": [1, 1]}), "none comes out"),
    taken("a burst", 11 * WORK, FAST, "the input index is less than 2"),
    taken(
        "a burst, at another pace",
        2
        * WORK
        * sum(
            w * (x + 3)
            for w, x in ((Fraction(1, 4), Fraction(1, 4)), (1, 1), (Fraction(1, 4), Fraction(9, 4)))
        ),
        put(FAST, {"motion.step_rad_per_s": "1/2"}),
    ),
    refused(
        "a burst, at its level: (ω² − 1) summed is 5, 1 + ω² is 8",
        put(FAST, {"level": "5/8"}),
        "none comes out",
    ),
    taken(
        "a burst, the output index",
        11 * WORK,
        put(FAST, {"system.numerator": [1, 1], "system.denominator": [1, -1], "index": "output"}),
    ),
    taken("a polynomial", 6, GROWS),
    taken("a polynomial, a level", 6 + 21 * 2, put(GROWS, {"level": 2})),
    refused(
        "a polynomial that takes nothing out",
        put(GROWS, {"motion.duration_s": "3/2", "motion.coefficients": ["3/2"]}),
        "none comes out",
    ),
    # Σ (C(6, 3 + j)/8)² = C(12, 6)/64
    taken(
        "a burst of power 3", Fraction(924, 64) * WORK, drawn({**BURST, "cycles": 4, "power": 3}, [-1], [1])
    ),
    refused("a burst of order 2", SMOOTH, "none comes out"),
    taken("a burst of order 2, a higher level", smooth(2), put(SMOOTH, {"level": 2})),
    refused("a burst that is not smooth", put(SMOOTH, {"motion.power": 0}), "more cycles than its power"),
    refused(
        "a burst of power 1 and order 3",
        drawn(BURST, [1, 0, 0, -1], [1, 1, 1, 1], 2),
        "a power of half the order or more",
    ),
    refused("fewer cycles than its power", put(FAST, {"motion.cycles": 1}), "more cycles than its power"),
    refused(
        "a burst of too many lines",
        put(FAST, {"motion.cycles": 500, "motion.power": 400, "system.numerator": [1] * 371}),
        "more effort",
    ),
    refused("no pace", put(FAST, {"motion.step_rad_per_s": 0}), "step_rad_per_s must be > 0"),
    refused("a pace below 0", put(FAST, {"motion.step_rad_per_s": -1}), "step_rad_per_s must be > 0"),
    refused("a power of 401", put(FAST, {"motion.power": 401, "motion.cycles": 402}), "power must be ≤ 400"),
    refused(
        "a polynomial that does not begin at rest", put(GROWS, {"motion.lowest_power": 0}), "begin at rest"
    ),
    refused("a polynomial of no time", put(GROWS, {"motion.duration_s": 0}), "motion.duration_s must be > 0"),
    refused(
        "a polynomial of less than no time",
        put(GROWS, {"motion.duration_s": -3}),
        "motion.duration_s must be > 0",
    ),
    refused("a burst in steps", put(DELAY, {"motion": BURST}), "is moved by a burst"),
    refused("a polynomial in steps", put(DELAY, {"motion": POLYNOMIAL}), "is moved by a burst"),
    refused("a sequence in time", put(FAST, {"motion": SEQUENCE}), "is moved by a burst"),
    *(
        refused(f"a {told['motion']['kind']} without {key}", without(told, f"motion.{key}"), "is missing")
        for told in (DELAY, FAST, GROWS)
        for key in told["motion"]
        if key != "kind"
    ),
]
