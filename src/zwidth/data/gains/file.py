"""A gain file as a mapping: YAML, JSON or TOML, every number as the text that was written.

A small file, and nothing in it is obeyed: YAML is read as text and lists alone, and no tag makes an object.
"""

from __future__ import annotations

import json
import tomllib
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from decimal import Decimal
from fractions import Fraction
from pathlib import Path
from typing import Any

from zwidth.errors import InputError
from zwidth.missing import did_you_mean
from zwidth.model.specification.read import refuse_settings, text_of
from zwidth.model.specification.table import plain, quoted
from zwidth.quantity.units import parse_number

MOST_JOINTS = 64

DEEPEST = 4
"""Tables inside tables in which gains are looked for."""


@dataclass(frozen=True)
class GainTable:
    """Keys of a gain file with what stands there; `label` says where that is, `keys` how one comes there."""

    label: str
    values: Mapping[str, Any]
    keys: tuple[str, ...] = ()

    def __contains__(self, key: object) -> bool:
        return key in self.values

    def where(self, key: str) -> str:
        """The place of a key, for messages and as the source of a number."""
        return f"{self.label}, {key}"

    def table(self, key: str) -> GainTable:
        """The table below a key."""
        inner = self.values[key]
        if not isinstance(inner, Mapping):
            raise InputError(f"{self.where(key)}: expected keys below it, got {_kind(inner)}")
        return GainTable(f"{self.label}, {key}", inner, (*self.keys, key))

    def below(self) -> Iterator[GainTable]:
        """This table and those inside it, each once, the outer ones first."""
        seen: set[int] = set()
        waiting = [(self, 0)]
        while waiting:
            table, depth = waiting.pop(0)
            if id(table.values) in seen:  # YAML may name one place often
                continue
            seen.add(id(table.values))
            yield table
            inner = (key for key, value in table.values.items() if isinstance(value, Mapping))
            waiting += [(table.table(key), depth + 1) for key in inner if depth < DEEPEST]

    def number(self, key: str, unit: str) -> Fraction:
        return parse_number(self.values[key], unit, self.where(key)).fraction

    def numbers(self, key: str, unit: str, joints: int | None = None) -> list[Fraction]:
        """A list of a number for each joint."""
        if key not in self.values:
            raise InputError(f"{self.label}: {key} is missing: a gain for each joint [{unit}]")
        given = self.values[key]
        if not isinstance(given, Sequence) or isinstance(given, str) or not given:
            raise InputError(
                f"{self.where(key)}: expected a list with a number for each joint, got {_kind(given)}"
            )
        if len(given) > MOST_JOINTS:
            raise InputError(f"{self.where(key)}: {len(given)} joints, at most {MOST_JOINTS} are read")
        if joints is not None and len(given) != joints:
            raise InputError(
                f"{self.where(key)}: {len(given)} numbers where the arm has {joints} joints; "
                "each list has one for each joint"
            )
        return [
            parse_number(value, unit, f"{self.where(key)}[{n}]").fraction for n, value in enumerate(given)
        ]

    def springs(self, stiffness: str, damping: str) -> tuple[list[Fraction], list[Fraction]]:
        """The lists of the springs and of the dampers of the joints."""
        found = self.numbers(stiffness, "N*m/rad")
        return found, self.numbers(damping, "N*m*s/rad", len(found))


def read_table(path: str | Path) -> GainTable:
    """The keys of a YAML, JSON or TOML file."""
    name = quoted(str(path))
    path = Path(path)
    text = text_of(path, name, "gain file", "file", lambda: f"there is no file {name}{did_you_mean(path)}")
    refuse_settings(text, name)
    suffix = path.suffix.lower()
    read: Callable[..., Any] | None = {".json": json.loads, ".toml": tomllib.loads}.get(suffix)
    try:
        content = _yaml(text) if read is None else read(text, parse_float=Decimal)
    except RecursionError:
        raise InputError(f"{name}: nested too deeply for a gain file") from None
    except ValueError as error:
        kind = {".json": "JSON", ".toml": "TOML"}.get(suffix, "YAML")
        raise InputError(f"{name}: not {kind}: {plain(str(error), 160)}") from None
    if not isinstance(content, Mapping):
        raise InputError(f"{name}: expected keys with values, got {_kind(content)}")
    return GainTable(plain(path.name), content)


def _yaml(text: str) -> Any:
    import yaml  # only where such a file is read

    # Text, lists and mappings alone; keys that are given twice are one mapping, as ROS takes them.
    joined: Any = type("Joined", (yaml.BaseLoader,), {})
    joined.add_constructor("tag:yaml.org,2002:map", _joined)
    try:
        return yaml.load(text, Loader=joined)
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        where = f"line {mark.line + 1}: " if mark else ""
        raise ValueError(f"{where}{getattr(error, 'problem', None) or 'cannot be read'}") from None


def _joined(loader: Any, node: Any) -> dict[str, Any]:
    table: dict[str, Any] = {}
    for key_node, value_node in node.value:
        key, value = (
            loader.construct_object(key_node, deep=True),
            loader.construct_object(value_node, deep=True),
        )
        if not isinstance(key, str):
            raise ValueError(f"line {key_node.start_mark.line + 1}: a key is a word")
        table[key] = _both(table[key], value, key, key_node.start_mark.line + 1) if key in table else value
    return table


def _both(first: Any, second: Any, key: str, line: int) -> Any:
    if not (isinstance(first, dict) and isinstance(second, dict)):
        raise ValueError(f"line {line}: {key} is given twice")
    found = dict(first)
    for name, value in second.items():
        found[name] = _both(found[name], value, name, line) if name in found else value
    return found


def _kind(value: object) -> str:
    if isinstance(value, Mapping):
        return "keys"
    if isinstance(value, Sequence) and not isinstance(value, str):
        return "a list"
    return "nothing" if value in (None, "") else quoted(str(value))
