"""The verdict as a report in the terminal: the answer, what to do, what is assumed; the rest where asked for.

Whatever narrows the claim is in the short report too.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from math import inf
from types import MappingProxyType
from typing import TYPE_CHECKING

from rich.padding import Padding
from rich.table import Table
from rich.text import Text

from zwidth.cli.decision import hand_rows
from zwidth.cli.loop_lines import advice_rows, advice_section, device_line, environment_line
from zwidth.cli.output import encodes
from zwidth.cli.page import (
    PICTURE,
    Row,
    bar,
    below,
    blocks,
    claimed,
    grid,
    items,
    more_with_all,
    motion_in_short,
    motion_lines,
    page,
    section,
    small_print,
)
from zwidth.passivity.linear_verdict import LinearVerdict
from zwidth.passivity.verdict import Verdict
from zwidth.passivity.wording import in_short, intervals
from zwidth.quantity.glossary import GLOSSARY
from zwidth.quantity.text import shown

if TYPE_CHECKING:
    from rich.console import Console

    from zwidth.passivity.finite_stiffness import FiniteStiffnessReplay
    from zwidth.passivity.interval_devices import OverRanges
    from zwidth.passivity.stability import Stability
    from zwidth.passivity.stability.active_hand import ToleratedActivity


_FIRST = ("limit", "largest passive gain")
"""Of the numbers: what a short report has; how stiff it may be stands in what to change."""

_SLOW = "slower hands are safe up to"


def print_verdict(
    verdict: Verdict,
    replayed: FiniteStiffnessReplay | None = None,
    active_hand: ToleratedActivity | None = None,
    in_full: bool = False,
    ranges: OverRanges | None = None,
    hands: Mapping[str, Stability] = MappingProxyType({}),
) -> None:
    """Print the report on standard output, with what was asked for of real, known and active hands.

    `ranges` is what holds over the ranges of a device of the catalogue.
    """
    with page() as out:
        out.print(claimed(verdict.outcome, verdict.claim))
        if ranges is not None:
            blocks(out, _over(ranges, in_full))
        (_all if in_full else _few)(out, verdict, ranges is not None)
        if replayed is not None:
            section(out, "a real hand", [grid(replayed.rows())])
        if hands:
            section(out, "hands that are known", [grid(hand_rows(hands))])
        if active_hand is not None:
            section(out, "an active hand", [grid(active_hand.rows())])
        if not in_full:
            more_with_all(out, "numbers, budget, motion, actuator, assumptions in full")


def _over(ranges: OverRanges, in_full: bool) -> Iterator[Row]:
    """What holds for every device in the ranges; in full with why each is stated."""
    for name, text in ranges.rows():
        yield name, Text(text, style="yellow" if name == "ranges" else "")
    if in_full:
        for text in ranges.why():
            yield "", text


def _few(out: Console, verdict: Verdict, over_ranges: bool) -> None:
    """What binds and what to change; the loop, and what is assumed of it."""
    of_the_loop = (*_loop(verdict, over_ranges), *_not_ideal(verdict), ("assumes", _assumed(verdict)))
    blocks(out, _to_do(verdict), of_the_loop)


def _to_do(verdict: Verdict) -> Iterator[Row]:
    yield from advice_rows(verdict.advice, verdict.is_proved, verdict.claim)
    rows = dict(verdict.rows())
    first = [rows[name] if name == "limit" else f"{name}: {rows[name]}" for name in _FIRST if name in rows]
    if first:
        yield "limit", "; ".join(first)
    if verdict.witness is not None:
        yield "the motion", motion_in_short(verdict.witness)
    if verdict.is_beyond_actuator:
        yield "but", Text("; ".join(verdict.demand), style="yellow")
    if _SLOW in rows:
        yield "slow hands", f"{_SLOW.removeprefix('slower hands ')} {rows[_SLOW]}"


def _not_ideal(verdict: Verdict) -> Iterator[Row]:
    """Checks that the actuator fails, by name: the claim takes it for ideal."""
    if isinstance(verdict, LinearVerdict):
        failed = [check.name for check in verdict.actuator if check.ok is False]
        if failed:
            yield "actuator", Text(f"not as ideal as is assumed: {', '.join(failed)}", style="yellow")


def _assumed(verdict: Verdict) -> Text:
    demand = () if verdict.is_beyond_actuator else verdict.demand
    return small_print(in_short(verdict.scope, verdict.outcome), *demand)


def _all(out: Console, verdict: Verdict, over_ranges: bool) -> None:
    fancy = encodes(PICTURE)
    out.print(below(grid(_loop(verdict, over_ranges))))
    out.print(_numbers(verdict))
    if isinstance(verdict, LinearVerdict):
        section(out, "budget", budget_bars(verdict, fancy))
    if verdict.witness is not None:
        section(out, "the motion", motion_lines(verdict.witness, fancy))
    section(out, *advice_section(verdict.advice, verdict.is_proved))
    if isinstance(verdict, LinearVerdict):
        section(out, "actuator", _actuator(verdict))
    beside_the_loop = intervals(verdict.scope, verdict.outcome)
    assumed = (line for line in verdict.assumptions if line != beside_the_loop)
    section(out, "assumes", items((*assumed, *verdict.demand), "dim"))


def _loop(verdict: Verdict, over_ranges: bool) -> Iterator[Row]:
    """The loop, at the worst corner of its intervals, which are told already where they are stated ranges."""
    yield "device", device_line(verdict.device)
    yield "environment", environment_line(verdict.environment, verdict.device.motion)
    between = intervals(verdict.scope, verdict.outcome)
    if between is not None and not over_ranges:
        yield "intervals", Text(between, style="yellow")


def _numbers(verdict: Verdict) -> Padding:
    rows: list[tuple[str, str | Text]] = [
        (name, Text(text, style="bold" if name == "limit" else "red" if text.startswith("-") else ""))
        for name, text in verdict.rows()
        if name != "motion"
    ]
    if isinstance(verdict, LinearVerdict) and verdict.mode is not None:
        rows.append(("shows itself as", verdict.mode))
    return below(grid(rows))


def _actuator(verdict: LinearVerdict) -> Iterator[Text]:
    for check in verdict.actuator:
        mark, style = {True: ("✓", "green"), False: ("✗", "red"), None: ("·", "dim")}[check.ok]
        yield Text.assemble((f"{mark} ", style), f"{check.name}: {check.text}")


_LONGEST_BAR = 34


def budget_bars(verdict: LinearVerdict, fancy: bool) -> Iterator[Table]:
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
    if need is None:
        table.add_row("needed", "", "no bound is known")
    else:
        style = "red" if need > have * (1 + 1e-12) else "yellow"
        enough = shown(need, unit) if need < inf else "no amount is enough"
        table.add_row("needed", Text(bar(0, need, scale, _LONGEST_BAR, fancy), style=style), enough)
    picture = Text(bar(0, have, scale, _LONGEST_BAR, fancy), style="green")
    table.add_row(name, picture, shown(have, unit))
