"""A violated criterion, at one frequency:  2b²/T |D|² + b (−R + (1 + c) S) − T α (1 − α)/2 |N|² < 0.

The closed forms are those of `linear` and `delays`; for α = 3/8, K = T = 1 it is 45/64 (1 − c) with b =
15/16.
"""

from __future__ import annotations

from typing import Any

from . import TINY, Fraction, accepted, edge, loop, put, refused, without
from .linear import LESS


def violation(damping: Any, numerator: Any, denominator: Any = (1,), **device: Any) -> Any:
    """A loop, and `proof` as it is given."""
    proof = device.pop("proof", {"kind": "criterion", "cosine": device.pop("cosine", None)})
    told = loop(numerator, denominator, damping_N_s_per_m=damping, **device)
    return {"kind": "violation", "loop": told, "proof": proof}


def pair(name: str, damping: Any, *law: Any, **device: Any) -> Any:
    """At the limit it is not violated, with a hair less damping it is."""
    false = violation(damping, *law, **device)
    true = violation(Fraction(damping) + LESS, *law, **device)
    return edge(name, true, false, "not violated", shows="active")


UNSTABLE, POLE = {"kind": "unstable environment"}, {"kind": "unstable environment", "offset": 1}
STATIC = {"kind": "negative static stiffness"}
SPRING = violation(Fraction(3, 2) + LESS, [3], cosine=-1)

CASES = [
    accepted(
        "a spring",
        SPRING,
        "is violated at 0.5 Hz",
        shows="active",
        hands="every",
        contact="kept",
        encoder="ideal",
        force_limit=False,
        force_steps=False,
        fed_with="",
    ),
    accepted("T = 2 s", violation("2.999", [3], cosine=-1, sample_period_s=2), "is violated at 0.25 Hz"),
    accepted("T above any double", violation(1, [3], cosine=-1, sample_period_s="1e400"), "at 5e-401 Hz"),
    accepted("T below any double", violation(0, [3], cosine=-1, sample_period_s="1e-400"), "at 5e+399 Hz"),
    accepted(
        "an encoder and friction change nothing",
        put(SPRING, {"loop.resolution_m": 1, "loop.coulomb_friction_N": 9}),
        encoder="counted",
    ),
    accepted("no surface", put(SPRING, {"loop.unilateral": False}), contact="both sides"),
    *pair("K: 2b − K", "3/2", [3], cosine=-1),
    *pair("K, any frequency", "3/2", [3], cosine="1/3"),
    *pair("K, a sample late, at 0 Hz", 3, [2], cosine=1, delay_s=1),
    *pair("K, a sample late: 2b − 2 − 4c", "4/3", [2], cosine="1/6", delay_s=1),
    # two samples: M = K ζ²: −K (2c² − 1) − (1 + c) K 2c = −K (4c² + 2c − 1)
    *pair("K, two samples late", "19/9", [2], cosine="2/3", delay_s=2),
    *pair("K + B (1 − ζ): 2b − 2 + 2c", "4/3", [3, -1], [1, 0], cosine="-1/3"),
    *pair("3 + ζ − ζ²: 2b − 5 + 4c²", "41/18", [3, 1, -1], [1, 0, 0], cosine="1/3"),
    *pair("1/(1 − ζ/2): 2b (5/4 − c) − 3/2", "9/11", [1, 0], [1, "-1/2"], cosine="1/3"),
    *pair("T = ½ takes half", "2/3", [2], cosine="1/6", delay_s="1/2", sample_period_s="1/2"),
    *pair("α = 3/8", "15/16", [1], cosine=1, delay_s="3/8"),
    *pair("α = 23/16", "63/32", [1], cosine=1, delay_s="23/16"),
    *pair("α = 3/8, T = 2, K = 3", "45/8", [3], cosine=1, delay_s="3/4", sample_period_s=2),
    # 2b² − b (1 + 2α c) − α (1 − α)/2 with α = ½, c = −¾: 2b² − b/4 − 1/8 = 0 has b = 5/16 + …: (1 + √17)/16
    accepted("α = ½ at c = −¾", violation("0.32", [1], cosine="-3/4", delay_s="1/2")),
    refused(
        "α = ½ at c = −¾, damped enough",
        violation("0.3202", [1], cosine="-3/4", delay_s="1/2"),
        "not violated",
    ),
    # α = ½, 1/(1 − ζ/2): 2b² (5/4 − c) + b (…) − 1/8: by M D̄ = ½ (1 + ζ)(1 − ζ̄/2)
    accepted("at c = 1", violation(0, [1], cosine=1, delay_s="1/2")),
    refused("c is above 1", violation(0, [1], cosine=1 + TINY), "proof.cosine must be"),
    refused("c is below −1", violation(0, [1], cosine=-1 - TINY), "proof.cosine must be"),
    accepted("H(1) < 0", violation(99, [-TINY], proof=STATIC), "H(1) is negative", shows="active"),
    accepted("H(1) < 0 by the sign of D", violation(99, [1], [-1], proof=STATIC)),
    refused("H(1) is 0", violation(0, [1, -1], [1, 0], proof=STATIC), "not negative"),
    refused("H(1) > 0", violation(0, [1], proof=STATIC), "not negative"),
    refused("H(1) > 0, both signs turned", violation(0, [-1], [-1], proof=STATIC), "not negative"),
    # −1/(1 − 2ζ) with τ = b + g: z² − (3 + 1/τ) z + 2
    accepted("a pole at 2", violation(9, [-1, 0], [1, -2], proof=POLE), "is not positive real"),
    refused(
        "a spring with little damping: z = 1 − K/(b + g)",
        violation(0, [1], proof=POLE),
        "may be positive real",
    ),
    # K = 2, b + g = 1: z = −1
    accepted("its root on the circle", violation(0, [2], proof=POLE)),
    refused("its root just inside", violation(0, [2 - TINY], proof=POLE), "may be positive real"),
    accepted("H(1) < 0, z = 1 + K/(b + g)", violation(9, [-1], proof=POLE)),
    refused("offset 0", violation(0, [3], proof={**POLE, "offset": 0}), "proof.offset must be > 0"),
    refused("offset below 0", violation(0, [3], proof={**POLE, "offset": -1}), "proof.offset must be > 0"),
    # −(1 − ζ)/(1 + ζ) with b = ½ is positive real; without the common 1 − ζ taken out it would have a root
    # at 1
    refused("N(1) = 0: z = −1/3", violation("1/2", [-1, 1], [1, 1], proof=POLE), "may be positive real"),
    accepted("N(1) = 0, its sign turned", violation("1/2", [1, -1], [1, 1], proof=POLE)),
    refused("common factors", violation(9, [-2, 4], [1, -2], proof=POLE), "common factor"),
    accepted(
        "part of a sample, a pole at 2",
        violation(9, [1, 0], [1, -2], delay_s="1/2", proof=UNSTABLE),
        "pole on or outside",
    ),
    accepted("part of a sample, a pole at 1", violation(9, [1, 0], [1, -1], delay_s="1/2", proof=UNSTABLE)),
    refused(
        "part of a sample, a pole just inside",
        violation(0, [1, 0], [1, -1 + TINY], delay_s="1/2", proof=UNSTABLE),
        "every pole of H(z) lies inside",
    ),
    refused(
        "part of a sample, common factors",
        violation(9, [2, -4], [1, -2], delay_s="1/2", proof=UNSTABLE),
        "common factor",
    ),
    refused(
        "part of a sample with an offset", violation(9, [1, 0], [1, -2], delay_s="1/2", proof=POLE), "entries"
    ),
    refused(
        "whole samples without an offset", violation(9, [-1, 0], [1, -2], proof=UNSTABLE), "offset is missing"
    ),
    refused("another kind", violation(9, [-1], proof={"kind": "by eye"}), "proof.kind must be criterion or"),
    refused("no cosine", violation(0, [3], proof={"kind": "criterion"}), "proof.cosine is missing"),
    refused("an entry more", put(SPRING, {"proof.offset": 1}), "entries"),
    refused("no proof", without(SPRING, "proof"), "proof is missing"),
    refused(
        "negative static stiffness of a law without one",
        violation(1, [-1, 0], [1, -1], proof=STATIC),
        "is not negative",
    ),
]
