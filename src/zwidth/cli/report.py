"""The verdict as a report in the terminal.

Plain words first, then the numbers, then what to do; the small print last.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import chain
from typing import TYPE_CHECKING

from rich.padding import Padding
from rich.table import Table
from rich.text import Text

from zwidth.cli.bars import PICTURE, bar
from zwidth.cli.description import device_line, environment_line
from zwidth.cli.motion import joules, motion_lines
from zwidth.cli.output import encodes
from zwidth.cli.page import below, grid, headline, items, page, section
from zwidth.passivity.advice import Advice, in_lines
from zwidth.passivity.linear_verdict import LinearVerdict
from zwidth.passivity.outcome import TOLD
from zwidth.passivity.verdict import Verdict
from zwidth.passivity.wording import intervals
from zwidth.quantity.glossary import GLOSSARY
from zwidth.quantity.text import shown

if TYPE_CHECKING:
    from zwidth.passivity.finite_stiffness import FiniteStiffnessReplay
    from zwidth.stability.active_hand import ToleratedActivity

_LONGEST_BAR = 34


def print_verdict(
    verdict: Verdict,
    replayed: FiniteStiffnessReplay | None = None,
    active_hand: ToleratedActivity | None = None,
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
        if replayed is not None:
            section(out, "a real hand", [grid(replayed.rows())])
        if active_hand is not None:
            section(out, "an active hand", [grid(active_hand.rows())])
        if isinstance(verdict, LinearVerdict):
            section(out, *advice_section(verdict.advice, verdict.is_proved))
            section(out, "actuator", _actuator(verdict))
        beside_the_loop = intervals(verdict.scope, verdict.outcome)
        assumed = (line for line in verdict.assumptions if line != beside_the_loop)
        section(out, "assumes", items((*assumed, *verdict.demand), "dim"))


def _headline(verdict: Verdict) -> Padding:
    return headline(verdict.outcome, TOLD[verdict.outcome].terminal, _claim(verdict))


def _claim(verdict: Verdict) -> str:
    if verdict.outcome != "active":
        return verdict.claim
    if verdict.witness is None:
        return f"{verdict.claim} No motion that shows it was found short enough to be written down."
    return f"The motion below takes {joules(verdict.witness)} out of this loop, each time it is made."


def _loop(verdict: Verdict) -> Padding:
    rows: list[tuple[str, str | Text]] = [
        ("device", device_line(verdict.device)),
        ("environment", environment_line(verdict.environment, verdict.device.motion)),
    ]
    between = intervals(verdict.scope, verdict.outcome)
    if between is not None:
        rows.append(("intervals", Text(between, style="yellow")))
    return below(grid(rows))


def _numbers(verdict: Verdict) -> Padding:
    """All but the motion, which has a section of its own."""
    rows: list[tuple[str, str | Text]] = [
        (name, Text(text, style="bold" if name == "limit" else "red" if text.startswith("-") else ""))
        for name, text in verdict.rows()
        if name != "motion"
    ]
    if isinstance(verdict, LinearVerdict) and verdict.mode is not None:
        rows.append(("shows itself as", verdict.mode))
    return below(grid(rows))


def _budget(verdict: LinearVerdict, fancy: bool) -> Iterator[Table]:
    """Each leak on top of the one before, and below them what the device dissipates."""
    account, motion = verdict.budget, verdict.device.motion
    scale = max(account.hold, account.hold + account.dynamics, account.required, account.damping)
    unit = GLOSSARY["damping"].unit_for(motion)
    kept = (
        "" if verdict.decision.is_spring or verdict.scope.contact == "both sides" else "while contact lasts, "
    )
    table = _account(f"viscous, {kept}at {shown(account.frequency, 'Hz')}")
    done = 0.0
    for name in ("hold", "dynamics", "delay"):
        share = getattr(account, name)
        if abs(share) > 1e-12 * scale:
            colour = "red" if share > 0 else "cyan"
            picture = bar(done, done + share, scale, _LONGEST_BAR, fancy)
            table.add_row(name, Text(picture, style=colour), shown(share, unit))
        done += share
    _balance(table, account.required, account.damping, scale, unit, "device b", fancy)
    yield table
    if account.friction_required or account.coulomb_friction:
        yield _friction(verdict, fancy)


def _friction(verdict: LinearVerdict, fancy: bool) -> Table:
    account, unit = verdict.budget, GLOSSARY["coulomb_friction"].unit_for(verdict.device.motion)
    table = _account("Coulomb, K Δ/2 against f_c" if verdict.decision.is_spring else "Coulomb")
    need = account.friction_required
    if need is None:
        table.add_row("needed", "", "no bound is known")
    scale = max(need or 0.0, account.coulomb_friction)
    _balance(table, need, account.coulomb_friction, scale, unit, "device f_c", fancy)
    return table


def _account(title: str) -> Table:
    table = Table(box=None, padding=(0, 2, 0, 0), header_style="dim", show_header=True, pad_edge=False)
    table.add_column("", min_width=10)
    table.add_column(title, min_width=_LONGEST_BAR)
    table.add_column("", justify="left")
    return table


def _balance(
    table: Table, need: float | None, have: float, scale: float, unit: str, name: str, fancy: bool
) -> None:
    if need is not None:
        style = "red" if need > have * (1 + 1e-12) else "yellow"
        table.add_row(
            "needed", Text(bar(0, need, scale, _LONGEST_BAR, fancy), style=style), shown(need, unit)
        )
    picture = Text(bar(0, have, scale, _LONGEST_BAR, fancy), style="green")
    table.add_row(name, picture, shown(have, unit))


def advice_section(advice: Iterable[Advice], passive: bool) -> tuple[str, Iterator[Text]]:
    """The title and the lines of what to change, or of what is left."""
    title, useful, useless = in_lines(advice, passive)
    return title, chain(items(useful), items([useless] if useless else [], "dim"))


def _actuator(verdict: LinearVerdict) -> Iterator[Text]:
    for check in verdict.actuator:
        mark, style = {True: ("✓", "green"), False: ("✗", "red"), None: ("·", "dim")}[check.ok]
        yield Text.assemble((f"{mark} ", style), f"{check.name}: {check.text}")
