"""A relaxing law touched and left: K + Σ g (1 − ζ)/(1 − p ζ).

Fed with the penetration, no delay, every g > 0 and 0 ≤ p < 1, one part at most if it never pulls:
b ≥ K T/2 + Σ g T/(1 + p).  Otherwise b ≥ (2d + 1) K T/2 + T Σ |g|/(1 − |p|).
2 f_c ≥ (K + Σ |g| n) Δ, n = 2, or 2/(1 − |p|) for p < 0.
"""

from __future__ import annotations

from typing import Any

from . import TINY, Fraction, accepted, edge, loop, put, refused, without


def relaxing(
    parts: Any, numerator: Any, denominator: Any, fed: str = "penetration", pulls: bool = True, **device: Any
) -> Any:
    """K = 4 N/m, T = ½ s and parts as (p, g)."""
    listed = [{"pole": pole, "stiffness_N_per_m": g} for pole, g in parts]
    law = {"stiffness_N_per_m": 4, "parts": listed, "fed_with": fed, "never_pulls": not pulls}
    return {
        "kind": "relaxing contact",
        "loop": loop(numerator, denominator, **{"sample_period_s": "1/2", **device}),
        "law": law,
    }


# p = ½, g = 3: (7 − 5ζ)/(1 − ζ/2); b ≥ 1 + 1, 2 f_c ≥ 10 Δ; otherwise b ≥ 1 + 3
ONE = relaxing([("1/2", 3)], [7, -5], [1, "-1/2"], damping_N_s_per_m=2, coulomb_friction_N=5, resolution_m=1)
POSITION = put(ONE, {"law.fed_with": "position", "loop.damping_N_s_per_m": 4})
# p = −½, g = 3: (7 − ζ)/(1 + ζ/2); b ≥ 1 + 3, 2 f_c ≥ (4 + 12) Δ
SWINGS = relaxing(
    [("-1/2", 3)], [7, -1], [1, "1/2"], damping_N_s_per_m=4, coulomb_friction_N=8, resolution_m=1
)
# p = ½, g = −3: (1 + ζ)/(1 − ζ/2); b ≥ 1 + 3, 2 f_c ≥ 10 Δ
SOFTENS = relaxing(
    [("1/2", -3)], [1, 1], [1, "-1/2"], damping_N_s_per_m=4, coulomb_friction_N=5, resolution_m=1
)
# p = ½ and 0, g = 3 and 2: 4 + 3 (1 − ζ)/(1 − ζ/2) + 2 (1 − ζ) = (9 − 8ζ + ζ²)/(1 − ζ/2); b ≥ 1 + 1 + 1,
# else 1 + 3 + 1
TWO = relaxing(
    [("1/2", 3), (0, 2)],
    [9, -8, 1],
    [1, "-1/2", 0],
    damping_N_s_per_m=3,
    coulomb_friction_N=7,
    resolution_m=1,
)
# p = ½ and −½, g = 3 and 3: (10 − 6ζ − ζ²)/(1 − ζ²/4); b ≥ 1 + 3 + 3
BOTH = relaxing([("1/2", 3), ("-1/2", 3)], [10, -6, -1], [1, 0, "-1/4"])
LESS, FRICTION, OTHER = "damping is below", "below ‖h‖₁ Δ/2", "is not the law"


def damped(name: str, document: Any, needed: Any, **changes: Any) -> Any:
    """The damping that is needed, and less."""
    told = put(
        document, {"loop.damping_N_s_per_m": needed, **{k.replace("__", "."): v for k, v in changes.items()}}
    )
    return edge(name, told, put(told, {"loop.damping_N_s_per_m": needed - TINY}), LESS)


CASES = [
    accepted(
        "one part",
        ONE,
        "fed with the penetration, with contact",
        shows="passive",
        hands="every",
        contact="made and broken",
        encoder="counted",
        force_limit=False,
        force_steps=False,
        fed_with="penetration",
    ),
    accepted("fed with the position", POSITION, "fed with the position, with contact", fed_with="position"),
    accepted(
        "it never pulls",
        put(ONE, {"law.never_pulls": True}),
        "fed with the penetration, that never pulls, with contact",
    ),
    *damped("one part that relaxes", ONE, 2),
    *damped("one part that never pulls", ONE, 2, law__never_pulls=True),
    *damped("fed with the position, it takes more", POSITION, 4),
    *damped("late, it takes more", ONE, 8, loop__delay_s="1"),
    *damped("a pole below 0 takes more", SWINGS, 4),
    *damped("a part below 0 takes more", SOFTENS, 4),
    *damped("beside a pole below 0 a part takes more", BOTH, 7),
    *damped("two parts", TWO, 3),
    *damped("two parts that never pull take more", TWO, 5, law__never_pulls=True),
    *damped("no part", relaxing([], [4], [1]), 1),
    *damped("no part that never pulls", relaxing([], [4], [1], pulls=False), 1),
    *(
        case
        for name, document, needed in (
            ("one part", ONE, 5),
            ("a pole below 0", SWINGS, 8),
            ("a part below 0", SOFTENS, 5),
            ("two parts", TWO, 7),
        )
        for case in edge(
            f"friction, {name}", document, put(document, {"loop.coulomb_friction_N": needed - TINY}), FRICTION
        )
    ),
    # p = ½, g = ½ and −½: (9/2 − 5ζ/2)/(1 − ζ/2), b ≥ 1 + 1/6; (7/2 − 3ζ/2)/(1 − ζ/2), b ≥ 1 + ½
    *damped("a small part", relaxing([("1/2", "1/2")], ["9/2", "-5/2"], [1, "-1/2"]), Fraction(7, 6)),
    *damped(
        "a small part below 0", relaxing([("1/2", "-1/2")], ["7/2", "-3/2"], [1, "-1/2"]), Fraction(3, 2)
    ),
    # g = 0 is no part that relaxes, and needs nothing
    *damped("a part of 0", relaxing([("1/2", 0)], [4], [1]), 1),
    accepted("common factors", put(ONE, {"loop.numerator": [14, -10], "loop.denominator": [2, -1]})),
    refused("another pole", put(ONE, {"law.parts.0.pole": "1/3"}), OTHER),
    refused("another part", put(ONE, {"law.parts.0.stiffness_N_per_m": 2}), OTHER),
    refused("another stiffness", put(ONE, {"law.stiffness_N_per_m": 3}), OTHER),
    refused(
        "a longer law", put(ONE, {"loop.numerator": [7, -5, 1], "loop.denominator": [1, "-1/2", 0]}), OTHER
    ),
    refused("no surface", put(ONE, {"loop.unilateral": False}), "acts inside only"),
    refused(
        "part of a sample",
        put(ONE, {"loop.delay_s": "1/4", "loop.damping_N_s_per_m": 99}),
        "whole number of samples",
    ),
    refused(
        "K < 0",
        put(relaxing([], [-4], [1], damping_N_s_per_m=99), {"law.stiffness_N_per_m": -4}),
        "stiffness_N_per_m must be ≥ 0",
    ),
    accepted("K = 0", put(relaxing([], [0], [1]), {"law.stiffness_N_per_m": 0})),
    refused(
        "a pole at 1", relaxing([(1, 3)], [7, -7], [1, -1], damping_N_s_per_m=99), "parts[0].pole must be"
    ),
    refused(
        "a pole at −1", relaxing([(-1, 3)], [7, 1], [1, 1], damping_N_s_per_m=99), "parts[0].pole must be"
    ),
    refused(
        "a pole at 2", relaxing([(2, 3)], [7, -11], [1, -2], damping_N_s_per_m=99), "parts[0].pole must be"
    ),
    refused("fed with something else", put(ONE, {"law.fed_with": "force"}), "fed_with must be"),
    refused(
        "never_pulls is a word", put(ONE, {"law.never_pulls": "no"}), "never_pulls must be true or false"
    ),
    refused("parts that are no list", put(ONE, {"law.parts": {}}), "parts must be a list"),
    refused("61 parts", relaxing([(0, 0)] * 61, [4], [1], damping_N_s_per_m=99), "must have 0 to 60"),
    accepted("60 parts", relaxing([(0, 0)] * 60, [4], [1], damping_N_s_per_m=99)),
    refused("an entry of the law that no proof has", put(ONE, {"law.remark": 1}), "entries"),
    refused("an entry of a part that no proof has", put(ONE, {"law.parts.0.remark": 1}), "entries"),
    *(
        refused(f"without {key}", without(ONE, key), phrase)
        for key, phrase in (
            ("law", "law is missing"),
            ("law.parts", "parts is missing"),
            ("law.fed_with", "fed_with is missing"),
            ("law.never_pulls", "never_pulls is missing"),
            ("law.stiffness_N_per_m", "stiffness_N_per_m is missing"),
            ("law.parts.0.pole", "pole is missing"),
            ("law.parts.0.stiffness_N_per_m", "parts[0].stiffness_N_per_m is missing"),
        )
    ),
]
