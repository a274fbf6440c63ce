"""A file of answers: its tables, each value with a remark, and what is not known as a remark in its place."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

from zwidth.model.specification.write import toml


class Row(NamedTuple):
    """A key of the file; without a value the remark stands in its place."""

    key: str
    value: str | list[str] | None
    remark: str = ""

    def __str__(self) -> str:
        if self.value is None:
            return f"# {self.key} is not known. {self.remark}"
        remark = f"  # {self.remark}" if self.remark else ""
        return f"{self.key} = {toml(self.value)}{remark}"


class Written(NamedTuple):
    """A file, and what to say when it is there."""

    text: str
    then: list[str]


def table(name: str, head: str, rows: Iterable[Row]) -> str:
    """A table of a specification as text."""
    return "\n".join([f"# {head}", f"[{name}]", *map(str, rows), ""])
