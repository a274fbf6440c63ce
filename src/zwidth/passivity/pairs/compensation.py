"""What compensation of friction takes from a pair, as the rows and the words of its verdict."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from zwidth.passivity.pairs.criterion import PairCriterion
from zwidth.quantity.text import outward_decimal, shown

_ARMS = ("leader", "follower")


def assumed_of_forces(criterion: PairCriterion) -> Iterator[str]:
    """What is taken for granted of the forces, compensation of friction among them."""
    computed = "forces are given as computed: no limit, no steps of the converter, "
    if not any(criterion.pair.compensations):
        yield f"{computed}no compensation of friction or gravity"
        return
    yield f"{computed}no compensation of gravity; a constant force gives back what it takes"
    held = "compensation of friction is computed once a sample and held, from"
    if criterion.any_mean:
        yield (
            f"{held} any mean of each arm's moves over past samples, of fixed weights: a window, a filter or "
            "a delay; a speed that a drive measures within a part of a sample is not covered"
        )
    else:
        yield f"{held} the mean speed of each arm since its last sample; no other estimate is covered"


def compensation_rows(criterion: PairCriterion, share: float | None) -> Iterator[tuple[str, str]]:
    """The law of each arm, what it takes, and how much of it is passive."""
    pair = criterion.pair
    if not any(pair.compensations):
        return
    for name, arm in zip(_ARMS, criterion.arms, strict=True):
        law = arm.side.compensation
        dry = shown(float(arm.line.height), pair.leader.unit("coulomb_friction"))
        wet = shown(float(law.viscous + arm.line.slope), pair.leader.unit("damping"))
        spent = f", takes {dry} of friction and up to {wet} of damping" if law else ""
        yield f"compensated in the {name}", f"{law.force_in_words(pair.motion)}{spent}"
    most = (
        "none: without it the pair is not passive either"
        if share is None
        else f"{outward_decimal(100 * share, False):.4g} % of this on both sides, with all else as it is"
    )
    yield "largest compensation", most


def compensation_numbers(criterion: PairCriterion, share: float | None) -> dict[str, Any]:
    """The same as plain data; nothing where nothing is compensated."""
    pair = criterion.pair
    if not any(pair.compensations):
        return {}
    key = pair.leader.key
    spent = {
        name: {
            key("coulomb_friction"): float(arm.line.height),
            key("damping"): float(arm.side.compensation.viscous + arm.line.slope),
        }
        for name, arm in zip(_ARMS, criterion.arms, strict=True)
    }
    return {"largest_compensation": share, "compensation_takes": spent}
