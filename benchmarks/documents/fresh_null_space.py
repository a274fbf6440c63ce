"""Null-space springs written from nothing: friction about what is needed at random places, or more."""

from __future__ import annotations

from fractions import Fraction
from random import Random
from typing import Any

import numpy as np

from .judges.null_space import Redundant

Document = dict[str, Any]

TURNS = (
    [["1", "0", "0"], ["0", "1", "0"], ["0", "0", "1"]],
    [["1", "0", "0"], ["0", "0", "-1"], ["0", "1", "0"]],
    [["0", "0", "1"], ["0", "1", "0"], ["-1", "0", "0"]],
    [["3/5", "0", "4/5"], ["0", "1", "0"], ["-4/5", "0", "3/5"]],
)
PLACES = 40


def null_space(rng: Random) -> Document:
    """Three or four joints, a hand of one to three coordinates, in the plane in pose or not."""
    planar = rng.random() < 0.3
    turns = 1 if planar and rng.random() < 0.5 else 0
    size = rng.choice((1, 2)) if planar else rng.randint(1, 3)
    joints, rest = [], []
    for _ in range(rng.randint(max(2, size + turns), 4)):
        low = Fraction(rng.randint(-20, 10), 10)
        high = low + Fraction(rng.choice((0, 1, 5, 20)), 10)
        rest.append(low + (high - low) * Fraction(rng.randint(0, 4), 4))
        joints.append({
            "kind": "revolute", "rotation": TURNS[0] if planar else rng.choice(TURNS),
            "translation_m": [str(Fraction(rng.randint(-20, 20), 100)) for _ in range(3)],
            "low_rad": str(low), "high_rad": str(high),
            "damping_N_m_s_per_rad": str(Fraction(rng.randint(1, 50), 100)), "coulomb_friction_N_m": "0",
        })  # fmt: skip
    size = 2 if turns else size
    rows = [["10" if i == k else "0" for k in range(size + turns)] for i in range(size + turns)]
    none = [["0"] * (size + turns) for _ in range(size + turns)]
    units = ("N_m_rad", "N_m_s_rad") if turns else ("N_per_m", "N_s_per_m")
    wall: Document = {f"stiffness_{units[0]}": rows}
    wall |= {f"{name}_{units[1]}": none for name in ("virtual_damping", "damping_bound")}
    distance = Fraction(rng.choice((1, 3, 10, 30, 60)), 100)
    document = {
        "kind": "null space",
        "arm": {
            "joints": joints,
            "end_m": [str(Fraction(rng.randint(2, 15), 100)) for _ in range(3)],
        },
        "wall": wall | ({"turns": 1, "rest": "every orientation"} if turns else {}),
        "loop": {"sample_period_s": "0.001", "delay_samples": rng.choice((0, 0, 2))},
        "spring": {
            "stiffness_N_m_per_rad": str(rng.choice((1, 10))),
            "damping_N_m_s_per_rad": rng.choice(("0", "0.01")),
            "rest_rad": [str(x) for x in rest],
            "regularization": rng.choice(("0", "0", "0.05", "0.2")),
            "distance_rad": str(distance),
        },
    }  # fmt: skip
    _rub(document, rng, float(distance))
    return document


def _rub(document: Document, rng: Random, distance: float) -> None:
    """Friction in each joint of the largest lack found, times some factor."""
    arm, places = Redundant(document), np.random.default_rng(rng.randrange(2**31))
    found = np.zeros(len(arm.rest))
    try:
        first = arm.projector(arm.rest)
        for _ in range(PLACES):
            q = arm.anywhere(distance, places)
            found = np.maximum(found, np.abs((arm.projector(q) - first) @ (q - arm.rest)))
    except ValueError:
        pass
    stiffness = float(document["spring"]["stiffness_N_m_per_rad"])
    for joint, lack in zip(document["arm"]["joints"], found, strict=True):
        factor = rng.choice((0.9, 1.1, 1.3, 2, 4))
        joint["coulomb_friction_N_m"] = f"{factor * stiffness * lack + 1e-12:.9g}"


FRESH_NULL_SPACE = {"null space": null_space}
