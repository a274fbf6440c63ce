"""A running loop in the browser: a page that this machine serves to itself, out of what is installed on it.

A thread reads the rows, another one serves.  Each viewer has a document of its own, which can pause; what
all of them draw is kept once.  A viewer that does not say that it has its last pictures is sent no more until
it does.
"""

from __future__ import annotations

import logging
import math
import webbrowser
from collections.abc import Callable
from dataclasses import dataclass
from html import escape
from threading import Event, Thread
from typing import Any

import numpy as np

from zwidth.machine.servo.live.page import (
    HOST,
    OWN,
    Page,
    Serving,
    bound,
    checked_port,
    guarded,
    library,
    origins,
)
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
    Band,
    Envelope,
    News,
    Rows,
    Tally,
    Watched,
    scales_of,
)
from zwidth.native.compiled import Array
from zwidth.showing import printable

FRAME = 0.05
"""Between two pictures [s]."""


def open_page(
    rows: Rows, port: int = 0, open_browser: bool = True, *, surface: float | None = 0.0, frame: float = FRAME
) -> Page:
    """Serve a page with four graphs of a running loop: position, force, energy and lateness.

    Only browsers on this machine are answered, and only pages that come from this server get rows.

    Parameters
    ----------
    rows
        Of the loop.
    port
        1 to 65535, or 0 for one that is free.
    open_browser
        Open the page in the person's browser.
    surface
        Where the wall begins [m; rad], to shade it; None where there is no wall.
    frame
        Between two pictures, > 0 [s].

    Raises
    ------
    InputError
        If Bokeh is not installed, or the port is none or in use.
    """
    server = _Server(rows, checked_port(port), surface, frame)
    if open_browser:
        webbrowser.open(server.address)
    return Page(server.address, server.close)


class _Server:
    """The thread that serves, and the one that reads."""

    def __init__(self, rows: Rows, port: int, surface: float | None, frame: float) -> None:
        sockets, self._port = bound(port)
        self.address = f"http://{HOST}:{self._port}/"
        self._envelope, self._tally = Envelope(len(CURVES), SPANS), Tally(rows)
        self._shown = Shown(rows, self._envelope, self._tally, surface, frame)
        self._serving = Serving(sockets, self._made, "zwidth live page")
        self._reader = Reader(rows, self._take, frame)

    def _take(self, news: News) -> None:
        self._tally.add(news)
        self._envelope.add(news.times, news.curves)

    def _made(self) -> tuple[Any, Callable[[], None]]:
        """A server of Bokeh for pages of its own alone, and what ends it."""
        # a viewer that leaves is no fault: not worth a line over whatever the terminal shows
        logging.getLogger("bokeh.server.views.ws").setLevel(logging.ERROR)
        application = library("bokeh.application", "Bokeh").Application
        handler = library("bokeh.application.handlers", "Bokeh").FunctionHandler
        tornado = library("bokeh.server.tornado", "Bokeh").BokehTornado(
            {"/": application(handler(lambda doc: make_document(doc, self._shown)))},
            extra_websocket_origins=origins(OWN, self._port),
        )
        http = library("tornado.httpserver", "Tornado").HTTPServer(guarded(tornado, OWN, self._port))
        loop = library("tornado.ioloop", "Tornado").IOLoop.current()
        server = library("bokeh.server.server", "Bokeh").BaseServer(loop, tornado, http)
        server.start()
        return http, server.stop

    def close(self) -> None:
        """End both threads."""
        self._reader.close()
        self._serving.close()


SPANS = 1000
"""Of the curves: one or two for each pixel of a graph."""

_AHEAD = 3
"""Pictures that a viewer is sent before it says that it has them: a slow one gets fewer, and fuller ones."""

_WORDS_EVERY = 5
"""Frames between two lines of words."""

_LEAST_LATENESS = 0.1
"""The logarithmic axis has no 0: the least that is drawn [µs]."""

_BLUE, _ORANGE, _GREEN, _RED, _VIOLET = "#3a7bd5", "#e08a1e", "#2e9e6b", "#d64545", "#8e6bd1"
_GREY = "#5d636c"
"""Of all that is no curve."""

_DARK = "@media (prefers-color-scheme: dark) { .bk-Canvas { filter: invert(1) hue-rotate(180deg); } }"
"""No grey can be read on white and on black: in the dark what is light and what is dark change places."""

_STYLE = """{% block postamble %}<style>
:root { color-scheme: light dark; --words: #5d636c; }
html, body { margin: 0; height: 100%; }
body { display: flex; flex-direction: column; background: #fff; font-family: system-ui, sans-serif; }
body > div > div { flex: 1; min-height: 640px; padding: 6px; box-sizing: border-box; }
@media (prefers-color-scheme: dark) { :root { --words: #a7adb6; } body { background: #14171c; } }
</style>{% endblock %}"""

_HEARD = "const n = source.data.number; if (n.length) words.tags = [n[n.length - 1]];"


@dataclass(frozen=True)
class Shown:
    """What every viewer is shown, at every frame [s]: another thread adds to envelope and tally.

    The wall begins at `surface` [m; rad]; None where there is none.
    """

    rows: Rows
    envelope: Envelope
    tally: Tally
    surface: float | None
    frame: float


def make_document(document: Any, shown: Shown) -> None:
    """Fill the document of a new viewer, and keep it going."""
    models = library("bokeh.models", "Bokeh")
    band = shown.envelope.after(-1)
    source = models.ColumnDataSource(_columns(band, shown.rows))
    words = models.Div(
        styles={"color": "var(--words)", "font-size": "13px"}, sizing_mode="stretch_width", tags=[band.newest]
    )
    words.text = _words(shown)
    heard = models.CustomJS(args={"source": source, "words": words}, code=_HEARD)
    source.js_on_change("streaming", heard)
    document.js_on_event("document_ready", heard)  # what was sent meanwhile came with the page
    pause = models.Toggle(label="Pause", width=80, sizing_mode="fixed", height=30)
    viewer = _Viewer(shown, source, words, pause, band.newest)
    pause.on_change("active", viewer.paused)
    layouts = library("bokeh.layouts", "Bokeh")
    head = layouts.row(pause, words, sizing_mode="stretch_width")
    graphs = layouts.gridplot(
        [[figure] for figure in _figures(shown, source)],
        sizing_mode="stretch_both",
        toolbar_options={"logo": None},
    )
    document.add_root(layouts.column(head, graphs, sizing_mode="stretch_both"))
    document.title = printable(shown.rows.title)
    document.template = _STYLE
    document.add_periodic_callback(viewer.update, max(1, round(1e3 * shown.frame)))


class _Viewer:
    """One viewer: what it was sent, and what it says that it has."""

    def __init__(self, shown: Shown, source: Any, words: Any, pause: Any, newest: int) -> None:
        self._shown, self._source, self._words, self._pause = shown, source, words, pause
        self._sent = newest
        self._unheard: list[int] = []
        self._frames = 0

    def update(self) -> None:
        """A frame: send what is new."""
        heard = self._words.tags[0]
        self._unheard = [number for number in self._unheard if number > heard]
        if self._pause.active or len(self._unheard) >= _AHEAD:
            return
        band = self._shown.envelope.after(self._sent)
        self._frames += 1
        if len(band.times):
            self._sent = band.newest
            self._unheard.append(band.newest)
            self._source.stream(_columns(band, self._shown.rows), rollover=SPANS)
        if self._frames % _WORDS_EVERY == 0:
            self._words.text = _words(self._shown)

    def paused(self, _: str, __: bool, active: bool) -> None:
        """The button: the graphs stand still; then they jump to what is now."""
        self._pause.label = "Go on" if active else "Pause"
        if not active:
            band = self._shown.envelope.after(-1)
            self._sent, self._words.tags = band.newest, [band.newest]
            self._source.data = _columns(band, self._shown.rows)


def _words(shown: Shown) -> str:
    return f"<b>{escape(printable(shown.rows.title))}</b><br>{escape(shown.tally.line)}"


def _columns(band: Band, rows: Rows) -> dict[str, Array]:
    """What Bokeh draws, in the units of the axes."""
    scale = scales_of(rows.motion)[2]
    late = np.maximum(1e6 * band.high[:, LATENESS], _LEAST_LATENESS)
    columns = {"time": band.times, "late": late, "number": np.rint(band.times / SPAN * SPANS - 0.5)}
    columns["missed"] = np.where(late >= 1e6 * rows.period, late, math.nan)
    scaled = ((POSITION, 1e3), (WISHED_FORCE, scale), (FORCE, scale), (ENERGY_OUT, 1e3), (FRICTION_LOSS, 1e3))
    for curve, factor in (*scaled, (MARGIN, 1e3)):
        columns[f"low_{curve}"] = band.low[:, curve] * factor
        columns[f"high_{curve}"] = band.high[:, curve] * factor
    return columns


def _figures(shown: Shown, source: Any) -> list[Any]:
    """Four graphs over one time."""
    models = library("bokeh.models", "Bokeh")
    time = models.DataRange1d(follow="end", follow_interval=SPAN, range_padding=0)
    position, force, _ = scales_of(shown.rows.motion)
    make = _maker(time)
    x = make(f"position [{position}]")
    _band(x, source, POSITION, _BLUE)
    if shown.surface is not None:
        wall = models.BoxAnnotation(
            name="wall", bottom=1e3 * shown.surface, fill_color=_GREY, fill_alpha=0.18, line_color=_GREY
        )
        x.add_layout(wall)
    f = make(f"force [{force}]")
    _band(f, source, WISHED_FORCE, _ORANGE, "asked for")
    _band(f, source, FORCE, _GREEN, "given")
    energy = make("energy [mJ]")
    _band(energy, source, FRICTION_LOSS, _BLUE, "friction loss")
    _band(energy, source, ENERGY_OUT, _RED, "energy out")
    _band(energy, source, MARGIN, _GREEN, "margin")
    late = make("lateness [µs]", y_axis_type="log")
    late.line("time", "late", source=source, color=_VIOLET, line_width=1.5)
    late.scatter("time", "missed", source=source, marker="x", size=9, color=_RED, line_width=2)
    period = models.Span(
        location=1e6 * shown.rows.period, dimension="width", line_color=_RED, line_dash="dashed"
    )
    late.add_layout(period)
    late.xaxis.axis_label = "time [s]"
    late.xaxis.visible = True
    for figure in (f, energy):
        _set(
            figure.legend,
            orientation="horizontal", background_fill_alpha=0, border_line_alpha=0, label_text_color=_GREY,
            label_text_font_size="11px", padding=0, margin=0, label_standoff=4,
        )  # fmt: skip
        figure.add_layout(figure.legend[0], "above")
    return [x, f, energy, late]


def _set(parts: Any, **values: Any) -> None:
    """Of all axes, grids or legends of a figure."""
    for name, value in values.items():
        setattr(parts, name, value)


def _maker(time: Any) -> Callable[..., Any]:
    """What makes the graphs alike."""
    plotting = library("bokeh.plotting", "Bokeh")
    models = library("bokeh.models", "Bokeh")

    def make(label: str, **options: Any) -> Any:
        values = models.DataRange1d(only_visible=True, default_span=1e-3)
        figure = plotting.figure(
            x_range=time, y_range=values, y_axis_label=label, min_height=120, sizing_mode="stretch_both",
            tools="pan,wheel_zoom,box_zoom,reset", active_drag=None, active_scroll=None, stylesheets=[_DARK],
            background_fill_alpha=0, border_fill_alpha=0, outline_line_color=_GREY, outline_line_alpha=0.4,
            **options,
        )  # fmt: skip
        _set(figure.grid, grid_line_color=_GREY, grid_line_alpha=0.25)
        _set(
            figure.axis,
            axis_label_text_color=_GREY, major_label_text_color=_GREY, axis_label_text_font_style="normal",
            axis_line_color=_GREY, major_tick_line_color=_GREY, minor_tick_line_color=None,
        )  # fmt: skip
        figure.xaxis.visible = False
        figure.yaxis.axis_label_text_font_size = "12px"
        return figure

    return make


def _band(figure: Any, source: Any, curve: int, colour: str, name: str | None = None) -> None:
    """From the lowest to the highest; a line where they are one."""
    low, high = f"low_{curve}", f"high_{curve}"
    named = {} if name is None else {"legend_label": name}
    figure.varea("time", low, high, source=source, color=colour, alpha=0.45, **named)
    for edge in (low, high):
        figure.line("time", edge, source=source, color=colour, line_width=1.5, **named)


class Reader:
    """A thread that asks a loop for its rows at every so many seconds, and hands on what is new.

    What `take` raises ends it, and is logged; others, and the loop, stay as they are.
    """

    def __init__(self, rows: Rows, take: Callable[[News], None], every: float) -> None:
        self._watched, self._take, self._every = Watched(rows), take, every
        self._ended = Event()
        self._thread = Thread(target=self._run, name="zwidth live reader", daemon=True)
        self._thread.start()

    def _run(self) -> None:
        try:
            while not self._ended.wait(self._every):
                self._take(self._watched.news())
        except Exception:
            logging.getLogger(__name__).exception("a live graph has ended; the loop runs on")

    def close(self) -> None:
        """End it; may be called again."""
        self._ended.set()
        self._thread.join()
