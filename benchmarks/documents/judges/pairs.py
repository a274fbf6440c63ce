"""Two arms: the work of both hands as a Hermitian form in the moves of each part of each reading.

It is made from the definitions, twice: of all motions of some samples from rest, and of those in which each
sample is the one before times e^{jθ}.  What a move inside a sample wins or loses is in both, as it is, and
nothing is minimised by hand.  What compensates friction is a line h + s v above it: its linear part is in the
form, the rest is taken from the damping; and some rounds are tried against the law itself.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from fractions import Fraction
from typing import Any

import numpy as np

from ..opinion import Opinion, agrees, cannot_say, false
from ..plain import exact
from .pair_arms import SLACK, Arm, arms_of, friction_for, spent
from .pair_motions import gaining_round

Document = dict[str, Any]
Rng = np.random.Generator
Array = np.ndarray
Readings = Callable[[int, int], Array]

MOST_MOVES, MOST_READINGS, SAMPLES = 240, 100, 30
ANGLES = np.concatenate([np.geomspace(1e-4, 0.1, 8), np.linspace(0.1, np.pi, 60)])


def form(arms: Sequence[Arm], reading: Readings, moves: Array) -> Array:
    """What both hands give, over readings 0 to n − 1: in the moves (n, 2 arms, early and late, size)."""
    made, given = [], []
    for i, arm in enumerate(arms):
        for k in range(len(moves)):
            for move, share, late in (
                (moves[k, i, 0], arm.part, arm.whole + 1),
                (moves[k, i, 1], 1 - arm.part, arm.whole),
            ):
                if not share:
                    continue
                at = k - late
                seen = [reading(i if mine else 1 - i, k_) for mine, k_ in arm.readings(at)]
                force = arm.force(*seen)
                paid = float(arm.damping / (share * arm.period))
                made.append(move)
                given.append(float(arm.weight) * (force + paid * move))
        if arm.moving:
            for k in range(0, len(moves), arm.often):
                move = moves[k : k + arm.often, i].sum(axis=(0, 1))
                before = reading(i, k) - reading(i, k - arm.often)
                took = float(arm.still) * move + float(arm.moving) * before
                made.append(move)
                given.append(-float(arm.weight / (arm.period * arm.often)) * took)
    return np.asarray(np.array(made).conj().T @ np.array(given))


def _units(arms: Sequence[Arm], moves: int, hands: Sequence[int] = (0, 1)) -> Array:
    """The moves of some hands, each by itself, as long as viscous friction takes 1 J from it."""
    size = 4 * moves
    paid = [
        float(arm.weight * arm.damping / (arm.period * (share or 1)))
        for arm in arms
        for share in (arm.part, 1 - arm.part)
    ]
    long = np.tile(1 / np.sqrt(paid), moves)
    unit = np.diag(long).reshape(moves, 2, 2, size)
    for i, arm in enumerate(arms):
        unit[:, i, : 2 if i not in hands else 1 if not arm.part else 0] = 0
    return unit[..., np.abs(unit).sum(axis=(0, 1, 2)) > 0]


def least_from_rest(arms: Sequence[Arm]) -> tuple[float, float]:
    """The least eigenvalue of the form of all motions of some samples from rest, and what rounding does."""
    moves = arms[0].often * max(1, min(SAMPLES, MOST_MOVES // arms[0].often // 4))
    unit = _units(arms, moves)
    size = unit.shape[-1]
    x = np.concatenate((np.zeros((1, 2, size)), np.cumsum(unit.sum(axis=2), axis=0)))
    return _least(form(arms, lambda i, k: x[max(k, 0), i], unit))


def least_at(arms: Sequence[Arm], theta: float, hands: Sequence[int] = (0, 1)) -> tuple[float, float]:
    """The same of motions of some hands of which every sample is the one before times e^{jθ}."""
    often = arms[0].often
    unit = _units(arms, often, hands)
    ahead = np.concatenate((np.zeros((1, 2, unit.shape[-1])), np.cumsum(unit.sum(axis=2), axis=0)))
    first = ahead[-1] / (2j * np.sin(theta / 2) * np.exp(0.5j * theta))  # e^{jθ} − 1, to the last digit

    def reading(i: int, k: int) -> Array:
        return np.exp(1j * theta * (k // often)) * (first[i] + ahead[k % often, i])

    return _least(form(arms, reading, unit))


def _least(matrix: Array) -> tuple[float, float]:
    """Of the Hermitian part; the rest, far larger at low frequencies, is what rounding goes by."""
    values = np.linalg.eigvalsh((matrix + matrix.conj().T) / 2)
    return float(values[0]), SLACK + 1e-14 * float(np.abs(matrix).sum(axis=0).max())


def _pair(document: Document, rng: Rng) -> Opinion:
    """Wherever it was looked at the form is not negative, and friction covers readings at their worst."""
    arms = arms_of(document["loop"])
    if arms is None:
        return false("there is no pair with such numbers")
    whole, tangents = arms, document["proof"].get("tangents", {})
    if any(arm.law and not arm.law.speed and exact(tangents.get(name, 1)) < 1 for arm, name in _named(arms)):
        return false("the sign of the speed is under no line but F")
    first, second = (spent(arm, exact(tangents.get(name, 1))) for arm, name in _named(arms))
    arms = first, second
    if not all(arm.damping > 0 for arm in arms):
        return false("nothing pays for the hold of an arm without damping")
    for arm, other in (arms, arms[::-1]):
        error = friction_for(arm, other)
        if arm.friction < error:
            return false(f"readings at their worst change a force by {float(error):.9g}")
    if arms[0].often > MOST_READINGS:
        return cannot_say("so many readings make too large a form")
    values = [("from rest", *least_from_rest(arms))]
    values += [(f"at {a:.6g} rad", *least_at(arms, a)) for a in _angles(arms, rng)]
    where, least, slack = min(values, key=lambda v: v[1] + v[2])
    if least < -slack:
        return false(f"{where} a motion wins {-least:.3g} of what it loses")
    found = gaining_round(whole, rng) if any(arm.law for arm in whole) else ""
    return false(found) if found else agrees()


def _angles(arms: Sequence[Arm], rng: Rng) -> Array:
    """Some of everywhere, and those around the worst of them."""
    some = ANGLES if arms[0].often < 10 else ANGLES[::4]
    worst = some[int(np.argmin([least_at(arms, a)[0] for a in some]))]
    return np.concatenate([some, np.clip(worst * (1 + 0.05 * rng.standard_normal(6)), ANGLES[0], np.pi)])


def _named(arms: Sequence[Arm]) -> Iterator[tuple[Arm, str]]:
    return zip(arms, ("leader", "follower"), strict=True)


def _violation(document: Document, rng: Rng) -> Opinion:
    """The form is negative there; without a place, that of one hand alone is somewhere."""
    arms = arms_of(document["loop"])
    if arms is None:
        return false("there is no pair with such numbers")
    if any(arm.part and not arm.damping for arm in arms):
        return false("without damping a force that changes inside a sample is not covered")
    if arms[0].often > MOST_READINGS:
        return cannot_say("so many readings make too large a form")
    if "proof" not in document and any(arm.law.viscous for arm in arms if arm.law):
        return cannot_say("compensation of viscous friction may brake between two readings")
    first, second = (spent(arm, Fraction(1)) for arm in arms)
    arms = first, second
    bare = not all(arm.damping for arm in arms)
    arms = arms[0]._replace(damping=_some(arms[0])), arms[1]._replace(damping=_some(arms[1]))
    if "proof" in document:
        c = exact(document["proof"]["cosine"])
        if not -1 <= c < 1:
            return false("no frequency has such a cosine")
        values = [least_at(arms, float(np.arccos(float(c))))]
    elif arms[0].often == 1:
        return false("an arm that reads itself once in a sample has nothing between its readings")
    else:
        near = np.concatenate([[1e-3, np.pi - 1e-3], ANGLES[::4], np.pi - ANGLES[:8]])
        values = [least_at(arms, a, (hand,)) for a in near for hand in (0, 1)]
    if any(least < -slack for least, slack in values):
        return agrees()
    if not bare and all(least > slack for least, slack in values):
        return false(f"every motion loses, at least {min(v for v, _ in values):.3g} of viscous friction")
    return cannot_say("rounding hides the sign")


def _some(arm: Arm) -> Fraction:
    """Its damping, or a hair: what gains with that gains without it."""
    return arm.damping or (arm.stiffness + arm.sent) * arm.period / 10**6


JUDGES: dict[str, Callable[[Document, Rng], Opinion]] = {
    "pair": _pair,
    "pair violation": _violation,
}
