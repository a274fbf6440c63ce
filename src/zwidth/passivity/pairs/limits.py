"""How far each number of a pair may go, all else as it is, and what to change."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import partial
from math import floor
from typing import Any, Literal

from zwidth.errors import InputError
from zwidth.model.device import Device
from zwidth.model.pairs import Pair
from zwidth.passivity.advice import (
    Advice,
    Knob,
    between_delays,
    between_rates,
    between_sizes,
    outward,
    turn,
    turn_all,
)
from zwidth.passivity.linear.boundary import COARSE, COARSER, Holds, largest_holding, smallest_holding
from zwidth.passivity.linear.loop import HIGH_DEGREE
from zwidth.passivity.pairs.criterion import PairCriterion, largest_spring, spending
from zwidth.quantity.answered import answered, known
from zwidth.quantity.balls import as_fraction
from zwidth.quantity.documented import Documented
from zwidth.quantity.exact import Exact
from zwidth.quantity.spoken import spoken
from zwidth.quantity.text import in_words, shown


def is_passive(pair: Pair) -> bool:
    """True where the criterion holds and friction covers the steps of both encoders."""
    return spending(pair).proves


def grain_of(pair: Pair) -> int:
    """How near a limit is looked for: less near where old readings make every decision take long."""
    return COARSE if samples_around(pair) <= HIGH_DEGREE else COARSER


def samples_around(pair: Pair) -> int:
    """The delays of both arms and of the link there and back, in samples."""
    return sum(arm.whole + arm.age for arm in PairCriterion(pair).arms)


def largest_stiffness(pair: Pair) -> float | None:
    """The largest K, both sides in proportion and all else as it is, that is passive; None if none is.

    As the leader feels it, what is reflected to it added.
    """
    holds, closed = _holds(pair.stiffened), largest_spring(pair)
    guess = float(closed) if closed else float(pair.felt_stiffness)
    if not ((guess > 0 and holds(Exact(guess / 10**6).fraction)) or is_passive(pair)):
        return None
    found = largest_holding(lambda k: not k or holds(k), guess, grain_of(pair))
    return found or None


def largest_compensation(pair: Pair) -> float | None:
    """The largest share of the compensation of friction, on both sides, that is passive; None if none is."""
    if not any(pair.compensations) or not is_passive(with_share(pair, Fraction(0))):
        return None
    return largest_holding(lambda share: is_passive(with_share(pair, share)), 1.0, grain_of(pair))


def with_share(pair: Pair, share: Fraction) -> Pair:
    """With so many times the compensation of friction on both sides."""
    law, other = (law.scaled(share) for law in pair.compensations)
    return pair.replace(compensation=law, follower_compensation=other)


def required_damping(pair: Pair, name: str) -> float | None:
    """The least b of the "leader" or the "follower", the other's as it is; None if none is enough."""
    device: Device = getattr(pair, name)
    guess = max(float(device.exact("damping")), float(pair.felt_stiffness * pair.sample_period))

    def holds(b: Fraction) -> bool:
        return spending(pair.replace(**{name: device.replace(damping=Exact(b))})).holds

    return smallest_holding(holds, guess, grain_of(pair))


def required_friction(pair: Pair, name: str) -> float | None:
    """The least f_c of the "leader" or the "follower", the other's as it is; None if none is enough.

    For the steps of both encoders and for its compensation: with more of it a line that takes less of damping
    is paid for.
    """
    here = ("leader", "follower").index(name)
    device: Device = getattr(pair, name)
    wide = PairCriterion(pair).arms
    most = wide[here].missing_friction(wide[1 - here]) + wide[here].side.coulomb_friction
    if not pair.compensations[here].coulomb:
        return float(most)

    def holds(f: Fraction) -> bool:
        criterion = spending(pair.replace(**{name: device.replace(coulomb_friction=Exact(f))}))
        return criterion.missing_friction[here] <= 0 and criterion.holds

    if not holds(most):
        return None
    found = smallest_holding(holds, float(most), grain_of(pair))
    return float(most) if found is None else min(found, float(most))


MOST_SAMPLES = 200
"""Delays around the whole loop, in samples, beyond which a look at every number takes too long."""

_EIGHTHS = 10
"""Local dampings that are tried where another one might help, in eighths of the lesser b."""

Change = Callable[[Fraction], Pair]


@dataclass(frozen=True)
class StiffnessAt(Documented):
    """The largest passive stiffness, if link delay or rate were so many `times` what they are."""

    parameter: Literal["link_delay", "rate"] = answered('`"link_delay"` or `"rate"`')
    times: float = answered("what it is multiplied by")
    stiffness: float | None = answered("how stiff the coupling could then be", quantity="stiffness")
    text: str = answered("the same in words")
    motion: str = known('"linear" or "rotary"')


def advise(pair: Pair, passive: bool) -> tuple[Advice, ...]:
    """Advice on every number of a pair; none where its readings are so old that this takes too long."""
    if samples_around(pair) > MOST_SAMPLES:
        return ()
    kind: Literal["change", "slack"] = "slack" if passive else "change"
    grain = grain_of(pair)
    knobs = [*_of_the_coupling(pair), *_of_the_arms(pair)]
    found = turn_all(knobs, pair.motion, kind, grain)
    if not passive:
        found += _both_arms(pair, grain)
        found += turn_all(_more_local_damping(pair), pair.motion, kind, grain)
    if any(pair.compensations):
        found.append(_share(pair, kind, grain))
    return tuple(found)


def _share(pair: Pair, kind: Literal["change", "slack"], grain: int) -> Advice:
    """How much of the compensation of friction, on both sides in proportion."""
    knob = Knob("compensation", 1.0, _holds(partial(with_share, pair)), False, "compensation of friction")
    advice = turn(knob, pair.motion, kind, grain)
    if not isinstance(advice.to, float):
        return advice
    part = f"{shown(outward(advice.to, knob), '%', 12)} of what it is"
    if kind == "change":
        return replace(advice, text=f"lower the compensation of friction to {part}")
    return replace(advice, text=f"compensation of friction may go up to {part}")


def stiffness_elsewhere(pair: Pair) -> tuple[StiffnessAt, ...]:
    """How stiff the coupling may be at half the link delay, if there is one, and at twice the rate."""
    if samples_around(pair) > MOST_SAMPLES:
        return ()
    found = []
    half = pair.replace(delay=tuple(Exact(d.fraction / 2) for d in pair.delay))
    if samples_around(half) < samples_around(pair):
        found.append(_stiffness_at(half, "link_delay", Fraction(1, 2), "at half the link delay"))
    try:
        double = _at_rate(pair, 2 / pair.sample_period)
    except InputError:  # at this rate the delays are too many samples
        return tuple(found)
    return (*found, _stiffness_at(double, "rate", Fraction(2), "at twice the rate"))


def _stiffness_at(
    pair: Pair, parameter: Literal["link_delay", "rate"], times: Fraction, where: str
) -> StiffnessAt:
    largest, unit = largest_stiffness(pair), pair.leader.unit("stiffness")
    if largest is None:
        proved = "proved" if any(pair.compensations) else "passive"
        return StiffnessAt(parameter, float(times), None, f"{where} no stiffness is {proved}", pair.motion)
    safe = outward(largest, next(_of_the_coupling(pair)), spoken(unit)[0])
    text = f"{where} a stiffness of up to {shown(safe, unit, 12)} is passive"
    return StiffnessAt(parameter, float(times), largest, text, pair.motion)


def _holds(change: Change) -> Holds:
    """Whether the pair with a value is passive; one that cannot be built, or decided, is not."""

    def holds(value: Fraction) -> bool:
        try:
            return is_passive(change(value))
        except (InputError, ZeroDivisionError):
            return False

    return holds


def _at_rate(pair: Pair, rate: Fraction) -> Pair:
    """Both arms so much quicker that the slower of them has this rate."""
    leader, follower = pair.readings if pair.drive_rate is None else (1, 1)
    return pair.replace(
        leader=pair.leader.replace(rate=Exact(rate * leader)),
        follower=pair.follower.replace(rate=Exact(rate * follower)),
    )


def _of_the_coupling(pair: Pair) -> Iterator[Knob]:
    yield Knob(
        "stiffness",
        float(pair.felt_stiffness),
        _holds(pair.stiffened),
        False,
        "stiffness",
        near=partial(_stiffness_that_turns, pair),
    )
    own_in_drive = pair.local_damping == -pair.damping  # one gain, whose other half is in the arms' damping
    keys = () if own_in_drive else (("damping", "virtual_damping"), ("local_damping", "local_damping"))
    for key, quantity in keys:
        gain: Exact = getattr(pair, key)
        if gain and getattr(pair, f"follower_{key}") is None:
            sign = -1 if gain < 0 else 1
            change: Change = lambda v, key=key, sign=sign: pair.replace(**{key: Exact(sign * v)})  # type: ignore[misc]  # noqa: E731
            size = abs(float(gain))
            yield Knob(
                quantity,
                size,
                _holds(change),
                False,
                in_words(quantity),
                between=partial(between_sizes, size),
                sign=sign,
            )
    longer = max(pair.delay)

    def link(delay: Fraction) -> Pair:
        parts = (d.fraction / longer.fraction if longer else Fraction(1) for d in pair.delay)
        return pair.replace(delay=tuple(Exact(delay * part) for part in parts))

    name = "link delay" if pair.there == pair.back else "longer link delay, the other in proportion,"
    far, period = float(longer), float(pair.sample_period)
    yield Knob(
        "link_delay",
        far,
        _holds(link),
        False,
        name,
        between=partial(between_delays, far, period),
        near=partial(_delay_that_turns, pair),
    )
    holds = _holds(lambda rate: _at_rate(pair, rate))
    yield Knob("rate", 1 / period, holds, True, "rate", between=partial(between_rates, 1 / period, far))


def _of_the_arms(pair: Pair) -> Iterator[Knob]:
    for here, arm in enumerate(("leader", "follower")):
        device: Device = getattr(pair, arm)

        def change(key: str, arm: str = arm, device: Device = device) -> Change:
            return lambda value: pair.replace(**{arm: device.replace(**{key: Exact(value)})})

        for key, more in (("damping", True), ("coulomb_friction", True), ("resolution", False)):
            name = f"{'encoder resolution' if key == 'resolution' else in_words(key)} of the {arm}"
            near = partial(_where_it_turns, pair, here, key)
            yield Knob(f"{arm}.{key}", float(device.exact(key)), _holds(change(key)), more, name, near=near)


def _where_it_turns(pair: Pair, here: int, key: str) -> float | None:
    """The limit of a number of an arm but for rounding, where that has a closed form."""
    criterion = PairCriterion(pair)
    if key == "damping":
        return _damping_at_rest(criterion, here)
    arm, other = criterion.arms[here], criterion.arms[1 - here]
    missing = arm.missing_friction(other), other.missing_friction(arm)
    if key == "coulomb_friction":
        return float(max(arm.side.coulomb_friction + missing[0], Fraction(0)))
    slopes = map(as_fraction, (arm.error_of_steps[0], other.error_of_steps[1]))
    room = [-lacks / slope for lacks, slope in zip(missing, slopes, strict=True) if slope]
    return float(max(arm.side.resolution + min(room), Fraction(0))) if room else None


def _damping_at_rest(criterion: PairCriterion, here: int) -> float | None:
    """The b of an arm at which M(0) of springs alone is singular."""
    if not criterion.of_springs or any(arm.part for arm in criterion.arms):
        return None
    own, other = criterion.at_rest[here], criterion.at_rest[1 - here]
    if other <= 0:
        return None
    arm = criterion.arms[here]
    more = as_fraction(criterion.at_rest[2] ** 2 / other - own) / arm.weight
    return float(max(arm.damping + more, Fraction(0)))


def _stiffness_that_turns(pair: Pair) -> float | None:
    """The largest stiffness of springs alone, whose steps friction pays for, too."""
    closed, arms = largest_spring(pair), PairCriterion(pair).arms
    if closed is None:
        return None
    for arm, other in (arms, arms[::-1]):
        if error := arm.force_error(other):
            closed = min(closed, pair.felt_stiffness * arm.side.coulomb_friction / error)
    return float(closed)


def _delay_that_turns(pair: Pair) -> float | None:
    """The longest link delay of springs alone, the same each way: whole samples, by M(0)."""
    criterion = PairCriterion(pair)
    if pair.there != pair.back or not criterion.of_springs or pair.there == 0:
        return None
    first, second, crossed = criterion.at_rest
    age = pair.felt_stiffness * pair.sample_period  # that both readings are a sample older adds this
    if min(first, second) < 0:
        return None
    more = floor((float(as_fraction(first * second)) ** 0.5 - float(as_fraction(crossed))) / float(age))
    return float(max(criterion.arms[0].age + more, 0) * pair.sample_period)


def _both_arms(pair: Pair, grain: int) -> Iterator[Advice]:
    """What one arm alone cannot do: the same value of both, where that is more than either has."""
    for key in ("damping", "coulomb_friction"):
        now = [device.exact(key) for device in (pair.leader, pair.follower)]

        def change(value: Fraction, key: str = key) -> Pair:
            arms = {"leader": pair.leader, "follower": pair.follower}
            raised: dict[str, Any] = {
                arm: device.replace(**{key: Exact(max(value, device.exact(key)))})
                for arm, device in arms.items()
            }
            return pair.replace(**raised)

        knob = Knob(key, float(min(now)), _holds(change), True, f"{in_words(key)} of both arms")
        advice = turn(knob, pair.motion, "change", grain)
        if not isinstance(advice.to, float) or advice.to <= max(now):
            continue
        if now[0] != now[1]:
            to = advice.text.rpartition(" to ")[2]
            advice = replace(advice, text=f"raise the {knob.name} to {to}")
        yield advice


def _more_local_damping(pair: Pair) -> Iterator[Knob]:
    """Local damping helps slow motions and hurts quick ones: if any does, what does lies in an interval."""
    if pair.follower_local_damping is not None or pair.local_damping < 0:
        return
    now = pair.local_damping.fraction
    holds = _holds(lambda d: pair.replace(local_damping=Exact(d)))
    step = min(device.exact("damping") for device in (pair.leader, pair.follower)) / 8
    enough = next((d for d in (now + n * step for n in range(1, _EIGHTHS + 1)) if holds(d)), None)
    if step and enough is not None:
        yield Knob("local_damping", float(now), lambda d: d >= enough or holds(d), True, "local damping")
