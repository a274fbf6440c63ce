"""Arms whose joints damp each other: δ is a matrix, in the place of a number for each joint.

At one place as in `arm`.  And two slides at right angles, where J = 1 and the sides are known by hand: with
R = diag(1/2, 1/4) and δ = ((59/100, c), (c, 1/4 + d)) the matrix δ − R is ≻ 0 exactly if 9 d/100 > c².
"""

from __future__ import annotations

from typing import Any

from . import TINY, Case, Fraction, accepted, plain, put, refused, without
from .arm import ARMS, LESS, MIXED, TWO, damped, of

ALONG_X = [["0", "0", "1"], ["0", "1", "0"], ["-1", "0", "0"]]
THEN_Y = [["1", "0", "0"], ["0", "0", "1"], ["0", "-1", "0"]]
"""Turned so that the third axis is along x of the base, then along y."""
ENOUGH, COUPLED = Fraction(4, 100), Fraction(6, 100)


def table(d: Any = ENOUGH, c: Any = COUPLED, **entries: Any) -> Any:
    """Two slides before a wall of 1000 and 500 N/m, T = 1 ms."""
    slide = {"kind": "prismatic", "translation_m": ["0", "0", "0"], "low_m": "-0.1", "high_m": "0.1"}
    zero = [["0", "0"], ["0", "0"]]
    document = {
        "kind": "arm",
        "arm": {
            "geometry": "chain",
            "joints": [{**slide, "rotation": ALONG_X}, {**slide, "rotation": THEN_Y}],
            "end_m": ["0", "0", "0"],
            "damping_N_m_s_rad": [[Fraction(59, 100), c], [c, Fraction(1, 4) + d]],
        },
        "wall": {
            "stiffness_N_per_m": [["1000", "0"], ["0", "500"]],
            "virtual_damping_N_s_per_m": zero,
            "damping_bound_N_s_per_m": zero,
        },
        "loop": {
            "sample_period_s": "1/1000",
            "delay_samples": 0,
            "encoder": "ideal",
            "torque": "follows the arm",
        },
    }
    return put(plain(document), entries)


def one_by_one(document: Any) -> Any:
    """The same arm with a number for each joint or leg, told as a matrix."""
    part = "joints" if "joints" in document["arm"] else "legs"
    keys = [
        f"arm.{part}.{i}.{next(key for key in joint if key.startswith('damping'))}"
        for i, joint in enumerate(document["arm"][part])
    ]
    own = [joint[key.split(".")[-1]] for joint, key in zip(document["arm"][part], keys, strict=True)]
    name = "damping_N_m_s_rad" if part == "joints" else "damping_N_m_s_per_rad"
    matrix = [[b if i == k else "0" for k in range(len(own))] for i, b in enumerate(own)]
    return put(without(document, *keys), {f"arm.{name}": matrix})


def turned_round(document: Any) -> Any:
    """The same arm, its legs told from the last to the first."""
    legs, matrix = document["arm"]["legs"], document["arm"]["damping_N_m_s_per_rad"]
    told = {"arm.legs": legs[::-1], "arm.damping_N_m_s_per_rad": [row[::-1] for row in matrix[::-1]]}
    return put(document, told)


APART = "coupled legs, elbows apart"
MATRIX = "arm.damping_N_m_s_rad"
CASES: list[Case] = [
    *(case for name in ARMS if "coupled" in name for case in of(name)),
    *(
        accepted(f"{name}, told as a matrix", one_by_one(damped(name, 1 + TINY)))
        for name in ("mixed", "two legs")
    ),
    *(
        refused(f"{name}, told as a matrix, but for a hair", one_by_one(damped(name, 1 - TINY)), LESS)
        for name in ("mixed", "two legs")
    ),
    accepted("the other leg first", turned_round(damped(APART, 1 + TINY))),
    refused("the other leg first, but for a hair", turned_round(damped(APART, 1 - TINY)), LESS),
    accepted("two slides that damp each other", table(ENOUGH * (1 + TINY))),
    refused("two slides, but for a hair", table(ENOUGH * (1 - TINY)), LESS),
    accepted("two slides, the other way round", table(ENOUGH * (1 + TINY), -COUPLED)),
    refused("two slides, coupled a hair more", table(ENOUGH, COUPLED * (1 + TINY)), LESS),
    accepted("two slides, coupled a hair less", table(ENOUGH, COUPLED * (1 - TINY))),
    refused("a matrix, and a number of a joint", table(**{"arm.joints.0.damping_N_s_per_m": 9}), "of no use"),
    refused("neither", without(table(1), MATRIX), "damping of each joint is missing"),
    refused("a number of one joint alone", without(MIXED, "arm.joints.1.damping_N_s_per_m"), "is missing"),
    refused("not symmetric", table(1, **{f"{MATRIX}.0": ["0.59", "0.0600000001"]}), "not symmetric"),
    refused("not symmetric below", table(1, **{f"{MATRIX}.0": ["0.59", "0.0599999999"]}), "not symmetric"),
    refused(
        "one of three pairs not symmetric",
        put(damped("coupled chain", 9), {f"{MATRIX}.2.1": "0.0001"}),
        "not symmetric",
    ),
    refused("a row too many", table(1, **{MATRIX: [["9", "0"], ["0", "9"], ["0", "0"]]}), "has 2 rows"),
    refused("a row too few", table(1, **{MATRIX: [["9", "0"]]}), "has 2 rows"),
    refused("a row too short", table(1, **{f"{MATRIX}.1": ["9"]}), "has 2 rows"),
    refused("a row too long", table(1, **{f"{MATRIX}.0": ["9", "0", "0"]}), "has 2 rows"),
    refused("a negative eigenvalue", table(1, 9), "not positive definite"),
    refused(
        "a motion that costs nothing", table(**{MATRIX: [["1", "1"], ["1", "1"]]}), "not positive definite"
    ),
    refused("a negative number on the diagonal", table(-1), "not positive definite"),
    refused("a matrix of more than 2⁶⁴", table(1 + 2**64), "a number is too large"),
    refused("an empty matrix", table(**{MATRIX: []}), "must have 1 to 16 entries"),
    refused(
        "a matrix of legs in the unit of chains",
        put(one_by_one(TWO), {MATRIX: [["9", "0"], ["0", "9"]]}),
        "the unit of damping must be that of damping_N_m_s_per_rad",
    ),
]
