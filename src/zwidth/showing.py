"""Text of others, such as the names in a file, is shown and never obeyed.

A terminal obeys control characters, a notebook and a browser obey markup: whoever writes a file
could have them do what its reader did not ask for.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from html import escape

OBEYED = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x9f\u061c\u200e\u200f\u2028-\u202e\u2066-\u2069]")
"""What a terminal obeys, except tabs and line ends: controls, and what turns the direction of writing."""


class Html(str):
    """Text that is HTML already; any other text is escaped before it becomes a part of it."""

    __slots__ = ()


def printable(text: str) -> str:
    """The text with ? for every character that a terminal would obey."""
    return OBEYED.sub("?", text)


def element(tag: str, *inside: object, **attributes: str) -> Html:
    """What is inside in a tag; what is no `Html` is escaped, and so are the attributes."""
    given = "".join(f' {name}="{escape(value)}"' for name, value in attributes.items())
    return Html(f"<{tag}{given}>{join(*inside)}</{tag}>")


def join(*parts: object) -> Html:
    """One after the other; what is no `Html` is escaped."""
    return Html("".join(part if isinstance(part, Html) else escape(printable(str(part))) for part in parts))


def row(cells: Iterable[object], tag: str = "td") -> Html:
    """A row of a table."""
    return element("tr", *(element(tag, cell) for cell in cells))


def table(head: Iterable[object], rows: Iterable[Iterable[object]]) -> Html:
    """A table below its headings."""
    return element("table", element("thead", row(head, "th")), element("tbody", *map(row, rows)))


def named(rows: Iterable[tuple[object, object]]) -> Html:
    """A table whose lines are each a name and what it is."""
    left = {"align": "left"}
    lines = (element("tr", element("th", k, **left), element("td", v, **left)) for k, v in rows)
    return element("table", *lines)


def bullets(items: Iterable[object]) -> Html:
    """A list."""
    return element("ul", *(element("li", item) for item in items))
