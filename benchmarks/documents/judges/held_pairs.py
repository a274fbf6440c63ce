"""Two arms of which a known hand holds one: waves solved for at many angles, eigenvalues, both arms run.

Intervals are looked at in their corners and at some places between.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from fractions import Fraction
from itertools import product
from typing import Any

import numpy as np

from ..opinion import Opinion, agrees, cannot_say, false
from ..plain import entry, exact, exacts
from .hands import CLOSE, Plant, held, radius
from .pair_arms import Arm, arms_of

Document = dict[str, Any]
Rng = np.random.Generator

SLACK = 1e-7
SAMPLES = 3000
ANGLES = np.concatenate([np.geomspace(1e-3, 0.1, 60), np.linspace(0.1, np.pi, 400)])


def read(document: Document) -> tuple[Arm, Arm] | None:
    """The free arm and the held one, both of one rate and without compensation."""
    arms = arms_of(document["loop"])
    if arms is None or document["held"]["arm"] not in ("leader", "follower"):
        return None
    if any(arm.law is not None or arm.often > 1 for arm in arms):
        return None
    return arms if document["held"]["arm"] == "follower" else arms[::-1]


def ends(told: Any) -> tuple[Fraction, Fraction]:
    """Of a number or an interval."""
    both = exacts(told) if isinstance(told, list) else [exact(told)] * 2
    return both[0], both[-1]


def hands(document: Document, rng: Rng, more: int = 20) -> Iterator[tuple[float, float, float]]:
    """Mass, damping and stiffness: corners, and some between."""
    sides = [ends(entry(document["held"], name)) for name in ("mass", "damping", "stiffness")]
    yield from {tuple(map(float, corner)) for corner in product(*sides)}
    if any(low < high for low, high in sides):
        for _ in range(more):
            yield tuple(float(low) + rng.random() * float(high - low) for low, high in sides)


def plant_of(arm: Arm, moving: tuple[float, float, float]) -> Plant:
    """Arm and hand behind the hold, with the arm's delay."""
    return held(*moving, float(arm.period), float((arm.whole + arm.part) * arm.period))


def rows(arm: Arm) -> tuple[dict[int, float], dict[int, float]]:
    """What a unit in a reading of its own, or of the other, makes of the force, by its age."""
    made: tuple[dict[int, float], dict[int, float]] = ({}, {})
    for place, (mine, at) in enumerate(arm.readings(0)):
        unit = [np.array(float(place == i)) for i in range(6)]
        row = made[0] if mine else made[1]
        row[-at] = row.get(-at, 0.0) + float(arm.force(*unit))
    return made


def felt(free: Arm, arm: Arm, plant: Plant, z: np.ndarray) -> np.ndarray:
    """H at points of the circle."""
    own, other, its_own, its_other = (
        sum(c * z**-age for age, c in row.items()) for side in (free, arm) for row in rows(side)
    )
    g = plant.response(z)
    return own - other * g * its_other / (1 + g * its_own)


def needed(free: Arm, arm: Arm, plant: Plant, angles: np.ndarray) -> np.ndarray:
    """Damping that the free arm needs at each angle."""
    z, part = np.exp(1j * angles), float(free.part)
    h = felt(free, arm, plant, z)
    hold = (z**-free.whole) * (1 - part + part / z)
    base = float(free.period) / 2 * ((1 - 1 / z) * hold * h).real / (1 - np.cos(angles))
    return (
        (base + np.sqrt(base**2 + float(free.period) ** 2 * part * (1 - part) * np.abs(h) ** 2)) / 2
        if part
        else base
    )


def run(free: Arm, arm: Arm, plant: Plant, path: np.ndarray, strayed: np.ndarray) -> np.ndarray:
    """The free arm's forces along its readings; `strayed` is added to those of the held arm."""
    (own, other), (its_own, its_other) = rows(free), rows(arm)
    seen, pushed, forces = np.zeros(len(path)), np.zeros(len(path) + 1), np.zeros(len(path))
    state = np.zeros(2)
    for k in range(len(path)):
        seen[k] = state[0] + strayed[k]
        for row, values, target in (
            (own, path, forces), (other, seen, forces), (its_own, seen, pushed), (its_other, path, pushed),
        ):  # fmt: skip
            target[k] += sum(c * values[k - age] for age, c in row.items() if age <= k)
        late, later = k - plant.whole, k - plant.whole - 1
        state = plant.step @ state
        for place, row in ((late, plant.late), (later, plant.later)):
            state = state - row * (pushed[place] if place >= 0 else 0.0)
    return forces


def encoder_error(free: Arm, arm: Arm, plant: Plant, unit: np.ndarray) -> float:
    """What half a count of both readings does to the force at most, over so many samples."""
    counts = ((unit, 0 * unit, free.resolution), (0 * unit, unit, arm.resolution))
    return sum(
        float(np.abs(run(free, arm, plant, path, strayed)).sum()) * float(count) / 2
        for path, strayed, count in counts
    )


def _held_pair(document: Document, rng: Rng) -> Opinion:
    arms = read(document)
    if arms is None or arms[1].friction:
        return false("what is not linear, and linear it must be")
    free, arm = arms
    for moving in hands(document, rng):
        if moving[1] < float(arm.damping) * (1 - SLACK) or moving[0] <= 0:
            return false("the hand drives the arm")
        plant = plant_of(arm, moving)
        its_own = rows(arm)[0]
        above = np.array([its_own.get(age, 0.0) for age in range(max(its_own) + 1)])
        size = radius(plant, above, np.array([1.0, *[0.0] * (len(above) - 1)]))
        if size > 1 + CLOSE:
            return false(f"the held arm shakes: {size}")
        most = float(needed(free, arm, plant, ANGLES).max())
        if most > float(free.damping) * (1 + SLACK):
            return false(f"{most} of damping is needed")
        if free.resolution or arm.resolution:
            unit = np.eye(1, SAMPLES)[0]
            norms = [
                np.abs(run(free, arm, plant, *pair)).sum() for pair in ((unit, 0 * unit), (0 * unit, unit))
            ]
            error = norms[0] * float(free.resolution) / 2 + norms[1] * float(arm.resolution) / 2
            if error > float(free.friction) * (1 + SLACK):
                return false(f"encoders are off by {error}")
    return agrees()


def _violation(document: Document, rng: Rng) -> Opinion:
    arms = read(document)
    if arms is None:
        return false("what is not linear, and linear it must be")
    free, arm = arms
    moving = next(hands(document, rng))
    at = float(np.arccos(np.clip(float(exact(document["proof"]["cosine"])), -1.0, 1.0)))
    if at < 1e-4:
        return cannot_say("too near to rest")
    need = float(needed(free, arm, plant_of(arm, moving), np.array([at]))[0])
    return (
        agrees() if need > float(free.damping) * (1 - SLACK) else false(f"{need} of damping is needed there")
    )


def _motion(document: Document, rng: Rng) -> Opinion:
    arms = read(document)
    if arms is None or arms[1].friction or arms[0].resolution or arms[1].resolution:
        return false("what is not linear, and linear it must be")
    free, arm = arms
    path = np.array([float(x) for x in exacts(entry(document, "positions"))])
    if len(path) > SAMPLES:
        return cannot_say("too long")
    forces = run(free, arm, plant_of(arm, next(hands(document, rng))), path, 0 * path)
    moves, part, sums = np.diff(path), float(free.part), []
    for late, share in ((free.whole, 1 - part), (free.whole + 1, part)):
        acting = np.concatenate([np.zeros(late), forces])[: len(moves)]
        sums.append(share * acting * moves)
    rubbed = float(free.damping / free.period) * moves**2 + float(free.friction) * np.abs(moves)
    total = sum(map(np.sum, sums)) + rubbed.sum()
    size = sum(np.abs(s).sum() for s in sums) + rubbed.sum()
    told = float(exact(document["energy_J"]))
    return agrees() if abs(told + total) <= 1e-6 * size else false(f"{-total} J come out")


JUDGES: dict[str, Callable[[Document, Rng], Opinion]] = {
    "held pair": _held_pair,
    "held pair violation": _violation,
    "held pair motion": _motion,
}
