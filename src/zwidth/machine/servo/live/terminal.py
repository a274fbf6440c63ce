"""A running loop in the terminal: position, force, energy and lateness scroll by, and a line says the rest.

Where the output is no terminal, or cannot show braille patterns, the line alone comes, once a second.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from threading import Event
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from rich.console import Console, Group
from rich.live import Live
from rich.text import Text

from zwidth.machine.servo.live.rows import (
    CURVES,
    ENERGY_OUT,
    FORCE,
    FRICTION_LOSS,
    LATENESS,
    MARGIN,
    POSITION,
    SPAN,
    WISHED_FORCE,
    Envelope,
    Rows,
    Tally,
    Watched,
    scales_of,
)
from zwidth.native.compiled import Array
from zwidth.quantity.text import shown
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
    x, f, scale = scales_of(motion)
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
    head = Text(f"{printable(title)}, the last {shown(SPAN, 's')}", overflow="ellipsis", no_wrap=True)
    room = height - below - 1
    fitting = max(min(len(graphs), room // (_LEAST_LINES + 1)), 1)
    columns = max(width - _SCALE, 1) * DOTS_ACROSS
    low, high = envelope.drawn(columns)
    parts = [head]
    for i, graph in enumerate(graphs[:fitting]):
        lines = room // fitting + (i < room % fitting) - 1
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


# Curves as text: each character has two dots across and four down, a braille pattern of Unicode.  From
# above the dots are worth 1, 2, 4, 64 on the left and 8, 16, 32, 128 on the right, added to U+2800 (The
# Unicode Standard, block U+2800 to U+28FF).


DOTS_ACROSS, DOTS_DOWN = 2, 4

_WORTH = np.array([[1, 8], [2, 16], [4, 32], [64, 128]])
EMPTY = 0x2800

Codes = NDArray[np.int64]


def cells(low: Array, high: Array, lines: int, bottom: float, top: float) -> Codes:
    """The character codes of a curve, a row for each line of text, from above; 0x2800 where there is no dot.

    Lowest and highest of each column of dots, NaN where there is nothing; bottom and top are what the lowest
    and the highest row of dots stand for.
    """
    down = lines * DOTS_DOWN
    low, high = _joined(low, high)
    scale = (down - 1) / (top - bottom)
    with np.errstate(invalid="ignore"):
        first = np.rint((top - high) * scale)
        last = np.rint((top - low) * scale)
        row = np.arange(down)[:, None]
        dots = (row >= first) & (row <= last)  # False where NaN
    blocks = dots.reshape(lines, DOTS_DOWN, -1, DOTS_ACROSS)
    return EMPTY + np.einsum("ldwa,da->lw", blocks, _WORTH)


def _joined(low: Array, high: Array) -> tuple[Array, Array]:
    """Each column reaches to where the one before ended, so that a steep curve has no holes."""
    before_low, before_high = np.append(np.nan, low[:-1]), np.append(np.nan, high[:-1])
    with np.errstate(invalid="ignore"):
        low = np.where(before_high < low, before_high, low)
        high = np.where(before_low > high, before_low, high)
    return low, high
