"""Intervals: which single values of the parameters decide for all of them.

More damping and Coulomb friction never hurt, a finer encoder never hurts, and mass plays no part: one end of
each decides.  The other parameters are decided by the corners of their box where the requirements are convex
or monotone in each of them separately, since such a function is largest at a corner:

* T and the delay of a spring, as b* increases in both;
* T without delay where the requirement is proportional to it, or that plus a constant;
* parameters of the law that enter H linearly, since the required damping is a supremum of convex
  functions of H, and ‖h‖₁ is convex; others for which there is a closed form.

Which of them are intervals it may be, each law says by `Environment.decided_by_corners`.
Elsewhere the corners are still looked at, but prove nothing for what is between.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import fields, is_dataclass
from itertools import product
from typing import Any

from zwidth.errors import InputError
from zwidth.model.device import Device
from zwidth.model.environment.environment import Box, Environment
from zwidth.quantity.exact import Exact, Interval, ends

Loop = tuple[Device, Environment]

MOST_CORNERS = 64
_TIMING = ("sample_period", "delay")


def worst_corners(device: Device, environment: Environment) -> list[Loop]:
    """The certain loops at the corners of the box of parameters."""
    device = _at_ends(device, damping=0, coulomb_friction=0, resolution=1)
    timings = [_values(getattr(device, key)) for key in _TIMING]
    laws = list(_variants(environment))
    if len(laws) * len(timings[0]) * len(timings[1]) > MOST_CORNERS:
        raise InputError(
            f"the intervals have more than {MOST_CORNERS} corners; give single values for some parameters"
        )
    return [
        (device.replace(sample_period=period, delay=delay), law)
        for period, delay, law in product(*timings, laws)
    ]


def corners_decide(device: Device, environment: Environment, contact: bool = False) -> bool:
    """True when passivity at every corner proves it for every value in the box.

    `contact` is True when every corner is covered with contact made and broken.
    """
    box = Box(
        _uncertain_fields(environment),
        frozenset(key for key in _TIMING if isinstance(getattr(device, key), Interval)),
        ends(device.delay) == (0, 0),
        contact,
    )
    return not (box.of_law or box.of_timing) or environment.decided_by_corners(box)


def best_corner(device: Device, environment: Environment) -> Loop | None:
    """A loop that is active only if every loop in the box is; None where none is known."""
    device = _at_ends(device, damping=1, coulomb_friction=1, resolution=0)
    timing = any(isinstance(getattr(device, key), Interval) for key in _TIMING)
    if not timing and not _uncertain_fields(environment):
        return device, environment
    law = environment.least_demanding(ends(device.delay) == (0, 0) and ends(device.resolution) == (0, 0))
    return None if law is None else (_at_ends(device, sample_period=0, delay=0), law)


def _at_ends(device: Device, **which: int) -> Device:
    """The device with the low (0) or the high (1) end of the named parameters."""
    uncertain = {key: end for key, end in which.items() if isinstance(getattr(device, key), Interval)}
    chosen = {key: Exact(ends(getattr(device, key))[end]) for key, end in uncertain.items()}
    return device.replace(**chosen) if chosen else device


def _uncertain_fields(part: Any) -> frozenset[str]:
    """Fields in which an interval is found, at any depth."""
    return frozenset(f.name for f in fields(part) if len(list(_variants(getattr(part, f.name)))) > 1)


def _variants(value: Any) -> Iterator[Any]:
    """The value with every interval in it, at any depth, replaced by either end."""
    if isinstance(value, Interval):
        yield from (value.low, value.high)
    elif isinstance(value, tuple):
        yield from (tuple(choice) for choice in product(*(list(_variants(v)) for v in value)))
    elif is_dataclass(value) and not isinstance(value, type):
        yield from _variants_of_fields(value)
    else:
        yield value


def _variants_of_fields(value: Any) -> Iterator[Any]:
    names = [f.name for f in fields(value)]
    choices = [list(_variants(getattr(value, name))) for name in names]
    if all(len(choice) == 1 for choice in choices):
        yield value
        return
    for chosen in product(*choices):
        yield type(value)(**dict(zip(names, chosen, strict=True)))


def _values(value: Exact | Interval) -> list[Exact]:
    return [value.low, value.high] if isinstance(value, Interval) else [value]
