"""The gains of two arms as a report in the terminal, joint by joint."""

from __future__ import annotations

from collections.abc import Iterable

from rich.table import Table as Lines
from rich.text import Text

from zwidth.cli.page import claimed, items, more_with_all, page, section
from zwidth.cli.pair.pair_report import print_pair
from zwidth.data.gains import ArmGains, Controllers, GainsVerdict, HeldJoints, PassiveGains
from zwidth.passivity.pairs import PairVerdict
from zwidth.passivity.pairs.in_short import pair_in_short
from zwidth.passivity.scope import TOLD
from zwidth.quantity.text import shown
from zwidth.showing import Table, typed


def print_gains(verdict: GainsVerdict, in_full: bool = False) -> None:
    decided, better = verdict.tables()
    with page() as out:
        out.print(claimed(verdict.outcome, verdict.claim))
        section(out, f"{verdict.gains.published.title}: {decided.caption}", [_set(decided)])
        section(
            out, "what is passive, each proved: with the kd of the file, and with the best", [_set(better)]
        )
        section(out, "assumes", items(verdict.notes if in_full else _in_short(verdict), "dim"))
        if not in_full:
            more_with_all(out, "what is assumed of two arms in full")


def _in_short(verdict: GainsVerdict) -> list[str]:
    """What is known of the gains as it stands, and of every two arms in a few words."""
    of_two_arms = {line for joint in verdict.joints for line in joint.verdict.small_print()}
    own = [note for note in verdict.notes if note not in of_two_arms]
    return [*own, *dict.fromkeys(pair_in_short(joint.verdict) for joint in verdict.joints)]


def print_joint(verdict: PairVerdict, notes: Iterable[str], in_full: bool = False) -> None:
    """Print the verdict on one joint, and what its gains are."""
    print_pair(verdict, in_full)
    said = set(verdict.small_print())
    with page() as out:
        section(out, "\nof the gains", items((note for note in notes if note not in said), "dim"))


def print_held(found: HeldJoints, better: PassiveGains | None = None) -> None:
    """Print the verdicts on the joints of one arm, and the gains that were written."""
    parts = list(found.report())
    with page() as out:
        out.print(claimed(found.outcome, found.claim))
        section(out, "joint by joint", [_set(part) for part in parts if isinstance(part, Table)])
        if better is not None:
            share = f"{shown(better.share, '%', 6)} of b"
            section(out, f"written, each proved with {share}", [_set(_written(better))])
        section(out, "assumes", items(found.notes, "dim"))


def _written(better: PassiveGains) -> Table:
    """p, i and d of each joint, and of the file where they were others."""
    heads = [["joint", "p", "i", "d", ""], ["", "N·m/rad", "N·m/(rad·s)", "N·m·s/rad", ""]]
    rows = []
    for old, new in better.changed:
        numbers = [f"{float(v):g}" for v in (new.stiffness, new.integral, new.damping)]
        same = (old.stiffness, old.integral, old.damping) == (new.stiffness, new.integral, new.damping)
        rows.append([new.name, *numbers, "as it was" if same else "changed"])
    return Table(rows=rows, heads=heads, lefts=1)


def print_cartesian(controllers: Controllers, path: str) -> None:
    """Print impedances at the end, and the command that decides them."""
    with page() as out:
        out.print(claimed("undecided", "An impedance at the end of the arm: it takes the arm to decide it."))
        for one in controllers.cartesian:
            rows = [
                [name, f"{k:g}", f"{d:.4g}"]
                for name, k, d in zip(_COORDINATES, one.stiffness, one.damping, strict=True)
            ]
            heads = [["", "K", "D"], ["", "N/m, N·m/rad", "N·s/m, N·m·s/rad"]]
            section(out, one.source, [_set(Table(rows=rows, heads=heads, lefts=1))])
            section(out, "of it", items(one.notes(3), "dim"))
        if controllers.notes:
            section(out, "of the file", items(controllers.notes, "dim"))
        one = controllers.cartesian[0]
        rate = one.rate or controllers.rate
        often = f' --rate "{shown(rate, "Hz", 6)}"' if rate is not None else ""
        ask = f"zwidth workspace ARM.urdf --pose --wall {typed(path)}{often}"
        lines = [f"{ask} --postures 20000{'' if one.of_task else ' -o passive.yaml'}"]
        if one.nullspace:
            lines.append(f'{ask} --null-stiffness wall --within "2 deg"')
        section(out, "next", [Text(line) for line in lines])


_COORDINATES = ("x", "y", "z", "about x", "about y", "about z")


def print_follower(gains: ArmGains) -> None:
    """Print the gains of arms without a law of both."""
    parts = list(gains.report())
    with page() as out:
        claim = "The leader feels nothing: these gains make no pair. --both asks of them on both sides."
        out.print(claimed("undecided", claim))
        section(out, str(parts[0]), [_set(part) for part in parts if isinstance(part, Table)])
        section(out, "what they are", items(gains.notes, "dim"))


def _set(table: Table) -> Lines:
    """Columns, those of numbers set right."""
    lines = Lines.grid(padding=(0, 2))
    for place in range(len(table.rows[0])):
        lines.add_column(justify="left" if place < (table.lefts or 0) else "right", no_wrap=True)
    for head in table.heads:
        lines.add_row(*(Text(cell, "dim") for cell in head))
    for cells in table.rows:
        lines.add_row(*(Text(cell, TOLD[cell].terminal if cell in TOLD else "") for cell in cells))
    return lines
