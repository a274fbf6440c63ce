"""A device, an environment and laws as the TOML text that `read` reads, digit for digit.

    [device]                                [environment]
    damping = "0.15 N*s/m"                  type = "wall"
    sample_period = "0.001 s"               stiffness = "300 N/m"

Each quantity carries its unit.  What is written is read again and compared before it is handed out.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping
from typing import Any, NamedTuple

from zwidth.errors import InputError
from zwidth.model.device import Device
from zwidth.model.environment import BackwardDifference, Environment, OnePole, VelocityFilter, Window
from zwidth.model.kind import Kind, name_of
from zwidth.model.pairs import Pair
from zwidth.model.rendering import ESTIMATORS, LAWS
from zwidth.model.specification.environments import ELEMENTS, TYPES, build_environment
from zwidth.model.specification.laws import with_laws
from zwidth.model.specification.load import KEYS, pair_of
from zwidth.model.specification.read import PAIR_TABLES, WITH_LAWS, Specification, specified, tables_of
from zwidth.model.specification.values import FILTERS
from zwidth.quantity.exact import Exact, Interval, as_parameter
from zwidth.quantity.glossary import GLOSSARY
from zwidth.quantity.parameter import parameters_of
from zwidth.quantity.text import exact_text
from zwidth.showing import one_line


class Tables(NamedTuple):
    """The tables of a loop: texts with units, words, flags, lists and tables in tables."""

    device: dict[str, object]
    environment: dict[str, object]
    laws: tuple[dict[str, object], ...]


def tables(device: Device, environment: Environment) -> Tables:
    """The loop as the tables that `written` writes, each quantity a text with its unit."""
    chain = getattr(environment, "laws", ())
    inner = environment.environment if chain else environment  # type: ignore[attr-defined]
    laws = tuple(_written(link, LAWS, device.motion) for link in chain)
    return Tables(device_table(device), _written(inner, TYPES, device.motion), laws)


def written(device: Device, environment: Environment) -> str:
    """The loop as a specification in TOML; the environment may stand behind laws in a chain."""
    values = tables(device, environment)
    rows = [("[device]", values.device), ("[environment]", values.environment)]
    rows += [("[[law]]", law) for law in values.laws]
    text = _text(rows)
    again = parsed(text)
    if (again.device.replace(name=device.name), again.environment) != (device, environment):
        raise InputError(f"a specification cannot say all of this: {environment.describe(device.motion)}")
    return text


def written_environment(environment: Environment, motion: str = "linear") -> str:
    """The environment alone, as the file that stands beside a device: `zwidth check DEVICE FILE`."""
    text = _text([("[environment]", _written(environment, TYPES, motion))])
    again = build_environment(tables_of(text, "environment")["environment"], motion)
    if again != environment:
        raise InputError(f"a specification cannot say all of this: {environment.describe(motion)}")
    return text


def parsed(text: str, name: str = "specification") -> Specification:
    """The loop of a text, with its laws in a chain; `name` says in messages where it stands."""
    found = tables_of(text, name, WITH_LAWS)
    loop = specified({kind: table for kind, table in found.items() if kind != "law"})
    row = found.get("law")
    return Specification(loop.device, with_laws(loop.environment, row, None, loop.device.motion))


def _text(tables: Iterable[tuple[str, Mapping[str, object]]]) -> str:
    return "\n".join(line for head, row in tables for line in (head, *lines(row), ""))


def lines(values: Mapping[str, object]) -> Iterator[str]:
    """A table, a line for each key."""
    return (f"{key} = {toml(value)}" for key, value in values.items())


def toml(value: object) -> str:
    """A text, a flag, a list or a table as TOML has it on one line."""
    if isinstance(value, Mapping):
        return f"{{ {', '.join(lines(value))} }}"
    if isinstance(value, list):
        return f"[{', '.join(map(toml, value))}]"
    if isinstance(value, bool):
        return "true" if value else "false"
    assert isinstance(value, str)
    return json.dumps(one_line(value), ensure_ascii=False)


def device_table(device: Device) -> dict[str, object]:
    """The numbers of a device, each a text with its unit."""
    values: dict[str, object] = {"name": device.name, "motion": device.motion}
    for key, value in device.parameters().items():
        name = "inertia" if key == "mass" and device.motion == "rotary" else key
        if key not in device.assumed:
            values[name] = quantity_text(value, GLOSSARY[key].unit_for(device.motion))
    if device.transmission is not None:
        own = parameters_of(type(device.transmission))
        values["transmission"] = {
            key: quantity_text(value, own[key].unit_for(device.motion))
            for key, value in device.transmission.parameters().items()
        } | {"encoder": device.transmission.encoder}
    return values


def quantity_text(value: Exact | Interval | int, unit: str) -> object:
    """One value with its unit; an interval is a list of two."""
    if isinstance(value, Interval):
        return [quantity_text(end, unit) for end in (value.low, value.high)]
    number = str(value) if isinstance(value, int) else exact_text(value.fraction)
    return number if unit in ("", "1") else f"{number} {unit}"


def _written(thing: object, kinds: Mapping[str, Kind], motion: str) -> dict[str, object]:
    name = name_of(thing, kinds)
    if name is None:
        raise InputError(f"a specification has no {type(thing).__name__}")
    values: dict[str, object] = {"type": name}
    for key, kind in kinds[name].keys.items():
        value = getattr(thing, key)
        if kind.form == "branches":
            units = [GLOSSARY[f"branch_{own}"].unit_for(motion) for own in ("stiffness", "damping")]
            values[key] = [list(map(quantity_text, branch, units)) for branch in value]
        elif kind.form == "elements":
            values[key] = [_written(element, ELEMENTS, motion) for element in value]
        elif kind.form in _INNER:
            values[key] = _written(value, _INNER[kind.form], motion)
        elif kind.form == "velocity filter":
            values[key] = _filter(value)
        elif value is not None:
            values[key] = _value(value, kind.unit_for(motion))
    return values


_INNER: Mapping[str, Mapping[str, Kind]] = {"environment": TYPES, "velocity": ESTIMATORS}
"""By form, what stands in a table of its own inside another."""


def _value(value: Any, unit: str) -> object:
    if isinstance(value, tuple):
        return [quantity_text(one, unit) for one in value]
    return value if isinstance(value, str | bool) else quantity_text(value, unit)


_FILTERS: Mapping[type, str] = {
    BackwardDifference: "backward-difference", Window: "window", OnePole: "one-pole",
    VelocityFilter: "filter",
}  # fmt: skip


def _filter(estimate: object) -> dict[str, object]:
    name = _FILTERS.get(type(estimate))
    if name is None:
        raise InputError(f"a specification has no {type(estimate).__name__}")
    units = {key: "s" if key == "time_constant" else "1" for key in FILTERS[name] if key != "cutoff"}
    return {"type": name, **{key: _value(getattr(estimate, key), unit) for key, unit in units.items()}}


def written_pair(pair: Pair) -> str:
    """A pair as a specification in TOML."""
    tables = [
        ("[leader]", device_table(pair.leader)),
        ("[follower]", device_table(pair.follower)),
        ("[coupling]", _coupling(pair)),
    ]
    text = _text(tables)
    if pair_of(tables_of(text, "specification", PAIR_TABLES)) != pair:
        raise InputError("a specification cannot say all of this pair")
    return text


def _coupling(pair: Pair) -> dict[str, object]:
    values: dict[str, object] = {}
    given = {"there": "link_delay", "back": "link_delay_back"}
    for name, own in parameters_of(Pair).items():
        value = getattr(pair, name)
        if value is not None and (value != 0 or name == "stiffness"):
            values[given.get(name, name)] = quantity_text(value, own.quantity.unit_for(pair.motion))
    for prefix, law in (("", pair.compensation), ("follower_", pair.follower_compensation)):
        for name in parameters_of(type(law)) if law is not None else ():
            unit = KEYS[f"compensation_{name}"].quantity.unit_for(pair.motion)
            values[f"{prefix}compensation_{name}"] = quantity_text(as_parameter(getattr(law, name)), unit)
    return values
