"""The command `devices`: the catalogue as a table and as JSON."""

from __future__ import annotations

import argparse
import json
from collections.abc import Sequence
from typing import Any

from rich.table import Table
from rich.text import Text

from zwidth.cli.output import print_json
from zwidth.cli.page import page
from zwidth.model.device import catalogue
from zwidth.model.device.catalogue import Datum, Entry, Range
from zwidth.quantity.glossary import unit_suffix
from zwidth.quantity.text import in_words, shown

OPTIONS = ({"name=NAME?": "only this device, with every value", "--json": "print JSON, units in the keys"},)


def run(arguments: argparse.Namespace) -> int:
    """`zwidth devices`: 0."""
    names = catalogue.names() if arguments.name is None else (arguments.name,)
    entries = [catalogue.entry(name) for name in names]
    if arguments.json:
        print_json(json.dumps({e.name: _document(e) for e in entries}, indent=2, ensure_ascii=False))
    else:
        print_entries(entries, in_full=arguments.name is not None)
    return 0


def print_entries(entries: Sequence[Entry], in_full: bool) -> None:
    """Print devices; in full every unknown value has a row, otherwise they share one line."""
    with page() as out:
        for entry in entries:
            out.print(Text.assemble((entry.name, "bold"), "  ", (entry.title, "dim")))
            if entry.note:
                out.print(Text(f"  {entry.note}", style="italic"))
            out.print(_table(entry, in_full))
            if in_full and entry.ranges:
                out.print(Text("\nstated, not measured", style="bold"))
                out.print(_ranges(entry))
            out.print()
        if not in_full:
            out.print(
                Text(
                    "zwidth check NAME takes any of them: what is unknown within its stated range, where it "
                    "has one; else give it yourself.",
                    style="dim",
                )
            )


def _table(entry: Entry, in_full: bool) -> Table:
    grid = Table.grid(padding=(0, 2))
    grid.add_column(width=0)
    grid.add_column(min_width=22, no_wrap=True)
    grid.add_column(min_width=12, no_wrap=True)
    grid.add_column(style="dim")
    unknown = []
    for key, datum in entry.values.items():
        name = in_words(entry.key(key))
        if datum.value is not None:
            grid.add_row("", name, Text(shown(datum.value, datum.unit, 7)), Text(datum.source))
        elif in_full:
            grid.add_row("", name, Text("unknown", style="yellow"), Text("no source found"))
        elif key not in entry.ranges:
            unknown.append(name)
    if entry.ranges and not in_full:
        within = ", ".join(f"{in_words(k)} {shown(r.interval, r.unit)}" for k, r in entry.ranges.items())
        grid.add_row("", "taken within", "", Text(within))
    if unknown:
        grid.add_row("", Text("unknown", style="yellow"), "", Text(", ".join(unknown)))
    return grid


def _ranges(entry: Entry) -> Table:
    grid = Table.grid(padding=(0, 2))
    grid.add_column(width=0)
    grid.add_column(min_width=16)
    grid.add_column(min_width=12)
    grid.add_column(style="dim")
    for key, own in entry.ranges.items():
        grid.add_row("", in_words(key), Text(shown(own.interval, own.unit)), Text(own.why))
    return grid


def _document(entry: Entry) -> dict[str, Any]:
    """Each value has its unit in its key, null where no source gives one."""
    values = {
        _key(key, datum): {"value": datum.value, "source": datum.source}
        for key, datum in entry.values.items()
    }
    ranges = {
        _key(key, own): {"low": own.low, "high": own.high, "why": own.why}
        for key, own in entry.ranges.items()
    }
    about = {"title": entry.title, "note": entry.note, "motion": entry.motion}
    return {**about, "values": values, "ranges": ranges}


def _key(key: str, datum: Datum | Range) -> str:
    return key if datum.unit in ("", "1") else f"{key}_{unit_suffix(datum.unit)}"
