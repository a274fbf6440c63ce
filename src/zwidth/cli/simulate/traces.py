"""The command `traces`: saved touches beside each other."""

from __future__ import annotations

import argparse
import json
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from zwidth.cli.output import PICTURES, print_json, say_written, target
from zwidth.cli.simulate.simulate import ANGLES
from zwidth.errors import InputError
from zwidth.quantity.spoken import note

if TYPE_CHECKING:
    import xarray as xr


OPTIONS = (
    {
        "files=FILE+": "traces that zwidth simulate saved",
        "--json": "print JSON, units in the keys",
        "--plot FILE": "save a plot of all: .png, .svg or .pdf",
        "--force": "replace a file that exists",
    },
)


def run(arguments: argparse.Namespace) -> int:
    """`zwidth traces`: the numbers of saved traces beside each other."""
    plot = target("--plot", arguments.plot, PICTURES, arguments.force)
    from zwidth.loop.traces import compare_traces, load_trace

    comparison = compare_traces(dict(_labelled(arguments.files, load_trace)))
    if plot is not None:
        comparison.plot(plot)
    if arguments.json:
        print_json(json.dumps(comparison.to_dict(), indent=2, ensure_ascii=False))
    else:
        from zwidth.cli.simulate.trace_report import print_comparison

        print_comparison(comparison)
        say_written(plot)
    return 0


def _labelled(files: list[str], load: Any) -> Iterator[tuple[str, xr.Dataset]]:
    seen: set[str] = set()
    for name in files:
        if name in seen:
            raise InputError(f"{name} is given twice")
        seen.add(name)
        trace = load(name)
        note(str(trace.attrs.get(ANGLES, "")))
        yield name, trace
