"""A file of JSON, and a document read as its kind declares it; refused before it costs much."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from decimal import Decimal, DecimalException
from functools import cache
from itertools import pairwise
from pathlib import Path
from typing import Any

from .fields import LINEAR, ROTARY, Read, Record
from .refusal import Invalid, spend

LARGEST_FILE = 10_000_000
"""Bytes."""
MOST_VALUES = 500_000
"""Numbers, texts, lists and objects in it, counted by their commas and brackets."""
DEEPEST = 20
"""Objects and lists within one another."""


class Unreadable(Exception):
    """A file that is no document at all; the message says why."""


def read_file(path: str | Path) -> object:
    """What a file holds."""
    try:
        with Path(path).open("rb") as file:
            content = file.read(LARGEST_FILE + 1)  # a device says nothing of its size
    except (OSError, ValueError) as error:
        raise Unreadable(getattr(error, "strerror", None) or str(error)) from None
    if len(content) > LARGEST_FILE:
        raise Unreadable(
            f"larger than {LARGEST_FILE} bytes: give each proof or motion in it in a file by itself"
        )
    values = sum(map(content.count, (b",", b"{", b"[")))
    if values > MOST_VALUES:
        raise Unreadable(
            f"more than {MOST_VALUES} numbers and texts: give each proof or motion in it in a file by itself"
        )
    spend(values, each=1)
    try:
        return json.loads(
            content.decode(), parse_float=_decimal, parse_int=_integer, object_pairs_hook=_once_each
        )
    except UnicodeDecodeError as error:
        raise Unreadable(f"not UTF-8 text (byte {error.start}): write it by -o FILE, not by > FILE") from None
    except (ValueError, RecursionError) as error:
        raise Unreadable(f"not JSON: {error}") from None


def require_shallow(document: Mapping[str, object]) -> None:
    """Refuse what is nested deeper than any document is, before anything goes down into it."""
    level: list[Any] = [document]
    for _ in range(DEEPEST):
        level = [
            inner
            for value in level
            for inner in (value.values() if isinstance(value, Mapping) else value)
            if isinstance(inner, (Mapping, list))
        ]
        if not level:
            return
    raise Unreadable(f"more than {DEEPEST} objects and lists within one another, and no document has so many")


def _once_each(pairs: list[tuple[str, object]]) -> dict[str, object]:
    """An object whose keys are all different: of two with one name nobody could say which is meant."""
    found = dict(pairs)
    if len(found) < len(pairs):
        names = sorted(name for name, _ in pairs)
        twice = next(a for a, b in pairwise(names) if a == b)
        raise Unreadable(f"{twice[:60]!r} is given twice in one object, and only one of them can be meant")
    return found


def _integer(text: str) -> object:
    return int(text) if len(text) <= 4000 else _decimal(text)


def _decimal(text: str) -> Decimal:
    try:
        return Decimal(text)
    except DecimalException:  # an exponent beyond any
        raise Unreadable(f"expected a number of ordinary size, got {text[:40]}") from None


MOST_LEVELS = 12
"""Of objects and lists within one another."""


def read_document(fields: Record, document: Mapping[str, Any]) -> tuple[Read, str]:
    """What a document says, and whether it is of a linear or a rotary device."""
    motion = _motion(fields, document)
    found: Read = fields.read(document, "", motion)
    found.units = motion
    return found, motion


def _motion(fields: Record, document: Mapping[str, Any]) -> str:
    linear, rotary = _keys_of_one_motion(fields)
    told = set(_told(document))
    slides, turns = sorted(told & linear), sorted(told & rotary)
    if slides and turns:
        raise Invalid(
            f"one document has the units of a linear device or of a rotary one: {slides[0]} and {turns[0]}"
        )
    return ROTARY if turns else LINEAR


@cache
def _keys_of_one_motion(fields: Record) -> tuple[set[str], set[str]]:
    """The keys that only a linear device has, and those that only a rotary one has."""
    linear, rotary = set(fields.keys(LINEAR)), set(fields.keys(ROTARY))
    return linear - rotary, rotary - linear


def _told(value: Any, depth: int = MOST_LEVELS) -> Iterator[str]:
    if depth == 0:
        raise Invalid(f"a document has at most {MOST_LEVELS} levels")
    if isinstance(value, Mapping):
        for key, inner in value.items():
            yield str(key)
            yield from _told(inner, depth - 1)
    elif isinstance(value, (list, tuple)) and any(isinstance(v, (Mapping, list, tuple)) for v in value):
        for inner in value:
            yield from _told(inner, depth - 1)
