"""A device, an environment and laws as the TOML text that `read` reads, digit for digit.

    [device]                                [environment]
    damping = "0.15 N*s/m"                  type = "wall"
    sample_period = "0.001 s"               stiffness = "300 N/m"

Each quantity carries its unit.  What is written is read again and compared before it is handed out.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

from zwidth.errors import InputError
from zwidth.model.device import Device
from zwidth.model.environment import BackwardDifference, Environment, OnePole, VelocityFilter, Window
from zwidth.model.kind import Kind, name_of
from zwidth.model.rendering import ESTIMATORS, LAWS
from zwidth.model.specification.environments import TYPES, build_environment
from zwidth.model.specification.laws import with_laws
from zwidth.model.specification.read import WITH_LAWS, Specification, specified, tables_of
from zwidth.model.specification.scenes import ELEMENTS
from zwidth.quantity.exact import Exact, Interval
from zwidth.quantity.glossary import GLOSSARY
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
    laws = tuple(_law(link, LAWS, device.motion) for link in chain)
    return Tables(device_table(device), _environment(inner, device.motion), laws)


def written(device: Device, environment: Environment) -> str:
    """The loop as a specification in TOML.

    Parameters
    ----------
    device, environment
        A loop; the environment may stand behind laws in a chain.
    """
    values = tables(device, environment)
    rows = [("[device]", values.device), ("[environment]", values.environment)]
    rows += [("[[law]]", law) for law in values.laws]
    text = "\n".join(line for head, row in rows for line in (head, *lines(row), ""))
    again = parsed(text)
    if (again.device.replace(name=device.name), again.environment) != (device, environment):
        raise InputError(f"a specification cannot say all of this: {environment.describe(device.motion)}")
    return text


def written_environment(environment: Environment, motion: str = "linear") -> str:
    """The environment alone, as the file that stands beside a device: `zwidth check DEVICE FILE`."""
    text = "\n".join(["[environment]", *lines(_environment(environment, motion)), ""])
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
    return values


def quantity_text(value: Exact | Interval | int, unit: str) -> object:
    """One value with its unit; an interval is a list of two."""
    if isinstance(value, Interval):
        return [quantity_text(end, unit) for end in (value.low, value.high)]
    number = str(value) if isinstance(value, int) else exact_text(value.fraction)
    return number if unit in ("", "1") else f"{number} {unit}"


def _environment(environment: Environment, motion: str) -> dict[str, object]:
    name = name_of(environment, TYPES)
    if name is None:
        raise InputError(f"a specification has no {type(environment).__name__}")
    values: dict[str, object] = {"type": name}
    for key, kind in TYPES[name].keys.items():
        value = getattr(environment, key)
        if kind.form == "branches":
            values[key] = [_branch(branch, motion) for branch in value]
        elif kind.form == "environment":
            values[key] = _environment(value, motion)
        elif kind.form == "elements":
            values[key] = [_law(element, ELEMENTS, motion) for element in value]
        elif kind.form == "velocity filter":
            values[key] = _filter(value)
        elif value is not None:
            values[key] = _value(value, kind.unit_for(motion))
    return values


def _value(value: Any, unit: str) -> object:
    if isinstance(value, tuple):
        return [quantity_text(one, unit) for one in value]
    return value if isinstance(value, str | bool) else quantity_text(value, unit)


def _branch(branch: Any, motion: str) -> list[object]:
    units = (GLOSSARY[key].unit_for(motion) for key in ("branch_stiffness", "branch_damping"))
    return [quantity_text(value, unit) for value, unit in zip(branch, units, strict=True)]


def _filter(estimate: object) -> dict[str, object]:
    if isinstance(estimate, BackwardDifference):
        return {"type": "backward-difference"}
    if isinstance(estimate, Window):
        return {"type": "window", "samples": str(estimate.samples)}
    if isinstance(estimate, OnePole):
        return {"type": "one-pole", "time_constant": quantity_text(estimate.time_constant, "s")}
    if isinstance(estimate, VelocityFilter):
        sides = {key: _value(getattr(estimate, key), "1") for key in ("numerator", "denominator")}
        return {"type": "filter", **sides}
    raise InputError(f"a specification has no {type(estimate).__name__}")


def _law(law: object, kinds: Mapping[str, Kind], motion: str) -> dict[str, object]:
    name = name_of(law, kinds)
    if name is None:
        raise InputError(f"a specification has no {type(law).__name__}")
    values: dict[str, object] = {"type": name}
    for key, kind in kinds[name].keys.items():
        value = getattr(law, key)
        if kind.form == "velocity":
            values[key] = _law(value, ESTIMATORS, motion)
        elif value is not None:
            values[key] = _value(value, kind.unit_for(motion))
    return values
