"""A file of JSON, read with every number as the decimal that is written; refused before it costs much."""

from __future__ import annotations

import json
from collections.abc import Mapping
from decimal import Decimal, DecimalException
from itertools import pairwise
from pathlib import Path
from typing import Any

from .effort import spend

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
        raise Unreadable(str(error)) from None
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
