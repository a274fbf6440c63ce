"""What a person should know about an identified device, in sentences."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import replace
from itertools import chain, combinations
from typing import NamedTuple

from zwidth.data.identification.device.choice import SURE
from zwidth.data.identification.device.estimate import Directions, Estimate, perhaps_none
from zwidth.data.identification.device.fit import Found
from zwidth.data.identification.device.two_masses import TwoMasses
from zwidth.data.logs import Finding, Log
from zwidth.data.logs.table import Block
from zwidth.errors import InputError
from zwidth.quantity.text import shown, told_quantity

_SEEN = {
    "slow": "more friction at rest than f_c, as of lubricated contacts (Stribeck),",
    "spring": "a spring, or gravity on an arc,",
    "force_lag": "a force recorded late, or early where this is negative,",
}

_KINDS = {"slow": "Stribeck friction"}


def findings(
    found: Found,
    names: tuple[str, ...],
    estimates: Mapping[str, Estimate],
    directions: Directions,
    slopes: Directions,
    speed: float,
    period: float,
) -> Iterable[Finding]:
    """The wrong model first, then what is not known, then what was fitted besides."""
    yield from _model(found, names, estimates, period)
    if directions.difference.beyond(SURE):
        yield Finding(
            kind="damping by direction",
            text=f"damping differs by direction: {directions.inward} into the wall, {directions.outward} "
            "out of it; a hand may be quick one way and slow the other, so walls rest on the smaller",
        )
    yield from perhaps_none(estimates, ("damping", "coulomb_friction"))
    for name, what in _SEEN.items():
        if name in estimates:
            until = ""
            if name == "slow":
                until = f", gone at {told_quantity(found.moments.knee, 'friction_speed', found.motion, 3)}"
            elif name == "spring" and estimates[name].interval()[1] < 0:
                until = (
                    "; below 0: gravity on a handle above its axis, or a hand whose force is not in the log"
                )
            text = f"{what} is seen and fitted: {estimates[name]}{until}"
            yield Finding(kind=_KINDS.get(name, name.replace("_", " ")), text=text)
    yield from _bend(found, names, slopes, speed)


def moves_apart(cable: TwoMasses) -> Finding:
    """Where the log surely shows two masses, or that neither one nor two explain it."""
    if not cable.explain:
        return Finding(
            kind="not one mass",
            text="one mass leaves more of the readings than the encoder's steps, and so do two: the numbers "
            "are those of one, and no wall is promised. Where something gives way between motor and handle, "
            "walls rest on the motor's side alone; to see it, shake the motor harder, nobody at the handle",
        )
    share = cable.damping.value / (cable.motor["damping"].value + cable.between["handle_damping"].value)
    text = (
        f"the handle moves on a cable, a belt or a gear: nobody at the handle, the two swing at "
        f"{shown(cable.resonance, 'Hz', 3)}; walls rest on what the motor feels whatever the hand does, "
        f"{shown(share, '%', 2)} of the damping of both sides"
    )
    return Finding(kind="two masses", text=text)


def _bend(found: Found, names: tuple[str, ...], slopes: Directions, speed: float) -> Iterable[Finding]:
    """Friction whose slope changes with speed."""
    if "coulomb_friction" not in names:
        return
    more = () if "slow" in names else ("slow",)
    if found.sees(names, "quadratic") or found.sees((*names, *more), "quadratic"):
        at = told_quantity(speed, "friction_speed", found.motion, 3)
        yield Finding(
            kind="bent friction",
            text=f"friction is not f_c + b |v|: at {at} its slope is {slopes.weaker}; "
            "what is proved rests on the largest model below the friction curve",
        )


def _model(
    found: Found, names: tuple[str, ...], estimates: Mapping[str, Estimate], period: float
) -> Iterable[Finding]:
    whole = (*(n for n in names if n != "coulomb_friction"), "coulomb_friction")
    full, viscous = found.regression(whole), found.regression(whole[:-1])
    if full is None or viscous is None:
        return
    limits = [
        told_quantity(2 * fit.value("damping") / period, "stiffness", found.motion, 4)
        for fit in (viscous, full)
    ]
    if "coulomb_friction" not in names:
        if found.sees(names, "coulomb_friction"):
            yield Finding(
                kind="wrong model",
                text="a mass and a damper are the wrong model: Coulomb friction of "
                f"{told_quantity(full.value('coulomb_friction'), 'force', found.motion, 3)} is seen; without "
                f"it 2b/T is {limits[0]} and not {limits[1]}: walls between the two would be called passive "
                'and are not; identify with model="Coulomb and viscous"',
            )
    elif estimates["coulomb_friction"].beyond(SURE):
        yield Finding(
            kind="Coulomb friction",
            text="Coulomb friction is seen; a mass and a damper alone would have 2b/T = "
            f"{limits[0]} instead of {limits[1]}",
        )


# Numbers that no device and no finger has, m < 0, b < 0 or k < 0, and what most likely made them.
#
# Turn the sign of every force round, and m, b, f_c and k change theirs: a sensor that counts the other way
# gives all of them below 0.  Where a hand's force and an actuator's are both logged, each sign is tried.

Estimates = Mapping[str, Estimate]


class Bounds(NamedTuple):
    """What cannot be below 0."""

    whose: str
    """"device" or "finger"."""
    above: tuple[str, ...]
    """The names that are > 0 in every one."""
    sure: tuple[str, ...]
    """Of these, those that a log must show to be > 0 for its signs to be the right ones."""
    causes: str
    """What else may be wrong, where no sign helps."""


DEVICE = Bounds(
    "device",
    ("mass", "damping"),
    ("mass", "damping"),
    "no sign that is turned round makes a device of it: is an actuator at work whose force is not in the "
    "log, is friction compensated, does it fall with speed, or are force and position not of one moment?",
)


def refuse_impossible(
    log: Log, estimates: Estimates, again: Callable[[Log], Estimates | None], bounds: Bounds = DEVICE
) -> None:
    """Refuse a log that shows what is surely below 0 and cannot be; `again` fits it with other signs."""
    below = [name for name in bounds.above if name in estimates and estimates[name].interval()[1] < 0]
    sure = [name for name in bounds.sure if name in estimates]
    if not below:
        return
    said = " and ".join(f"{name} comes out as {estimates[name]}" for name in below)
    said = f"{log.source}: {said}, and no {bounds.whose} has that"
    sizes = range(1, len(log.channels) + 1)
    for channels in chain(*(combinations(log.channels, size) for size in sizes)):  # the fewest signs first
        found = again(_turned(log, channels))
        if found is not None and all(found[name].interval()[0] > 0 for name in sure):
            raise InputError(f"{said}; {_flipped(log, channels, found, below)}")
    raise InputError(f"{said}; {bounds.causes}")


def _flipped(log: Log, channels: tuple[str, ...], found: Estimates, below: list[str]) -> str:
    """What to type, and how the data would look then."""
    words = " and ".join(name.replace("_", " ") for name in channels)
    right = " and ".join(f"{name} {shown(found[name].value, found[name].unit)}" for name in below)
    typed = " and ".join(f'scale={{"{name}": "-1"}}' for name in channels)
    other = ""
    if channels == log.channels:
        other = ' or, where it is the position that counts the other way, scale={"position": "-1"}'
    return (
        f"the sign of the {words} looks turned round: with the other one {right} come out; read the log "
        f"with {typed}{other}, or with a factor of the other sign where one was given"
    )


def _turned(log: Log, channels: tuple[str, ...]) -> Log:
    def blocks() -> Iterator[Block]:
        for block in log.blocks():
            forces = {name: getattr(block, name) for name in channels}
            yield block._replace(**{name: -force for name, force in forces.items()})

    return replace(log, _blocks=blocks)
