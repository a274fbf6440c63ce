"""Absolute stability:  Re{M (1 + K G)} + q₁ K Re{(1 − 1/z) G} + q₂ K [Re{(z − 1) G} − (K/2) |(z − 1) G|²]
> 0.

G = 1/(z − ½) has Re G = (c − ½)/(5/4 − c), least −2/3 at z = −1: K < 3/2; with q₁ = 1 the left side times
|D|² is
9/4 − 9K/2 there: K < ½.  Of the others the least m₀ was found from the frequency response, in 30 digits; a
touched
device has (M, B, k, T) and its force is late.
"""

from __future__ import annotations

from typing import Any

from . import TINY, Fraction, accepted, put, refused, without

ONE_POLE = {"numerator": ["1"], "denominator": ["1", "-1/2"]}
SIX = {"numerator": ["2", "0.92"], "denominator": ["1", "-0.5", "0"]}
KEYS = {
    "mass_kg": "1/2", "damping_N_s_per_m": 2, "hand_mass_kg": "3/2", "hand_damping_N_s_per_m": 3,
    "hand_stiffness_N_per_m": 3, "sample_period_s": "1/2",
}  # fmt: skip
TOUCHED = {**KEYS, "delay_s": "5/8"}
FAST = {
    "mass_kg": "0.04", "damping_N_s_per_m": "0.7", "hand_mass_kg": "0.02", "hand_damping_N_s_per_m": "0.3",
    "hand_stiffness_N_per_m": 350, "sample_period_s": "0.001", "delay_s": "0.0014",
}  # fmt: skip


def wall(
    slope: Any,
    center: Any = 1,
    taps: Any = None,
    convex: Any = 0,
    smooth: Any = 0,
    kind: str = "monotone",
    **of: Any,
) -> Any:
    """A document of a plant or of a loop, a first-order plant if neither is given."""
    return {
        "kind": "absolute stability",
        **(of or {"plant": ONE_POLE}),
        "nonlinearity": kind,
        "slope": slope,
        "center": center,
        "taps": [{"place": place, "weight": weight} for place, weight in (taps or {}).items()],
        "convexity": convex,
        "smoothness": smooth,
    }


CENTERS = {  # the least m₀
    "2.422522040751925": wall("0.3", None, None, 3, 0, plant=SIX),
    "0.6233618008467783": wall("0.3", None, {-2: "0.6"}, "0.1", "0.2", plant=SIX),
    "0.00091559028796048849": wall(10, None, {1: "0.0001", -2: "0.00005"}, 1, 2, loop=FAST),
    "0.00164630258321338402": wall(10, None, {1: "0.0001", -2: "0.00005"}, 3, 2, loop=FAST),
    "0.48435811904654049": wall(1, None, {1: "1/8", -2: "1/16"}, 5, 2, loop=TOUCHED),
    "0.45731541643598951": wall(1, None, None, 5, 2, loop=TOUCHED),
    "0.55371872783007375": wall(1, None, {1: "1/8"}, 5, 0, loop={**KEYS, "delay_s": 1}),
}
NOT = "is not positive where"
POLE = wall(Fraction(3, 2) - TINY)
WORDED = wall("0.3", 1, {2: "0.3", -1: "0.2"}, plant=SIX)
HAND = wall(1, 1, loop=TOUCHED)

CASES = [
    accepted("taps", WORDED),  # the first: `shown.txt` has its rows, and none of a tap
    accepted(
        "one pole",
        POLE,
        "every monotone wall with slopes between 0 and 1.49999 brings the loop to rest",
        shows="stable",
        hands="known",
        contact="made and broken",
        encoder="ideal",
        force_limit=False,
        force_steps=False,
        fed_with="",
    ),
    refused("one pole, K = 3/2", put(POLE, {"slope": "3/2"}), NOT),
    refused("one pole, more than 3/2", put(POLE, {"slope": "1.51"}), NOT),
    accepted("q₁ = 1, K = ½", wall(Fraction(1, 2) - TINY, convex=1)),
    refused("q₁ = 1, K = ½ and no less", wall("1/2", convex=1), NOT),
    accepted("D is scaled", put(POLE, {"plant.numerator": [2], "plant.denominator": [2, -1]})),
    refused("D is scaled alone", put(POLE, {"plant.denominator": ["1/2", "-1/4"]}), NOT),
    *(
        case
        for center, told in CENTERS.items()
        for case in (
            accepted(f"m₀ = {center}", put(told, {"center": Fraction(center) * (1 + TINY)})),
            refused(f"m₀ = {center}, less", put(told, {"center": Fraction(center) * (1 - TINY)}), NOT),
        )
    ),
    accepted(
        "negative taps of an odd wall",
        wall("0.2", 1, {2: "-0.3", -1: "0.2"}, kind="odd monotone", plant=SIX),
        "every odd monotone wall",
    ),
    refused(
        "negative taps of a wall that is not odd",
        wall("0.2", 1, {2: "-0.3", -1: "0.2"}, plant=SIX),
        "no negative tap",
    ),
    accepted("a tap of 0", wall("0.2", 1, {2: 0}, plant=SIX)),
    refused("the taps weigh as much as the center", put(WORDED, {"center": "1/2"}), "less than the center"),
    accepted("the taps weigh just less", put(WORDED, {"center": "0.500000001", "slope": "0.01"})),
    refused(
        "negative taps weigh, too",
        wall("0.01", "0.5", {2: "-0.3", -1: "0.2"}, kind="odd monotone", plant=SIX),
        "less than the center",
    ),
    refused("another nonlinearity", put(POLE, {"nonlinearity": "any"}), "must be"),
    refused("slope 0", put(POLE, {"slope": 0}), "slope must be > 0"),
    refused("slope below 0", put(POLE, {"slope": "-1/10"}), "slope must be > 0"),
    refused("convexity below 0", put(POLE, {"convexity": "-1/10"}), "must be ≥ 0"),
    refused("smoothness below 0", put(POLE, {"smoothness": "-1/10", "slope": "1/10"}), "must be ≥ 0"),
    refused("a tap at 0", put(WORDED, {"taps.0.place": 0}), "a place of its own"),
    refused("two taps at one place", put(WORDED, {"taps.0.place": -1}), "a place of its own"),
    refused("a tap at 201", put(WORDED, {"taps.0.place": 201}), "place must be ≤ 200"),
    refused("a tap at −201", put(WORDED, {"taps.0.place": -201}), "taps[0].place must be ≥ -200"),
    accepted("taps at 200 and −200", wall("0.01", 1, {200: "0.1", -200: "0.1"})),
    refused("taps that are no list", put(WORDED, {"taps": {}}), "taps must be a list"),
    refused("a plant and a loop", {**POLE, "loop": TOUCHED}, "loop is of no use here"),
    refused("neither plant nor loop", without(POLE, "plant"), "loop is missing"),
    refused("a plant that is not strictly proper", put(POLE, {"plant.numerator": [1, 1]}), "strictly proper"),
    refused("a plant without N", put(POLE, {"plant.numerator": []}), "plant.numerator must have"),
    refused(
        "a plant that begins with 0", put(POLE, {"plant.denominator": [0, 1, "-1/2"]}), "strictly proper"
    ),
    refused("a pole at 1", wall("1/10", plant={"numerator": [1], "denominator": [1, -1]}), "pole outside"),
    refused("a pole at 2", wall("1/10", plant={"numerator": [1], "denominator": [1, -2]}), "pole outside"),
    # G = z⁻² … of 1/(z² + 1/4)
    accepted("N = 0", wall(99, plant={"numerator": [0], "denominator": [1, "1/2"]})),
    *(
        refused(f"{key} is {value}", put(HAND, {f"loop.{key}": value}), "must be")
        for key, value in (
            ("mass_kg", 0),
            ("mass_kg", "-1/10"),
            ("hand_mass_kg", "-1/10"),
            ("damping_N_s_per_m", "-1/10"),
            ("hand_damping_N_s_per_m", "-1/10"),
            ("hand_stiffness_N_per_m", 0),
            ("hand_stiffness_N_per_m", -1),
            ("sample_period_s", 0),
            ("sample_period_s", "-1/10"),
            ("delay_s", "-1/10"),
        )
    ),
    refused(
        "no damping at all",
        put(HAND, {"loop.damping_N_s_per_m": 0, "loop.hand_damping_N_s_per_m": 0}),
        "must be > 0",
    ),
    accepted(
        "the hand's damping is enough",
        put(HAND, {"loop.damping_N_s_per_m": 0, "loop.hand_damping_N_s_per_m": 5, "slope": "1/10"}),
    ),
    refused("an entry of the loop that no proof has", put(HAND, {"loop.numerator": [1]}), "entries"),
    refused("too fast for the series", put(HAND, {"loop.sample_period_s": 20}), "too far within one sample"),
    *(
        refused(f"without {key}", without(WORDED, key), "is missing")
        for key in (
            "nonlinearity",
            "slope",
            "center",
            "taps",
            "convexity",
            "smoothness",
            "taps.0.place",
            "taps.0.weight",
        )
    ),
]
