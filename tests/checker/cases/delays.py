"""Every delay of an interval: on a piece α (1 − α) is below its tangent in the middle m, τ = m (1 − m) ±
(1 − 2m) h/2.

K = T = 1:  2b² − b (1 + 2α c) − τ/2 for d = 0, and 2b² + b (2α − 1 − 2c − 4α c²) − τ/2 for a sample more.
From 0 to ¼ the tangent at the end is 2m − 3m² with m = ⅛, and b = 13/16 leaves (13/32)(1 − c).
"""

from __future__ import annotations

from typing import Any

from . import TINY, Fraction, accepted, edge, loop, put, refused, without
from .linear import AT_ONE, OPEN, signs
from .quantized import norm

LEAST = Fraction(13, 16)


def tangent(low: Fraction, high: Fraction, at: Fraction) -> Fraction:
    middle = (low + high) / 2
    return middle * (1 - middle) + (1 - 2 * middle) * (at - middle)


def q(b: Fraction, part: Fraction, share: Fraction, whole: int) -> list[Fraction]:
    """The criterion of K = T = 1 in powers of c."""
    if whole == 0:
        return [2 * b**2 - b - share / 2, -2 * part * b]
    return [2 * b**2 + b * (2 * part - 1) - share / 2, -2 * b, -4 * part * b]


def piece(b: Any, low: Any, high: Any) -> dict[str, Any]:
    """A piece within one sample of delay 0 or 1, its signs as they are."""
    b, low, high = Fraction(b), Fraction(low), Fraction(high)
    whole = low // 1
    ends = (low - whole, high - whole)
    at_low, at_high = (signs(q(b, end, tangent(*ends, end), whole)) for end in ends)
    return {"low": low, "high": high, "at_low": at_low, "at_high": at_high}


def delays(b: Any, *ends: Any, delay: Any = 0, high: Any = None) -> Any:
    """Pieces from each number to the next."""
    return {
        "kind": "delays",
        "loop": loop([1], damping_N_s_per_m=b, delay_s=delay),
        "proof": {
            "stability": OPEN,
            "pieces": [piece(b, x, y) for x, y in zip(ends, ends[1:], strict=False)],
        },
        "delay_high_s": ends[-1] if high is None else high,
    }


EDGE = put(delays(LEAST, 0, "1/4"), {"proof.pieces.0.at_high": AT_ONE})
WIDE = delays(4, 0, "1/2", 1, "5/4")
COUNTED = put(WIDE, {"loop.resolution_m": 2, "loop.coulomb_friction_N": 1, "proof.norm": norm(top=[1])})
SHIFTED = put(delays(4, 0, "1/2"), {"loop.delay_s": "1/4"})

CASES = [
    *edge(
        "a piece of a quarter of a sample",
        EDGE,
        put(EDGE, {"loop.damping_N_s_per_m": LEAST - TINY}),
        "do not multiply",
        "for every delay",
        shows="passive",
        hands="every",
        contact="kept",
        encoder="ideal",
        force_limit=False,
        force_steps=False,
        fed_with="",
    ),
    refused(
        "a piece longer than its proof",
        put(EDGE, {"proof.pieces.0.high": "0.251", "delay_high_s": "0.251"}),
        "do not multiply",
    ),
    refused(
        "its first end has the sign of the last",
        put(EDGE, {"proof.pieces.0.at_low": AT_ONE}),
        "do not multiply",
    ),
    accepted("three pieces, one in the second sample", WIDE),
    accepted("it begins at the delay of the loop", delays(4, "1/4", "1/2", delay="1/4")),
    accepted(
        "T = 2 s", put(WIDE, {"loop.sample_period_s": 2, "loop.numerator": ["1/2"], "delay_high_s": "5/2"})
    ),
    refused(
        "it begins past the delay of the loop",
        put(delays(4, "1/4", "1/2"), {"loop.delay_s": 0}),
        "do not follow",
    ),
    refused("it begins before the delay of the loop", SHIFTED, "do not follow"),
    refused(
        "it begins whole samples before it",
        put(WIDE, {"loop.delay_s": Fraction(WIDE["loop"]["delay_s"]) + 1}),
        "do not follow",
    ),
    refused("a gap between two pieces", put(WIDE, {"proof.pieces.1": piece(4, "5/8", 1)}), "do not follow"),
    refused("two pieces that overlap", put(WIDE, {"proof.pieces.1": piece(4, "3/8", 1)}), "do not follow"),
    refused("it ends before the last delay", put(WIDE, {"delay_high_s": "11/8"}), "do not cover"),
    refused("it ends past the last delay", put(WIDE, {"delay_high_s": "9/8"}), "do not cover"),
    refused("no piece for an interval", put(WIDE, {"proof.pieces": []}), "pieces must have 1"),
    refused(
        "a piece past a sample",
        put(delays(4, 0, "1/2"), {"proof.pieces.0": piece(4, 0, "5/4"), "delay_high_s": "5/4"}),
        "within one sample",
    ),
    accepted("a piece up to a sample", delays(4, 0, 1)),
    refused("a piece of no length", put(WIDE, {"proof.pieces.0.high": 0}), "within one sample"),
    refused("a piece that goes back", put(WIDE, {"proof.pieces.0.high": "-1/2"}), "within one sample"),
    refused("at_low is false", put(WIDE, {"proof.pieces.1.at_low": signs([1])}), "do not multiply"),
    refused("at_high is false", put(WIDE, {"proof.pieces.1.at_high": signs([1])}), "do not multiply"),
    *edge(
        "an encoder",
        COUNTED,
        put(COUNTED, {"loop.coulomb_friction_N": 1 - TINY}),
        "below ‖h‖₁ Δ/2",
        encoder="counted",
    ),
    refused("an encoder and no norm", without(COUNTED, "proof.norm"), "norm is missing"),
    refused(
        "no damping",
        put(
            delays(0, 0, "1/2"),
            {
                "loop.numerator": [0],
                "proof.pieces.0.at_low": signs(square=()),
                "proof.pieces.0.at_high": signs(square=()),
            },
        ),
        "need damping",
    ),
    refused(
        "a closed loop",
        put(WIDE, {"proof.stability": {"kind": "closed loop", "offset": 1}}),
        "stable by itself",
    ),
    refused("H(1) < 0", put(WIDE, {"loop.numerator": [-1]}), "H(1) is negative"),
    refused("pieces that are no list", put(WIDE, {"proof.pieces": {}}), "must be a list"),
    refused("without delay_high_s", without(WIDE, "delay_high_s"), "delay_high_s is missing"),
    refused("more than 2000 samples", put(WIDE, {"delay_high_s": 2001}), "more than 2000 samples"),
]
