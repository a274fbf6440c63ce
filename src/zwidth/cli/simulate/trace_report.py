"""A simulated touch as a report in the terminal: what happened, and where every joule went."""

from __future__ import annotations

from collections.abc import Iterator
from math import isnan
from typing import TYPE_CHECKING

import numpy as np
from rich.padding import Padding
from rich.table import Table
from rich.text import Text

from zwidth.cli.page import below, blocks, grid, headline, more_with_all, page
from zwidth.loop.energy import ROUNDING, PairLedger, ledger
from zwidth.loop.trace import UNITS
from zwidth.loop.traces.measures import measure, static_stiffness, tracking_error, units_of
from zwidth.model.specification.table import plain
from zwidth.quantity.text import quantity_unit, shown

if TYPE_CHECKING:
    from zwidth.loop.trace import AnyTrace
    from zwidth.loop.traces.comparison import Comparison


_MOVING = 1e-9


_FEW = ("deepest position", "farthest position", "largest actuator force", "contacts made", "at the end")
"""Of the measures: what a short report has."""


def print_trace(
    trace: AnyTrace, in_full: bool = False, missed: str = "", hand: str = "", everywhere: bool = False
) -> None:
    """Print the report of one trace.

    `missed` says that the hand met nothing, `hand` which would suit; `everywhere` that the law acts at every
    position, so that no contact is made.
    """
    rows = [row for row in _measures(trace, everywhere) if not (missed and row[0] == "contacts made")]
    with page() as out:
        out.print(headline("missed", "yellow", missed) if missed else trace_headline(trace))
        if not in_full:
            blocks(out, [row for row in rows if row[0] in _FEW], _about(trace, hand))
            more_with_all(out, "every measure, where each joule went")
            return
        out.print(below(grid(_about(trace, hand))))
        out.print(below(grid(rows)))
        out.print(Text("energy", style="bold"))
        out.print(grid((text, shown(value, "J")) for text, value in ledger(trace).rows()))


def print_comparison(comparison: Comparison) -> None:
    """Print the numbers of several traces, a column for each."""
    with page() as out:
        table = Table.grid(padding=(0, 2))
        head, *lines = comparison.table()
        for cells in zip(head, *lines, strict=True):
            first, *others = cells
            table.add_row(
                Text(first, style="dim"), *(Text(plain(cell, 40), justify="right") for cell in others)
            )
        out.print(table)


def trace_headline(trace: AnyTrace) -> Padding:
    """Whether this hand got energy out, and what that shows."""
    book = ledger(trace)
    got, held = shown(book.got_out, "J"), book.held_at_start
    if (shaking := _shaking(trace)) is not None:
        return headline("shakes", "red", shaking)
    significant = book.got_out > ROUNDING * book.moved
    if book.active:
        there = f"the {shown(held, 'J')} that" if held else "there"
        words = f"This hand got {got} out of the loop, more than {there} was in it."
        return headline("gained", "red", words)
    if significant and book.unknown:
        words = (
            f"This hand got {got} out. That does not show whether the loop is active: how much it held at "
            f"the start is not known, for {book.unknown}."
        )
        return headline("out", "yellow", words)
    if significant:
        words = f"{got} came out, {shown(held, 'J')} were stored at the start: nothing was gained."
    else:
        words = "This hand got no energy out of the loop."
    return headline("touch", "blue", f"{words} That proves nothing of other hands: see zwidth check.")


_AS_MUCH = 0.98
"""Of the swing at first that is as much: encoder steps change it from turn to turn."""

_TURNS = 4
"""Stops and turns of what comes back and forth, and is not thrown off once."""


def _shaking(trace: AnyTrace) -> str | None:
    """What to say where nobody holds the device, and it swings no less in the end than it did at first."""
    x = trace["position"].values
    if trace["hand_force"].values.any() or trace.attrs["stops"] < _TURNS:
        return None
    first, last = (float(np.ptp(part)) for part in (x[: x.size // 4], x[-(x.size // 4) :]))
    if not 0 < _AS_MUCH * first <= last:
        return None
    unit = UNITS[str(trace.attrs["motion"])][0]
    return (
        f"Left alone it goes on: it swings {shown(first, unit)} in the first quarter of the time, "
        f"{shown(last, unit)} in the last. No hand takes part, so none got energy out."
    )


def _about(trace: AnyTrace, hand: str) -> Iterator[tuple[str, str]]:
    about = trace.attrs
    yield "device", plain(str(about["device"]), 60)
    if "transmission_force" in trace:
        yield "transmission", f"positions are of the handle, the encoder reads the {about['encoder']}"
    yield "environment", plain(str(about["environment"]), 200)
    yield "hand", plain(str(about["operator"]), 200)
    if hand:
        yield "", hand
    yield "amplifier", str(about["amplifier"])
    if about["timing"] != "regular":
        yield "clock", str(about["timing"])
    yield from how_long(trace)


def how_long(trace: AnyTrace) -> Iterator[tuple[str, str]]:
    """How long was simulated, and why no longer."""
    about = trace.attrs
    seconds = float(trace["time"].values[-1])
    count = int(trace["sampled"].values.sum()) - 1
    yield "time", f"{shown(seconds, 's')}, {count:,} samples of {shown(about['sample_period_s'], 's')}"
    if "interrupted_at_s" in about:
        yield "interrupted", f"at {shown(about['interrupted_at_s'], 's')}; what was finished is kept"
    if "diverged_at_s" in about:
        yield "diverged", f"at {shown(about['diverged_at_s'], 's')}: beyond that the numbers mean nothing"


def _measures(trace: AnyTrace, everywhere: bool) -> Iterator[tuple[str, str]]:
    motion = str(trace.attrs["motion"])
    units, values = units_of(motion), measure(trace)
    length, speed, _ = UNITS[motion]
    if everywhere:
        yield "farthest position", shown(float(np.abs(trace["position"].values).max()), length)
    else:
        yield "deepest position", shown(values["deepest_position"], length)
    yield "largest actuator force", shown(values["peak_actuator_force"], units["peak_actuator_force"])
    yield "largest force of the hand", shown(values["peak_hand_force"], units["peak_hand_force"])
    yield "chatter above 30 Hz inside", shown(values["chatter"], units["chatter"])
    if not everywhere:
        yield "contacts made", f"{values['contacts']:.0f}"
    yield "stops and turns", f"{values['stops']:.0f}"
    x, v = float(trace["position"].values[-1]), float(trace["velocity"].values[-1])
    state = "at rest" if abs(v) <= _MOVING else f"moving at {shown(v, speed)}"
    yield "at the end", f"{state}, at {shown(x, length)}"
    yield "swing in the last quarter", shown(values["last_swing"], length)


_FEW_OF_A_PAIR = ("stiffness felt at the leader", "leader and follower apart, rms")
"""Of the measures: what a short report has."""


def print_pair_trace(trace: AnyTrace, in_full: bool = False) -> None:
    book = PairLedger(trace)
    with page() as out:
        out.print(_pair_headline(book))
        if not in_full:
            blocks(
                out,
                [row for row in _measures_of_a_pair(trace) if row[0] in _FEW_OF_A_PAIR],
                _about_a_pair(trace),
            )
            more_with_all(out, "every measure, where each joule went")
            return
        out.print(below(grid(_about_a_pair(trace))))
        out.print(below(grid(_measures_of_a_pair(trace))))
        out.print(Text("energy", style="bold"))
        out.print(
            grid((text, f"{v:.6g}" if text.endswith("times") else shown(v, "J")) for text, v in book.rows())
        )


def _pair_headline(book: PairLedger) -> Padding:
    got, held = shown(book.got_out, "J"), shown(book.held_at_start, "J")
    if book.active:
        words = f"{got} came out of this pair, more than the {held} that was in it."
        return headline("gained", "red", words)
    if book.got_out > ROUNDING * book.moved:
        words = f"{got} came out, {held} were stored at the start: nothing was gained."
    else:
        words = "No energy came out of this pair."
    return headline("touch", "blue", f"{words} That proves nothing of other hands: see zwidth pair.")


def _about_a_pair(trace: AnyTrace) -> Iterator[tuple[str, str]]:
    about = trace.attrs
    yield "coupling", plain(str(about["coupling"]), 200)
    for arm in ("leader", "follower"):
        yield arm, plain(f"{about[f'{arm}_device']}; {about[f'{arm}_holder']}", 200)
        yield f"amplifier of the {arm}", str(about[f"{arm}_amplifier"])
    yield from how_long(trace)


def _measures_of_a_pair(trace: AnyTrace) -> Iterator[tuple[str, str]]:
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
