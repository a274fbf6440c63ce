"""A motion that touches and leaves, the energy by hand; T = 1 s, each at rest outside first.

K = 2: 0 → 1 → 0 takes out 2 − 2b − 2 f_c.  K + B (1 − ζ) with K = 1, B = 2, from −1: fed with the
penetration 1
after 0 the force is 3, fed with the position, 1 after −1, it is 5.
"""

from __future__ import annotations

from typing import Any

from . import accepted, loop, put, refused, without


def touching(
    positions: Any,
    energy: Any,
    numerator: Any = (2,),
    denominator: Any = (1,),
    fed: str = "penetration",
    never_pulls: bool = False,
    **device: Any,
) -> Any:
    """b = ½ N·s/m if nothing else is said."""
    return {
        "kind": "touching motion",
        "loop": loop(numerator, denominator, **{"damping_N_s_per_m": "1/2", **device}),
        "law": {"fed_with": fed, "never_pulls": never_pulls},
        "sample_period_s": device.get("sample_period_s", 1),
        "positions_m": list(positions),
        "energy_J": energy,
    }


def taken(name: str, energy: Any, told: Any, **facts: Any) -> Any:
    return accepted(name, put(told, {"energy_J": energy}), "the motion extracts", energy, **facts)


THERE = touching([0, 1, 0], 1)
QUARTER = put(touching([0, 1, 0], "1/2", delay_s="1/4"), {"switch_positions_m": ["1/4", "3/4"]})
DAMPED = touching([-1, 1, -1], 0, [3, -2], [1, 0])
# the forces 3, 1 of 1, 1: 1 → 1 → −1 gives 2 · 1
LONGER = put(DAMPED, {"positions_m": [-1, 1, 1, -1]})
# 1/(1 − ζ/2) on 1, 1: 1, 3/2; on 1, −1 (0 outside), 1: 1, –, 5/4
FILTER = touching([0, 1, 1, 0], 0, [1, 0], [1, "-1/2"])
AGAIN = put(FILTER, {"positions_m": [0, 1, -1, 1, 0]})
# 1 − 2ζ/(1 …): K + B (1 − ζ) drawn back: 2 after 3: 1 · 2 − 2 = 0; 1 after 3: 1 − 4 = −3
PULLS = touching([0, 3, 1, 0], 0, [3, -2], [1, 0])
HALF = put(FILTER, {"loop.numerator": [2, 0], "loop.denominator": [2, -1]})

CASES = [
    taken(
        "a spring",
        1,
        THERE,
        shows="active",
        hands="every",
        contact="made and broken",
        encoder="ideal",
        force_limit=False,
        force_steps=False,
        fed_with="",
    ),
    taken("T = 2", "3/2", put(THERE, {"loop.sample_period_s": 2, "sample_period_s": 2})),
    taken("friction", "1/2", put(THERE, {"loop.coulomb_friction_N": "1/4"})),
    taken("a coarse reading", "1/2", put(THERE, {"loop.resolution_m": "3/4"}), encoder="counted"),
    taken("a sample late", 1, put(THERE, {"loop.delay_s": 1, "positions_m": [0, 1, 1, 0]})),
    taken("two samples late", 1, put(THERE, {"loop.delay_s": 2, "positions_m": [0, 1, 1, 1, 0]})),
    taken("a quarter late", "1/2", QUARTER),
    taken("a quarter late, friction", "1/4", put(QUARTER, {"loop.coulomb_friction_N": "1/8"})),
    taken(
        "a quarter late, more of the way",
        "7/12",
        put(QUARTER, {"switch_positions_m": ["1/4", 1], "loop.damping_N_s_per_m": "17/28"}),
    ),
    taken(
        "one and a quarter late",
        "1/2",
        put(
            QUARTER,
            {"loop.delay_s": "5/4", "positions_m": [0, 1, 1, 0], "switch_positions_m": ["1/4", 1, "3/4"]},
        ),
    ),
    # forces 0, 2, 4: −1 · 2, 3/4 · 2, −1 · 4, and 23/3 b
    taken(
        "a quarter late, farther in",
        "7/2",
        put(
            QUARTER,
            {
                "positions_m": [0, 1, 2, 0],
                "switch_positions_m": ["1/2", "5/4", 1],
                "loop.damping_N_s_per_m": "3/23",
            },
        ),
    ),
    taken("fed with the penetration", 2, put(DAMPED, {"loop.damping_N_s_per_m": "1/2"})),
    taken("fed with the position", 6, put(DAMPED, {"law.fed_with": "position"})),
    taken("it damps, penetration", 1, put(LONGER, {"loop.damping_N_s_per_m": "1/8"})),
    taken(
        "it damps, position", 1, put(LONGER, {"loop.damping_N_s_per_m": "1/8", "law.fed_with": "position"})
    ),
    taken("a filter", "1/2", FILTER),
    taken("a filter that is left", "1/4", put(AGAIN, {"loop.damping_N_s_per_m": "3/10"})),
    # H(1) = 2: at −1 it rests with −2; u = 2, 2 adds 2, 3
    taken(
        "a filter fed with the position, from outside",
        1,
        put(
            FILTER,
            {"law.fed_with": "position", "positions_m": [-1, 1, 1, -1], "loop.damping_N_s_per_m": "1/8"},
        ),
    ),
    taken("a filter that divides", "1/2", HALF),
    taken(
        "a filter that divides, left",
        "1/4",
        put(HALF, {"positions_m": [0, 1, -1, 1, 0], "loop.damping_N_s_per_m": "3/10"}),
    ),
    taken(
        "a filter fed with the position, left",
        "3/4",
        put(AGAIN, {"law.fed_with": "position", "loop.damping_N_s_per_m": "1/5"}),
    ),
    # at 1 after 3 it pulls with −3: on the way 1 → 0 it takes 3; at 3 it pushes with 9
    taken("it pulls", 8, put(PULLS, {"loop.damping_N_s_per_m": "1/2"})),
    taken("it never pulls", 11, put(PULLS, {"law.never_pulls": True})),
    *(
        taken(name, 11, put(PULLS, {"law.never_pulls": True, "loop.numerator": n, "loop.denominator": d}))
        for name, n, d in (
            ("it never pulls, N and D below 0", [-3, 2], [-1, 0]),
            ("it never pulls, N and D three times as large", [9, -6], [3, 0]),
        )
    ),
    taken(
        "it never pulls, a force of one unit",
        "1/2",
        touching([0, 1, 0], 0, (1,), never_pulls=True, damping_N_s_per_m="1/4"),
    ),
    # 1/(1 − ζ/2 − ζ²/4): the forces 0, 1, 3/2, 2
    taken(
        "a filter of two poles",
        1,
        put(
            FILTER,
            {
                "positions_m": [0, 1, 1, 1, 0],
                "loop.numerator": [1, 0, 0],
                "loop.denominator": [1, "-1/2", "-1/4"],
            },
        ),
    ),
    refused(
        "the motion of one that never pulls, by one that pulls",
        put(PULLS, {"energy_J": 11}),
        "the energy is 8 J",
        8,
    ),
    refused(
        "nothing comes out",
        put(THERE, {"loop.damping_N_s_per_m": 1, "energy_J": 0}),
        "no more than the 0 J",
        0,
    ),
    refused("too much is told", put(THERE, {"energy_J": "1.0000000011"}), "the energy is", 1),
    refused("no surface", put(THERE, {"loop.unilateral": False}), "acts inside only"),
    refused("one position", put(THERE, {"positions_m": [0]}), "positions_m must have 2 to 50000 entries"),
    refused(
        "it begins inside", put(THERE, {"positions_m": ["1/1000", 1, "1/1000"]}), "begin at rest outside"
    ),
    accepted(
        "it begins in the first count",
        put(THERE, {"positions_m": ["1/4", "5/4", "1/4"], "loop.resolution_m": "1/2", "energy_J": 1}),
        energy=1,
    ),
    refused(
        "a switch position too many",
        put(QUARTER, {"switch_positions_m": ["1/4", "3/4", 0]}),
        "one switch position",
    ),
    refused(
        "a switch position too few", put(QUARTER, {"switch_positions_m": ["1/4"]}), "one switch position"
    ),
    refused("a pole at 2", put(FILTER, {"loop.denominator": [1, -2]}), "does not forget"),
    refused("a pole at 1", put(FILTER, {"loop.denominator": [1, -1]}), "does not forget"),
    refused(
        "a law whose numbers grow by 16 000 bits a sample",
        put(FILTER, {"loop.denominator": ["1e4990", 1], "positions_m": [0, *[1] * 400, 0]}),
        "too large to be checked",
    ),
    refused("another sample period beside it", put(THERE, {"sample_period_s": 2}), "T is 1 s, not 2 s"),
    refused("fed with something else", put(THERE, {"law.fed_with": "force"}), "fed_with must be"),
    refused(
        "never_pulls is a word", put(THERE, {"law.never_pulls": "no"}), "never_pulls must be true or false"
    ),
    refused("an entry of the law that no proof has", put(THERE, {"law.remark": 1}), "entries"),
    refused("no positions", without(THERE, "positions_m"), "positions_m is missing"),
    *(
        refused(f"it ends at {end}", put(THERE, {"positions_m": [0, 1, end]}), "return to where it began")
        for end in ("1/2", "-1/2")
    ),
]
