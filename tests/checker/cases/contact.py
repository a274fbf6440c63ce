"""A damped wall touched and left: b ≥ (2d + 1) K T/2 + |B| Σ|w|  and  2 f_c ≥ (K + |B| ‖h_v‖₁) Δ; part of a
sample late b ≥ ½ (Q + √(Q² + α(1 − α) S²)) with Q = (2d + 1 + 2α) K T/2 + |B| Σ|w|, S = K T + 2 |B| Σ|w|.

H = K + B W(ζ) (1 − ζ)/T.  The weights (2, −1) have Σ|w| = 3 and ‖h_v‖₁ T = |2| + |−3| + |1| = 6; a pole p
has 1
and 2 (1 − p).
"""

from __future__ import annotations

from fractions import Fraction
from importlib import import_module
from typing import Any

from . import TINY, Case, accepted, edge, loop, plain, put, refused, without


def contact(k: Any, b: Any, weights: Any, numerator: Any, denominator: Any, **device: Any) -> Any:
    """A document with its law."""
    law = {"stiffness_N_per_m": k, "virtual_damping_N_s_per_m": b, "weights": weights}
    return {"kind": "contact", "loop": loop(numerator, denominator, **device), "law": law}


# T = ½: K + 2B (2 − 3ζ + ζ²)
DAMPED = contact(
    4, 3, [2, -1], [16, -18, 6], [1, 0, 0],
    damping_N_s_per_m=10, sample_period_s="1/2", coulomb_friction_N=20, resolution_m=1,
)  # fmt: skip
LATE = put(DAMPED, {"loop.delay_s": 1, "loop.damping_N_s_per_m": 14})
# T = ½, p = ¾: K + 2B (1 − ζ)/4/(1 − 3ζ/4)
FILTERED = contact(
    4, -3, {"pole": "3/4"}, ["5/2", "-3/2"], [1, "-3/4"],
    damping_N_s_per_m=4, sample_period_s="1/2", coulomb_friction_N=7, resolution_m=2,
)  # fmt: skip
# T = ½, half a sample late: Q = 4, S = 6, b = ½ (4 + √(4² + 6²/4)) = 9/2
HALF = contact(
    4, "2/3", [2, -1], ["20/3", -4, "4/3"], [1, 0, 0],
    damping_N_s_per_m="9/2", delay_s="1/4", sample_period_s="1/2", coulomb_friction_N=6, resolution_m=1,
)  # fmt: skip
LESS = "is below what hold"
OTHER = "is not the wall"


def weights_may_be_a_tuple() -> str:
    """As they may be in Python, and not in a file."""
    found = import_module("zwidth.checker").verify(put(plain(DAMPED), {"law.weights": (2, -1)}))
    return "" if found.valid else str(found.reason)


CASES = [
    Case("weights may be a tuple", weights_may_be_a_tuple, ""),
    refused("weights that are a number", put(DAMPED, {"law.weights": 2}), "must be a list or an object"),
    refused("weights that are a word", put(DAMPED, {"law.weights": "pole"}), "must be a list or an object"),
    *edge(
        "weights",
        DAMPED,
        put(DAMPED, {"loop.damping_N_s_per_m": 10 - TINY}),
        LESS,
        "cover this wall",
        shows="passive",
        hands="every",
        contact="made and broken",
        encoder="counted",
        force_limit=False,
        force_steps=False,
        fed_with="",
    ),
    *edge(
        "weights, the friction",
        DAMPED,
        put(DAMPED, {"loop.coulomb_friction_N": 20 - TINY}),
        "Coulomb friction is below",
    )[1:],
    *edge("two samples late", LATE, put(LATE, {"loop.damping_N_s_per_m": 14 - TINY}), LESS),
    *edge("a pole, B < 0", FILTERED, put(FILTERED, {"loop.damping_N_s_per_m": 4 - TINY}), LESS),
    refused(
        "a pole, B < 0, less friction",
        put(FILTERED, {"loop.coulomb_friction_N": 7 - TINY}),
        "Coulomb friction is below",
    ),
    accepted(
        "an ideal encoder",
        put(DAMPED, {"loop.resolution_m": 0, "loop.coulomb_friction_N": 0}),
        encoder="ideal",
    ),
    accepted(
        "common factors of N and D",
        put(DAMPED, {"loop.numerator": [16, -10, -3, 3], "loop.denominator": [1, "1/2", 0, 0]}),
    ),
    refused("another stiffness", put(DAMPED, {"law.stiffness_N_per_m": 3}), OTHER),
    refused("another damping", put(DAMPED, {"law.virtual_damping_N_s_per_m": 2}), OTHER),
    refused("the damping's sign", put(DAMPED, {"law.virtual_damping_N_s_per_m": -3}), OTHER),
    refused("other weights", put(DAMPED, {"law.weights": [1, 0]}), OTHER),
    refused("another pole", put(FILTERED, {"law.weights.pole": "1/2"}), OTHER),
    refused(
        "a law that is longer",
        put(DAMPED, {"loop.numerator": [16, -18, 6, 1], "loop.denominator": [1, 0, 0, 0]}),
        OTHER,
    ),
    refused("weights for nothing", put(DAMPED, {"law.weights": []}), OTHER),
    accepted("a spring and no weights", contact(4, 0, [], [4], [1], damping_N_s_per_m=2)),
    accepted("a spring and B = 0", contact(4, 0, [1], [4], [1], damping_N_s_per_m=2)),
    refused("no surface", put(DAMPED, {"loop.unilateral": False}), "acts inside only"),
    *edge("half a sample late", HALF, put(HALF, {"loop.damping_N_s_per_m": Fraction(9, 2) - TINY}), LESS),
    refused("half a sample late, undamped", put(HALF, {"loop.damping_N_s_per_m": 0}), LESS),
    refused("undamped", put(DAMPED, {"loop.damping_N_s_per_m": 0}), LESS),
    refused("K < 0", contact(-1, 0, [], [-1], [1], damping_N_s_per_m=9), "stiffness_N_per_m must be ≥ 0"),
    accepted("K = 0", contact(0, 0, [], [0], [1])),
    # p = 1: W = 0, nothing is damped
    refused(
        "a pole of 1",
        contact(4, 3, {"pole": 1}, [4, -4], [1, -1], damping_N_s_per_m=99),
        "law.weights.pole must be",
    ),
    refused(
        "a pole below 0",
        contact(4, 0, {"pole": "-1/2"}, [4], [1], damping_N_s_per_m=99),
        "law.weights.pole must be",
    ),
    accepted("a pole of 0", contact(4, 3, {"pole": 0}, [7, -3], [1, 0], damping_N_s_per_m=5)),
    *(
        refused(f"without {key}", without(DAMPED, key), phrase)
        for key, phrase in (
            ("law", "law is missing"),
            ("law.weights", "weights is missing"),
            ("law.stiffness_N_per_m", "stiffness_N_per_m is missing"),
            ("law.virtual_damping_N_s_per_m", "virtual_damping_N_s_per_m is missing"),
        )
    ),
    refused("a pole that is not there", put(FILTERED, {"law.weights": {}}), "pole is missing"),
]
