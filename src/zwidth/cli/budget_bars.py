"""Where the damping of a device goes, as bars: each leak on top of the one before, against what there is."""

from __future__ import annotations

from collections.abc import Iterator

from rich.table import Table
from rich.text import Text

from zwidth.cli.bars import bar
from zwidth.passivity.linear_verdict import LinearVerdict
from zwidth.quantity.glossary import GLOSSARY
from zwidth.quantity.text import shown

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
