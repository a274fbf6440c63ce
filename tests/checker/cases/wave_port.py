"""A wave port: β ≤ b, φ ≤ f_c, τ ≥ T, |δ − Δ| ≤ u Δ, whole samples of delay, and the roundings paid:

    (1 + u)²⁴ − 1 ≤ ε (1 − u)²⁴        (1 − μ) (1 + u)²⁴ ≤ 1

With u = 1/100 that is ε ≥ (1.01²⁴ − 1)/0.99²⁴ and μ ≥ 1 − 1.01⁻²⁴.
"""

from __future__ import annotations

from . import TINY, Fraction, accepted, put, refused, without

U = Fraction(1, 100)
HAIR = ((1 + U) ** 24 - 1) / (1 - U) ** 24
MARGIN = 1 - 1 / (1 + U) ** 24
PORT = {
    "kind": "wave port",
    "loop": {
        "damping_N_s_per_m": 2,
        "coulomb_friction_N": "0.3",
        "resolution_m": "1/2",
        "sample_period_s": "1/4",
        "delay_s": "3/4",
    },
    "law": {
        "damping_N_s_per_m": 2,
        "friction_N": "0.3",
        "count_m": "0.505",
        "period_s": "1/4",
        "hair": HAIR,
        "margin": MARGIN,
        "roundoff": U,
    },
}
EXACT = put(PORT, {"law.hair": 0, "law.margin": 0, "law.roundoff": 0, "law.count_m": "1/2"})


def less(name: str, path: str, value: object, phrase: str) -> object:
    return refused(name, put(PORT, {path: value}), phrase)


CASES = [
    accepted(
        "at every bound",
        PORT,
        "friction takes at least",
        shows="passive",
        hands="every",
        contact="both sides",
        encoder="counted",
        force_limit=True,
        force_steps=True,
        fed_with="",
    ),
    accepted("without rounding", EXACT),
    accepted("the count rounded down", put(PORT, {"law.count_m": "0.495"})),
    accepted("an ideal encoder", put(PORT, {"loop.resolution_m": 0, "law.count_m": 0}), encoder="ideal"),
    accepted("without friction", put(PORT, {"loop.coulomb_friction_N": 0, "law.friction_N": 0})),
    accepted("at once", put(PORT, {"loop.delay_s": 0})),
    accepted("less than there is", put(PORT, {"law.damping_N_s_per_m": 0, "law.friction_N": 0})),
    accepted("a longer period", put(PORT, {"law.period_s": 1})),
    less("less damping", "loop.damping_N_s_per_m", 2 - TINY, "more damping"),
    less("more damping credited", "law.damping_N_s_per_m", 2 + TINY, "more damping"),
    less("a shorter period", "law.period_s", Fraction(1, 4) - TINY, "more damping"),
    less("less friction", "loop.coulomb_friction_N", Fraction(3, 10) - TINY, "more Coulomb friction"),
    less("more friction credited", "law.friction_N", Fraction(3, 10) + TINY, "more Coulomb friction"),
    less("a larger count", "law.count_m", Fraction(505, 1000) + TINY, "not the encoder's"),
    less("a smaller count", "law.count_m", Fraction(495, 1000) - TINY, "not the encoder's"),
    refused("a count of nothing", put(EXACT, {"loop.resolution_m": 0}), "not the encoder's"),
    less("part of a sample late", "loop.delay_s", Fraction(3, 4) + TINY, "whole samples"),
    less("less for the energies", "law.hair", HAIR - TINY, "off the energy"),
    less("less for the forces", "law.margin", MARGIN - TINY, "off the force"),
    refused(
        "more rounding of energies",
        put(PORT, {"law.roundoff": U + TINY, "law.margin": "1/2"}),
        "off the energy",
    ),
    refused(
        "more rounding of forces", put(PORT, {"law.roundoff": U + TINY, "law.hair": "1/2"}), "off the force"
    ),
    less("early", "loop.delay_s", -TINY, "delay_s must be ≥ 0"),
    less("T is 0", "loop.sample_period_s", 0, "sample_period_s must be > 0"),
    less("Δ is below 0", "loop.resolution_m", -1, "resolution_m must be ≥ 0"),
    less("τ is 0", "law.period_s", 0, "period_s must be > 0"),
    less("β below 0", "law.damping_N_s_per_m", -1, "damping_N_s_per_m must be ≥ 0"),
    less("φ below 0", "law.friction_N", -1, "friction_N must be ≥ 0"),
    less("δ below 0", "law.count_m", -1, "count_m must be ≥ 0"),
    refused("ε below 0", put(EXACT, {"law.hair": -1}), "hair must be ≥ 0"),
    refused("μ below 0", put(EXACT, {"law.margin": -1}), "margin must be ≥ 0"),
    refused("u below 0", put(EXACT, {"law.roundoff": -1}), "roundoff must be ≥ 0"),
    less("ε is 1", "law.hair", 1, "must be < 1"),
    less("μ is 1", "law.margin", 1, "must be < 1"),
    less("u is 1", "law.roundoff", 1, "must be < 1"),
    *(
        refused(f"without {key}", without(PORT, key), phrase)
        for key, phrase in (
            ("loop", "loop is missing"),
            ("law", "law is missing"),
            ("loop.delay_s", "delay_s is missing"),
            ("law.margin", "margin is missing"),
            ("law.period_s", "period_s is missing"),
        )
    ),
]
