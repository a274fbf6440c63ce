"""Two arms written from nothing, one in a hand that is known, the other damped about as much as it needs."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from math import cos
from random import Random

import numpy as np

from .fresh_pairs import loop_of_two
from .judges.held_pairs import ANGLES, encoder_error, needed, plant_of, read, run
from .polynomials import Document, close, short, texts


def _loop(rng: Random) -> tuple[Document, float]:
    """The pair and the hand, and the angle at which most is needed."""
    loop = loop_of_two(rng)[0]
    while loop.get("own_readings", 1) != 1:
        loop = loop_of_two(rng)[0]
    arm = rng.choice(("leader", "follower"))
    stiffness, period = Fraction(loop[arm]["stiffness_N_per_m"]), Fraction(loop["sample_period_s"])
    damping = Fraction(loop[arm]["damping_N_s_per_m"]) + stiffness * period * rng.choice((0, 1))
    mass = stiffness * period**2 * short(rng, 1, 100)
    document: Document = {
        "loop": loop,
        "held": {
            "arm": arm,
            "mass_kg": str(mass),
            "damping_N_s_per_m": str(damping),
            "stiffness_N_per_m": str(rng.choice((0, stiffness * short(rng, 0.1, 10)))),
        },
    }
    loop[arm]["coulomb_friction_N"] = "0" if rng.random() < 0.9 else "1/1000"
    found = read(document)
    assert found is not None
    free, held = found
    moving = tuple(float(Fraction(document["held"][k])) for k in list(document["held"])[1:])
    plant = plant_of(held, moving)  # type: ignore[arg-type]  # three of them
    needs = needed(free, held, plant, ANGLES)
    most = max(float(needs.max()), 1e-6)
    other = "leader" if arm == "follower" else "follower"
    loop[other]["damping_N_s_per_m"] = str(close(rng, Fraction(f"{most:.9g}")))
    if free.resolution or held.resolution:
        unit = np.eye(1, 2000)[0]
        error = encoder_error(free, held, plant, unit)
        loop[other]["coulomb_friction_N"] = str(close(rng, Fraction(f"{min(error, 1e6):.9g}")))
    return document, float(ANGLES[int(np.argmax(needs))])


def _proof(rng: Random) -> Document:
    document, _ = _loop(rng)
    held = document["held"]
    for key in list(held)[1:]:
        if rng.random() < 0.1:
            held[key] = [held[key], str(Fraction(held[key]) * short(rng, 1, 1.1))]
    return {"kind": "held pair", **document}


def _violation(rng: Random) -> Document:
    document, at = _loop(rng)
    return {"kind": "held pair violation", **document, "proof": {"cosine": f"{cos(at):.9f}"}}


def _motion(rng: Random) -> Document:
    """Some steps, with a part of the damping; the energy as it comes out, or nearly."""
    document, _ = _loop(rng)
    loop = document["loop"]
    other = "leader" if document["held"]["arm"] == "follower" else "follower"
    for name in ("leader", "follower"):
        loop[name]["coulomb_friction_N"] = loop[name]["resolution_m"] = "0"
    loop[other]["damping_N_s_per_m"] = str(Fraction(loop[other]["damping_N_s_per_m"]) * short(rng, 0.02, 0.5))
    found = read(document)
    assert found is not None
    free, held = found
    path = [
        Fraction(0),
        *(Fraction(rng.randint(-3, 3), 1000) for _ in range(rng.randint(2, 12))),
        Fraction(0),
    ]
    moving = tuple(float(Fraction(document["held"][k])) for k in list(document["held"])[1:])
    seen = np.array([float(x) for x in path])
    forces = run(free, held, plant_of(held, moving), seen, 0 * seen)  # type: ignore[arg-type]  # three of them
    moves, part = np.diff(seen), float(free.part)
    late, later = (np.concatenate([np.zeros(n), forces])[: len(moves)] for n in (free.whole, free.whole + 1))
    work = ((1 - part) * late + part * later) @ moves
    taken = -float(work) - float(free.damping / free.period) * float(moves @ moves)
    energy = Fraction(f"{taken:.13g}")
    return {
        "kind": "held pair motion", **document, "sample_period_s": loop["sample_period_s"],
        "energy_J": str(close(rng, energy) if rng.random() < 0.3 else energy), "positions_m": texts(path),
    }  # fmt: skip


FRESH_HELD_PAIRS: dict[str, Callable[[Random], Document]] = {
    "held pair": _proof,
    "held pair violation": _violation,
    "held pair motion": _motion,
}
