"""A motion against laws in a chain: the forces as they are listed, T = 1 s.  0 → 1 → 0 under 2 N
gains 2 − 2b − 2 f_c.
"""

from __future__ import annotations

from typing import Any

from . import Fraction, accepted, put, refused, without

WORDS = {"description": "a wall", "counts_force_limit": False, "counts_force_resolution": False}


def motion(positions: Any, forces: Any, part: tuple[int, int, int]) -> Any:
    """b = ½ N·s/m, Δ = 1 m."""
    return {
        "kind": "row motion",
        "loop": {
            "damping_N_s_per_m": "1/2",
            "coulomb_friction_N": 0,
            "resolution_m": 1,
            "sample_period_s": 1,
            "delay_s": 0,
        },
        "law": WORDS,
        "positions_m": positions,
        "forces_N": forces,
        "repeats": dict(zip(("first", "last", "times"), part, strict=True)),
        "energy_J": 0,
    }


def taken(name: str, energy: Any, told: Any, **facts: Any) -> Any:
    return accepted(name, put(told, {"energy_J": energy}), "more with each round", energy, **facts)


THERE = motion([0, 1, 0], [0, 2], (0, 2, 3))
FAR = motion([0, 3, 1, 3, 0], [0, 6, 2, 6], (1, 3, 2))

CASES = [
    taken(
        "three rounds",
        3,
        THERE,
        shows="active",
        hands="every",
        contact="made and broken",
        encoder="counted",
        force_limit=False,
        force_steps=False,
        fed_with="",
    ),
    taken("friction", "3/2", put(THERE, {"loop.coulomb_friction_N": "1/4"})),
    taken("T = 2", "9/2", put(THERE, {"loop.sample_period_s": 2})),
    taken("before and after the rounds", 34 - Fraction(9 + 16 + 9, 2), FAR),
    taken("it ends elsewhere", "5/2", motion([0, 1, 0, -1], [0, 2, 0], (0, 2, 3))),
    refused("nothing comes out", put(THERE, {"loop.damping_N_s_per_m": 1}), "none comes out", 0),
    refused(
        "rounds gain and all does not",
        motion([0, -9, 0, 1, 0], [0, 0, 0, 2], (2, 4, 3)),
        "none comes out",
        -78,
    ),
    refused("nothing comes out of a round", put(FAR, {"loop.damping_N_s_per_m": 1}), "none comes out", 0),
    refused("another energy", put(THERE, {"energy_J": 2}), "the energy is 3 J", 3),
    refused("a force too many", put(THERE, {"forces_N": [0, 2, 0]}), "one force for each move"),
    refused("a force too few", put(THERE, {"forces_N": [0]}), "one force for each move"),
    *(
        refused(f"rounds of {part}", motion([0, 1, 0], [0, 2], part), "return to where it began")
        for part in ((0, 1, 3), (1, 2, 3), (1, 1, 3), (2, 0, 3), (0, 3, 3))
    ),
    refused("no round", motion([0, 1, 0], [0, 2], (0, 2, 0)), "repeats.times must be ≥ 1"),
    refused("part of a sample", put(THERE, {"loop.delay_s": "1/4"}), "whole samples"),
    accepted(
        "as deep as its bound, under more N than m",
        put(THERE, {"energy_J": 3, "bounds": {"depth_m": 1, "speed_m_per_s": 1}}),
    ),
    refused(
        "deeper than its bound", put(THERE, {"bounds": {"depth_m": "1/2"}}), "does not keep to its depth"
    ),
    refused(
        "faster than its bound",
        put(THERE, {"bounds": {"speed_m_per_s": "1/2"}}),
        "does not keep to its speed",
    ),
    refused(
        "a description that is none",
        put(THERE, {"law.description": 1}),
        "description must be text of at most 10000 letters",
    ),
    refused("counts_force_limit is a word", put(THERE, {"law.counts_force_limit": "no"}), "true or false"),
    refused(
        "counts_force_resolution is a word",
        put(THERE, {"law.counts_force_resolution": "no"}),
        "true or false",
    ),
    *(
        refused(f"without {key}", without(THERE, key), phrase)
        for key, phrase in (
            ("positions_m", "positions_m is missing"),
            ("forces_N", "forces_N is missing"),
            ("repeats", "repeats is missing"),
            ("law", "law is missing"),
            ("law.description", "description is missing"),
        )
    ),
]
