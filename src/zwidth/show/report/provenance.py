"""Where each number of a loop comes from: typed, read from a file, published, or not given at all."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from math import pi
from pathlib import PurePath
from typing import Any

from zwidth.model.device import Device, Transmission, catalogue
from zwidth.model.device.rotary import ROTARY
from zwidth.model.environment.environment import Environment
from zwidth.model.kind import name_of
from zwidth.model.pairs import Pair
from zwidth.model.specification.environments import TYPES
from zwidth.model.specification.load import KEYS
from zwidth.model.specification.table import COMMAND_LINE, Table
from zwidth.passivity.verdict import Verdict
from zwidth.quantity.exact import Exact, Interval, ends
from zwidth.quantity.glossary import GLOSSARY
from zwidth.quantity.parameter import Parameter, parameters_of
from zwidth.quantity.text import in_words, shown, unit_text

_WRITTEN_AS = {
    "sample_period": ("sample_period", "rate"),
    "mass": ("mass", "inertia"),
    "resolution": ("resolution", "counts_per_turn"),
}
"""The keys under which a number of a device may stand, where there are several."""

_IN_PYTHON = "given in Python"
_DEFAULT = "not given: the default"
_DIGITS = 6

Row = tuple[str, str, str]
"""What, its value with unit, where it comes from."""


@dataclass(frozen=True)
class Provenance:
    """Where a loop comes from.

    Parameters
    ----------
    numbers
        (what, value with unit, where it comes from), in the order of the report.
    command
        What makes the report again; "" where it was made in Python.
    device_file, environment_file
        The names of the files that they are of; "" where they are of none.
    """

    numbers: tuple[Row, ...] = ()
    command: str = ""
    device_file: str = ""
    environment_file: str = ""


def of_verdict(verdict: Verdict) -> Provenance:
    """Of a loop made in Python: what the catalogue has too is told with its source."""
    device, scope = verdict.device, verdict.scope
    known = catalogue.entry(device.name).values if device.name in catalogue.names() else {}
    numbers: list[Row] = []
    for key, value in device.parameters().items():
        where = f"the worst of the interval {_IN_PYTHON}" if key in scope.intervals else _IN_PYTHON
        origin = _published(key, value, known) or _unless_assumed(key, scope.assumed, where)
        numbers.append((*_named(key, value, device.motion), origin))
    numbers += [(what, value, _IN_PYTHON) for _, what, value in _of_the_transmission(device)]
    law = ("law", verdict.environment.describe(device.motion), _IN_PYTHON)
    return Provenance((*numbers, law))


def of_device(table: Table, device: Device) -> Iterator[Row]:
    """Of a device made of a table, the parameters of the command line in it."""
    name = table.values.get("catalogue")
    known = {} if name is None else catalogue.entry(str(name)).values
    ranges = {} if name is None else catalogue.entry(str(name)).ranges
    for key, value in device.parameters().items():
        written = next((k for k in _WRITTEN_AS.get(key, (key,)) if k in table.values), None)
        asked = key if key != "mass" else in_words(key, device.motion)
        where = _place(table, written, asked) if written else _of_the_catalogue(key, value, known, ranges)
        yield (*_named(key, value, device.motion), where or _unless_assumed(key, device.assumed, "not given"))
    inside: Any = table.values.get("transmission", {})
    for name, what, number in _of_the_transmission(device):
        option = f"transmission.{name}"
        where = of_file(table.label) if name in inside else _DEFAULT
        yield what, number, _place(table, option, option) if table.is_typed(option) else where
    for key, own in ROTARY.items():
        if key in table.values and not (key == "inertia" and device.motion == "rotary"):  # it is told above
            yield in_words(key), as_written(table.values[key], own.unit), _place(table, key, key)


def _of_the_transmission(device: Device) -> Iterator[Row]:
    given = device.transmission
    if given is None:
        return
    for key, value in given.parameters().items():
        own = parameters_of(Transmission)[key]
        named = f"transmission: {in_words(key)} {own.quantity.symbol}"
        yield key, named, _value(value, own.unit_for(device.motion))
    yield "encoder", "transmission: encoder", f"at the {given.encoder}"


def of_environment(
    table: Table, environment: Environment, motion: str, laws: Table | None = None, typed: Sequence[str] = ()
) -> Iterator[Row]:
    """Of an environment made of a table.

    `table`: with the parameters of the command line in it, as it was read.
    `environment`: what was made of it; it may stand behind laws in a chain.
    `motion`: "linear" or "rotary".
    `laws`, `typed`: the [[law]] tables of a file, and what stood behind each `--law`, which takes their
        place.
    """
    chain = getattr(environment, "laws", ())
    inner: Any = environment.environment if chain else environment  # type: ignore[attr-defined]
    kind = name_of(inner, TYPES)
    yield "law", (kind or inner.describe(motion)).replace("-", " "), _place(table, "type", "type")
    for name, key in TYPES[kind].keys.items() if kind else ():
        value = getattr(inner, name)
        if value is not None:
            where = _place(table, name, name) if name in table.values else _DEFAULT
            yield (*_of_a_key(name, key, value, motion), where)
    behind = f"typed: --law {','.join(typed)}" if typed or laws is None else of_file(laws.label)
    for law in chain:
        yield "law behind it", law.describe(motion), behind


def _of_a_key(name: str, key: Parameter, value: Any, motion: str) -> tuple[str, str]:
    if key.is_number and key.quantity.name in GLOSSARY:
        return _named(key.quantity.name, value, motion)
    if isinstance(value, bool):
        return in_words(name), "yes" if value else "no"
    if isinstance(value, Environment):
        return in_words(name), value.describe(motion)
    if hasattr(value, "describe"):
        return in_words(name), value.describe()
    if isinstance(value, (tuple, list)) and len(str(value)) > 60:
        return in_words(name, motion), f"{len(value)} of them"
    if isinstance(value, tuple) and all(isinstance(one, Exact) for one in value):
        return in_words(name, motion), ", ".join(_value(one, key.unit_for(motion)) for one in value)
    return in_words(name), str(value)


def _named(key: str, value: Exact | Interval, motion: str) -> tuple[str, str]:
    own, name = GLOSSARY[key], in_words(key, motion)
    named = name if name == "inertia" else f"{name} {own.symbol}".rstrip()
    return named, _value(value, own.unit_for(motion))


def _value(value: Exact | Interval, unit: str) -> str:
    return shown(value, unit, _DIGITS) if isinstance(value, Interval) else shown(float(value), unit, _DIGITS)


def as_written(value: object, unit: str) -> str:
    """As it stands in a file, with the unit where it has none there."""
    text = str(value).replace("*", "·")
    return text if any(map(str.isalpha, text)) else f"{text} {unit_text(unit)}".rstrip()


def _of_the_catalogue(
    key: str,
    value: Exact | Interval,
    known: Mapping[str, catalogue.Datum],
    ranges: Mapping[str, catalogue.Range],
) -> str:
    """The source of a published number, or that it is a range and why; "" where it is neither."""
    stated = next((ranges[k] for k in (*_WRITTEN_AS.get(key, ()), key) if k in ranges), None)
    if stated is not None and isinstance(value, Interval):
        return f"catalogue, stated and not measured: {stated.why}"
    return _published(key, value, known)


def _published(key: str, value: Exact | Interval, known: Mapping[str, catalogue.Datum]) -> str:
    """The source in the catalogue of a number that is the one there."""
    for name in ("rate", key) if key == "sample_period" else (key,):
        datum = known.get(name)
        if datum is None or datum.value is None or not isinstance(value, Exact):
            continue
        told = 1 / value.fraction if name == "rate" else value.fraction
        if datum.value.fraction == told:
            return f"catalogue: {datum.source}"
    counts = known.get("counts_per_turn") if key == "resolution" else None
    if counts is None or counts.value is None or float(ends(value)[0]) != 2 * pi / float(counts.value):
        return ""
    return f"catalogue, {float(counts.value):g} counts per turn: {counts.source}"


def _unless_assumed(key: str, assumed: Sequence[str], otherwise: str) -> str:
    return "not given: taken as 0" if key in assumed else otherwise


def _place(table: Table, key: str, asked: str) -> str:
    """Where a key was written, and under which name where that is another one."""
    if table.is_typed(key):
        option = "virtual-damping" if key == "damping" and "type" in table.values else key.replace("_", "-")
        return f"typed: --{option} {table.values[key]}"
    if table.label == COMMAND_LINE:
        return _DEFAULT
    return of_file(table.label) + ("" if key == asked else f": {key}")


def file_of(table: Table) -> str:
    """The name of the file of a table; "" where it is of none."""
    path, found, _ = table.label.rpartition(": [")
    return PurePath(path).name if found else ""


def of_file(label: str) -> str:
    """A table of a file, which is called by its name alone."""
    file, found, name = label.rpartition(": [")
    return f"{PurePath(file.removesuffix(': [')).name}, [{name}" if found else label


def of_pair(tables: Mapping[str, Table], pair: Pair) -> Iterator[Row]:
    """Of two arms made of the tables of one file, as they were read; of one [device] both are made."""
    arms = [("leader", pair.leader), ("follower", pair.follower)]
    for name, device in arms if "leader" in tables else [("device", pair.leader)]:
        for what, value, where in of_device(tables[name], device):
            yield f"{name}: {what}", value, where
    coupling = tables["coupling"]
    for key, given in coupling.values.items():
        unit = KEYS[key].unit_for(pair.motion) if KEYS[key].is_number else ""
        yield f"coupling: {in_words(key)}", as_written(given, unit), of_file(coupling.label)
