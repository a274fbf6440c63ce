"""What every report in the terminal is made of: a headline, names with their texts, sections.

Everything a person typed is printed as text, never read as markup.
"""

from __future__ import annotations

import sys
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from io import StringIO

from rich.console import Console, ConsoleOptions, RenderableType
from rich.padding import Padding
from rich.segment import Segment
from rich.table import Table
from rich.text import Text

from zwidth.cli.output import quiet_pipe, spelled
from zwidth.cli.width import GLUE, columns
from zwidth.showing import printable

Row = tuple[str, str | Text]
"""A name, and what stands beside it."""

_ANY = 100
"""Lines of a page: it is not cut, and with a number the console does not look for a terminal's."""


class _Shown(Console):
    """A console of which only its own colours are obeyed, never what stands in a text.

    A text is spelled out for a terminal that lacks its characters before it is broken into lines.
    """

    def render(self, renderable: RenderableType, options: ConsoleOptions | None = None) -> Iterator[Segment]:
        if isinstance(renderable, Text):
            plain = GLUE.join(map(spelled, renderable.plain.split(GLUE)))
            if plain != renderable.plain:
                renderable = renderable.copy()
                renderable.plain = plain
        for part in super().render(renderable, options):
            yield part if part.control else Segment(printable(part.text), part.style)


@contextmanager
def page() -> Iterator[Console]:
    """A console that prints text as it is, at a width that reads well, without blanks at line ends."""
    terminal = sys.stdout is not None and sys.stdout.isatty()
    console = _Shown(
        file=StringIO(),
        force_terminal=terminal or None,
        width=columns(),
        height=_ANY,
        markup=False,
        highlight=False,
        emoji=False,
    )
    yield console
    text = console.file.getvalue()  # type: ignore[attr-defined]  # it is the StringIO above
    with quiet_pipe():
        print("\n".join(line.rstrip() for line in text.replace(GLUE, " ").rstrip().split("\n")))


def headline(word: str, colour: str, claim: str) -> Padding:
    """The outcome as a badge, and the claim beside it; below it where too little room is left."""
    badge, told = Text(f" {word.upper()} ", style=f"bold white on {colour}"), Text(claim, style="bold")
    rows = [(badge, told)] if len(badge) <= columns() // 3 else [(badge,), (told,)]
    line = _folding(len(rows[0]), (0, 1))
    for row in rows:
        line.add_row(*row)
    return below(line)


def grid(rows: Iterable[Row], width: int = 0) -> Table:
    """Names, in a column of at least some width, and beside each its text."""
    table = _folding(2, (0, 2))
    table.columns[0].min_width = width or None
    for name, text in rows:
        table.add_row(Text(name, style="dim"), text if isinstance(text, Text) else Text(text))
    return table


def blocks(out: Console, *groups: Iterable[Row]) -> None:
    """Groups of names with their texts, one column of names for all, a blank line after each group."""
    filled = [rows for rows in map(list, groups) if rows]
    widest = max((len(name) for rows in filled for name, _ in rows), default=0)
    for rows in filled:
        out.print(below(grid(rows, widest)))


def below(table: Table) -> Padding:
    """A table with a blank line after it."""
    return Padding(table, (0, 0, 1, 0))


def small_print(*parts: str) -> Text:
    """What is assumed, in one paragraph; no line ends between a name and its number."""
    return Text("; ".join(parts).replace(" = ", f"{GLUE}={GLUE}"), style="dim")


def more_with_all(out: Console, what: str) -> None:
    """The line below a short report: what --all shows too."""
    out.print(Text(f"--all shows the rest: {what}", style="dim"))


def section(out: Console, title: str, parts: Iterable[Text | Table]) -> None:
    """A title and what belongs to it, set in; nothing where there is nothing."""
    lines = list(parts)
    if not lines:
        return
    out.print(Text(title, style="bold"))
    for part in lines:
        out.print(_hanging(part) if isinstance(part, Text) else Padding(part, (0, 0, 0, 2)))
    out.print()


def items(texts: Iterable[object], style: str = "") -> Iterator[Text]:
    """A list, line by line."""
    for text in texts:
        yield Text(f"· {text}", style=style)


def _hanging(text: Text) -> Table:
    """A line that, where it breaks, goes on under its own beginning."""
    line = _folding(3)
    mark, _, rest = text.plain.partition(" ")
    if len(mark) == 1:
        style = text.spans[0].style if text.spans else text.style
        line.add_row("  ", Text(f"{mark} ", style), Text(rest, text.style))
    else:
        line = _folding(2)
        line.add_row("  ", text)
    return line


def _folding(count: int, padding: tuple[int, int] = (0, 0)) -> Table:
    """Columns in which a word that is too long is broken, not cut."""
    table = Table.grid(padding=padding)
    for _ in range(count):
        table.add_column(overflow="fold")
    return table
