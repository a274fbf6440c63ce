"""A hand of activity a: the loop with b − a is passive, or the criterion holds with b everywhere and b_in
in a band.

b_in = b − a, or b (b − a)/(b − a θ²/12) for a > b; the band ends at f₀, 2π f₀ T ≤ θ, and cos θ ≥ c₀.
K = 2 a sample late: 4 (1 − c) with b_in = 3.  3 − ζ: 2b − 2 + 2c, which is 2c − 1 with b_in = ½, ≥ 0 from
c₀ = ½ on.
"""

from __future__ import annotations

from importlib import import_module
from typing import Any

from . import TINY, Case, Fraction, accepted, edge, put, refused, without
from .contact import DAMPED, FILTERED
from .linear import (
    AT_MINUS_ONE,
    AT_ONE,
    CONSTANT,
    DAMPER,
    LATE_SPRING,
    ON_CIRCLE,
    PARTLY,
    SPRING,
    linear,
    signs,
)
from .multiplier_contact import WALL
from .quantized import norm, quantized
from .relaxing_contact import ONE
from .spring import spring


def everywhere(reduced: Any, activity: Any = 1) -> Any:
    """With the activity added to the damping of what is proved."""
    more = put(
        reduced,
        {"loop.damping_N_s_per_m": Fraction(reduced["loop"]["damping_N_s_per_m"]) + Fraction(activity)},
    )
    return {
        "kind": "active hand",
        "loop": more["loop"],
        "activity_N_s_per_m": activity,
        "proof": {"reduced": reduced},
    }


def banded(
    told: Any, damping: Any, positivity: Any, activity: Any, band: Any, angle: Any, cosine: Any, below: Any
) -> Any:
    """The criterion with `damping` everywhere, and in the band what is left of it."""
    proof = {
        "stability": {"kind": "open loop"},
        "positivity": positivity,
        "angle": angle,
        "cosine": cosine,
        "in_band": band,
    }
    loop = {**told["loop"], "damping_N_s_per_m": damping}
    return {
        "kind": "active hand",
        "loop": loop,
        "activity_N_s_per_m": activity,
        "below_Hz": below,
        "proof": proof,
    }


# a quarter of the way to the rate's half: θ = 2π/8 with the π of the checker, a unit of its last digit above
ANGLE = 2 * Fraction(31415926535897932385, 10**19) / 8
LATE = banded(LATE_SPRING, 4, signs([6, -4]), 1, AT_ONE, ANGLE, "0.707", "1/8")
THIRD = {"angle": "1.04719755", "cosine": "1/2", "below": "0.16666666"}
DAMPS = banded(DAMPER, 2, AT_MINUS_ONE, "3/2", AT_MINUS_ONE, **THIRD)
# 1 − ζ: 2b + 2c, b = 1; θ = 21/20, c₀ = 0.49, b_in = −0.49: 1 − a = −0.49 (1 − a θ²/12)
MOST = Fraction("1.49") / (1 + Fraction("0.49") * Fraction(21, 20) ** 2 / 12)
BARE = put(DAMPER, {"loop.numerator": [1, -1]})
MORE = banded(BARE, 1, AT_MINUS_ONE, MOST, AT_MINUS_ONE, "21/20", "0.49", "0.167")
COUNTED = put(LATE, {"loop.resolution_m": 1, "loop.coulomb_friction_N": 1, "proof.norm": norm(top=[2])})
WRONG, NARROW = "do not multiply", "narrower than what is said"
FULL = banded(SPRING, 2, CONSTANT, "1/2", signs(square=()), "3.2", -1, "1/2")
CLOSE = put(FULL, {"proof.angle": "3.14", "below_Hz": "0.4997"})
# no law: 2b everywhere, and 0 where the hand gives out what b takes
IDLE = banded(linear(1, CONSTANT, [0]), 1, CONSTANT, 1, signs(square=()), 4, -1, "1/2")
REDUCED = everywhere(spring(4))


def least_cosines() -> str:
    """Below the cosine by 10⁻¹⁶ at most, by twice as many terms of the series; −1 beyond π."""
    least = import_module("zwidth.checker.active_hand")._least_cosine
    for k in range(1, 33):
        x, cosine, term = Fraction(k, 8), Fraction(0), Fraction(1)
        for n in range(32):
            cosine, term = cosine + term, -term * x**2 / ((2 * n + 1) * (2 * n + 2))
        wanted = cosine if k < 26 else Fraction(-1)
        if not max(Fraction(-1), wanted - Fraction(1, 10**16)) <= least(x) <= wanted:
            return f"{float(least(x))} up to {x}"
    near = Fraction(31415926535897932384, 10**19) - Fraction(1, 10**25)
    return "" if least(near) >= -1 else "below −1"


CASES = [
    accepted(
        "a spring",
        REDUCED,
        "with the activity taken from the damping",
        shows="passive",
        hands="activity",
        contact="made and broken",
        encoder="ideal",
        force_limit=False,
        force_steps=False,
        fed_with="",
    ),
    accepted("no activity", everywhere(spring(4), 0)),
    *(
        accepted(
            f"by a proof of {told['kind']}, {place}",
            everywhere(told),
            hands="activity",
            contact=touched,
            encoder=encoder,
        )
        for place, (told, touched, encoder) in enumerate(
            (
                (SPRING, "kept", "ideal"),
                (quantized(SPRING, norm(top=[3]), 2, 3), "kept", "counted"),
                (DAMPED, "made and broken", "counted"),
                (FILTERED, "made and broken", "counted"),
                (ONE, "made and broken", "counted"),
                (WALL, "made and broken", "counted"),
                (ON_CIRCLE, "kept", "ideal"),
                (PARTLY, "kept", "ideal"),
            )
        )
    ),
    refused("more activity", put(REDUCED, {"activity_N_s_per_m": 1 + TINY}), "is not this one"),
    refused("less activity", put(REDUCED, {"activity_N_s_per_m": 1 - TINY}), "is not this one"),
    refused("another loop", put(REDUCED, {"loop.coulomb_friction_N": 1}), "is not this one"),
    refused("what is left is not enough", everywhere(spring(4 - TINY)), "damping is below"),
    refused("an activity below 0", everywhere(spring(4), "-1/2"), "activity_N_s_per_m must be ≥ 0"),
    refused(
        "an activity below 0 in a band",
        put(LATE, {"activity_N_s_per_m": -1}),
        "activity_N_s_per_m must be ≥ 0",
    ),
    refused(
        "by a proof of delays",
        everywhere({**SPRING, "kind": "delays"}),
        "proof.reduced.kind must be spring or",
    ),
    refused(
        "by a proof of something else",
        everywhere({**SPRING, "kind": "violation"}),
        "proof.reduced.kind must be spring or",
    ),
    accepted(
        "a band",
        LATE,
        "b − a in the band",
        shows="passive",
        hands="activity",
        contact="kept",
        encoder="ideal",
        force_limit=False,
        force_steps=False,
        fed_with="",
    ),
    refused("a band, more activity", put(LATE, {"activity_N_s_per_m": 1 + TINY}), WRONG),
    refused("a band, less damping", put(LATE, {"loop.damping_N_s_per_m": 4 - TINY}), WRONG),
    refused("a wider band", put(LATE, {"below_Hz": "0.1250000001"}), NARROW),
    refused("a smaller angle", put(LATE, {"proof.angle": ANGLE - Fraction(1, 10**15)}), NARROW),
    refused(
        "an angle of π from below",
        put(LATE, {"proof.angle": 2 * Fraction(31415926535897932384, 10**19) / 8}),
        NARROW,
    ),
    # cos 3.1 = −0.99913515027327946449…
    accepted(
        "c₀ just below cos 3.1",
        put(
            FULL,
            {
                "proof.angle": "3.1",
                "proof.cosine": "-0.9991351502732794646",
                "below_Hz": "0.49",
                "proof.in_band": signs(square=()),
            },
        ),
    ),
    refused(
        "c₀ just above cos 3.1",
        put(
            FULL,
            {
                "proof.angle": "3.1",
                "proof.cosine": "-0.9991351502732794644",
                "below_Hz": "0.49",
                "proof.in_band": signs(square=()),
            },
        ),
        NARROW,
    ),
    # cos 3.14 = −0.99999873172753954528…
    *edge(
        "c₀ just below cos 3.14",
        put(CLOSE, {"proof.cosine": "-0.9999987317275395454"}),
        put(CLOSE, {"proof.cosine": "-0.9999987317275395452"}),
        NARROW,
    ),
    # 1 + cos 3.141592653 = 1.74 · 10⁻¹⁹
    accepted(
        "c₀ next to −1", put(CLOSE, {"proof.angle": "3.141592653", "proof.cosine": "-0.9999999999999999999"})
    ),
    accepted("a larger angle", put(LATE, {"proof.angle": "0.78539817", "proof.cosine": "0.70710677"})),
    accepted("c₀ just below cos θ", put(LATE, {"proof.cosine": "0.7071067811"})),
    refused("c₀ just above cos θ", put(LATE, {"proof.cosine": "0.7071067812"}), NARROW),
    refused("c₀ below −1", put(LATE, {"proof.cosine": "-1.0001"}), "proof.cosine must be ≥ -1"),
    accepted(
        "T = ½",
        put(
            LATE,
            {
                "loop.sample_period_s": "1/2",
                "loop.delay_s": "1/2",
                "loop.damping_N_s_per_m": 2,
                "activity_N_s_per_m": "1/2",
                "below_Hz": "1/4",
            },
        ),
    ),
    refused(
        "T = ½ and a wider band",
        put(
            LATE,
            {
                "loop.sample_period_s": "1/2",
                "loop.delay_s": "1/2",
                "loop.damping_N_s_per_m": 2,
                "activity_N_s_per_m": "1/2",
                "below_Hz": "0.2500000001",
            },
        ),
        NARROW,
    ),
    *edge("a damper", DAMPS, put(DAMPS, {"activity_N_s_per_m": Fraction(3, 2) + TINY}), WRONG),
    refused("a damper, c₀ is less", put(DAMPS, {"proof.cosine": "0.4999999"}), WRONG),
    *edge("more activity than damping", MORE, put(MORE, {"activity_N_s_per_m": MOST + TINY}), WRONG),
    refused(
        "so much that none is left",
        put(MORE, {"activity_N_s_per_m": 12 / Fraction(21, 20) ** 2}),
        "so wide a band",
    ),
    accepted("all frequencies: b − a", FULL),
    refused(
        "all frequencies, more activity", put(FULL, {"activity_N_s_per_m": Fraction(1, 2) + TINY}), WRONG
    ),
    refused("more than half the rate", put(FULL, {"below_Hz": "0.5000000001"}), "at most at half the rate"),
    refused("a band that ends at 0", put(LATE, {"below_Hz": 0}), "below_Hz must be > 0"),
    refused("a band that ends below 0", put(LATE, {"below_Hz": -1}), "below_Hz must be > 0"),
    # beyond π the cosine rises: nothing but −1 is below it
    refused("beyond π", put(FULL, {"proof.cosine": "-0.9"}), NARROW),
    refused("an angle above 4", put(FULL, {"proof.angle": "4.0001"}), "proof.angle must be ≤ 4"),
    *edge("as much activity as damping", IDLE, put(IDLE, {"activity_N_s_per_m": 1 + TINY}), "so wide a band"),
    accepted("an angle of 4", put(FULL, {"proof.angle": 4})),
    refused(
        "an angle of many digits",
        put(LATE, {"proof.angle": f"0.78539817{'0' * 1300}1"}),
        "the band has too many digits",
    ),
    *edge(
        "a band, an encoder",
        COUNTED,
        put(COUNTED, {"loop.coulomb_friction_N": 1 - TINY}),
        "below ‖h‖₁ Δ/2",
        encoder="counted",
    ),
    refused("the criterion with b fails", put(LATE, {"proof.positivity": CONSTANT}), WRONG),
    refused("part of a sample", put(LATE, {"loop.delay_s": "5/4"}), "whole samples"),
    refused("steps without a norm", without(COUNTED, "proof.norm"), "norm is missing"),
    refused(
        "a closed loop",
        put(LATE, {"proof.stability": {"kind": "closed loop", "offset": 1}}),
        "stable by themselves",
    ),
    refused(
        "H(1) < 0",
        put(LATE, {"loop.numerator": [-2], "proof.positivity": signs([10, 4])}),
        "H(1) is negative",
    ),
    *(
        refused(f"without {key}", without(LATE, key), phrase)
        for key, phrase in (
            ("below_Hz", "below_Hz is missing"),
            ("activity_N_s_per_m", "activity_N_s_per_m is missing"),
            ("proof", "proof is missing"),
            ("proof.in_band", "in_band is missing"),
            ("proof.cosine", "cosine is missing"),
        )
    ),
    Case("the least cosine up to an angle", least_cosines, ""),
]
