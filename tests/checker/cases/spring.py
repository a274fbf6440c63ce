"""A spring: b² − b (KT/2)(2d + 1 + 2α) ≥ (T²/4) α (1 − α) K²  and  2 f_c ≥ K Δ.

With K = T = 1 the larger root is b = ¼ (2d + 1 + 2α + √((2d + 1)² + 8 α (d + 1))).
"""

from __future__ import annotations

from typing import Any

from . import TINY, Fraction, accepted, edge, loop, put, refused, without


def spring(damping: Any, numerator: Any = ("8",), denominator: Any = ("1",), **device: Any) -> Any:
    """K = 8 N/m if nothing else is said: without delay b = 4 N·s/m is exactly enough."""
    return {
        "kind": "spring",
        "loop": loop(numerator, denominator, damping_N_s_per_m=damping, **device),
    }


PARTS = {  # samples of delay: b/(KT), where the root above is rational
    "3/8": "15/16",
    "5/32": "45/64",
    "23/16": "63/32",
    "111/32": "255/64",
}

CASES = [
    refused("no damping", spring(0), "the damping is below"),
    *edge(
        "b is KT/2",
        spring(4),
        spring(4 - TINY),
        "damping is below",
        "admit this stiffness",
        shows="passive",
        hands="every",
        contact="made and broken",
        encoder="ideal",
        force_limit=False,
        force_steps=False,
        fed_with="",
    ),
    *edge(
        "T is ½",
        spring(2, sample_period_s="1/2"),
        spring(2 - TINY, sample_period_s="1/2"),
        "damping is below",
    ),
    *edge("K is N/D", spring(2, ["8"], ["2"]), spring(2 - TINY, ["8"], ["2"]), "damping is below"),
    *edge("two samples late", spring(20, delay_s=2), spring(20 - TINY, delay_s=2), "damping is below"),
    *(
        case
        for late, needed in PARTS.items()
        for case in edge(
            f"{late} samples late",
            spring(6 * Fraction(needed), [3], sample_period_s=2, delay_s=2 * Fraction(late)),
            spring(6 * Fraction(needed) - TINY, [3], sample_period_s=2, delay_s=2 * Fraction(late)),
            "damping is below",
        )
    ),
    *edge(
        "3/8 of a sample of ½ s late",
        spring("15/16", [2], sample_period_s="1/2", delay_s="3/16"),
        spring(Fraction(15, 16) - TINY, [2], sample_period_s="1/2", delay_s="3/16"),
        "damping is below",
    ),
    refused(
        "a spring of two coefficients, the second 0", spring(4 - TINY, [8, 0], [1, 0]), "damping is below"
    ),
    refused("a soft spring that pushes away", spring(4, ["-1/2"]), "stiffness is negative"),
    refused("the smaller root is not enough", spring("-1/16", [1], delay_s="3/8"), "≥ 0"),
    refused("less than the smaller root", spring("1/100", [1], delay_s="3/8"), "damping is below"),
    *edge(
        "2 f_c is K Δ",
        spring(4, coulomb_friction_N=2, resolution_m="1/2"),
        spring(4, coulomb_friction_N=2 - TINY, resolution_m="1/2"),
        "half a count",
        encoder="counted",
    ),
    refused("a spring that pushes away", spring(4, [-8]), "stiffness is negative"),
    refused("a spring that pushes away, above any double", spring(4, ["-1e400"]), "negative: -1e+400"),
    accepted("no spring at all", spring(0, [0])),
    refused("H(z) has a zero", spring(99, [8, 1], [1, 0]), "not a spring"),
    refused("H(z) has a pole", spring(99, [8, 0], [1, "-1/2"]), "not a spring"),
    accepted("powers of 1/z that are 0", spring(4, [8, 0], [1, 0])),
    accepted("no surface", put(spring(4), {"loop.unilateral": False}), contact="both sides"),
    refused("no loop", {"kind": "spring"}, "loop is missing"),
    refused("a loop that is a list", {"kind": "spring", "loop": []}, "must be an object"),
    *(
        refused(f"without {key}", without(spring(4), f"loop.{key}"), phrase)
        for key, phrase in (
            ("damping_N_s_per_m", "damping_N_s_per_m is missing"),
            ("coulomb_friction_N", "coulomb_friction_N is missing"),
            ("resolution_m", "resolution_m is missing"),
            ("sample_period_s", "sample_period_s is missing"),
            ("delay_s", "delay_s is missing"),
            ("numerator", "numerator is missing"),
            ("denominator", "denominator is missing"),
            ("unilateral", "unilateral is missing"),
        )
    ),
    *(
        refused(f"{key} below 0", spring(99, **{key: "-1/1000"}), "≥ 0")
        for key in ("coulomb_friction_N", "resolution_m", "delay_s")
    ),
    refused("b below 0", spring("-1/1000", [0]), "≥ 0"),
    refused("T is 0", spring(4, sample_period_s=0), "sample_period_s must be > 0"),
    refused("T is below 0", spring(4, sample_period_s=-1), "sample_period_s must be > 0"),
    refused("more of N than of D", spring(99, [8, 0], [1]), "must be proper"),
    accepted("less of N than of D is led by zeros, K = 0", spring(0, [0], [1, 0])),
    refused("less of N than of D is led by zeros, H = 8/z", spring(99, [8], [1, 0]), "not a spring"),
    refused("no D", spring(4, [], []), "numerator must have 1"),
    refused("D begins with 0", spring(4, [8, 0], [0, 1]), "must be proper"),
    refused("unilateral is a number", put(spring(4), {"loop.unilateral": 1}), "true or false"),
    refused("unilateral is a word", put(spring(4), {"loop.unilateral": "true"}), "true or false"),
    accepted("2000 samples late", spring("32004", delay_s=2000)),
    refused("2001 samples late", spring("99999", delay_s=2001), "the delay is"),
    refused("an entry of the loop that no proof has", put(spring(4), {"loop.force_limit_N": "1"}), "entries"),
    refused(
        "an entry of the document that no proof has", {**spring(4), "remark": "1"}, "no proof of this kind"
    ),
    accepted("a format", {**spring(4), "format": "zwidth certificate 1"}),
]
