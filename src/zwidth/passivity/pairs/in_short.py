"""What a verdict on two arms takes for granted, in a few words for each thing: `assumed` says it in full."""

from __future__ import annotations

from collections.abc import Iterator

from zwidth.model.pairs import Pair
from zwidth.passivity.pairs.criterion import PairCriterion
from zwidth.passivity.pairs.held.verdict import HeldVerdict
from zwidth.passivity.pairs.verdict import PairVerdict
from zwidth.passivity.wording import AS_ONE


def pair_in_short(verdict: PairVerdict | HeldVerdict) -> str:
    """In one paragraph."""
    parts = _of_one_hand(verdict) if isinstance(verdict, HeldVerdict) else _of_two_hands(verdict)
    return "; ".join(parts)


def _of_two_hands(verdict: PairVerdict) -> Iterator[str]:
    yield "two hands of any speed and force"
    yield "what the spring between the arms holds at the start may come back"
    if verdict.pair.power_ratio != 1:
        yield (
            f"the energy of the follower's hand counts {float(verdict.pair.power_ratio):.6g} times: one body "
            "that holds both arms is not covered"
        )
    yield from _of_both(verdict.criterion, verdict.passive)


def _of_one_hand(verdict: HeldVerdict) -> Iterator[str]:
    free, held = verdict.question.free, verdict.question.held
    yield f"a hand of any speed and force on the {free}"
    if verdict.with_any_such_hand:
        yield f"what holds the {held} gives out no energy of its own"
    else:
        yield from _of_the_held(verdict, free, held)
    yield from _of_both(PairCriterion(verdict.pair), verdict.with_any_such_hand)


def _of_the_held(verdict: HeldVerdict, free: str, held: str) -> Iterator[str]:
    hand = verdict.question.hand
    yield (
        f"nobody on the {held}" if hand.is_nobody else f"on the {held} just the hand given, fixed to a place"
    )
    yield f"mass and damping of the {held} just as given, both arms at rest at first"
    if verdict.outcome == "active":
        yield f"friction and encoders do not help against large motions of the {free}"
        return
    yield f"no Coulomb friction in the {held}"
    if verdict.scope.encoder == "counted":
        yield "what the springs hold at first for half a count may come back"


def _of_both(criterion: PairCriterion, any_age: bool) -> Iterator[str]:
    pair = criterion.pair
    times = " and ".join(map(str, dict.fromkeys(pair.readings)))
    often = "" if pair.readings == (1, 1) else f", each itself {times} times a period"
    yield f"both arms read at the same instants{often}"
    ages = " and ".join(str(age) for age in dict.fromkeys(arm.age for arm in criterion.arms))
    if any_age and criterion.ages_may_vary:
        yield f"readings of the other arm at most {ages} samples old"
    else:
        yield f"readings of the other arm just {ages} samples old, none lost"
    yield from _of_forces(criterion)
    yield "encoder steps counted" if any(side.resolution for side in pair.sides) else "ideal position sensors"
    yield f"of each arm {AS_ONE}"
    yield from _not_given(pair)


def _of_forces(criterion: PairCriterion) -> Iterator[str]:
    if not any(criterion.pair.compensations):
        yield "ideal actuators, no compensation of friction or gravity"
        return
    means = (
        "means of past moves alone" if criterion.any_mean else "the mean speed since the last sample alone"
    )
    yield f"ideal actuators, no compensation of gravity, that of friction from {means}"


def _not_given(pair: Pair) -> Iterator[str]:
    leader, follower = (", ".join(device.assumed) for device in (pair.leader, pair.follower))
    if leader == follower:
        yield from [f"{leader} of both not given, taken as 0"] if leader else []
        return
    for name, assumed in (("leader", leader), ("follower", follower)):
        yield from [f"{assumed} of the {name} not given, taken as 0"] if assumed else []
