"""Two simulated arms as a report in the terminal: what happened, and where every joule went."""

from __future__ import annotations

from collections.abc import Iterator
from math import isnan
from typing import TYPE_CHECKING

import numpy as np
from rich.padding import Padding
from rich.text import Text

from zwidth.cli.page import below, blocks, grid, headline, more_with_all, page
from zwidth.cli.trace_report import how_long
from zwidth.loop.energy import PairLedger
from zwidth.loop.energy.ledger import ROUNDING
from zwidth.loop.trace import UNITS
from zwidth.loop.traces.scores import static_stiffness, tracking_error
from zwidth.model.specification.table import plain
from zwidth.quantity.text import quantity_unit, shown

if TYPE_CHECKING:
    from zwidth.loop.trace import AnyTrace


_FEW = ("stiffness felt at the leader", "leader and follower apart, rms")
"""Of the measures: what a short report has."""


def print_pair_trace(trace: AnyTrace, in_full: bool = False) -> None:
    """Print the report of one trace of a pair."""
    book = PairLedger(trace)
    with page() as out:
        out.print(_headline(book))
        if not in_full:
            blocks(out, [row for row in _measures(trace) if row[0] in _FEW], _about(trace))
            more_with_all(out, "every measure, where each joule went")
            return
        out.print(below(grid(_about(trace))))
        out.print(below(grid(_measures(trace))))
        out.print(Text("energy", style="bold"))
        out.print(grid(_energies(book)))


def _headline(book: PairLedger) -> Padding:
    got, held = shown(book.got_out, "J"), shown(book.held_at_start, "J")
    if book.active:
        words = f"{got} came out of this pair, more than the {held} that was in it."
        return headline("active", "red", words)
    if book.got_out > ROUNDING * book.moved:
        words = f"{got} came out, {held} were stored at the start: nothing was gained."
    else:
        words = "No energy came out of this pair."
    return headline("touch", "blue", f"{words} That proves nothing of other hands: see zwidth pair.")


def _energies(book: PairLedger) -> Iterator[tuple[str, str]]:
    for text, value in book.rows():
        yield text, f"{value:.6g}" if text.endswith("times") else shown(value, "J")


def _about(trace: AnyTrace) -> Iterator[tuple[str, str]]:
    about = trace.attrs
    yield "coupling", plain(str(about["coupling"]), 200)
    for arm in ("leader", "follower"):
        yield arm, plain(f"{about[f'{arm}_device']}; {about[f'{arm}_holder']}", 200)
        yield f"amplifier of the {arm}", str(about[f"{arm}_amplifier"])
    yield from how_long(trace)


def _measures(trace: AnyTrace) -> Iterator[tuple[str, str]]:
    motion = str(trace.attrs["motion"])
    length, _, force = UNITS[motion]
    felt = static_stiffness(trace.sel(arm="leader"))
    if not isnan(felt):
        yield "stiffness felt at the leader", shown(felt, quantity_unit("stiffness", motion))
    yield "leader and follower apart, rms", shown(tracking_error(trace), length)
    for arm in ("leader", "follower"):
        part = trace.sel(arm=arm)
        yield f"the {arm} moved over", shown(float(np.ptp(part["position"].values)), length)
        yield (
            f"largest actuator force of the {arm}",
            shown(float(np.abs(part["actuator_force"].values).max()), force),
        )
