"""Slow hands: f_c − f_0 ≥ (b_0 − b) v, where (f_0, b_0) cover every hand."""

from __future__ import annotations

from . import TINY, accepted, edge, put, refused, without
from .contact import DAMPED
from .spring import spring

# K = 8, Δ = ½, T = 1: b_0 = 4 and f_0 = 2 cover every hand; b = 3, f_c = 5: (4 − 3) v ≤ 5 − 2
SPRING = {
    "kind": "slow hands",
    "loop": spring(3, coulomb_friction_N=5, resolution_m="1/2")["loop"],
    "largest_speed_m_per_s": 3,
    "enough": {"kind": "spring", "damping_N_s_per_m": 4, "coulomb_friction_N": 2},
}
# b_0 = 10 and f_0 = 20; b = 8, f_c = 21
CONTACT = {
    "kind": "slow hands",
    "loop": {**DAMPED["loop"], "damping_N_s_per_m": 8, "coulomb_friction_N": 21},
    "law": DAMPED["law"],
    "largest_speed_m_per_s": "1/2",
    "enough": {"kind": "contact", "damping_N_s_per_m": 10, "coulomb_friction_N": 20},
}
LEFT = "friction left over is less"

CASES = [
    *edge(
        "a spring",
        SPRING,
        put(SPRING, {"largest_speed_m_per_s": 3 + TINY}),
        LEFT,
        "up to 3 m/s",
        shows="passive",
        hands="bounded",
        contact="made and broken",
        encoder="counted",
        force_limit=False,
        force_steps=False,
        fed_with="",
    ),
    *edge(
        "a damped wall",
        CONTACT,
        put(CONTACT, {"largest_speed_m_per_s": "0.500000001"}),
        LEFT,
        hands="bounded",
    ),
    refused("less damping", put(SPRING, {"loop.damping_N_s_per_m": 3 - TINY}), LEFT),
    refused("less friction", put(SPRING, {"loop.coulomb_friction_N": 5 - TINY}), LEFT),
    refused(
        "what covers every hand does not, its damping",
        put(SPRING, {"enough.damping_N_s_per_m": 4 - TINY}),
        "damping is below",
    ),
    refused(
        "what covers every hand does not, its friction",
        put(SPRING, {"enough.coulomb_friction_N": 2 - TINY}),
        "half a count",
    ),
    refused(
        "what covers every hand does not, a damped wall",
        put(CONTACT, {"enough.damping_N_s_per_m": 10 - TINY}),
        "is below",
    ),
    accepted(
        "more damping than every hand takes",
        put(SPRING, {"loop.damping_N_s_per_m": 5, "loop.coulomb_friction_N": 2}),
    ),
    # b − b_0 = 1 and v = 3 do not make up for friction that is missing: a slow hand has no damping
    refused(
        "less friction than every hand takes, more damping",
        put(SPRING, {"loop.damping_N_s_per_m": 9, "loop.coulomb_friction_N": 2 - TINY}),
        LEFT,
    ),
    accepted("hands at rest", put(SPRING, {"largest_speed_m_per_s": 0, "loop.damping_N_s_per_m": 0})),
    refused("a speed below 0", put(SPRING, {"largest_speed_m_per_s": -1}), "must be ≥ 0"),
    refused("another proof", put(SPRING, {"enough.kind": "linear"}), "enough.kind must be spring or contact"),
    refused(
        "a speed in km/h",
        {**without(SPRING, "largest_speed_m_per_s"), "largest_speed_km_per_h": 3},
        "must be",
    ),
    refused("no speed", without(SPRING, "largest_speed_m_per_s"), "largest_speed"),
    refused("no enough", without(SPRING, "enough"), "enough is missing"),
    refused("enough is a list", put(SPRING, {"enough": []}), "must be an object"),
    refused(
        "enough without damping",
        without(SPRING, "enough.damping_N_s_per_m"),
        "enough.damping_N_s_per_m is missing",
    ),
    refused("enough with more", put(SPRING, {"enough.delay_s": 0}), "entries"),
    refused("a damped wall without its law", without(CONTACT, "law"), "law is missing"),
]
