"""Where each number of a loop comes from: typed, read from a file, published, or not given at all."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import PurePath
from typing import Any

from zwidth.device import Device, catalogue
from zwidth.device.rotary import ROTARY
from zwidth.environment.environment import Environment
from zwidth.passivity.verdict import Verdict
from zwidth.quantity.exact import Exact, Interval
from zwidth.quantity.glossary import GLOSSARY
from zwidth.quantity.kind import name_of
from zwidth.quantity.parameter import Parameter
from zwidth.quantity.text import in_words, shown
from zwidth.specification.environments import TYPES
from zwidth.specification.table import COMMAND_LINE, Table

_WRITTEN_AS = {
    "sample_period": ("sample_period", "rate"),
    "mass": ("mass", "inertia"),
    "resolution": ("resolution", "counts_per_turn"),
}
"""The keys under which a number of a device may stand, where there are several."""

_IN_PYTHON = "given in Python"
_DIGITS = 6


@dataclass(frozen=True)
class Provenance:
    """Where a loop comes from.

    Parameters
    ----------
    numbers
        (what, value with unit, where it comes from), in the order of the report.
    command
        What makes the report again; "" where it was made in Python.
    """

    numbers: tuple[tuple[str, str, str], ...]
    command: str = ""


def of_verdict(verdict: Verdict) -> Provenance:
    """Of a loop made in Python: what the catalogue has too is told with its source."""
    device, asked = verdict.device, verdict.scope
    known = catalogue.entry(device.name).values if device.name in catalogue.names() else {}
    numbers = []
    for key, value in device.parameters().items():
        where = "the worst corner of what was given in Python" if key in asked.intervals else _IN_PYTHON
        origin = _published(key, value, known) or _unless_assumed(key, asked.assumed, where)
        numbers.append((*_named(key, value, device.motion), origin))
    law = ("law", verdict.environment.describe(device.motion), _IN_PYTHON)
    return Provenance((*numbers, law))


def of_tables(
    device_table: Table, environment_table: Table, device: Device, environment: Environment, command: str
) -> Provenance:
    """Of a loop made of two tables.

    Parameters
    ----------
    device_table, environment_table
        With the parameters of the command line in them, as they were read.
    device, environment
        What was made of them; the environment may stand behind laws in a chain.
    command
        As `Provenance` has it.
    """
    rows = [
        *_of_device(device_table, device),
        *_of_environment(environment_table, environment, device.motion),
    ]
    return Provenance(tuple(rows), command)


def _of_device(table: Table, device: Device) -> Iterator[tuple[str, str, str]]:
    name = table.values.get("catalogue")
    known = {} if name is None else catalogue.entry(str(name)).values
    for key, value in device.parameters().items():
        where = next((_place(table, k) for k in _WRITTEN_AS.get(key, (key,)) if k in table.values), "")
        yield (
            *_named(key, value, device.motion),
            where or _published(key, value, known) or _unless_assumed(key, device.assumed, "not given"),
        )
    for key, own in ROTARY.items():
        if key in table.values:
            yield in_words(key), f"{table.values[key]} {own.unit}".rstrip(" 1"), _place(table, key)


def _of_environment(table: Table, environment: Environment, motion: str) -> Iterator[tuple[str, str, str]]:
    chain = getattr(environment, "laws", ())
    inner: Any = environment.environment if chain else environment  # type: ignore[attr-defined]
    kind = name_of(inner, TYPES)
    yield "law", (kind or inner.describe(motion)).replace("-", " "), _place(table, "type")
    for name, key in TYPES[kind].keys.items() if kind else ():
        value = getattr(inner, name)
        if value is not None:
            where = _place(table, name) if name in table.values else "not given: the default"
            yield (*_of_a_key(name, key, value, motion), where)
    for law in chain:
        yield "law in the chain behind it", law.describe(motion), "[[law]] in a file, or --law"


def _of_a_key(name: str, key: Parameter, value: Any, motion: str) -> tuple[str, str]:
    if key.is_number and key.quantity.name in GLOSSARY:
        return _named(key.quantity.name, value, motion)
    if isinstance(value, bool):
        return in_words(name), "yes" if value else "no"
    said = (
        value.describe(motion)
        if isinstance(value, Environment)
        else getattr(value, "describe", value.__str__)()
    )
    return in_words(name), str(said)


def _named(key: str, value: Exact | Interval, motion: str) -> tuple[str, str]:
    own = GLOSSARY[key]
    return f"{in_words(key)} {own.symbol}", shown(value, own.unit_for(motion), _DIGITS)


def _published(key: str, value: Exact | Interval, known: Mapping[str, catalogue.Datum]) -> str:
    """The source in the catalogue of a number that is the one there."""
    for name in ("rate", key) if key == "sample_period" else (key,):
        datum = known.get(name)
        if datum is None or datum.value is None or not isinstance(value, Exact):
            continue
        told = 1 / value.fraction if name == "rate" else value.fraction
        if datum.value.fraction == told:
            return f"catalogue: {datum.source}"
    return ""


def _unless_assumed(key: str, assumed: Sequence[str], otherwise: str) -> str:
    return "not given: taken as 0" if key in assumed else otherwise


def _place(table: Table, key: str) -> str:
    """Where a key was written, a file by its name alone."""
    where = table.where(key)
    if where == COMMAND_LINE:
        return _typed(table, key)
    file, found, name = where.rpartition(": [")
    return f"{PurePath(file).name}, [{name}" if found else where


def _typed(table: Table, key: str) -> str:
    own = "virtual_damping" if key == "damping" and "type" in table.values else key
    if key not in table.values or isinstance(table.values[key], dict):
        return "command line"
    return f"typed: --{own.replace('_', '-')} {table.values[key]}"
