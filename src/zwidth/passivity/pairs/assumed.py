"""What every answer about a pair takes for granted of clocks, forces, sensors and friction, in words."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from zwidth.model.pairs import Pair
from zwidth.passivity.pairs.criterion import PairCriterion
from zwidth.passivity.wording import TRANSMISSION
from zwidth.quantity.exact import ends
from zwidth.quantity.text import shown, shown_at_most, told_quantity


def assumed_of_timing(criterion: PairCriterion, any_age: bool) -> Iterator[str]:
    """When the arms are read, how old what they use is, and how forces are given.

    `any_age` is of a proof that covers younger readings wherever springs alone are at work.
    """
    alike = len(set(criterion.pair.readings)) == 1
    does = "are read" if alike else "send what they read"
    yield f"both arms {does} at the same instants, and {_held(criterion.pair)}"
    ages = [f"{arm.age} sample{'' if arm.age == 1 else 's'} old" for arm in criterion.arms]
    used = f"the leader uses a reading of the follower {ages[0]}, the follower one of the leader {ages[1]}"
    if any_age and criterion.ages_may_vary:
        yield f"{used}, or any younger one, another in each sample; none comes later, also after a loss"
    else:
        yield f"{used}; none is lost, none comes later or sooner"
    yield from assumed_of_forces(criterion)


def assumed_of_arms(pair: Pair) -> Iterator[str]:
    """Of both sensors, of what is between motor and hand, and what was not given."""
    if any(side.resolution for side in pair.sides):
        yield "encoder counts of each arm's own size, their phase unknown"
    else:
        yield "ideal position sensors: no quantization"
    yield f"of each arm {TRANSMISSION}"
    for name, device in (("leader", pair.leader), ("follower", pair.follower)):
        if device.assumed:
            yield f"{name}: {', '.join(device.assumed)} not given, taken as 0"


def friction_goes_on(pair: Pair) -> str:
    """The condition on friction beyond the speeds at which it was measured; "" where there is none."""
    told = ", ".join(
        f"{name}: {told_quantity(float(ends(device.friction_speed)[0]), 'friction_speed', pair.motion)}"
        for name, device in (("leader", pair.leader), ("follower", pair.follower))
        if device.friction_speed is not None
    )
    if not told:
        return ""
    return f", if friction beyond the speeds where it was measured ({told}) is no less than f_c + b |v|"


def _held(pair: Pair) -> str:
    often, its = pair.readings
    if often == its == 1:
        return "each force is held for a period"
    if often != its:
        name, times = ("leader", often) if often > its else ("follower", its)
        return (
            f"what comes of the other's reading is held for the longer period of the two; the {name} "
            f"reads itself {times} times in it, at equal distances, and holds what comes of that until "
            "it reads again"
        )
    return (
        f"what comes of the other's reading is held for a period; each drive reads its own arm {often} "
        "times in it, at equal distances, and holds what comes of that until it reads again"
    )


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
        else f"{shown_at_most(share, '%')} of this on both sides, with all else as it is"
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
