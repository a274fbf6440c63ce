"""Numbers that no device and no finger has, m < 0, b < 0 or k < 0, and what most likely made them.

Turn the sign of every force round, and m, b, f_c and k change theirs: a sensor that counts the other way
gives all of them below 0.  Where a hand's force and an actuator's are both logged, each sign is tried.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from itertools import combinations
from typing import NamedTuple

from zwidth.data.identification.device.estimate import Estimate
from zwidth.data.logs import Log
from zwidth.data.logs.block import Block
from zwidth.errors import InputError

Estimates = Mapping[str, Estimate]


class Bounds(NamedTuple):
    """What cannot be below 0.

    Parameters
    ----------
    whose
        "device" or "finger".
    above
        The names that are > 0 in every one.
    sure
        Of these, those that a log must show to be > 0 for its signs to be the right ones.
    causes
        What else may be wrong, where no sign helps.
    """

    whose: str
    above: tuple[str, ...]
    sure: tuple[str, ...]
    causes: str


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
    for channels in _subsets(log.channels):
        found = again(_turned(log, channels))
        if found is not None and all(found[name].interval()[0] > 0 for name in sure):
            raise InputError(f"{said}; {_flipped(log, channels, found, below)}")
    raise InputError(f"{said}; {bounds.causes}")


def _flipped(log: Log, channels: tuple[str, ...], found: Estimates, below: list[str]) -> str:
    """What to type, and how the data would look then."""
    words = " and ".join(name.replace("_", " ") for name in channels)
    right = " and ".join(f"{name} {found[name].value:.4g} {found[name].unit}" for name in below)
    typed = " and ".join(f'scale={{"{name}": "-1"}}' for name in channels)
    other = ""
    if channels == log.channels:
        other = ' or, where it is the position that counts the other way, scale={"position": "-1"}'
    return (
        f"the sign of the {words} looks turned round: with the other one {right} come out; read the log "
        f"with {typed}{other}, or with a factor of the other sign where one was given"
    )


def _subsets(channels: tuple[str, ...]) -> Iterator[tuple[str, ...]]:
    """The fewest signs first."""
    for size in range(1, len(channels) + 1):
        yield from combinations(channels, size)


def _turned(log: Log, channels: tuple[str, ...]) -> Log:
    """The same log with the sign of some forces turned round."""

    def blocks() -> Iterator[Block]:
        for block in log.blocks():
            forces = {name: getattr(block, name) for name in channels}
            yield block._replace(**{name: -force for name, force in forces.items()})

    return replace(log, _blocks=blocks)
