"""Two arms that follow each other, T = 1 s: springs need (b_l − KT/2)(w b_f − KT/2) ≥ (N KT/2)².

N is 1 and the samples that a force is late all round.  Without delay M = (b − K/2, K/2; K/2, b − K/2): its
determinant is 0 at K = b.  With a link of a sample each way b − K/2 beside K/2 (1 + 2c): at K = 2, b = 4 that
is 9 − (1 + 2c)² = 4 (1 − c)(2 + c).  The checker looks at these times 2 − 2c, and (2 − 2c)².

`pairs.json` has proofs, violations and motions of pairs drawn at random, near their limits, of whole delays,
of delays within a sample and of drives that read their arm more often; the prover found them.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from . import TINY, Fraction, accepted, edge, put, refused, without
from .linear import signs


def arm(damping: Any, stiffness: Any, **more: Any) -> Any:
    """What is not named is 0."""
    zeros = (
        "coulomb_friction_N",
        "resolution_m",
        "delay_s",
        "virtual_damping_N_s_per_m",
        "local_damping_N_s_per_m",
        "link_delay_s",
    )
    return {"damping_N_s_per_m": damping, "stiffness_N_per_m": stiffness, **dict.fromkeys(zeros, 0), **more}


def loop(leader: Any, follower: Any = None) -> Any:
    return {
        "sample_period_s": 1,
        "leader": leader,
        "follower": dict(leader if follower is None else follower),
    }


def proved(told: Any, both: Any, leader: Any = None, follower: Any = None) -> Any:
    once = signs(at_one=1)
    proof = {"leader": leader or once, "follower": follower or leader or once, "both": both}
    return {"kind": "pair", "loop": told, "proof": proof}


def violated(told: Any, cosine: Any = None) -> Any:
    """At a frequency, or by a drive alone."""
    proof = {} if cosine is None else {"proof": {"cosine": cosine}}
    return {"kind": "pair violation", "loop": told, **proof}


def moved(told: Any, leader: Any, follower: Any, **more: Any) -> Any:
    return {
        "kind": "pair motion",
        "loop": told,
        "energy_J": 0,
        "leader_positions_m": leader,
        "follower_positions_m": follower,
        **more,
    }


def told(document: Any, energy: Any) -> Any:
    return put(document, {"energy_J": energy})


def again(first: int, last: int, times: int) -> Any:
    return [{"first": first, "last": last, "times": times}]


NOWHERE = signs(square=[])
SPRING = proved(loop(arm(4, 4)), NOWHERE)
UNEQUAL = proved(loop(arm(4, 4), arm(2, 2)), NOWHERE)
LINK = arm(4, 2, link_delay_s=1)
LATE = proved(loop(LINK), signs(at_one=3, factor=[2, 1]))
# B: M_ii = b − K/2 + B c, M_lf = K/2 − B c; det M = b (b − K + 2Bc)
DAMPED = proved(
    loop(arm(4, 2, virtual_damping_N_s_per_m=1)),
    signs(at_one=2, at_minus_one=1),
    signs(at_one=1, factor=[3, 1]),
)
# D alone adds to the diagonal: 3 + c, beside 1
LOCAL = proved(
    loop(arm(4, 2, local_damping_N_s_per_m=1)),
    signs(at_one=2, factor=[8, 6, 1]),
    signs(at_one=1, factor=[3, 1]),
)
# d = 3 on either side: M_ii = 14 − m, M_lf = m = 8c³ + 4c² − 4c − 1; det M = 28 (7 − m)
LATER = proved(
    loop(arm(14, 2, delay_s=3)), signs(at_one=3, factor=[2, 3, 2]), signs(at_one=1, factor=[15, 4, -4, -8])
)
# m = 2 readings of its own: β = b − K/4; with K = 4 and β = 2 as K/2: b = 3
DRIVEN = put(proved(loop(arm(3, 4)), NOWHERE), {"loop.own_readings": 2})
# γ = D = 1, β = 3: t = 17, u = 6, g = 1; M_ii = (17 − c)/(5 − c), beside K/2 = 2: (7 + c)(27 − 3c)
DRIVEN_DAMPED = put(
    proved(
        loop(arm(4, 4, local_damping_N_s_per_m=1)),
        signs(at_one=2, factor=[63, 2, -1]),
        signs(at_one=1, factor=[17, -1]),
    ),
    {"loop.own_readings": 2},
)
# the same follower beside a leader of springs alone: (b − 1)(17 − c) − 4 (5 − c) = 8/3 (1 + c) at b = 7/3
ONE_DAMPED = put(
    proved(
        loop(arm("7/3", 4), arm(4, 4, local_damping_N_s_per_m=1)),
        signs(at_one=2, at_minus_one=1),
        signs(at_one=1),
        signs(at_one=1, factor=[17, -1]),
    ),
    {"loop.own_readings": 2},
)
# γ = −1, β = 3: M_ii = (17 − c)/(7 + c), beside 2: (17 − c)² − 4 (7 + c)² = 3 (1 − c)(31 + c)
DRIVEN_ON = put(
    proved(
        loop(arm(4, 4, local_damping_N_s_per_m=-1)),
        signs(at_one=3, factor=[31, 1]),
        signs(at_one=1, factor=[17, -1]),
    ),
    {"loop.own_readings": 2},
)
# β = 1 beside K/2 (1 + 2c), K = 1/3: 1 − (1 + 2c)²/36
DRIVEN_LINK = put(
    proved(loop(arm("13/12", "1/3", link_delay_s=1)), signs(at_one=2, factor=[35, -4, -4])),
    {"loop.own_readings": 2},
)


def losing(leader: Any, follower: Any) -> Any:
    """β' and γ' of both."""
    keys = ("damping_N_s_per_m", "local_damping_N_s_per_m")
    pairs = zip(("leader", "follower"), (leader, follower), strict=True)
    return {name: dict(zip(keys, least, strict=True)) for name, least in pairs}


# the leader reads itself twice in a sample, the follower once: (3 − 1)(4 − 2) = 2²
UNEQUAL_RATES = put(
    proved(loop(arm(3, 4), arm(4, 4)), NOWHERE), {"loop.own_readings": 2, "loop.follower.own_readings": 1}
)
SLIPPING = put(loop(arm(2, 4, local_damping_N_s_per_m=1)), {"own_readings": 2})
ENCODERS = put(
    SPRING,
    {
        f"loop.{side}.{key}": value
        for side in ("leader", "follower")
        for key, value in (("resolution_m", 1), ("coulomb_friction_N", 4), ("damping_N_s_per_m", 4))
    },
)
# the follower's force is half as large, and so is its error
UNEQUAL_ENCODERS = put(
    UNEQUAL,
    {
        f"loop.{side}.{key}": value
        for side, friction in (("leader", 4), ("follower", 2))
        for key, value in (("resolution_m", 1), ("coulomb_friction_N", friction))
    },
)
ONE_ENCODER = put(
    SPRING,
    {
        "loop.leader.resolution_m": 1,
        "loop.leader.coulomb_friction_N": 2,
        "loop.follower.coulomb_friction_N": 2,
    },
)
ACTIVE = loop(arm("1/2", 4))
TO_AND_FRO = moved(ACTIVE, [0, 1, 0], [0, 0, 0])
LINKED = loop(arm(1, 4, link_delay_s=1))
ROUND = moved(LINKED, [0, 1, 0, 0], [0, 0, -1, 0])
ON = moved(loop(arm(1, 4)), [0, 1, 2], [0, 0, 0])
# own taps 4 + 2 and −2, twice in a sample
TWICE = moved({**loop(arm("1/2", 4, local_damping_N_s_per_m=1)), "own_readings": 2}, [0, 1, 0], [0, 0, 0])
PARTLY = moved(loop(arm("1/8", 4, delay_s="1/2"), arm(1, 4)), [0, 1, 0, 0], [0, 0, 0, 0])
WANDERING = [0, 0, 1, -1, 1, 2, 0], [0, 3, -1, 2, 0, -1, 0]
TURNED = {"leader_switch_positions_m": [1, "1/2", 0]}
# half a count of the leader's spring holds 1/2 J; the force is −4 N just below the edge, and 0 above it
FINE = arm(0, 4)
COARSE = moved(loop({**FINE, "resolution_m": 2}, FINE), [0, "-1/4", 0], [0, 0, 0])
COUNTED = moved(loop({**FINE, "resolution_m": 1}, FINE), [0, "-1/8", 0], [0, 0, 0])
BOTH_COUNTED = moved(loop({**FINE, "resolution_m": "1/2"}), [0, "-1/4", 0], [0, 0, 0])
# the leader is sent the follower's force, a sample late: b − 1 − 2c, b − 1 and (1 + ζ)(1 + ζ̄) = 2 + 2c
SENT = proved(
    loop(arm(5, 0, reflection=1, link_delay_s=1), arm(3, 2)),
    signs(at_one=3),
    signs(at_one=1, factor=[2, -1]),
    signs(at_one=1),
)
# a drive in the follower's arm, whose β = b − K/4 is 2 as before; the leader errs by 2 ζ and by −2 ζ
SENT_COUNTED = put(
    SENT,
    {
        "loop.own_readings": 2,
        "loop.follower.damping_N_s_per_m": "5/2",
        **{
            f"loop.{side}.{key}": value
            for side in ("leader", "follower")
            for key, value in (("resolution_m", 1), ("coulomb_friction_N", 2))
        },
    },
)
ITS_OWN = moved(loop(arm("1/2", 0, reflection=1, link_delay_s=1), arm(3, 2)), [0, 1, 1, 0], [0, 0, 0, 0])
FACTORS, NEGATIVE = "do not multiply", "is not negative at this frequency"

DRAWN = json.loads(Path(__file__).with_name("pairs.json").read_text(encoding="utf-8"))


def drawn() -> Any:
    """Each as it is, and with another number."""
    for place, told_ in enumerate(DRAWN):
        name = f"drawn {place}, {told_['kind']}"
        yield accepted(name, told_)
        if told_["kind"] == "pair motion":
            energy = Fraction(told_["energy_J"])
            yield refused(f"{name}, more", told(told_, energy * (1 + 5 * TINY)), "not ")
            yield refused(f"{name}, less", told(told_, energy * (1 - 5 * TINY)), "not ")
        elif told_["kind"] == "pair":
            for side in ("leader", "follower"):
                key = f"loop.{side}.damping_N_s_per_m"
                value = Fraction(told_["loop"][side]["damping_N_s_per_m"])
                yield refused(f"{name}, {side}", put(told_, {key: value * (1 - TINY)}), "multiply")


CASES = [
    *drawn(),
    *edge(
        "springs",
        SPRING,
        put(SPRING, {"loop.leader.damping_N_s_per_m": 4 - TINY}),
        FACTORS,
        "nowhere negative",
        shows="passive",
        hands="every",
        contact="both sides",
        encoder="ideal",
    ),
    refused("springs a hair stiffer", put(SPRING, {"loop.follower.stiffness_N_per_m": 4 + TINY}), FACTORS),
    *edge(
        "unequal springs, the follower counted twice",
        UNEQUAL,
        put(UNEQUAL, {"loop.follower.damping_N_s_per_m": 2 - TINY}),
        FACTORS,
    ),
    *edge(
        "rates that are not equal",
        UNEQUAL_RATES,
        put(UNEQUAL_RATES, {"loop.follower.damping_N_s_per_m": 4 - TINY}),
        FACTORS,
    ),
    accepted(
        "of a drive no more than it loses", put(DRIVEN_DAMPED, {"proof.losses": losing((3, 1), (3, 1))})
    ),
    *edge(
        "a stiffer drive that loses no less",
        put(
            DRIVEN_DAMPED,
            {"loop.leader.damping_N_s_per_m": 4 + TINY, "proof.losses": losing((3, 1), (3, 1))},
        ),
        put(
            DRIVEN_DAMPED,
            {"loop.leader.damping_N_s_per_m": 4 - TINY, "proof.losses": losing((3, 1), (3, 1))},
        ),
        "loses less",
    ),
    refused(
        "another part of it with the speed",
        put(DRIVEN_DAMPED, {"proof.losses": losing((3, 1), (3, 1 + TINY))}),
        "loses less",
    ),
    refused("losses without a drive", put(SPRING, {"proof.losses": losing((2, 0), (2, 0))}), "of a drive"),
    refused("the quicker arm as slow", put(UNEQUAL_RATES, {"loop.leader.own_readings": 1}), FACTORS),
    refused("more often than the loop", put(UNEQUAL_RATES, {"loop.leader.own_readings": 4}), "whole number"),
    *edge("a force that is sent", SENT, put(SENT, {"loop.leader.damping_N_s_per_m": 5 - TINY}), FACTORS),
    accepted("a leader without a spring has no force to send", put(SENT, {"loop.follower.reflection": 3})),
    refused("a force sent with its sign turned", put(SENT, {"loop.leader.reflection": -1}), "≥ 0"),
    *(
        case
        for side in ("leader", "follower")
        for case in edge(
            f"a force that is sent, in steps, the {side}",
            SENT_COUNTED,
            put(SENT_COUNTED, {f"loop.{side}.coulomb_friction_N": 2 - TINY}),
            "below the force error",
        )
    ),
    refused(
        "no more than a spring that is sent may hold",
        told(put(ITS_OWN, {"loop.leader.resolution_m": 1, "loop.follower.resolution_m": 1}), 1),
        "no more than the 1 J stored",
        1,
    ),
    accepted(
        "more than a spring that is sent may hold",
        told(put(ITS_OWN, {"loop.leader.resolution_m": 1, "loop.follower.resolution_m": "0.9"}), 1),
    ),
    *edge(
        "one's own force, sent back",
        told(ITS_OWN, 1),
        told(put(ITS_OWN, {"loop.leader.reflection": 1 - TINY}), 1),
        "energy",
    ),
    *edge("a link", LATE, put(LATE, {"loop.follower.link_delay_s": 1 + TINY}), FACTORS),
    *edge("late forces", LATER, put(LATER, {"loop.follower.damping_N_s_per_m": 14 - TINY}), FACTORS),
    accepted(
        "a link of less than a sample is one of a sample",
        put(LATE, {"loop.leader.link_delay_s": "1/9", "loop.follower.link_delay_s": "8/9"}),
    ),
    refused("no link at all", put(LATE, {"loop.leader.link_delay_s": 0}), "higher degree"),
    *edge("a damper", DAMPED, put(DAMPED, {"loop.leader.virtual_damping_N_s_per_m": 1 + TINY}), FACTORS),
    *edge(
        "dampers of their own", LOCAL, put(LOCAL, {"loop.leader.local_damping_N_s_per_m": 1 + TINY}), FACTORS
    ),
    *edge(
        "encoders",
        ENCODERS,
        put(ENCODERS, {"loop.follower.coulomb_friction_N": 4 - TINY}),
        "below the force error",
        "covers the steps of both",
        encoder="counted",
    ),
    *edge(
        "springs inside drives",
        DRIVEN,
        put(DRIVEN, {"loop.follower.damping_N_s_per_m": 3 - TINY}),
        FACTORS,
    ),
    *edge(
        "dampers inside drives",
        DRIVEN_DAMPED,
        put(DRIVEN_DAMPED, {"loop.follower.local_damping_N_s_per_m": 1 - TINY}),
        FACTORS,
    ),
    *edge(
        "a damper inside one drive",
        ONE_DAMPED,
        put(ONE_DAMPED, {"loop.leader.damping_N_s_per_m": Fraction(7, 3) - TINY}),
        FACTORS,
    ),
    *edge(
        "dampers that drive on inside drives",
        DRIVEN_ON,
        put(DRIVEN_ON, {"loop.leader.local_damping_N_s_per_m": -1 - TINY}),
        FACTORS,
    ),
    accepted("drives over a link", DRIVEN_LINK),
    accepted("one reading of its own", put(SPRING, {"loop.own_readings": 1})),
    refused("no reading", put(SPRING, {"loop.own_readings": 0}), "must be ≥ 1"),
    refused("a late drive", put(DRIVEN, {"loop.follower.delay_s": 1}), "without delay"),
    refused("a late drive of the leader", put(DRIVEN, {"loop.leader.delay_s": 1}), "without delay"),
    refused(
        "drives that gain",
        {**DRIVEN_DAMPED, "loop": put(SLIPPING, {"leader.damping_N_s_per_m": "7/4"})},
        "by itself",
    ),
    refused(
        "drives at the edge",
        {**DRIVEN_DAMPED, "loop": put(SLIPPING, {"leader.local_damping_N_s_per_m": -1})},
        "very edge",
    ),
    *edge(
        "drives that gain by themselves",
        violated(put(SLIPPING, {"follower.damping_N_s_per_m": 2 - TINY})),
        violated(SLIPPING),
        "proof is missing",
        "by itself inside a sample",
    ),
    refused(
        "at a frequency, drives that gain by themselves",
        violated(put(SLIPPING, {"follower.damping_N_s_per_m": 2 - TINY}), 0),
        "proof is of no use",
    ),
    refused("at no frequency", violated(ACTIVE), "proof is missing"),
    *edge(
        "encoders of unequal springs",
        UNEQUAL_ENCODERS,
        put(UNEQUAL_ENCODERS, {"loop.follower.coulomb_friction_N": 2 - TINY}),
        "below the force error",
    ),
    *edge(
        "one encoder",
        ONE_ENCODER,
        put(ONE_ENCODER, {"loop.follower.coulomb_friction_N": 2 - TINY}),
        "below the force error",
        "covers the steps of both",
        encoder="counted",
    ),
    refused(
        "encoders, the leader's friction",
        put(ENCODERS, {"loop.leader.coulomb_friction_N": 4 - TINY}),
        "below the force error",
    ),
    refused(
        "a coarser one on the other side",
        put(ENCODERS, {"loop.follower.resolution_m": 1 + TINY}),
        "below the force error",
    ),
    refused("a diagonal that is negative", put(SPRING, {"proof.leader.factor": [-1]}), "not multiply"),
    refused("a proof of less", without(SPRING, "proof.both"), "proof.both is missing"),
    refused(
        "a spring on one side", put(SPRING, {"loop.leader.stiffness_N_per_m": 0}), "no spring to the other"
    ),
    refused(
        "a spring on the other side",
        put(SPRING, {"loop.follower.stiffness_N_per_m": 0}),
        "no spring to the other",
    ),
    refused("a spring that pushes", put(SPRING, {"loop.leader.stiffness_N_per_m": -1}), "must be ≥ 0"),
    refused(
        "a force that changes inside a sample, undamped",
        put(SPRING, {"loop.leader.delay_s": "1/2", "loop.leader.damping_N_s_per_m": 0}),
        "without damping",
    ),
    refused("a very old reading", put(LATE, {"loop.leader.link_delay_s": 401}), "400 samples old"),
    refused("a very late force", put(LATE, {"loop.leader.delay_s": 401}), "samples old"),
    *edge(
        "violated",
        violated(put(SPRING["loop"], {"leader.damping_N_s_per_m": 4 - TINY}), "1/3"),
        violated(SPRING["loop"], "1/3"),
        NEGATIVE,
        "in every round",
        shows="active",
        encoder="ideal",
    ),
    accepted("violated next to rest", violated(ACTIVE, 1 - TINY)),
    accepted("no damping at all", violated(loop(arm(0, 4)), 0)),
    accepted("as old as may be", violated(loop(arm(0, 4, link_delay_s=400, delay_s=400)), 0)),
    accepted(
        "a drive that drives on",
        violated({**loop(arm(2, 4, local_damping_N_s_per_m=-3)), "own_readings": 2}),
    ),
    refused("violated at rest", violated(ACTIVE, 1), "must be < 1"),
    *edge(
        "to and fro",
        told(TO_AND_FRO, 3),
        told(TO_AND_FRO, 3 + 4 * TINY),
        "not 3",
        "extracts 3 J",
        energy=3,
        shows="active",
        contact="both sides",
    ),
    refused(
        "to and fro, rubbed", put(told(TO_AND_FRO, 0), {"loop.leader.coulomb_friction_N": "3/2"}), "0 J", 0
    ),
    accepted(
        "thirds of one's own readings",
        told(put(TO_AND_FRO, {"loop.leader.local_damping_N_s_per_m": "1/3"}), "10/3"),
        energy="10/3",
    ),
    accepted(
        "thirds of the other's readings",
        told(
            put(
                moved(ACTIVE, [0, 1, 0], [0, -1, 0]),
                {
                    f"loop.{side}.{key}_N_s_per_m": value
                    for side in ("leader", "follower")
                    for key, value in (("virtual_damping", "1/3"), ("local_damping", "-1/3"))
                },
            ),
            "44/3",
        ),
        energy="44/3",
    ),
    accepted(
        "rounds longer than what is remembered",
        told(put(moved(LINKED, *WANDERING), {"repeats": again(0, 6, 9)}), 462),
        energy=462,
    ),
    *(
        refused(
            f"rounds of which a late {side} remembers more than the other",
            put(moved(loop(arm(1, 4)), *WANDERING), {f"loop.{side}.delay_s": 6, "repeats": again(3, 5, 9)}),
            f"extracts {energy} J",
            energy,
        )
        for side, energy in (("follower", -2922), ("leader", -2950))
    ),
    accepted("between two samples", told(TWICE, 4), energy=4),
    refused(
        "a part of a sample again", put(told(TWICE, 4), {"repeats": again(0, 1, 2)}), "that both arms send"
    ),
    refused(
        "a sample again, from within one",
        put(told(moved(TWICE["loop"], [0, 1, 0, 0], [0] * 4), 4), {"repeats": again(1, 3, 2)}),
        "that both arms send",
    ),
    accepted("both arms", told(ROUND, 8), energy=8),
    accepted("five rounds", put(told(ROUND, 24), {"repeats": again(0, 3, 5)}), energy=24),
    accepted("many rounds", put(told(ROUND, 4004), {"repeats": again(0, 3, 1000)}), energy=4004),
    refused("always on", put(ON, {"repeats": again(1, 2, 10)}), "extracts -231", -231),
    accepted("another weight", told(put(ROUND, {"loop.leader.stiffness_N_per_m": 8}), 18), energy=18),
    accepted("inside a sample", told(put(PARTLY, TURNED), "13/8"), energy="13/8"),
    refused("inside a sample, untold", PARTLY, "switch positions is missing"),
    refused("too few instants", put(PARTLY, {"leader_switch_positions_m": [1]}), "one switch position"),
    refused(
        "too many instants",
        put(PARTLY, {"leader_switch_positions_m": [1, "1/2", 0, 0]}),
        "one switch position",
    ),
    refused("instants of no use", put(TO_AND_FRO, {"follower_switch_positions_m": [0, 0]}), "of no use"),
    refused(
        "one longer than the other", put(TO_AND_FRO, {"follower_positions_m": [0, 0]}), "start at rest at 0"
    ),
    *edge(
        "over an edge",
        told(put(COUNTED, {"leader_positions_m": [0, -Fraction(1, 8) - TINY, 0]}), Fraction(1, 2) + 4 * TINY),
        COUNTED,
        "no more than the 0.5 J stored",
        energy=Fraction(1, 2) + 4 * TINY,
        encoder="counted",
    ),
    *edge(
        "over an edge of both",
        told(
            put(BOTH_COUNTED, {"leader_positions_m": [0, -Fraction(1, 4) - TINY, 0]}),
            Fraction(1, 2) + 2 * TINY,
        ),
        BOTH_COUNTED,
        "no more than the 0.5 J stored",
    ),
    *edge(
        "over an edge of a coarse encoder",
        told(put(COARSE, {"leader_positions_m": [0, -Fraction(1, 4) - TINY, 0]}), 2 + 8 * TINY),
        COARSE,
        "no more than the 2 J stored",
    ),
    refused(
        "up by half a count in each round",
        put(
            COUNTED,
            {"leader_positions_m": [0, "1/2"], "follower_positions_m": [0, 0], "repeats": again(0, 1, 8)},
        ),
        "extracts -24",
        -24,
    ),
    refused(
        "on by half a count in each round",
        put(
            COUNTED,
            {"leader_positions_m": [0, "-1/2"], "follower_positions_m": [0, 0], "repeats": again(0, 1, 8)},
        ),
        "extracts -32",
        -32,
    ),
    refused("shorter than the other", put(TO_AND_FRO, {"leader_positions_m": [0, 0]}), "start at rest at 0"),
    refused(
        "the leader apart at first", put(TO_AND_FRO, {"leader_positions_m": [1, 1, 0]}), "start at rest at 0"
    ),
    refused("apart at first", put(TO_AND_FRO, {"follower_positions_m": [1, 1, 1]}), "start at rest at 0"),
    refused(
        "the follower apart at first",
        put(TO_AND_FRO, {"follower_positions_m": [1, 1, 0]}),
        "start at rest at 0",
    ),
    refused("rounds beyond the end", put(TO_AND_FRO, {"repeats": again(1, 3, 2)}), "must lie in the motion"),
]
