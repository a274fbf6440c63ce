"""Compensation of friction of two arms, T = 1 s: F tanh(v/v_s) + C v under a line h + s v.

Without delay, with K = 4, it is M_ii = b − 2 − s/2 − (C + s/2) c beside M_lf = 2: with b = 4 + C + s the
determinant is 0 at c = 1.  With C = 1 that is (3 − c)² − 4 = (1 − c)(5 − c); with s = 1 (5 − c)²/4 − 4 =
(1 − c)(9 − c)/4.

`pair_compensation.json` has proofs and motions of pairs drawn at random, near the most that is passive; the
prover found them.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from decimal import Decimal, localcontext
from fractions import Fraction
from importlib import import_module
from pathlib import Path
from random import Random
from typing import Any

from . import TINY, Case, accepted, edge, put, refused, without
from .linear import signs
from .pair import (
    FACTORS,
    NEGATIVE,
    NOWHERE,
    SPRING,
    TO_AND_FRO,
    arm,
    loop,
    moved,
    told,
    violated,
)


def law(coulomb: Any, viscous: Any, speed: Any) -> Any:
    """F, C and v_s."""
    return {
        "compensated_coulomb_friction_N": coulomb,
        "compensated_damping_N_s_per_m": viscous,
        "compensation_speed_m_per_s": speed,
    }


def helped(damping: Any, compensation: Any, **more: Any) -> Any:
    """Two arms with K = 4 and one compensation."""
    return loop({**arm(damping, 4, **more), "compensation": compensation})


def proved(told_: Any, arms: Any, both: Any, **tangents: Any) -> Any:
    """With one sign for both arms."""
    proof = {"leader": arms, "follower": arms, "both": both, "tangents": tangents}
    return {"kind": "pair", "loop": told_, "proof": proof}


LEVEL = (signs(at_one=1), NOWHERE)
"""Of springs without compensation that takes damping."""

# F in the direction of motion costs F of Coulomb friction
DRY = proved(helped(4, law(3, 0, 0), coulomb_friction_N=3), *LEVEL)
VISCOUS = (signs(at_one=1, factor=[3, -1]), signs(at_one=3, factor=[5, -1]))
WET = proved(helped(5, law(0, 1, 0)), *VISCOUS)
# r = 0: s = F/v_s = 1
STEEP = proved(
    helped(5, law(2, 0, 2)),
    signs(at_one=1, factor=[5, -1]),
    signs(at_one=3, factor=[9, -1]),
    leader=0,
    follower=0,
)
# r = 1/2: s = 3/4 F/v_s = 1, h = F/2 − F (3/4) artanh 1/2 = 0.0880203917494588657… F, F = 4/3
HALFWAY = put(STEEP, {"proof.tangents": {"leader": "1/2", "follower": "1/2"}})
for _side in ("leader", "follower"):
    HALFWAY = put(
        HALFWAY,
        {
            f"loop.{_side}.compensation": law("4/3", 0, 1),
            f"loop.{_side}.coulomb_friction_N": "0.11736052233261182098",
        },
    )
# m = 2 readings of its own: β = b − K/4 = 3, and C c is taken from it
DRIVEN = put(proved(helped(4, law(0, 1, 0)), *VISCOUS), {"loop.own_readings": 2})
STEEP_DRIVEN = put(
    proved(
        helped(4, law(1, 0, 1)),
        signs(at_one=1, factor=[5, -1]),
        signs(at_one=3, factor=[9, -1]),
        leader=0,
        follower=0,
    ),
    {"loop.own_readings": 2},
)
COUNTED = {"resolution_m": 1}
# of any mean it takes C + s of damping alone
WET_MEAN = proved(helped(5, law(0, 1, 0)), *LEVEL, speed="any mean")
STEEP_MEAN = proved(helped(5, law(2, 0, 2)), *LEVEL, leader=0, follower=0, speed="any mean")
DRIVEN_MEAN = put(proved(helped(4, law(0, 1, 0)), *LEVEL, speed="any mean"), {"loop.own_readings": 2})
WET_MEAN_COUNTED = put(WET_MEAN, {"loop": helped(5, law(0, 1, 0), **COUNTED, coulomb_friction_N=5)})
# half a count of each reading: own taps K − C and C, or K − 1/2 and 1/2 and as much again for what is no line
WET_COUNTED = proved(helped(5, law(0, 1, 0), **COUNTED, coulomb_friction_N=4), *VISCOUS)
STEEP_COUNTED = put(STEEP, {"loop": helped(5, law(2, 0, 2), **COUNTED, coulomb_friction_N="9/2")})
DRIVEN_COUNTED = put(
    DRIVEN, {"loop": {**helped(4, law(0, 1, 0), **COUNTED, coulomb_friction_N=5), "own_readings": 2}}
)
# with a drive s/2 is uncertain by a count, and the s/2 of the move before by another
STEEP_DRIVEN_COUNTED = put(
    STEEP_DRIVEN, {"loop": {**helped(4, law(1, 0, 1), **COUNTED, coulomb_friction_N=5), "own_readings": 2}}
)
# T = 2, K T as before: own taps 7/4 and 1/4, 2 of the other, and a quarter
STEEP_SLOW = put(
    STEEP, {"loop": loop({**arm(5, 2, **COUNTED, coulomb_friction_N="9/4"), "compensation": law(2, 0, 2)})}
)
STEEP_SLOW["loop"]["sample_period_s"] = 2
# at c = 1/3 the diagonal is b − 2 − C/3
SHAKEN = helped(5, law(100, 3, 0))
SLIPPING = {**helped(2 - TINY, law(7, 0, 1), local_damping_N_s_per_m=1), "own_readings": 2}
LATE = helped("1/2", law(1, 0, 1), delay_s="1/2")

# the arm goes out at 1 m/s and is braked on the way back by as much as it was helped
BRAKED = put(TO_AND_FRO, {"loop.leader.compensation": law(1, 0, 0)})
# late by a sample it helps the third move alone: 4 + 3/2 − 2 J are put in
LATER = moved(
    loop({**arm("1/2", 4, delay_s=1), "compensation": law(2, 0, 0)}, arm("1/2", 4)), [0, 1, 2, 3, 3], [0] * 5
)
TANH_ONE = "0.76159415595576488811945828260479359041276859725793655"


def drawn() -> Iterator[Case]:
    """Each as it is, and with a little more of compensation."""
    for place, told_ in enumerate(
        json.loads(Path(__file__).with_suffix(".json").read_text(encoding="utf-8"))
    ):
        name = f"drawn {place}, {told_['kind']}"
        yield accepted(name, told_)
        key = "loop.leader.compensation.compensated_damping_N_s_per_m"
        value = Fraction(told_["loop"]["leader"]["compensation"]["compensated_damping_N_s_per_m"])
        if told_["kind"] == "pair":
            yield refused(f"{name}, more of it", put(told_, {key: value + TINY}), "multiply")


def tanh_is_enclosed() -> str:
    """Between both numbers, which lie closely."""
    between, bits = _module().tanh_between, _module().BITS
    random = Random(1)
    for x in [
        0,
        *(Fraction(random.random()) * 10 ** random.randint(-9, 2) for _ in range(60)),
        43,
        63,
        64,
        65,
    ]:
        low, high = between(Fraction(x))
        with localcontext() as context:
            context.prec = 120
            far = (2 * Decimal(Fraction(x).numerator) / Decimal(Fraction(x).denominator)).exp()
            true = (far - 1) / (far + 1) * 2**bits
        if not low <= true <= high or high - low > 3:
            return f"tanh {x}: {low - true} … {high - true}"
    if between(Fraction(0)) != (0, 2):
        return "tanh 0"
    return "" if between(Fraction(10**40)) == (2**bits - 1, 2**bits) else "tanh far out"


def artanh_is_from_below() -> str:
    """Never above, and never far below."""
    below, random = _module().artanh_below, Random(2)
    parts = [Fraction(1, 3), Fraction(3, 5), Fraction(7, 9)]  # where (1 + r)/(1 − r) is a power of 2
    parts += [1 - Fraction(random.random()) / 10 ** random.randint(0, 12) for _ in range(60)]
    for r in parts:
        with localcontext() as context:
            context.prec = 120
            found = below(r)
            y = (1 + r) / (1 - r)
            true = (Decimal(y.numerator) / Decimal(y.denominator)).ln() / 2
            off = true - Decimal(found.numerator) / Decimal(found.denominator)
        if not 0 <= off <= true / 2**150:
            return f"artanh {float(r)}: {off} below"
    return "artanh 0 is not 0" if below(Fraction(0)) else ""


def _module() -> Any:
    """Of the checker, as it is loaded now."""
    return import_module("zwidth.checker.pair.coupling")


CASES = [
    *drawn(),
    *(
        Case(check.__name__.replace("_", " "), check, "")
        for check in (tanh_is_enclosed, artanh_is_from_below)
    ),
    *edge(
        "in the direction of motion",
        DRY,
        put(DRY, {"loop.follower.compensation": law(3 + TINY, 0, 0)}),
        "of compensation",
        shows="passive",
    ),
    accepted("at every speed it is less", put(DRY, {"loop.leader.compensation": law(3, 0, 1)})),
    accepted("of one arm alone", without(DRY, "loop.follower.compensation")),
    refused("no line", without(DRY, "proof.tangents"), "proof.tangents is missing"),
    refused("a line of nothing", put(SPRING, {"proof.tangents": {}}), "of no use"),
    refused("a line at no speed", put(DRY, {"proof.tangents": {"leader": "1/2"}}), "has no tangent below 1"),
    refused("a line beyond", put(DRY, {"proof.tangents": {"leader": 1 + TINY}}), "must be ≤ 1"),
    *edge("C", WET, put(WET, {"loop.leader.compensation": law(0, 1 + TINY, 0)}), FACTORS),
    *edge("at rest", STEEP, put(STEEP, {"loop.follower.compensation": law(2 + TINY, 0, 2)}), FACTORS),
    *edge(
        "between",
        HALFWAY,
        put(HALFWAY, {"loop.leader.coulomb_friction_N": "0.11736052233261182096"}),
        "of compensation",
    ),
    *edge(
        "C beside a drive", DRIVEN, put(DRIVEN, {"loop.leader.compensation": law(0, 1 + TINY, 0)}), FACTORS
    ),
    *edge(
        "at rest, beside a drive",
        STEEP_DRIVEN,
        put(STEEP_DRIVEN, {"loop.follower.compensation": law(1 + TINY, 0, 1)}),
        FACTORS,
    ),
    *(
        case
        for name, true in (
            ("C and encoders", WET_COUNTED),
            ("at rest and encoders", STEEP_COUNTED),
            ("C, drives and encoders", DRIVEN_COUNTED),
            ("at rest, drives and encoders", STEEP_DRIVEN_COUNTED),
            ("at rest and encoders, every other second", STEEP_SLOW),
            ("C of any mean and encoders", WET_MEAN_COUNTED),
        )
        for case in edge(
            name,
            true,
            put(
                true,
                {
                    "loop.leader.coulomb_friction_N": Fraction(true["loop"]["leader"]["coulomb_friction_N"])
                    - TINY
                },
            ),
            "below the force error",
            "covers the steps",
            encoder="counted",
        )
    ),
    *edge(
        "C of any mean", WET_MEAN, put(WET_MEAN, {"loop.leader.compensation": law(0, 1 + TINY, 0)}), FACTORS
    ),
    *edge(
        "at rest, of any mean",
        STEEP_MEAN,
        put(STEEP_MEAN, {"loop.follower.compensation": law(2 + TINY, 0, 2)}),
        FACTORS,
    ),
    *edge(
        "C of any mean beside a drive",
        DRIVEN_MEAN,
        put(DRIVEN_MEAN, {"loop.leader.compensation": law(0, 1 + TINY, 0)}),
        FACTORS,
    ),
    refused("another mean", put(WET_MEAN, {"proof.tangents.speed": "some mean"}), "last move or any mean"),
    refused(
        "all damping taken from a force that changes inside a sample",
        proved(LATE, *LEVEL, leader=0, follower=0),
        "without damping",
    ),
    *edge(
        "a large round, F is nothing",
        violated(put(SHAKEN, {"leader.damping_N_s_per_m": 5 - TINY}), "1/3"),
        violated(SHAKEN, "1/3"),
        NEGATIVE,
        "in every round",
        shows="active",
    ),
    accepted("inside a sample, whatever F is", without(violated(SLIPPING, 0), "proof")),
    refused(
        "inside a sample, C may brake",
        without(violated(put(SLIPPING, {"follower.compensation": law(7, TINY, 1)}), 0), "proof"),
        "unless compensation",
    ),
    *edge("braked by F", told(BRAKED, 2), told(BRAKED, 2 + 4 * TINY), "not 2", energy=2),
    refused("late by a sample", LATER, "extracts -3.5", Fraction(-7, 2)),
    accepted("braked by C", told(put(BRAKED, {"loop.leader.compensation": law(0, 1, 0)}), 2), energy=2),
    accepted(
        "braked by tanh 1, at most",
        told(put(BRAKED, {"loop.leader.compensation": law(1, 0, 1)}), str(3 - Decimal(TANH_ONE))),
    ),
]
