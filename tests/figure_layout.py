"""What is wrong with a picture: room left empty, words cut, laid over each other or over a curve."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.axis import Tick
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.spines import Spine
from matplotlib.text import Text
from matplotlib.transforms import Bbox

LEAST = 0.35
"""Part of an axis that data reach over."""

LOOSE = 0.015
"""Of the canvas' width: so much words may stick out or overlap, as fonts differ."""

COVERED = 0.04
"""Part of a curve that may run under a legend."""

LINES = 3
"""Of a title."""


def faults(figure: Figure) -> list[str]:
    """Each fault on a line; none of a good picture."""
    if not isinstance(figure.canvas, FigureCanvasAgg):
        FigureCanvasAgg(figure)
    figure.canvas.draw()
    found = [fault for axes in _shown(figure) for fault in _of_axes(axes)]
    return [*found, *_outside(figure), *_overlapping(figure)]


def _shown(figure: Figure) -> list[Axes]:
    return [a for a in figure.axes if a.get_visible() and a.axison and a.get_label() != "<colorbar>"]


def _of_axes(axes: Axes) -> Iterator[str]:
    name = _name(axes)
    across, up = coverage(axes)
    if across < LEAST:
        yield f"{name}: data reach over {across:.0%} of its width"
    if up < LEAST:
        yield f"{name}: data reach over {up:.0%} of its height"
    legend = axes.get_legend()
    if legend is not None:
        under = max((_under(line, legend.get_window_extent()) for line in axes.lines), default=0.0)
        if under > COVERED:
            yield f"{name}: the legend covers {under:.0%} of a curve"


def coverage(axes: Axes) -> tuple[float, float]:
    """Parts of the width and of the height that data reach over, from the 0 on where an axis ends there."""
    spans: tuple[list[float], list[float]] = ([], [])
    for points, counts in _points(axes):
        inside = axes.transAxes.inverted().transform(points)
        for values, counted, span in zip(inside.T, counts, spans, strict=True):
            finite = np.clip(values[np.isfinite(values)], 0, 1)
            if counted and finite.size:
                span.extend((float(finite.min()), float(finite.max())))
    for ends, span in zip((axes.get_xlim(), axes.get_ylim()), spans, strict=True):
        if span and 0 in ends:
            span.append(float(ends.index(0)))
    across, up = (max(span) - min(span) if span else 0.0 for span in spans)
    return across, up


def _points(axes: Axes) -> Iterator[tuple[Any, tuple[bool, bool]]]:
    """(points on the canvas, whether x and y are data) of whatever is drawn."""
    for line in axes.lines:
        transform = line.get_transform()
        yield transform.transform(line.get_path().vertices), _data(axes, transform)
    for patch in axes.patches:
        if not isinstance(patch, Spine) and patch.get_visible():
            points = patch.get_transform().transform(patch.get_path().vertices)
            yield points, _data(axes, patch.get_data_transform())
    for image in axes.images:
        left, right, bottom, top = image.get_extent()
        yield axes.transData.transform([(left, bottom), (right, top)]), (True, True)
    for drawn in axes.collections:
        limits = drawn.get_datalim(axes.transData)
        if np.all(np.isfinite(limits.get_points())):
            yield axes.transData.transform(limits.get_points()), (True, True)


def _data(axes: Axes, transform: Any) -> tuple[bool, bool]:
    if transform == axes.transData:
        return True, True
    x, y = transform.contains_branch_seperately(axes.transData)
    return bool(x), bool(y)


def _under(line: Any, box: Bbox) -> float:
    """Part of a curve's length across the canvas that lies in a box."""
    points = line.get_transform().transform(line.get_path().vertices)
    if not line.get_visible() or line.get_linestyle() == "None" or len(points) < 2:
        return 0.0
    fine = np.linspace(0, len(points) - 1, max(400, len(points)))
    x, y = (np.interp(fine, np.arange(len(points)), values) for values in points.T)
    within = (x > box.x0) & (x < box.x1) & (y > box.y0) & (y < box.y1)
    return float(within.mean())


def _outside(figure: Figure) -> Iterator[str]:
    room = LOOSE * figure.bbox.width
    for text in words(figure):
        box = text.get_window_extent()
        if min(box.x0, box.y0) < -room or box.x1 > figure.bbox.x1 + room or box.y1 > figure.bbox.y1 + room:
            yield f"cut at the edge: {text.get_text()!r}"
    for axes in figure.axes:
        for axis in (axes.xaxis, axes.yaxis):
            if axes.get_visible() and axis.get_offset_text().get_text():
                yield f"{_name(axes)}: an offset {axis.get_offset_text().get_text()!r}"


def _overlapping(figure: Figure) -> Iterator[str]:
    room = LOOSE * figure.bbox.width
    headings = [text for text in words(figure) if _is_heading(figure, text)]
    for text in headings:
        if text.get_text().count("\n") >= LINES:
            yield f"more than {LINES} lines: {text.get_text()!r}"
    boxes = [(text.get_text(), text.get_window_extent()) for text in headings]
    boxes += [("a legend", legend.get_window_extent()) for legend in _legends(figure)]
    for (one, first), (other, second) in combinations(boxes, 2):
        wide = min(first.x1, second.x1) - max(first.x0, second.x0)
        high = min(first.y1, second.y1) - max(first.y0, second.y0)
        if wide > room and high > room / 2:
            yield f"{one!r} lies over {other!r}"


def _legends(figure: Figure) -> list[Any]:
    return [*figure.legends, *(a.get_legend() for a in figure.axes if a.get_legend() is not None)]


def _is_heading(figure: Figure, text: Text) -> bool:
    """A title, an axis label or a heading of the figure."""
    if text in (figure._suptitle, figure._supxlabel, figure._supylabel):
        return True
    return any(
        text in (a.title, a._left_title, a._right_title, a.xaxis.label, a.yaxis.label) for a in figure.axes
    )


def words(figure: Figure) -> list[Text]:
    """Every text that is seen, but for the numbers along axes."""
    ticks = {id(text) for tick in figure.findobj(Tick) for text in tick.findobj(Text)}
    return [
        text
        for text in figure.findobj(Text)
        if text.get_visible() and text.get_text().strip() and id(text) not in ticks and _seen(text)
    ]


def _seen(text: Text) -> bool:
    return text.axes is None or bool(text.axes.get_visible())


def _name(axes: Axes) -> str:
    title = axes.get_title(loc="left") or axes.get_title() or axes.get_ylabel()
    return f"[{title.splitlines()[0] if title else 'axes'}]"
