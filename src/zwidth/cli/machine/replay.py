"""`zwidth replay`: what a recording of a served loop holds, and whether its law gives those forces again."""

from __future__ import annotations

import argparse
import json
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

from zwidth.cli.options import output
from zwidth.cli.output import print_json, print_report, print_text, say_written, targets
from zwidth.errors import InputError

if TYPE_CHECKING:
    from zwidth.machine.servo.recording import Recording

_SAVED = ".nc"


USAGE = "RECORDING [--json] [--plot FILE] [-o FILE] [--force]"
OPTIONS = (
    {"recording=RECORDING": "a .mcap file of zwidth serve, whole or cut off"},
    "output",
    output("what is in it", "position, force and lateness", "the columns with their units as NetCDF: .nc"),
)


def run(arguments: argparse.Namespace) -> int:
    """`zwidth replay`: 0, or 1 where a law gives other forces than were given."""
    from zwidth.machine.servo.recording import read_recording

    plot, save = targets(arguments.plot, arguments.save, arguments.force)
    if save is not None and save.suffix.lower() != _SAVED:
        raise InputError(f"--save: the file must end in {_SAVED}, got {str(save)!r}")
    recording = read_recording(arguments.recording)
    laws = list(_replayed(recording))
    _write(recording, plot, save)
    if arguments.json:
        print_json(json.dumps({**recording.to_dict(), "replays": laws}, indent=2, ensure_ascii=False))
    else:
        for law in laws:
            print_text(f"law {law['law']}: {law['found']}")
        print_report(recording.report())
        say_written(save, plot)
    return 1 if any(law["different_samples"] for law in laws) else 0


def _replayed(recording: Recording) -> Iterator[dict[str, Any]]:
    """What came of each law that was served; why not, where it cannot be replayed."""
    from zwidth.machine.servo.recording import replay

    for law in recording.laws:
        try:
            found = replay(recording, law=law)
        except InputError as error:
            yield {"law": law, "samples": 0, "different_samples": 0, "found": f"not replayed: {error}"}
            continue
        yield {
            "law": law,
            "samples": found.samples,
            "different_samples": found.different,
            f"largest_difference_{found.unit_key}": found.largest,
            "found": found.describe(),
        }


def _write(recording: Recording, plot: Path | None, save: Path | None) -> None:
    if plot is None and save is None:
        return
    if recording.samples < 2:
        raise InputError(f"{recording.path} holds {recording.samples} rows: there is nothing to draw or save")
    if save is not None:
        from zwidth.loop.traces.files import save_netcdf

        save_netcdf(recording.dataset(), save)
    if plot is not None:
        recording.plot(plot, overwrite=True)
