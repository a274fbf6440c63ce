"""A running loop in the terminal: position, force, energy and lateness scroll by, and a line says the rest.

Where the output is no terminal, or cannot show braille patterns, the line alone comes, once a second.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from threading import Event
from typing import NamedTuple

import numpy as np
from rich.console import Console, Group
from rich.live import Live
from rich.text import Text

from zwidth.machine.servo.live.braille import DOTS_ACROSS, EMPTY, Codes, cells
from zwidth.machine.servo.live.envelope import SPAN, Envelope
from zwidth.machine.servo.live.rows import (
    CURVES,
    ENERGY_OUT,
    FORCE,
    FRICTION_LOSS,
    LATENESS,
    MARGIN,
    POSITION,
    WISHED_FORCE,
    Rows,
    Watched,
)
from zwidth.machine.servo.live.tally import Tally
from zwidth.native.compiled import Array
from zwidth.showing import printable

_FRAME = 0.1
"""Between two pictures [s]."""

_LINE = 1.0
"""Between two lines where there are no pictures [s]."""

_SPANS = 500
_SCALE = 12
"""Characters left of a graph, for its scale."""

_LEAST_LINES = 3
"""Of a graph; where the terminal is lower, the last graphs are left out."""


class _Graph(NamedTuple):
    """What is drawn in one frame: curves with their names and colours, the later over the earlier."""

    title: str
    unit: str
    scale: float
    """Units in one SI unit."""
    curves: Sequence[tuple[int, str, str]]


def watch_in_terminal(rows: Rows, stop: Event, console: Console | None = None) -> None:
    """Show a loop in the terminal until `stop` is set; a last line stays.

    Parameters
    ----------
    rows
        Of the loop.
    stop
        Is set by another thread or a signal.
    console
        Where; None: standard output.
    """
    out = console or Console(markup=False, highlight=False, emoji=False)
    watched, tally = Watched(rows), Tally(rows)
    drawn = out.is_terminal and not out.is_dumb_terminal and "utf" in out.encoding.lower()
    try:
        if drawn:
            _watch_curves(rows, watched, tally, stop, out)
        else:
            _watch_lines(watched, tally, stop, out)
        _say(watched, tally, out)
    except BrokenPipeError:  # nobody reads any more, and the loop runs on
        stop.wait()


def _watch_lines(watched: Watched, tally: Tally, stop: Event, out: Console) -> None:
    while not stop.wait(_LINE):
        _say(watched, tally, out)


def _say(watched: Watched, tally: Tally, out: Console) -> None:
    """The line; not broken at any width."""
    tally.add(watched.news())
    out.file.write(f"{tally.line}\n")
    out.file.flush()


def _watch_curves(rows: Rows, watched: Watched, tally: Tally, stop: Event, out: Console) -> None:
    envelope = Envelope(len(CURVES), _SPANS)
    graphs = _graphs(rows.motion)
    with Live(console=out, screen=True, auto_refresh=False) as live:
        while not stop.wait(_FRAME):
            news = watched.news()
            tally.add(news)
            envelope.add(news.times, news.curves)
            live.update(picture(rows.title, tally.line, envelope, graphs, out), refresh=True)


def _graphs(motion: str) -> list[_Graph]:
    """Position, force, energy and lateness, in the order in which they are left out from the end."""
    x, f, scale = ("mrad", "mN·m", 1e3) if motion == "rotary" else ("mm", "N", 1.0)
    return [
        _Graph("position", x, 1e3, [(POSITION, "", "cyan")]),
        _Graph("force", f, scale, [(WISHED_FORCE, "asked for", "yellow"), (FORCE, "given", "green")]),
        _Graph(
            "energy",
            "mJ",
            1e3,
            [
                (FRICTION_LOSS, "friction loss", "blue"),
                (ENERGY_OUT, "energy out", "red"),
                (MARGIN, "margin", "green"),
            ],
        ),
        _Graph("lateness", "µs", 1e6, [(LATENESS, "", "magenta")]),
    ]


def picture(title: str, line: str, envelope: Envelope, graphs: Sequence[_Graph], out: Console) -> Group:
    """One picture: as many graphs as have room, and the line below."""
    words = Text(line, style="bold")
    width, height = out.size
    below = len(words.wrap(out, width))
    head = Text(f"{printable(title)}, the last {SPAN:g} s", overflow="ellipsis", no_wrap=True)
    room = height - below - 1
    shown = max(min(len(graphs), room // (_LEAST_LINES + 1)), 1)
    columns = max(width - _SCALE, 1) * DOTS_ACROSS
    low, high = envelope.drawn(columns)
    parts = [head]
    for i, graph in enumerate(graphs[:shown]):
        lines = room // shown + (i < room % shown) - 1
        parts += _drawn(graph, low, high, max(lines, 1))
    return Group(*parts, words)


def _drawn(graph: _Graph, low: Array, high: Array, lines: int) -> list[Text]:
    """A title line, and lines of dots with their scale on the left."""
    numbers = [curve for curve, _, _ in graph.curves]
    bottom, top = _range(low[:, numbers] * graph.scale, high[:, numbers] * graph.scale)
    head = Text(f"{graph.title} [{graph.unit}]", style="dim")
    codes: Codes = np.full((lines, low.shape[0] // DOTS_ACROSS), EMPTY)
    colours: Codes = np.zeros(codes.shape, np.int64)
    for i, (curve, name, colour) in enumerate(graph.curves):
        drawn = cells(low[:, curve] * graph.scale, high[:, curve] * graph.scale, lines, bottom, top)
        codes |= drawn
        colours[drawn != EMPTY] = i
        if name:
            head.append(f"  ━ {name}", style=colour)
    head.truncate(low.shape[0] // DOTS_ACROSS + _SCALE)
    scale = [""] * lines
    scale[-1], scale[0] = f"{bottom:.4g}", f"{top:.4g}"
    return [head, *(_line(s, c, k, graph) for s, c, k in zip(scale, codes, colours, strict=True))]


def _line(scale: str, codes: Codes, colours: Codes, graph: _Graph) -> Text:
    text = Text(f"{scale:>{_SCALE - 2}} │", style="dim", no_wrap=True)
    for part in np.split(np.arange(len(codes)), np.flatnonzero(np.diff(colours)) + 1):
        text.append("".join(map(chr, codes[part])), style=graph.curves[colours[part[0]]][2])
    return text


def _range(low: Array, high: Array) -> tuple[float, float]:
    """From the lowest to the highest, rounded outwards to what a person reads easily."""
    known = np.isfinite(low).any()
    bottom, top = (float(np.nanmin(low)), float(np.nanmax(high))) if known else (0.0, 1.0)
    step = 0.2 * 10.0 ** math.floor(math.log10(max(top - bottom, abs(top) * 1e-6, 1e-6)))
    bottom, top = math.floor(bottom / step) * step, math.ceil(top / step) * step
    return (bottom, top) if top > bottom else (bottom, bottom + step)
