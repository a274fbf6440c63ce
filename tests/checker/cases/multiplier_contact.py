"""A law fed with the position, touched and left: 4 λ κ |D|² ≥ |D − λ ζ^{d+1} N_G|², κ = b/T − (2d + 1) K/2,
H = K + (1 − ζ) N_G/D with K = H(1);  2 f_c ≥ (K + ‖H − K‖₁) Δ.

N_G = g, D = 1, λ = 1/g:  |1 − ζ|² = 2 − 2c, so that 4κ/g − 2 + 2c ≥ 0 takes κ = g;  a sample late |1 −
ζ²|² = 4 − 4c².
"""

from __future__ import annotations

from typing import Any

from . import TINY, accepted, edge, loop, put, refused, without
from .linear import signs
from .quantized import norm

LAW = {"fed_with": "position", "never_pulls": True}


def multiplier(
    numerator: Any, denominator: Any, positivity: Any, bound: Any, factor: Any = 1, **device: Any
) -> Any:
    """A document with λ = `factor`."""
    proof = {"multiplier": factor, "positivity": positivity, "norm": bound}
    return {
        "kind": "multiplier contact",
        "loop": loop(numerator, denominator, **device),
        "law": LAW,
        "proof": proof,
    }


# K = 2, N_G = 1: b = 1 + 1; ‖1 − ζ‖₁ = 2; the proof 4κ − 2 + 2c is 2 + 2c
WALL = multiplier(
    [3, -1], [1, 0], signs(at_minus_one=1), norm(top=[1, -1]),
    damping_N_s_per_m=2, coulomb_friction_N=2, resolution_m=1,
)  # fmt: skip
# N_G = 2 with λ = ½, T = ½: b/T = 1 + 2
STIFF = multiplier(
    [4, -2], [1, 0], signs(at_minus_one=1), norm(top=[2, -2]), "1/2",
    damping_N_s_per_m="3/2", coulomb_friction_N=3, resolution_m=1, sample_period_s="1/2",
)  # fmt: skip
# a sample late: κ = b − 3, and 4κ − 4 + 4c² is 4c²
LATE = put(WALL, {"loop.delay_s": 1, "loop.damping_N_s_per_m": 4, "proof.positivity": signs(square=[0, 1])})
# D = 1 − ζ/2, N_G = 1: |1 − 3ζ/2|² = 13/4 − 3c ≤ 4κ (5/4 − c); at c = −1 κ ≥ 25/36: there 2/9 (1 + c) is
# left over
FILTER = multiplier(
    [3, -2], [1, "-1/2"], signs(at_minus_one=1), norm([("1/2", -1)], [2]),
    damping_N_s_per_m="61/36", coulomb_friction_N=3, resolution_m=1,
)  # fmt: skip
WRONG = "do not multiply"

CASES = [
    *edge(
        "a damped wall",
        WALL,
        put(WALL, {"loop.damping_N_s_per_m": 2 - TINY}),
        WRONG,
        "cover this law, fed with the position",
        shows="passive",
        hands="every",
        contact="made and broken",
        encoder="counted",
        force_limit=False,
        force_steps=False,
        fed_with="position",
    ),
    *edge("λ = ½, T = ½", STIFF, put(STIFF, {"loop.damping_N_s_per_m": "1.499999999"}), WRONG),
    *edge("a sample late", LATE, put(LATE, {"loop.damping_N_s_per_m": 4 - TINY}), WRONG),
    *edge("a filter", FILTER, put(FILTER, {"loop.damping_N_s_per_m": "1.694444444"}), WRONG),
    refused(
        "friction, a damped wall",
        put(WALL, {"loop.coulomb_friction_N": 2 - TINY}),
        "Coulomb friction is below",
    ),
    refused(
        "friction, λ = ½, less",
        put(STIFF, {"loop.coulomb_friction_N": 3 - TINY}),
        "Coulomb friction is below",
    ),
    *edge(
        "finer steps",
        put(WALL, {"loop.resolution_m": "1/2", "loop.coulomb_friction_N": 1}),
        put(WALL, {"loop.resolution_m": "1/2", "loop.coulomb_friction_N": 1 - TINY}),
        "Coulomb friction is below",
    ),
    accepted(
        "an ideal encoder",
        without(put(WALL, {"loop.resolution_m": 0, "loop.coulomb_friction_N": 0}), "proof.norm"),
        encoder="ideal",
    ),
    accepted("it may pull", put(WALL, {"law.never_pulls": False})),
    refused("another multiplier", put(WALL, {"proof.multiplier": "1/2"}), WRONG),
    refused(
        "multiplier 0",
        put(WALL, {"proof.multiplier": 0, "proof.positivity": signs([-1])}),
        "multiplier must be > 0",
    ),
    refused("multiplier below 0", put(WALL, {"proof.multiplier": -1}), "multiplier must be > 0"),
    refused(
        "less damping than the spring needs",
        put(WALL, {"loop.damping_N_s_per_m": 1 - TINY}),
        "the spring alone needs",
    ),
    refused("no less than the spring needs, and no more", put(WALL, {"loop.damping_N_s_per_m": 1}), WRONG),
    refused("the norm of another law", put(WALL, {"proof.norm": norm(top=[3, -1])}), "do not sum"),
    refused(
        "fed with the penetration", put(WALL, {"law.fed_with": "penetration"}), "fed_with must be position"
    ),
    refused(
        "never_pulls is a word", put(WALL, {"law.never_pulls": "no"}), "never_pulls must be true or false"
    ),
    refused("an entry of the law that no proof has", put(WALL, {"law.remark": 1}), "entries"),
    refused("no surface", put(WALL, {"loop.unilateral": False}), "acts inside only"),
    refused(
        "part of a sample",
        put(WALL, {"loop.delay_s": "1/4", "loop.damping_N_s_per_m": 99}),
        "whole number of samples",
    ),
    # D = 1 − 2ζ, N_G = 1: |D − ζ|² = 10 − 6c ≤ 4κ (5 − 4c)
    refused(
        "a pole at 2",
        multiplier([3, -5], [1, -2], signs([10, -10]), norm(), damping_N_s_per_m=2),
        "pole outside",
    ),
    refused(
        "H(1) < 0",
        multiplier([0, -1], [1, 0], signs(at_minus_one=1), norm(), damping_N_s_per_m="1/2"),
        "H(1) is negative",
    ),
    accepted(
        "H(1) = 0",
        put(WALL, {"loop.numerator": [1, -1], "loop.damping_N_s_per_m": 1, "loop.coulomb_friction_N": 1}),
    ),
    *(
        refused(f"without {key}", without(WALL, key), f"{key.rpartition('.')[2]} is missing")
        for key in (
            "law",
            "law.fed_with",
            "law.never_pulls",
            "proof",
            "proof.multiplier",
            "proof.positivity",
            "proof.norm",
        )
    ),
]
