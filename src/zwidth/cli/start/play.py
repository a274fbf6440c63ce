"""The command `play`: a page on which a loop is held, pushed and heard."""

from __future__ import annotations

import argparse
import os
import tempfile
import webbrowser
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from zwidth.cli.options import FORCE, LAW, LOOP, PARAMETERS, overrides
from zwidth.cli.output import print_text, say_written, target
from zwidth.writing import writing_whole

if TYPE_CHECKING:
    from zwidth.show.explorer.play import Played

SUFFIXES = (".html", ".htm")


USAGE = "[SOURCE ...] [--law NAMES] [--PARAMETER VALUE ...] [-o FILE] [--force] [--no-browser]"
OPTIONS = (
    {"sources=SOURCE*": f"{LOOP}; without any, the page has eleven loops to begin with", **LAW},
    "output",
    {
        "-o FILE": "save the page: .html; else a browser opens it",
        **FORCE,
        "--no-browser": "say where the page is, and open no browser",
    },
    *PARAMETERS,
)


def run(arguments: argparse.Namespace) -> int:
    """`zwidth play`: 0."""
    from zwidth.show.explorer.play import play_page

    save = target("--save", arguments.save, SUFFIXES, arguments.force)
    loops = _loops(arguments)
    page = play_page(loops).encode()
    if (place := save) is None:
        handle, name = tempfile.mkstemp(prefix="zwidth-play-", suffix=".html")
        os.close(handle)
        place = Path(name)
    with writing_whole(place) as file:
        file.write(page)
    print_text(_outcomes(loops))
    say_written(place)
    if save is None and not arguments.no_browser and not webbrowser.open(place.as_uri()):
        print_text("no browser was found: open that file in one")
    return 0


def _outcomes(loops: Sequence[Played]) -> str:
    """The outcome of one loop; of several only how many there are of each."""
    if len(loops) == 1:
        return f"{loops[0].verdict.outcome.upper()}: {loops[0].name}"
    found = Counter(loop.verdict.outcome for loop in loops)
    return f"{len(loops)} loops to play: " + ", ".join(f"{count} {name}" for name, count in found.items())


def _loops(arguments: argparse.Namespace) -> list[Played]:
    """The loop that was asked for; those to begin with where none was."""
    from zwidth.cli.decision import asked, decided, of_one_value
    from zwidth.model.specification.read import Specification
    from zwidth.show.explorer.play import played, presets

    if not (arguments.sources or overrides(arguments) or arguments.law):
        return presets()
    loop = of_one_value(asked(arguments).loop)
    return [
        played(loop.device, loop.environment, decide=lambda device, law: decided(Specification(device, law)))
    ]
