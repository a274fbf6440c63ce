"""What a result says of itself, in parts that a terminal and a notebook show alike.

Text of others, such as the names in a file, is shown and never obeyed: a terminal obeys control
characters, a notebook and a browser obey markup, and whoever writes a file could have them do what
its reader did not ask for.
"""

from __future__ import annotations

import os
import re
import shlex
from base64 import b64encode
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from html import escape

OBEYED = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x9f\u061c\u200e\u200f\u2028-\u202e\u2066-\u2069]")
"""What a terminal obeys, except tabs and line ends: controls, and what turns the direction of writing."""


class Html(str):
    """Text that is HTML already; any other text is escaped before it becomes a part of it."""

    __slots__ = ()


_WINDOWS = os.name == "nt"


def typed(*words: str) -> str:
    """Words of a command as bash, PowerShell and cmd.exe take them: between double quotes where they must."""
    return " ".join(map(_typed, words))


def _typed(word: str) -> str:
    if re.fullmatch(r"[\w@+=:,./-]+", word.replace("\\", "/") if _WINDOWS else word):
        return word
    return f'"{word}"' if _WINDOWS or not re.search(r'["$`!\\]', word) else shlex.quote(word)


def printable(text: str) -> str:
    """The text with ? for every character that a terminal would obey."""
    return OBEYED.sub("?", text)


def one_line(text: str, longest: int | None = None) -> str:
    """The same of what stands in a line, such as a name: ? for a line's end too; not longer than that."""
    shown = "".join(c if c.isprintable() else "?" for c in text)
    return shown if longest is None or len(shown) <= longest else f"{shown[: longest - 3]}..."


def element(tag: str, *inside: object, **attributes: str) -> Html:
    """What is inside in a tag; what is no `Html` is escaped, and so are the attributes."""
    return Html(f"<{tag}{_given(attributes)}>{join(*inside)}</{tag}>")


def void(tag: str, **attributes: str) -> Html:
    """A tag that has nothing inside and no end, such as `meta` and `img`; XML too."""
    return Html(f"<{tag}{_given(attributes)}/>")


def _given(attributes: Mapping[str, str]) -> str:
    return "".join(f' {name}="{escape(printable(value))}"' for name, value in attributes.items())


def join(*parts: object) -> Html:
    """One after the other; what is no `Html` is escaped."""
    return Html("".join(part if isinstance(part, Html) else escape(printable(str(part))) for part in parts))


def row(cells: Iterable[object], tag: str = "td") -> Html:
    """A row of a table."""
    return element("tr", *(element(tag, cell) for cell in cells))


@dataclass(frozen=True, kw_only=True)
class Table:
    """Rows of cells, each as text.

    Parameters
    ----------
    heads
        Rows above, such as headings and units; none where the first cell of each row says what it is.
    lefts
        Columns that are set left; those after them are set right.
    caption
        A line above.
    """

    rows: Sequence[Sequence[str]]
    heads: Sequence[Sequence[str]] = ()
    lefts: int | None = None
    caption: str = ""

    @property
    def html(self) -> Html:
        """The table for a notebook."""
        caption = [element("caption", self.caption)] if self.caption else []
        heads = [element("thead", *(row(cells, "th") for cells in self.heads))] if self.heads else []
        line = row if self.heads else _named
        return element("table", *caption, *heads, element("tbody", *map(line, self.rows)))

    def __str__(self) -> str:
        lines = [*self.heads, *self.rows]
        widths = [max(map(len, column)) for column in zip(*lines, strict=True)]
        lefts = len(widths) if self.lefts is None else self.lefts
        sides = "<" * lefts + ">" * (len(widths) - lefts)
        texts = (
            "  ".join(f"{cell:{side}{width}}" for cell, side, width in zip(cells, sides, widths, strict=True))
            for cells in lines
        )
        return "\n".join([*([self.caption, ""] if self.caption else []), *(text.rstrip() for text in texts)])


def _named(cells: Sequence[str]) -> Html:
    """A row whose first cell says what it is."""
    name, *rest = cells
    others = (element("td", cell, style=_LEFT) for cell in rest)
    return element("tr", element("th", name, scope="row", style=_LEFT), *others)


_LEFT = "text-align:left"
"""A notebook sets cells right."""


@dataclass(frozen=True)
class Lines:
    """A list, a line for each item; below a heading it is folded up in a notebook."""

    items: Iterable[object]
    heading: str = ""
    mark: str = "·"

    @property
    def html(self) -> Html:
        """The list for a notebook."""
        items = element("ul", *(element("li", item) for item in self.items))
        return element("details", element("summary", self.heading), items) if self.heading else items

    def __str__(self) -> str:
        return "\n".join(f"{self.mark} {item}" for item in self.items)


@dataclass(frozen=True)
class Headline:
    """The outcome in its colour, and the claim."""

    word: str
    colour: str
    claim: str = ""

    @property
    def html(self) -> Html:
        """The line for a notebook."""
        return join(element("b", self.word, style=f"color:{self.colour}"), f" {self.claim}")

    def __str__(self) -> str:
        return f"{self.word}: {self.claim}"


@dataclass(frozen=True)
class Picture:
    """A picture as it stands in a file.

    Parameters
    ----------
    data, kind
        The file and what it is: "svg+xml" or "png".
    says
        What can be seen in it, for those who cannot see it.
    caption
        A line below.
    """

    data: bytes
    kind: str
    says: str
    caption: str = ""

    @property
    def html(self) -> Html:
        """The picture for a notebook: within the page, where nothing in it can be obeyed."""
        shown = void("img", src=data_uri(self.data, f"image/{self.kind}"), alt=self.says, style=_WIDTH)
        below = [element("figcaption", self.caption)] if self.caption else []
        return element("figure", shown, *below)

    def __str__(self) -> str:
        return self.says


_WIDTH = "max-width:100%;height:auto"


def data_uri(data: bytes, kind: str) -> str:
    """A file within an address."""
    return f"data:{kind};base64,{b64encode(data).decode()}"


Part = str | Table | Lines | Headline | Picture


class Shown:
    """Something that says once what it is, in parts: a terminal and a notebook show the same."""

    def report(self) -> Iterable[Part]:
        """What it says of itself, from the top down."""
        raise NotImplementedError

    def pictures(self) -> Iterable[Picture]:
        """What a notebook shows below that."""
        return ()

    def __repr__(self) -> str:
        return printable("\n".join(map(str, self.report())))

    def _repr_html_(self) -> Html:
        said = [*self.report(), *self.pictures()]
        parts = [element("p", part) if isinstance(part, str) else part.html for part in said if part]
        return parts[0] if len(parts) == 1 else element("div", *parts)
