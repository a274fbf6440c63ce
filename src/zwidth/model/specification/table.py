"""One table of a specification: its keys, and where each was written.

A message about a key must say in which file and table it stands, or that it
came from the command line, even after the two were merged.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from typing import TYPE_CHECKING

from zwidth.errors import InputError
from zwidth.missing import suggestion
from zwidth.showing import one_line

if TYPE_CHECKING:
    from zwidth.model.kind import Kind

COMMAND_LINE = "command line"


@contextmanager
def located(where: str) -> Iterator[None]:
    """Say where the input stands that an InputError inside complains about."""
    try:
        yield
    except InputError as error:
        raise InputError(f"{where}: {error}") from None


class Table:
    """Keys with their values as read; `label` says which table of which file."""

    def __init__(self, label: str, values: Mapping[str, object]) -> None:
        self.label = label
        self.values = dict(values)
        self._overridden: set[str] = set()

    def override(self, key: str, value: object, instead_of: Iterable[str] = ()) -> None:
        """Put a value of the command line in the place of the file's."""
        for other in instead_of:
            if other not in self._overridden:
                self.values.pop(other, None)
        self.values[key] = value
        self._overridden.add(key)

    def is_typed(self, key: str) -> bool:
        """True for a value of the command line."""
        return key in self._overridden

    def where(self, key: str) -> str:
        """The place where a key was written."""
        return COMMAND_LINE if key in self._overridden else self.label

    def rename(self, old: str, new: str) -> None:
        """Read an alias as the key that it stands for."""
        if old not in self.values:
            return
        if new in self.values:
            raise InputError(f"{self.where(old)}: {old} and {new} are the same quantity; give one of them")
        self.values[new] = self.values.pop(old)
        if old in self._overridden:
            self._overridden.add(new)

    def check_keys(self, allowed: Iterable[str], owner: str) -> None:
        """Refuse a key that `owner` does not have."""
        known = sorted(allowed)
        for key in self.values:
            if key not in known:
                raise InputError(f"{self.where(key)}: {owner} has no {quoted(key)}; {suggestion(key, known)}")

    def text(self, key: str) -> str:
        """The value of a key that holds a word."""
        value = self.values[key]
        if not isinstance(value, str):
            raise InputError(f'{self.where(key)}: {key} is a text in quotes, such as {key} = "…"')
        return value


def named_kind(table: Table, kinds: Mapping[str, Kind], what: str) -> Kind:
    """The class that the type of a table names; `what` says of which sort it is."""
    if "type" not in table.values:
        raise InputError(f"{table.label}: type is missing; choose from: {', '.join(kinds)}")
    name = table.text("type")
    if name not in kinds:
        hint = _BY_POINTS.format(name) if name in ("detents", "bump-stop") else suggestion(name, kinds)
        raise InputError(f"{table.where('type')}: there is no {what} {quoted(name)}; {hint}")
    return kinds[name]


_BY_POINTS = (
    "it is a nonlinear-spring by its points, and zwidth new environment FILE --type {0} makes the file of one"
)


def plain(text: str, longest: int = 60) -> str:
    """A text of the user as a message shows it: on one line, not too long."""
    return one_line(text, longest)


def quoted(text: str) -> str:
    """The same in quotes."""
    return f'"{plain(text)}"'
