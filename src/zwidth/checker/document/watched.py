"""A document that remembers which of its entries were looked at.

What nobody read is no part of what was proved, and whoever prints the document would show it as if it were.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

FREE = frozenset({"format"})
"""Entries that say what a document is, for people and programs that sort them."""


class Watched(Mapping[str, Any]):
    """An object of a document; to ask whether a key is there is not to read it."""

    def __init__(self, table: Mapping[str, Any]) -> None:
        self._table = table
        self._read: dict[str, Any] = {}

    def __getitem__(self, key: str) -> Any:
        if key not in self._read:
            self._read[key] = watched(self._table[key])
        return self._read[key]

    def __contains__(self, key: object) -> bool:
        return key in self._table

    def __iter__(self) -> Iterator[str]:
        return iter(self._table)

    def __len__(self) -> int:
        return len(self._table)

    def unread(self) -> Iterator[str]:
        """The keys that were not read, here and below, as a path each."""
        for key in self._table:
            if key not in self._read:
                if key not in FREE:
                    yield str(key)
            else:
                yield from (f"{key}.{path}" for path in _unread(self._read[key]))


def watched(value: Any) -> Any:
    """A value of a document, its objects watched."""
    if isinstance(value, Mapping):
        return Watched(value)
    if isinstance(value, list) and any(isinstance(entry, (Mapping, list)) for entry in value):
        return [watched(entry) for entry in value]
    return value


def _unread(value: Any) -> Iterator[str]:
    if isinstance(value, Watched):
        yield from value.unread()
    elif isinstance(value, list):
        for entry in value:
            yield from _unread(entry)
