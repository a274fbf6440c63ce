"""A spring through points: b ≥ (L/2 + d s) T and f_c ≥ s Δ/2, L the largest slope and s the largest |slope|.

A delay of a part α of a sample more asks for b ≥ (T/2) (w + √(w² + α (1 − α) s²)), w = L/2 + (d + α) s.

Beyond an end it pulls on for ever with more than friction holds: a hand takes energy out without end.
"""

from __future__ import annotations

from fractions import Fraction
from typing import Any

from . import TINY, accepted, edge, put, refused, without

LOOP = {
    "damping_N_s_per_m": 1,
    "coulomb_friction_N": 3,
    "resolution_m": 2,
    "sample_period_s": "1/2",
    "delay_s": 0,
}


def spring(points: Any, **device: Any) -> Any:
    """T = ½ s, Δ = 2 m."""
    return {"kind": "nonlinear spring", "loop": {**LOOP, **device}, "law": {"points_m_N": points}}


def pull(points: Any, friction: Any) -> Any:
    """An endless pull, whatever else the device has."""
    loop = {**LOOP, "damping_N_s_per_m": 99, "coulomb_friction_N": friction, "delay_s": "1/3"}
    return {"kind": "endless pull", "loop": loop, "law": {"points_m_N": points}}


# slopes 2, 4 and −3: b ≥ (4/2 + 4d)/2, f_c ≥ 4
RISING = spring([[-2, -2], [0, 2], [1, 6], [3, 0]], coulomb_friction_N=4)
# slopes 2 and −4: b ≥ (2/2 + 4d)/2
FALLING = spring([[-3, -4], [1, 4], [2, 0]], damping_N_s_per_m="1/2", coulomb_friction_N=4)
# every slope below 0: no damping without delay
ONLY_FALLING = spring([[-1, 0], [1, 0]], damping_N_s_per_m=0, coulomb_friction_N=0)
# too little damping, 2b/T = 1/4: g rises by 2 over 1, then falls by 1/4, and 3/2 left of friction pays
PAID = spring([[0, 0], [1, "9/4"]], damping_N_s_per_m="1/16", coulomb_friction_N="15/4")
PAID_ON = {  # the same where g falls faster than that on one side
    "larger x": put(PAID, {"law.points_m_N": [[-1, 0], [0, "-9/4"], [1, 0]]}),
    "smaller x": put(PAID, {"law.points_m_N": [[0, 0], [1, "9/4"], [2, 0]]}),
}
# g rises by 2, falls by 1, rises by 2: each rise alone asks for 3/2, both at once for 2.073
TWICE = put(PAID, {"law.points_m_N": [[0, 0], [1, "9/4"], [2, "3/2"], [3, "15/4"]]})
DAMPING, FRICTION = "damping is below", "below half a count"
RUNS_AWAY = pull([[0, 0], [1, -2]], "1.999")
BOTH = {"nonlinear spring": RISING, "endless pull": RUNS_AWAY}


def bad(name: str, points: Any, phrase: str) -> Any:
    """Points that are none, of a spring and of a pull."""
    return [
        refused(f"{name}, {kind}", put(told, {"law.points_m_N": points}), phrase)
        for kind, told in BOTH.items()
    ]


CASES = [
    *edge(
        "the largest slope",
        RISING,
        put(RISING, {"loop.damping_N_s_per_m": 1 - TINY}),
        DAMPING,
        "damping covers",
        shows="passive",
        hands="every",
        contact="both sides",
        encoder="counted",
        force_limit=False,
        force_steps=False,
        fed_with="",
    ),
    refused("friction, the largest slope", put(RISING, {"loop.coulomb_friction_N": 4 - TINY}), FRICTION),
    # x = 6 N/m · T = 3 and 3/8 of a sample more: w = x (½ + 3/8), b ≥ (w + x)/2
    *(
        case
        for side, told in {"both sides": PAID, **PAID_ON}.items()
        for case in edge(
            f"friction pays for a short rise, {side}",
            told,
            put(told, {"loop.coulomb_friction_N": Fraction(15, 4) - TINY}),
            DAMPING,
            "pays for its rises",
        )
    ),
    accepted("friction pays for two rises", put(TWICE, {"loop.coulomb_friction_N": "87/20"}), "pays for its"),
    refused("friction pays for one of two", put(TWICE, {"loop.coulomb_friction_N": "17/4"}), DAMPING),
    refused(
        "too many digits to be added up",
        put(PAID, {"law.points_m_N": [[i, f"{i * 10**99}/{10**99 + i}"] for i in range(99)]}),
        "too many digits",
    ),
    refused("friction pays, behind a delay", put(PAID, {"loop.delay_s": "1/2"}), DAMPING),
    refused("friction pays, no damping", put(PAID, {"loop.damping_N_s_per_m": 0}), DAMPING),
    *edge(
        "a stiff spring and a part of a sample",
        STIFF := spring([[-1, -6], [1, 6]], damping_N_s_per_m="45/16", delay_s="3/16", coulomb_friction_N=6),
        put(STIFF, {"loop.damping_N_s_per_m": Fraction(45, 16) - TINY}),
        DAMPING,
    ),
    refused("no damping", put(RISING, {"loop.damping_N_s_per_m": 0}), DAMPING),
    *edge("the steepest part falls", FALLING, put(FALLING, {"loop.coulomb_friction_N": 4 - TINY}), FRICTION),
    refused(
        "damping, the steepest part falls", put(FALLING, {"loop.damping_N_s_per_m": "0.499999999"}), DAMPING
    ),
    *edge(
        "two samples late",
        put(FALLING, {"loop.delay_s": 1, "loop.damping_N_s_per_m": "9/2"}),
        put(FALLING, {"loop.delay_s": 1, "loop.damping_N_s_per_m": "4.499999999"}),
        DAMPING,
    ),
    accepted("level", ONLY_FALLING),
    accepted(
        "an ideal encoder",
        put(RISING, {"loop.resolution_m": 0, "loop.coulomb_friction_N": 0}),
        encoder="ideal",
    ),
    accepted("it ends at 0", put(RISING, {"law.points_m_N": [[-2, 0], [0, 2], [1, 6], [3, 0]]})),
    refused(
        "it pulls away beyond the upper end",
        put(RISING, {"law.points_m_N": [[-2, -2], [0, 2], [1, 6], [3, "-0.001"]]}),
        "pulls away for ever",
    ),
    refused(
        "it pulls away beyond the lower end",
        put(RISING, {"law.points_m_N": [[-2, "0.001"], [0, 2], [1, 6], [3, 0]]}),
        "pulls away for ever",
    ),
    *(  # w² + α (1 − α) s² is 16, 4 and 36
        case
        for name, told, delay, damping in (
            ("3/8 of a sample", RISING, "3/16", "15/8"),
            ("an eighth of a sample", FALLING, "1/16", "7/8"),
            ("a sample and a part", FALLING, "67/112", "165/56"),
        )
        for late in (put(told, {"loop.delay_s": delay}),)
        for case in edge(
            name,
            put(late, {"loop.damping_N_s_per_m": damping}),
            put(late, {"loop.damping_N_s_per_m": Fraction(damping) - TINY}),
            DAMPING,
        )
    ),
    accepted("level, with a part of a sample", put(ONLY_FALLING, {"loop.delay_s": "1/4"})),
    accepted("2000 samples late", put(RISING, {"loop.delay_s": 1000, "loop.damping_N_s_per_m": 4001})),
    refused(
        "2001 samples late",
        put(RISING, {"loop.delay_s": "2001/2", "loop.damping_N_s_per_m": 9999}),
        "more than 2000 samples",
    ),
    *(
        refused(
            f"{key} is {value}",
            put(put(RISING, {"loop.damping_N_s_per_m": 99}), {f"loop.{key}": value}),
            f"{key} must be",
        )
        for key, value in (
            ("sample_period_s", 0),
            ("sample_period_s", -1),
            ("coulomb_friction_N", -1),
            ("resolution_m", -1),
            ("delay_s", -1),
        )
    ),
    refused(
        "damping is below 0",
        put(ONLY_FALLING, {"loop.damping_N_s_per_m": -1}),
        "damping_N_s_per_m must be ≥ 0",
    ),
    accepted(
        "an endless pull beyond the upper end",
        RUNS_AWAY,
        "pulls away with 2 for ever",
        shows="active",
        hands="every",
        contact="both sides",
        encoder="counted",
        force_limit=False,
        force_steps=False,
        fed_with="",
    ),
    accepted(
        "an endless pull beyond the last of three points",
        pull([[-1, 0], [0, 1], [1, -2]], "1.999"),
        "pulls away with 2 for ever",
    ),
    refused(
        "friction holds it, beyond the upper end",
        put(RUNS_AWAY, {"loop.coulomb_friction_N": 2}),
        "friction holds",
    ),
    accepted("an endless pull beyond the lower end", pull([[-1, 2], [1, 5]], "1.999"), encoder="counted"),
    refused("friction holds it, beyond the lower end", pull([[-1, 2], [1, 5]], 2), "friction holds"),
    accepted(
        "an endless pull without friction",
        put(pull([[0, 0], [1, "-0.001"]], 0), {"loop.damping_N_s_per_m": 0}),
        encoder="counted",
    ),
    accepted("an endless pull, an ideal encoder", put(RUNS_AWAY, {"loop.resolution_m": 0}), encoder="ideal"),
    refused("a spring that pushes back", pull([[-1, -1], [1, 1]], 0), "friction holds"),
    *(
        refused(f"a pull whose {key} is {value}", put(RUNS_AWAY, {f"loop.{key}": value}), f"{key} must be")
        for key, value in (
            ("sample_period_s", 0),
            ("sample_period_s", -1),
            ("coulomb_friction_N", -1),
            ("damping_N_s_per_m", -1),
        )
    ),
    *bad("one point", [[0, 0]], "must have 2 to 10000"),
    *bad("points that are no list", {}, "points_m_N must be a list"),
    *bad("a point of three", [[0, 0, 0], [1, 1, 1]], "must have 2 to 2 entries"),
    *bad("a point that is a word", ["00", "12"], "points_m_N[0] must be a list"),
    *bad("the last two of three points at one place", [[0, 0], [1, 1], [1, 2]], "must increase"),
    *bad("two points at one place", [[0, 0], [0, -9]], "must increase"),
    *bad("points that go back", [[1, 0], [0, -9]], "must increase"),
    *bad("10 001 points", [[k, 0] for k in range(10_001)], "points_m_N must have 2 to 10000 entries"),
    accepted("10 000 points", put(ONLY_FALLING, {"law.points_m_N": [[k, 0] for k in range(10_000)]})),
    *(
        refused(f"without {key}, {kind}", without(told, key), phrase)
        for kind, told in BOTH.items()
        for key, phrase in (
            ("law", "law is missing"),
            ("loop", "loop is missing"),
            ("law.points_m_N", "points_m_N is missing"),
            ("loop.damping_N_s_per_m", "damping_N_s_per_m is missing"),
        )
    ),
    accepted("two points are enough", spring([[0, 0], [1, 2]])),
]
