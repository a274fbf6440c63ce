"""The XML of a robot description; what is wrong with it becomes one message, with the line."""

from __future__ import annotations

import re
from collections.abc import Mapping
from math import isfinite
from pathlib import Path
from typing import NamedTuple
from xml.parsers.expat import ExpatError, ParserCreate

from zwidth.errors import InputError

_LARGEST = 2**25
"""[bytes] Largest description that is read."""

_DEEPEST, _MOST_PARTS = 200, 2000
_PARTS = ("link", "body", "joint", "freejoint")
_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?")


class Element(NamedTuple):
    """An element of XML, and the line on which it begins."""

    tag: str
    given: dict[str, str]
    line: int
    parts: list[Element]

    def all(self, tag: str) -> list[Element]:
        """Its children of this kind."""
        return [part for part in self.parts if part.tag == tag]

    def one(self, tag: str) -> Element | None:
        """Its child of this kind."""
        found = self.all(tag)
        if len(found) > 1:
            raise found[1].wrong(f"is one <{tag}> too many in <{self.tag}>")
        return found[0] if found else None

    def wrong(self, what: str) -> InputError:
        """What is said of it, with its line."""
        name = f" {self.given['name']!r}" if self.given.get("name") else ""
        return InputError(f"line {self.line}: <{self.tag}>{name} {what}")

    def numbers(
        self, key: str, count: int, given: Mapping[str, str] | None = None, least: int | None = None
    ) -> tuple[float, ...] | None:
        """`count` numbers, or from `least` on so many; None where the attribute is not there."""
        text = (self.given if given is None else given).get(key)
        if text is None:
            return None
        words = text.split()
        if not (count if least is None else least) <= len(words) <= count:
            wanted = "a number" if count == 1 else f"{count} numbers"
            raise self.wrong(f"has {key}={text[:60]!r}, where {wanted} should be")
        values = tuple(float(word) if _NUMBER.fullmatch(word) else float("nan") for word in words)
        if not all(map(isfinite, values)):
            raise self.wrong(f"has {key}={text[:60]!r}, which is no finite number everywhere")
        return values

    def number(self, key: str, default: float, given: Mapping[str, str] | None = None) -> float:
        """One number."""
        found = self.numbers(key, 1, given)
        return default if found is None else found[0]

    def choice(self, key: str, allowed: tuple[str, ...], given: Mapping[str, str] | None = None) -> str:
        """One of some words; the first is that of an attribute that is not there."""
        text = (self.given if given is None else given).get(key, allowed[0])
        if text not in allowed:
            raise self.wrong(f"has {key}={text[:40]!r}; it can be {', '.join(allowed)}")
        return text

    def known(self, names: str) -> None:
        """Refuse an attribute that the format does not have."""
        for key in self.given:
            if key not in names.split():
                raise self.wrong(f"has an attribute {key[:40]!r}, which this format does not know")


def parsed(path: Path) -> Element:
    """The tree; what is no XML is refused, and what leads elsewhere or has no end."""
    parser = ParserCreate()
    tree = _Tree(parser)
    parser.StartDoctypeDeclHandler = tree.doctype
    parser.StartElementHandler, parser.EndElementHandler = tree.begin, tree.end
    try:
        if path.stat().st_size > _LARGEST:
            raise InputError(f"it is larger than {_LARGEST} bytes, and no description of an arm is")
        with open(path, "rb") as file:
            parser.ParseFile(file)
    except (ExpatError, OSError, ValueError) as error:
        if isinstance(error, InputError):
            raise
        raise InputError(f"it is no XML, {error}") from None
    return tree.top.parts[0]


class _Tree:
    """Builds the elements; refuses what would make a description grow, lead elsewhere, or end the process."""

    def __init__(self, parser: object) -> None:
        self._parser, self._parts = parser, 0
        self.top = Element("", {}, 0, [])
        self._open = [self.top]

    def doctype(self, *_: object) -> None:
        """Entities can name other files, and a few lines of them stand for gigabytes."""
        raise InputError("it has a DOCTYPE, which no robot description needs; take it out")

    def begin(self, name: str, given: dict[str, str]) -> None:
        """Readers go deeper with each level, and with each joint."""
        self._parts += name in _PARTS
        line = getattr(self._parser, "CurrentLineNumber")  # noqa: B009
        if name == "include":
            raise InputError(f"it includes another file in line {line}; put all into one")
        if name.startswith("xacro:"):
            raise InputError(f"it has <{name}> in line {line}: expand it first, xacro FILE.xacro > arm.urdf")
        if len(self._open) > _DEEPEST or self._parts > _MOST_PARTS:
            raise InputError(
                f"it has more than {_DEEPEST} levels, or {_MOST_PARTS} bodies and joints; no arm has so many"
            )
        element = Element(name, given, line, [])
        self._open[-1].parts.append(element)
        self._open.append(element)

    def end(self, _: str) -> None:
        self._open.pop()
