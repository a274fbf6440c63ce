"""The numbers of an environment or a law, and behind a dot those of what it is made of.

    stiffness, virtual_damping                of a wall
    velocity_filter.time_constant             of the filter of its velocity
    environment.velocity_filter.samples       of the filter of a wall behind a coupling
    velocity.noise                            of the velocity of a damper in a chain

The damping of an environment is `virtual_damping`, as its option is: `damping` is the device's.  A one-pole
filter has its `cutoff` [Hz] as well, as a specification has it: τ is the double nearest to 1/(2πf).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields, is_dataclass, replace
from typing import Any

from zwidth.model.environment import OnePole, Window
from zwidth.model.environment.environment import Environment
from zwidth.model.specification.values import time_constant_of
from zwidth.quantity.exact import Exact, Interval
from zwidth.quantity.parameter import parameters_of

Units = Mapping[str, str]

_PARTS = ("environment", "velocity_filter", "velocity")
"""Fields that hold something which has numbers itself."""


def numbers_within(thing: Any, motion: str) -> Units:
    """The unit of each number, by its name; none of what has none."""
    found = dict(_own(thing, motion))
    for part in _PARTS:
        inner = getattr(thing, part, None)
        if inner is not None:
            found |= {f"{part}.{name}": unit for name, unit in numbers_within(inner, motion).items()}
    return found


def with_numbers(thing: Any, new: Mapping[str, Any]) -> Any:
    """The thing with other numbers, by the names of `numbers_within`; all of them are set at once."""
    own: dict[str, Any] = {}
    inner: dict[str, dict[str, Any]] = {}
    for name, value in new.items():
        part, _, rest = name.partition(".")
        if rest:
            inner.setdefault(part, {})[rest] = value
        else:
            own[_field(thing, name)] = time_constant_of(value) if name == "cutoff" else value
    own |= {part: with_numbers(getattr(thing, part), numbers) for part, numbers in inner.items()}
    return replace(thing, **own)


def _own(thing: Any, motion: str) -> Units:
    if isinstance(thing, Window):
        return {"samples": "1"}
    if isinstance(thing, OnePole):
        return {"time_constant": "s", "cutoff": "Hz"}
    if isinstance(thing, Environment):  # what may be left out says how it is made: it is given, or not
        given = [
            each.name for each in fields(thing) if isinstance(getattr(thing, each.name), Exact | Interval)
        ]
        return {_name(key): thing.unit_of(key, motion) for key in given}
    if not is_dataclass(thing):
        return {}
    return {key: own.unit_for(motion) for key, own in parameters_of(type(thing)).items() if own.is_number}


def _name(key: str) -> str:
    return "virtual_damping" if key == "damping" else key


def _field(thing: Any, name: str) -> str:
    """The field that holds a number."""
    if name == "cutoff" and isinstance(thing, OnePole):
        return "time_constant"
    return "damping" if name == "virtual_damping" and isinstance(thing, Environment) else name
