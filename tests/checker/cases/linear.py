"""The criterion at every frequency, an ideal encoder:  2b/T |D|² − R + (1 + c) S ≥ 0, and stability.

With T = 1, by hand, c = cos θ:

    K                  2b − K                         K, a sample late     2b − K − 2K c
    K + B (1 − ζ)      2b − K + 2B c                  3 + ζ − ζ²           2b − 5 + 4c²
    1/(1 − ζ/2)        2b (5/4 − c) − 3/2             −1/(1 − 2ζ)          2b (5 − 4c) + 3
    −(1 − ζ)/(1 + ζ)   (2b − 1)(2 + 2c)

and with a part α of a sample, times b, K = 1:  2b² − b (1 + 2α c) − α (1 − α)/2.
"""

from __future__ import annotations

from typing import Any

from . import TINY, Fraction, accepted, edge, loop, put, refused, without


def signs(factor: Any = (1,), square: Any = (1,), at_one: int = 0, at_minus_one: int = 0) -> dict[str, Any]:
    """(1 − c)ⁱ (1 + c)ʲ s² g."""
    return {"at_one": at_one, "at_minus_one": at_minus_one, "square": list(square), "factor": list(factor)}


OPEN = {"kind": "open loop"}


def linear(
    damping: Any, positivity: Any, numerator: Any, denominator: Any = (1,), stable: Any = OPEN, **device: Any
) -> Any:
    """A document of an ideal encoder."""
    told = loop(numerator, denominator, damping_N_s_per_m=damping, **device)
    return {"kind": "linear", "loop": told, "proof": {"positivity": positivity, "stability": stable}}


def closed(offset: Any = "1") -> dict[str, Any]:
    return {"kind": "closed loop", "offset": offset}


AT_ONE, AT_MINUS_ONE, CONSTANT = signs(at_one=1), signs(at_minus_one=1), signs()
NOTHING = signs(square=())
WRONG = "do not multiply"
SPRING = linear(2, CONSTANT, [3])  # 2b − K = 1
LATE_SPRING = linear(3, AT_ONE, [2], delay_s=1)
DAMPER = linear(2, AT_MINUS_ONE, [3, -1], [1, 0])  # K = 2, B = 1
SQUARE = linear("5/2", signs(square=[0, 1]), [3, 1, -1], [1, 0, 0])
FILTER = linear(3, AT_ONE, [1, 0], [1, "-1/2"])
PARTLY = linear("15/16", AT_ONE, [1], delay_s="3/8")
# 1/(1 − ζ²/2): 2b (9/4 − 2c²) − 3/2 − c is (1 − c)(21 + 20c) with b = 5
TWO_POLES = linear(5, signs([21, 20], at_one=1), [1, 0, 0], [1, 0, "-1/2"])
UNSTABLE = linear("1/2", signs([8, -4]), [-1, 0], [1, -2])
ON_CIRCLE = linear("1/2", NOTHING, [-1, 1], [1, 1], closed())
LESS = -TINY

CASES = [
    accepted(
        "a spring",
        SPRING,
        "nonnegative at every frequency",
        shows="passive",
        hands="every",
        contact="kept",
        encoder="ideal",
        force_limit=False,
        force_steps=False,
        fed_with="",
    ),
    accepted("a spring at its limit: q is 0", linear("3/2", NOTHING, [3])),
    refused("a spring past its limit", linear(Fraction(3, 2) + LESS, CONSTANT, [3]), WRONG),
    refused("q is 0 and said to be 1", linear("3/2", CONSTANT, [3]), WRONG),
    refused("q is 1 and said to be 0", linear(2, NOTHING, [3]), WRONG),
    *edge("late: 1 − c", LATE_SPRING, put(LATE_SPRING, {"loop.damping_N_s_per_m": 3 + LESS}), WRONG),
    *edge("a damper: 1 + c", DAMPER, put(DAMPER, {"loop.damping_N_s_per_m": 2 + LESS}), WRONG),
    *edge("c²", SQUARE, put(SQUARE, {"loop.damping_N_s_per_m": "2.4999999999"}), WRONG),
    *edge("a filter: 1 − c", FILTER, put(FILTER, {"loop.damping_N_s_per_m": 3 + LESS}), WRONG),
    *edge("two poles", TWO_POLES, put(TWO_POLES, {"loop.damping_N_s_per_m": 5 + LESS}), WRONG),
    *edge("α = 3/8: 1 − c", PARTLY, put(PARTLY, {"loop.damping_N_s_per_m": Fraction(15, 16) + LESS}), WRONG),
    accepted(
        "T = ½ takes half the damping",
        put(
            LATE_SPRING,
            {"loop.damping_N_s_per_m": "3/2", "loop.sample_period_s": "1/2", "loop.delay_s": "1/2"},
        ),
    ),
    refused(
        "T = ½ and less",
        put(
            LATE_SPRING,
            {
                "loop.damping_N_s_per_m": Fraction(3, 2) + LESS,
                "loop.sample_period_s": "1/2",
                "loop.delay_s": "1/2",
            },
        ),
        WRONG,
    ),
    accepted("α = 3/8, T = 2, K = 3", linear("45/8", AT_ONE, [3], sample_period_s=2, delay_s="3/4")),
    accepted(
        "a factor that takes halving: c² + 1/1000",
        linear("2.5005", signs(["0.001", 0, 4]), [3, 1, -1], [1, 0, 0]),
    ),
    refused(
        "a factor that is 0 inside",
        linear("5/2", signs([0, 0, 4]), [3, 1, -1], [1, 0, 0]),
        "not positive where",
    ),
    refused(
        "a factor below 0 inside",
        linear("2.4995", signs(["-0.001", 0, 4]), [3, 1, -1], [1, 0, 0]),
        "not positive where",
    ),
    # 3 + 4ζ − ζ²: 2b − 8 − 6c + 4c² is least at c = ¾, 2b − 41/4
    accepted("a factor least at ¾", linear("5.126", signs(["2.252", -6, 4]), [3, 4, -1], [1, 0, 0])),
    refused(
        "a factor below 0 at ¾",
        linear("5.124", signs(["2.248", -6, 4]), [3, 4, -1], [1, 0, 0]),
        "not positive where",
    ),
    accepted("a factor least at −¾", linear("5.126", signs(["2.252", 6, 4]), [9, -2, -1], [1, 0, 0])),
    refused(
        "a factor below 0 at −¾",
        linear("5.124", signs(["2.248", 6, 4]), [9, -2, -1], [1, 0, 0]),
        "not positive where",
    ),
    refused("a factor that is 0 at 1", linear(3, signs([1, -1]), [2], delay_s=1), "not positive where"),
    refused("a factor that is 0 at −1", linear(2, signs([1, 1]), [3, -1], [1, 0]), "not positive where"),
    refused("below 0 at 1", linear("2.9", signs(["3.8", -4]), [2], delay_s=1), "not positive where"),
    refused("below 0 at −1", linear("1.9", signs(["1.8", 2]), [3, -1], [1, 0]), "not positive where"),
    refused("below 0 everywhere", linear(1, CONSTANT, [3]), WRONG),
    refused("below 0 everywhere, as it is", linear(1, signs([-1]), [3]), "not positive where"),
    refused("the square of another root", put(SQUARE, {"proof.positivity.square": [1, 1]}), WRONG),
    refused("1 − c counted twice", put(LATE_SPRING, {"proof.positivity.at_one": 2}), WRONG),
    refused("1 + c for 1 − c", put(LATE_SPRING, {"proof.positivity": AT_MINUS_ONE}), WRONG),
    refused(
        "no factor",
        put(SPRING, {"proof.positivity.factor": []}),
        "proof.positivity.factor must have 1 to 2000 entries",
    ),
    refused("at_one is not whole", put(LATE_SPRING, {"proof.positivity.at_one": "1/2"}), "whole number"),
    refused("at_one is below 0", put(LATE_SPRING, {"proof.positivity.at_one": -1}), "at_one must be ≥ 0"),
    refused("without proof.stability.kind", without(SPRING, "proof.stability.kind"), "an object with kind"),
    refused("another degree", put(SPRING, {"proof.positivity.factor": [1, 1]}), WRONG),
    refused("a far higher degree", put(SPRING, {"proof.positivity.factor": [1] * 9}), "higher degree"),
    refused("an encoder", put(SPRING, {"loop.resolution_m": "1/1000"}), "ideal encoder only"),
    accepted("no surface", put(SPRING, {"loop.unilateral": False}), contact="both sides"),
    *(
        refused(f"without {key}", without(SPRING, key), "is missing")
        for key in (
            "proof",
            "proof.positivity",
            "proof.stability",
            "proof.positivity.factor",
            "proof.positivity.square",
            "proof.positivity.at_one",
            "proof.positivity.at_minus_one",
        )
    ),
    # stability
    refused("H(1) < 0", linear("1/2", signs([2]), [-1]), "H(1) is negative"),
    refused("H(1) < 0 by the sign of D", linear("1/2", signs([2]), [1], [-1]), "H(1) is negative"),
    accepted("H(1) = 0", linear(2, signs([2, 1]), [1, -1], [1, 0])),
    refused("a pole at 2", UNSTABLE, "pole outside"),
    refused(
        "a pole at 2, in the closed loop", put(UNSTABLE, {"proof.stability": closed()}), "not positive real"
    ),
    # −1/(1 + 2ζ): M D̄ = −1 − 2ζ̄: q = g (5 + 4c) + 1 + 2c … − (1 + c)·2 = g (5 + 4c) − 1
    refused("a pole at −2", linear(1, signs([9, 8]), [-1, 0], [1, 2]), "pole outside"),
    refused("a pole at −1", put(ON_CIRCLE, {"proof.stability": OPEN}), "pole outside"),
    refused("a pole at 1", linear(2, AT_ONE, [0, 0], [1, -1]), "pole outside"),
    # D = 1 + ζ²: |D|² = 2 + 2 cos 2θ = 4c²
    refused("poles at ±j", linear(2, signs(square=[0, 1]), [0, 0, 0], [1, 0, 1]), "pole outside"),
    accepted("poles just inside", linear(0, NOTHING, [0, 0, 0], [1, 0, 1 + LESS])),
    refused("poles just outside", linear(0, NOTHING, [0, 0, 0], [1, 0, 1 + TINY]), "pole outside"),
    accepted("a pole just inside 1", linear(0, NOTHING, [0, 0], [1, -1 + TINY])),
    refused("a pole just outside 1", linear(0, NOTHING, [0, 0], [1, -1 - TINY]), "pole outside"),
    accepted("a pole just inside −1", linear(0, NOTHING, [0, 0], [1, 1 - TINY])),
    refused("a pole just outside −1", linear(0, NOTHING, [0, 0], [1, 1 + TINY]), "pole outside"),
    # (z − 0.9)(z − 0.8)(z + 0.7)(z² + 0.9), and with the pair at ±1.1j
    accepted(
        "five poles inside", linear(0, NOTHING, [0] * 6, [1, "-1", "0.43", "-0.396", "-0.4230", "0.4536"])
    ),
    refused(
        "two of five poles outside",
        linear(0, NOTHING, [0] * 6, [1, -1, "0.74", "-0.706", "-0.5687", "0.60984"]),
        "pole outside",
    ),
    refused("real poles at 2 and ½", linear(0, NOTHING, [0] * 3, [1, "-5/2", 1]), "pole outside"),
    refused("real poles at −2 and −½", linear(0, NOTHING, [0] * 3, [1, "5/2", 1]), "pole outside"),
    refused("real poles at 2 and −½", linear(0, NOTHING, [0] * 3, [1, "-3/2", -1]), "pole outside"),
    # (z − 2)(z − ½)(z² + ¼), and with −2
    refused(
        "one of four poles at 2",
        linear(0, NOTHING, [0] * 5, [1, "-5/2", "5/4", "-5/8", "1/4"]),
        "pole outside",
    ),
    refused(
        "one of four poles at −2",
        linear(0, NOTHING, [0] * 5, [1, "5/2", "5/4", "5/8", "1/4"]),
        "pole outside",
    ),
    accepted("a pole on the circle, in the closed loop", ON_CIRCLE),
    refused("its damping less", put(ON_CIRCLE, {"loop.damping_N_s_per_m": "0.499"}), WRONG),
    # (1 − ζ)/(1 + ζ): q = (2b + 1)(2 + 2c), with the root of n + g d at −(1 + 1/(b + g))
    refused("its sign turned", linear("1/2", AT_MINUS_ONE, [1, -1], [1, 1], closed()), "not positive real"),
    refused(
        "H(1) < 0 in the closed loop", linear("1/2", CONSTANT, [-1], stable=closed()), "not positive real"
    ),
    accepted("a spring in the closed loop", put(SPRING, {"proof.stability": closed("1/1000")})),
    refused("offset 0", put(SPRING, {"proof.stability": closed(0)}), "proof.stability.offset must be > 0"),
    refused(
        "offset below 0", put(SPRING, {"proof.stability": closed(-1)}), "proof.stability.offset must be > 0"
    ),
    refused("no offset", put(SPRING, {"proof.stability": {"kind": "closed loop"}}), "offset is missing"),
    refused(
        "part of a sample in the closed loop", put(PARTLY, {"proof.stability": closed()}), "part of a sample"
    ),
    # 3 (1 − ζ/2)/(1 − ζ/2)
    refused(
        "a common factor", linear(2, signs(["5/4", -1]), [3, "-3/2"], [1, "-1/2"], closed()), "common factor"
    ),
    accepted("late, in the closed loop", put(LATE_SPRING, {"proof.stability": closed()})),
    accepted("a filter in the closed loop", put(FILTER, {"proof.stability": closed()})),
    refused(
        "another kind of stability",
        put(SPRING, {"proof.stability.kind": "both"}),
        "proof.stability.kind must be open loop or closed loop",
    ),
    refused("no damping, and part of a sample", linear(0, CONSTANT, [1], delay_s="1/2"), WRONG),
    accepted("no damping and no law", linear(0, NOTHING, [0], delay_s="1/2")),
]
