"""The verdict as a report in the terminal.

Plain words first, then the numbers, then what to do; the small print last.
Everything a person typed is printed as text, never read as markup.
"""

from __future__ import annotations

import sys
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from io import StringIO
from typing import TYPE_CHECKING

from rich.console import Console, ConsoleOptions, RenderableType
from rich.padding import Padding
from rich.segment import Segment
from rich.table import Table
from rich.text import Text

from zwidth.cli.bars import PICTURE, bar
from zwidth.cli.description import GLUE, device_line, environment_line
from zwidth.cli.motion import joules, motion_lines
from zwidth.cli.output import encodes, quiet_pipe
from zwidth.passivity.advice import Advice
from zwidth.passivity.linear_verdict import LinearVerdict
from zwidth.passivity.outcome import TOLD
from zwidth.passivity.verdict import Verdict
from zwidth.passivity.wording import intervals
from zwidth.quantity.glossary import GLOSSARY
from zwidth.quantity.text import shown
from zwidth.showing import printable

if TYPE_CHECKING:
    from zwidth.coupled_stability.active_hand import ToleratedActivity
    from zwidth.passivity.real_hand import RealHand

_WIDEST = 100
_LONGEST_BAR = 34
_ORDER = (
    "stiffness", "virtual_damping", "velocity_filter", "time_constant", "rate", "delay", "damping",
    "resolution", "coulomb_friction",
)  # fmt: skip
"""What is changed most easily comes first: the law, then the loop, then the machine."""


class _Shown(Console):
    """A console of which only its own colours are obeyed, never what stands in a text."""

    def render(self, renderable: RenderableType, options: ConsoleOptions | None = None) -> Iterator[Segment]:
        for part in super().render(renderable, options):
            yield part if part.control else Segment(printable(part.text), part.style)


@contextmanager
def page() -> Iterator[Console]:
    """A console that prints text as it is, at a width that reads well, without blanks at line ends."""
    terminal = sys.stdout is not None and sys.stdout.isatty()
    console = _Shown(
        file=StringIO(), force_terminal=terminal or None, markup=False, highlight=False, emoji=False
    )
    console.width = min(console.width, _WIDEST)
    yield console
    text = console.file.getvalue()  # type: ignore[attr-defined]  # it is the StringIO above
    with quiet_pipe():
        print("\n".join(line.rstrip() for line in text.replace(GLUE, " ").rstrip().split("\n")))


def print_verdict(
    verdict: Verdict, real_hand: RealHand | None = None, active_hand: ToleratedActivity | None = None
) -> None:
    """Print the report on standard output, with what was asked for of real and of active hands."""
    fancy = encodes(PICTURE)
    with page() as out:
        out.print(_headline(verdict))
        out.print(_loop(verdict))
        out.print(_numbers(verdict))
        if isinstance(verdict, LinearVerdict):
            section(out, "budget", _budget(verdict, fancy))
        if verdict.witness is not None:
            section(out, "the motion", motion_lines(verdict.witness, fancy))
        if real_hand is not None:
            section(out, "a real hand", _table(real_hand.rows()))
        if active_hand is not None:
            section(out, "an active hand", _table(active_hand.rows()))
        if isinstance(verdict, LinearVerdict):
            section(out, *_advice(verdict))
            section(out, "actuator", _actuator(verdict))
        beside_the_loop = intervals(verdict.scope, verdict.outcome)
        assumed = (line for line in verdict.assumptions if line != beside_the_loop)
        section(out, "assumes", assumption_lines((*assumed, *verdict.demand)))


def _table(rows: Iterable[tuple[str, str]]) -> Iterator[Table]:
    grid = Table.grid(padding=(0, 2))
    for name, text in rows:
        grid.add_row(Text(name, style="dim"), Text(text))
    yield grid


def _headline(verdict: Verdict) -> Padding:
    colour = TOLD[verdict.outcome].terminal
    grid = Table.grid(padding=(0, 1))
    badge = Text(f" {verdict.outcome.upper()} ", style=f"bold white on {colour}")
    grid.add_row(badge, Text(_claim(verdict), style="bold"))
    return _spaced(grid)


def _claim(verdict: Verdict) -> str:
    if verdict.outcome != "active":
        return verdict.claim
    if verdict.witness is None:
        return f"{verdict.claim} No motion that shows it was found short enough to be written down."
    return f"The motion below takes {joules(verdict.witness)} out of this loop, each time it is made."


def _loop(verdict: Verdict) -> Padding:
    grid = Table.grid(padding=(0, 2))
    motion = verdict.device.motion
    grid.add_row(Text("device", style="dim"), Text(device_line(verdict.device)))
    grid.add_row(Text("environment", style="dim"), Text(environment_line(verdict.environment, motion)))
    between = intervals(verdict.scope, verdict.outcome)
    if between is not None:
        grid.add_row(Text("intervals", style="dim"), Text(between, style="yellow"))
    return _spaced(grid)


def _numbers(verdict: Verdict) -> Padding:
    grid = Table.grid(padding=(0, 2))
    for name, text in verdict.rows():
        if name == "motion":
            continue  # it has a section of its own
        style = "bold" if name == "limit" else "red" if text.startswith("-") else ""
        grid.add_row(Text(_spelled(name), style="dim"), Text(text, style=style))
    if isinstance(verdict, LinearVerdict) and verdict.mode is not None:
        grid.add_row(Text("shows itself as", style="dim"), Text(verdict.mode))
    return _spaced(grid)


def _budget(verdict: LinearVerdict, fancy: bool) -> Iterator[Table]:
    """Each leak on top of the one before, and below them what the device dissipates."""
    account, motion = verdict.budget, verdict.device.motion
    scale = max(account.hold, account.hold + account.dynamics, account.required, account.damping)
    unit = GLOSSARY["damping"].unit_for(motion)
    kept = (
        "" if verdict.decision.is_spring or verdict.scope.contact == "both sides" else "while contact lasts, "
    )
    grid = _account(f"viscous, {kept}at {shown(account.frequency, 'Hz')}")
    done = 0.0
    for name in ("hold", "dynamics", "delay"):
        share = getattr(account, name)
        if abs(share) > 1e-12 * scale:
            colour = "red" if share > 0 else "cyan"
            picture = bar(done, done + share, scale, _LONGEST_BAR, fancy)
            grid.add_row(name, Text(picture, style=colour), shown(share, unit))
        done += share
    _balance(grid, account.required, account.damping, scale, unit, "device b", fancy)
    yield grid
    if account.friction_required or account.coulomb_friction:
        yield _friction(verdict, fancy)


def _friction(verdict: LinearVerdict, fancy: bool) -> Table:
    account, unit = verdict.budget, GLOSSARY["coulomb_friction"].unit_for(verdict.device.motion)
    grid = _account("Coulomb, K Δ/2 against f_c" if verdict.decision.is_spring else "Coulomb")
    need = account.friction_required
    if need is None:
        grid.add_row("needed", "", "no bound is known")
    scale = max(need or 0.0, account.coulomb_friction)
    _balance(grid, need, account.coulomb_friction, scale, unit, "device f_c", fancy)
    return grid


def _account(title: str) -> Table:
    grid = Table(box=None, padding=(0, 2, 0, 0), header_style="dim", show_header=True, pad_edge=False)
    grid.add_column("", min_width=10)
    grid.add_column(title, min_width=_LONGEST_BAR)
    grid.add_column("", justify="left")
    return grid


def _balance(
    grid: Table, need: float | None, have: float, scale: float, unit: str, name: str, fancy: bool
) -> None:
    if need is not None:
        style = "red" if need > have * (1 + 1e-12) else "yellow"
        grid.add_row("needed", Text(bar(0, need, scale, _LONGEST_BAR, fancy), style=style), shown(need, unit))
    picture = Text(bar(0, have, scale, _LONGEST_BAR, fancy), style="green")
    grid.add_row(name, picture, shown(have, unit))


def _advice(verdict: LinearVerdict) -> tuple[str, Iterator[Text]]:
    title = "slack" if verdict.is_proved else "what to change, any one of"
    return title, _advice_lines(verdict.advice)


def _advice_lines(advice: Iterable[Advice]) -> Iterator[Text]:
    ordered = sorted(advice, key=lambda a: _ORDER.index(a.parameter) if a.parameter in _ORDER else 99)
    useless = [a for a in ordered if a.to is None and a.current != 0]
    at_limit = [a for a in ordered if a.kind == "slack" and a.to is not None and a.to == a.current]
    for item in ordered:
        if item.to is not None and item not in at_limit:
            yield _item(item.text)
    if at_limit:
        yield _item(f"exactly at the limit: {_names(at_limit)}")
    if useless:
        slack = useless[0].kind == "slack"
        yield _item(f"{'no slack' if slack else 'no change alone would do'}: {_names(useless)}", "dim")


def _names(advice: Iterable[Advice]) -> str:
    return ", ".join(_spelled(a.parameter) for a in advice)


def _spelled(name: str) -> str:
    """A parameter's key as words."""
    return _named(name.replace("_", " "))


def _named(text: str) -> str:
    """Coulomb is a name."""
    return text.replace("coulomb", "Coulomb")


def _actuator(verdict: LinearVerdict) -> Iterator[Text]:
    for check in verdict.actuator:
        mark, style = {True: ("✓", "green"), False: ("✗", "red"), None: ("·", "dim")}[check.ok]
        yield Text.assemble((f"{mark} ", style), f"{check.name}: {check.text}")


def assumption_lines(assumptions: Iterable[str]) -> Iterator[Text]:
    """What is taken for granted, line by line."""
    for line in assumptions:
        yield _item(line, "dim")


def _item(text: str, style: str = "") -> Text:
    return Text(f"· {_named(text)}", style=style)


def section(out: Console, title: str, parts: Iterable[Text | Table]) -> None:
    """A title and what belongs to it, set in; nothing where there is nothing."""
    lines = list(parts)
    if not lines:
        return
    out.print(Text(title, style="bold"))
    for part in lines:
        out.print(_hanging(part) if isinstance(part, Text) else Padding(part, (0, 0, 0, 2)))
    out.print()


def _hanging(text: Text) -> Table:
    """A line that, where it breaks, goes on under its own beginning."""
    grid = Table.grid()
    mark, _, rest = text.plain.partition(" ")
    if len(mark) == 1:
        grid.add_row(
            "  ", Text(f"{mark} ", text.spans[0].style if text.spans else text.style), Text(rest, text.style)
        )
    else:
        grid.add_row("  ", text)
    return grid


def _spaced(grid: Table) -> Padding:
    return Padding(grid, (0, 0, 1, 0))
