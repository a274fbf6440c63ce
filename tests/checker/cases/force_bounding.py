"""Force bounding: 4 β κ = 1, β ≤ b/T, φ (1 + u) ≤ f_c, δ ≥ Δ, h ≥ ΔF/2, and the roundings paid:

    (1 + u)⁹ − 1 ≤ ε (1 − u)¹³

With u = 1/100 that is ε ≥ (1.01⁹ − 1)/0.99¹³.
"""

from __future__ import annotations

from . import TINY, Fraction, accepted, put, refused, without

U = Fraction(1, 100)
HAIR = ((1 + U) ** 9 - 1) / (1 - U) ** 13
DOUBLE = Fraction(1, 1 << 53)
HAIR_OF_DOUBLES = ((1 + DOUBLE) ** 9 - 1) / (1 - DOUBLE) ** 13
# b/T = 4, f_c = 2.02, Δ = ½, ΔF = ¼
BOUND = {
    "kind": "force bounding",
    "loop": {
        "damping_N_s_per_m": 2,
        "coulomb_friction_N": "2.02",
        "resolution_m": "1/2",
        "sample_period_s": "1/2",
        "delay_s": 0,
        "force_resolution_N": "1/4",
    },
    "law": {
        "credit_N_per_m": 4,
        "friction_N": 2,
        "count_m": "1/2",
        "half_step_N": "1/8",
        "hair": HAIR,
        "roundoff": U,
    },
}
EXACT = put(BOUND, {"law.hair": 0, "law.roundoff": 0, "loop.coulomb_friction_N": 2})


def less(name: str, path: str, value: object, phrase: str) -> object:
    return refused(name, put(BOUND, {path: value}), phrase)


CASES = [
    accepted(
        "at every bound",
        BOUND,
        "friction takes at least",
        shows="passive",
        hands="every",
        contact="made and broken",
        encoder="counted",
        force_limit=True,
        force_steps=True,
        fed_with="",
    ),
    accepted("without rounding", EXACT),
    accepted("rounded as doubles are", put(BOUND, {"law.hair": HAIR_OF_DOUBLES, "law.roundoff": DOUBLE})),
    refused(
        "without rounding, less friction",
        put(EXACT, {"loop.coulomb_friction_N": 2 - TINY}),
        "less Coulomb friction",
    ),
    accepted(
        "an ideal encoder and converter",
        put(BOUND, {"loop.resolution_m": 0, "loop.force_resolution_N": 0}),
        encoder="ideal",
        force_steps=False,
    ),
    less("less damping", "loop.damping_N_s_per_m", 2 - TINY, "more than b/T"),
    less("a longer period", "loop.sample_period_s", "0.500000001", "more than b/T"),
    less("more credit", "law.credit_N_per_m", 4 + TINY, "more than b/T"),
    less("less friction", "loop.coulomb_friction_N", "2.019999999", "less Coulomb friction"),
    less("more friction credited", "law.friction_N", 2 + TINY, "less Coulomb friction"),
    less("a smaller count", "law.count_m", "0.499999999", "smaller than the encoder's"),
    less("larger counts", "loop.resolution_m", "0.500000001", "smaller than the encoder's"),
    less("less for the converter", "law.half_step_N", "0.1249999999", "half a step"),
    less("larger steps", "loop.force_resolution_N", "0.2500000001", "half a step"),
    less("less for rounding", "law.hair", HAIR - TINY, "pay for its rounding"),
    refused(
        "more rounding",
        put(BOUND, {"law.roundoff": U + TINY, "loop.coulomb_friction_N": 3}),
        "pay for its rounding",
    ),
    accepted(
        "all larger than it must be", put(BOUND, {"law.count_m": 1, "law.half_step_N": 1, "law.hair": "1/2"})
    ),
    accepted("credit 1, κ = ¼", put(BOUND, {"law.credit_N_per_m": 1, "loop.damping_N_s_per_m": "1/2"})),
    refused(
        "credit 1, less damping",
        put(BOUND, {"law.credit_N_per_m": 1, "loop.damping_N_s_per_m": "0.499999999"}),
        "more than b/T",
    ),
    less("late", "loop.delay_s", TINY, "applied late"),
    less("early", "loop.delay_s", -TINY, "delay_s must be ≥ 0"),
    less("T is 0", "loop.sample_period_s", 0, "sample_period_s must be > 0"),
    less("T is below 0", "loop.sample_period_s", -1, "sample_period_s must be > 0"),
    less("Δ is below 0", "loop.resolution_m", -1, "resolution_m must be ≥ 0"),
    less("ΔF is below 0", "loop.force_resolution_N", -1, "force_resolution_N must be ≥ 0"),
    refused(
        "f_c is below 0",
        put(EXACT, {"loop.coulomb_friction_N": -1, "law.friction_N": -2}),
        "coulomb_friction_N must be ≥ 0",
    ),
    refused(
        "b is below 0",
        put(EXACT, {"loop.damping_N_s_per_m": -2, "law.credit_N_per_m": -4}),
        "damping_N_s_per_m must be ≥ 0",
    ),
    less("credit 0", "law.credit_N_per_m", 0, "credit_N_per_m must be > 0"),
    less("credit below 0", "law.credit_N_per_m", -1, "credit_N_per_m must be > 0"),
    less("φ below 0", "law.friction_N", -1, "friction_N must be ≥ 0"),
    refused("δ below 0", put(BOUND, {"law.count_m": -1, "loop.resolution_m": 0}), "count_m must be ≥ 0"),
    refused(
        "h below 0",
        put(BOUND, {"law.half_step_N": -1, "loop.force_resolution_N": 0}),
        "half_step_N must be ≥ 0",
    ),
    refused("ε below 0", put(EXACT, {"law.hair": -1}), "hair must be ≥ 0"),
    refused("u below 0", put(EXACT, {"law.roundoff": -1}), "roundoff must be ≥ 0"),
    less("ε is 1", "law.hair", 1, "must be < 1"),
    refused("u is 1", put(BOUND, {"law.roundoff": 1, "loop.coulomb_friction_N": 9}), "must be < 1"),
    *(
        refused(f"without {key}", without(BOUND, key), phrase)
        for key, phrase in (
            ("loop", "loop is missing"),
            ("law", "law is missing"),
            ("loop.delay_s", "delay_s is missing"),
            ("law.hair", "hair is missing"),
            ("law.friction_N", "friction_N is missing"),
        )
    ),
]
