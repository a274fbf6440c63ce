"""What every report in the terminal is made of: a headline, names with their texts, sections.

Everything a person typed is printed as text, never read as markup.
"""

from __future__ import annotations

import sys
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from io import StringIO
from math import inf, isfinite
from typing import TYPE_CHECKING

from rich.console import Console, ConsoleOptions, RenderableType
from rich.padding import Padding
from rich.segment import Segment
from rich.table import Table
from rich.text import Text

from zwidth.cli.output import GLUE, columns, quiet_pipe, spelled
from zwidth.cli.parsing import command_lines
from zwidth.quantity.text import shown
from zwidth.showing import printable

if TYPE_CHECKING:
    from zwidth.passivity.outcome_evidence import Moves

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


def claimed(outcome: str, claim: str) -> Padding:
    """The same of an answer about passivity, in the colour of its outcome."""
    from zwidth.passivity.scope import TOLD  # loaded by now

    return headline(outcome, TOLD[outcome].terminal, claim)


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
        if isinstance(part, Text) and _is_command(part):  # no word of it in two, or a shell cannot read it
            typed = "\n".join(f"  {line}" for line in command_lines(part.plain, columns() - 2))
            out.print(Text(typed, part.style), soft_wrap=True)
        else:
            out.print(_hanging(part) if isinstance(part, Text) else Padding(part, (0, 0, 0, 2)))
    out.print()


def items(texts: Iterable[object], style: str = "") -> Iterator[Text]:
    for text in texts:
        yield Text(f"· {text}", style=style)


def _is_command(text: Text) -> bool:
    return text.plain.startswith("zwidth ") or text.plain[1:].startswith(" zwidth ")


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


_EIGHTHS = " ▏▎▍▌▋▊▉█"
_LEVELS = "▁▂▃▄▅▆▇█"
_ASCII_LEVELS = "_.-=+*%#"

PICTURE = _EIGHTHS + _LEVELS
"""Every character that the Unicode form uses."""


def bar(start: float, end: float, scale: float, width: int, fancy: bool) -> str:
    """A bar from `start` to `end` on an axis from 0 to `scale`, `width` cells long."""
    low, high = sorted((_cells(start, scale, width), _cells(end, scale, width)))
    if high - low <= 0:
        return ""
    first = int(low)
    if not fancy:
        return " " * first + "#" * max(1, round(high) - first)
    whole, part = divmod(high - first, 1)
    tail = _EIGHTHS[round(8 * part)].strip()
    return " " * first + "█" * int(whole) + (tail or ("" if whole else _EIGHTHS[1]))


def _cells(value: float, scale: float, width: int) -> float:
    if not scale or not isfinite(value):
        return float(width) if value == inf else 0.0
    return min(max(value / scale, 0.0), 1.0) * width


def levels(values: Sequence[float], fancy: bool) -> str:
    """Each value as a character of its height, the smallest to the largest."""
    marks = _LEVELS if fancy else _ASCII_LEVELS
    low, high = min(values), max(values)
    span = (high - low) or 1.0
    return "".join(marks[round((v - low) / span * (len(marks) - 1))] for v in values)


_SAMPLES_SHOWN = 48


def _said_of_a_replay(witness: Moves) -> str:
    from zwidth.passivity.result import Evidence  # loaded by now

    checked = isinstance(witness, Evidence)
    return "" if checked else ", replayed in the simulator, not checked by the independent checker"


def motion_in_short(witness: Moves) -> str:
    """How long, how deep and how fast it is; what it takes where the claim does not say it."""
    from zwidth.passivity.wording import size  # loaded by now

    replayed = _said_of_a_replay(witness)
    replayed = replayed and f", takes {shown(witness.energy, 'J')} out{replayed}"
    return (
        f"{witness.motion.samples:.6g} samples in "
        f"{shown(witness.motion.samples * witness.sample_period, 's')}, "
        f"{size(witness.depth, witness.peak_speed, witness.unit)}{replayed}"
    )


def motion_lines(witness: Moves, fancy: bool) -> Iterator[Text]:
    yield Text(motion_in_short(witness).partition(", takes")[0])
    for part in witness.motion.repeats:
        if part.times > 1:
            yield Text(f"samples {part.first} to {part.last} are a cycle, done {part.times:.6g} times")
    is_cycle = witness.motion.rounds > 1 and len(witness.motion.repeats) == 1
    each = f" ({shown(witness.energy_per_cycle, 'J')} per cycle)" if is_cycle else ""
    yield Text(f"extracts {shown(witness.energy, 'J')}{each}{_said_of_a_replay(witness)}", style="bold")
    first = witness.positions[:_SAMPLES_SHOWN]
    more = " …" if len(witness.positions) > len(first) else ""
    yield Text(f"x(kT)  {levels(first, fancy)}{more}", style="cyan")
