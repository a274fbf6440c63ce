"""A motion that a one-sided wall keeps up for ever.

G = (2z + 0.92)/(z² − z/2), gap −1: from K = 175/192 on there are motions of three samples, one or two of them
inside; at 175/192 a sample stands on the surface.  A hand of spring and damper: where a sample comes
to the surface was bisected on the positions of the exact hold, in 30 digits.
1/(z − ½), gap −1, a sample inside and one not: x(0) = −2K/(3 + 2K) and x(1) = 2 x(0), below −1 for K > 3/2.
"""

from __future__ import annotations

from typing import Any

from . import TINY, Fraction, accepted, put, refused, without
from .absolute import ONE_POLE, SIX

LIMIT, HAIR = Fraction(175, 192), Fraction(1, 10**60)


def six(slope: Any, *inside: bool, **more: Any) -> Any:
    """The plant of two poles."""
    return {"kind": "vibration", "plant": SIX, "slope": slope, "gap": "-1", "inside": list(inside), **more}


def hand(slope: Any, gap: Any, inside: int, samples: int, **loop: Any) -> Any:
    """Device and hand, the first samples inside."""
    pattern = [True] * inside + [False] * (samples - inside)
    return {"kind": "vibration", "loop": loop, "slope": slope, "gap": gap, "inside": pattern}


HEAVY = {
    "mass_kg": "3/2", "damping_N_s_per_m": "0.1", "hand_mass_kg": "1/2", "hand_damping_N_s_per_m": "0.15",
    "hand_stiffness_N_per_m": 3, "sample_period_s": 1, "delay_s": "1/4",
}  # fmt: skip
LIGHT = {
    **HEAVY,
    "mass_kg": 1,
    "hand_mass_kg": 0,
    "damping_N_s_per_m": "0.1",
    "hand_damping_N_s_per_m": 0,
    "hand_stiffness_N_per_m": 1,
    "delay_s": 0,
}
LATE = {**LIGHT, "hand_damping_N_s_per_m": "0.1", "hand_stiffness_N_per_m": 2, "delay_s": "3/2"}
LIMITS = {  # the slope from which on the pattern is one of the wall
    "1.81627437453474": (1, 1, 5, HEAVY),
    "1.650652264572836": (1, 1, 6, LIGHT),
    "2.239682460506923": (1, 1, 5, LATE),
    "0.9308975163864071": (-1, 2, 5, LATE),
}
NOT = "is not one of the wall"
ONE, TWO = six("0.92", True, False, False), six("0.92", True, True, False)
POLE = put(six(2, True, False), {"plant": ONE_POLE})

CASES = [
    accepted(
        "one sample inside",
        ONE,
        "slope 0.92, -1 off the hand's rest, vibrates for ever: rounds of 3 samples, 1 inside",
        shows="unstable",
        hands="known",
        contact="made and broken",
        encoder="ideal",
        force_limit=False,
        force_steps=False,
        fed_with="",
    ),
    accepted("two samples inside", TWO, "rounds of 3 samples, 2 inside"),
    *(
        case
        for name, pattern in (("one", (True, False, False)), ("two", (True, True, False)))
        for case in (
            accepted(f"just above the limit, {name}", six(LIMIT + HAIR, *pattern)),
            refused(f"at the limit, {name}", six(LIMIT, *pattern), NOT),
            refused(f"just below the limit, {name}", six(LIMIT - HAIR, *pattern), NOT),
        )
    ),
    accepted(
        "above the limit by less than 256 bits tell",
        six(LIMIT + Fraction(1, 10**100), True, False, False),
        "vibrates for ever",
    ),
    refused(
        "a plant of too high an order",
        put(ONE, {"plant.denominator": [1, *[0] * 61]}),
        "order of G(z) is too high",
    ),
    accepted("one pole", put(POLE, {"slope": Fraction(3, 2) + HAIR}), "rounds of 2 samples, 1 inside"),
    refused("one pole, at the limit", put(POLE, {"slope": "3/2"}), NOT),
    refused("one pole, below the limit", put(POLE, {"slope": Fraction(3, 2) - HAIR}), NOT),
    refused(
        "every motion of two samples goes on, and none is told",
        put(POLE, {"plant": {"numerator": [0], "denominator": [1, 0, -1]}}),
        NOT,
    ),
    accepted("begun a sample later", six("0.92", False, False, True)),
    accepted("twice round", six("0.92", *[True, False, False] * 2)),
    accepted("another gap", put(ONE, {"gap": "-0.0371"})),
    refused("off the wall", put(ONE, {"gap": "0.0371"}), NOT),
    refused("at the surface", put(ONE, {"gap": 0}), NOT),
    accepted("D is scaled", put(ONE, {"plant": {"numerator": [4, "1.84"], "denominator": [2, -1, 0]}})),
    refused("D is scaled alone", put(ONE, {"plant.denominator": [2, -1, 0]}), NOT),
    refused("another pattern", six("0.92", True, False), NOT),
    refused("a longer pattern", six("0.92", True, False, False, False), NOT),
    *(
        case
        for slope, (gap, inside, samples, loop) in LIMITS.items()
        for case in (
            accepted(
                f"a hand, from {slope} on", hand(Fraction(slope) * (1 + TINY), gap, inside, samples, **loop)
            ),
            refused(
                f"a hand, below {slope}",
                hand(Fraction(slope) * (1 - TINY), gap, inside, samples, **loop),
                NOT,
            ),
        )
    ),
    *(
        refused(f"a hand, {key} is {value}", put(hand(2, 1, 1, 5, **HEAVY), {f"loop.{key}": value}), phrase)
        for key, value, phrase in (
            ("mass_kg", "-1/2", "must be > 0"),
            ("hand_mass_kg", "-1/10", "must be ≥ 0"),
            ("damping_N_s_per_m", "-0.01", "must be ≥ 0"),
            ("hand_damping_N_s_per_m", "-0.01", "must be ≥ 0"),
            ("hand_stiffness_N_per_m", -1, "must be ≥ 0"),
            ("mass_kg", ["1.5", "1.6"], "mass_kg: expected a number"),
            ("sample_period_s", [1, 2], "sample_period_s: expected a number"),
        )
    ),
    refused(
        "a hand, an entry that no proof has",
        put(hand(2, 1, 1, 5, **HEAVY), {"loop.numerator": [1]}),
        "entries",
    ),
    refused("a hand and a plant", {**hand(2, 1, 1, 5, **HEAVY), "plant": SIX}, "loop is of no use here"),
    refused("all inside", six("0.92", True, True, True), "inside the wall and samples outside"),
    refused("none inside", six("0.92", False, False, False), "inside the wall and samples outside"),
    refused("numbers for true and false", {**ONE, "inside": [1, 0, 0]}, "must be true or false"),
    refused("one sample", six("0.92", True), "inside must"),
    refused("no list", {**ONE, "inside": "100"}, "inside must"),
    refused("1001 samples", six("0.92", *[True, False, False] * 333, True, False), "inside must"),
    refused("slope 0", put(ONE, {"slope": 0}), "slope must be > 0"),
    refused("slope below 0", put(ONE, {"slope": -1}), "slope must be > 0"),
    refused(
        "a plant that is not strictly proper", put(ONE, {"plant.numerator": [1, 2, 3]}), "strictly proper"
    ),
    refused("a plant without N", put(ONE, {"plant.numerator": []}), "numerator must have 1"),
    refused("a plant without D", put(ONE, {"plant.denominator": []}), "denominator must have 1"),
    refused(
        "a plant that begins with 0", put(ONE, {"plant.denominator": [0, 1, "-1/2", 0]}), "strictly proper"
    ),
    refused("neither plant nor loop", without(ONE, "plant"), "loop is missing"),
    *(
        refused(f"without {key}", without(ONE, key), "is missing")
        for key in ("slope", "gap", "inside", "plant.numerator", "plant.denominator")
    ),
]
