"""What is wrong with a picture: room left empty, words cut, laid over each other or over a curve, no name."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.axis import Tick
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import PolyCollection
from matplotlib.colors import to_hex, to_rgb
from matplotlib.container import ErrorbarContainer
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.spines import Spine
from matplotlib.text import Text
from matplotlib.transforms import Bbox

from zwidth.show.plots.style import SMALL, WIDEST

LEAST = 0.35
"""Part of an axis that data reach over."""

LOOSE = 0.015
"""Of the canvas' width: so much words may stick out or overlap, as fonts differ."""

COVERED = 0.04
"""Part of a curve that may run under a legend."""

LINES = 3
"""Of a title."""

GREYS = 0.08
"""Difference in lightness, from 0 to 1, by which curves are told apart in grey."""

OVER = 2.5
"""Dots of the canvas by which boxes of words may overlap, as the boxes are larger than the letters."""

GUIDE = 0.8
"""Lightness from which on a line only leads the eye."""

FILLED, PART_FILLED = 0.7, 0.4
"""Parts of a picture, and of each quarter of it, across and up."""


def faults(figure: Figure) -> list[str]:
    """Each fault on a line; none of a good picture."""
    if not isinstance(figure.canvas, FigureCanvasAgg):
        FigureCanvasAgg(figure)
    figure.draw_without_rendering()
    found = [fault for axes in _shown(figure) for fault in _of_axes(axes)]
    return [*found, *_outside(figure), *_overlapping(figure)]


def faults_of_ours(figure: Figure) -> list[str]:
    """The same and more, of the pictures that the package draws."""
    found = faults(figure)
    for axes in figure.axes:
        found += [*_nameless(figure, axes), *_alike(axes)]
    return [*found, *_texts_over_texts(figure), *_cut(figure), *_small(figure), *_empty(figure)]


def _shown(figure: Figure) -> list[Axes]:
    return [a for a in figure.axes if a.get_visible() and a.axison and a.get_label() != "<colorbar>"]


def _of_axes(axes: Axes) -> Iterator[str]:
    name = _name(axes)
    across, up = coverage(axes)
    if across < LEAST:
        yield f"{name}: data reach over {across:.0%} of its width"
    if up < LEAST:
        yield f"{name}: data reach over {up:.0%} of its height"
    for legend in _legends(axes.figure):
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
    if line.get_clip_on():  # what is beyond the axes is not drawn
        box = Bbox.intersection(box, line.axes.bbox) or Bbox.null()
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
        if text is not figure._suptitle and text.get_text().count("\n") >= LINES:
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


def _nameless(figure: Figure, axes: Axes) -> Iterator[str]:
    """Of curves, marks and areas that look different all but one have a name, or a text in their colour.

    What is at 0 needs none, nor pale lines that lead the eye.
    """
    named = {_look(one) for other in figure.axes for one in _drawn(other) if _is_named(one)}
    bars = [group for group in axes.containers if isinstance(group, ErrorbarContainer) and _is_named(group)]
    named |= {_look(one) for group in bars for one in group.get_children() if isinstance(one, Line2D)}
    named |= {_look(one)[0] for legend in _legends(figure) for one in legend.legend_handles if one}
    written = {to_hex(text.get_color()) for text in axes.texts}
    looks = {_look(one): one for one in _drawn(axes) if not _at_zero(one) and not _is_guide(one)}
    without = [
        one
        for look, one in looks.items()
        if look not in named and look[0] not in named and look[0] not in written
    ]
    if len(without) > (0 if len(looks) > len(without) else 1):
        kinds = ", ".join(str(_look(one)) for one in without)
        yield f"{_name(axes)}: no name says what is {kinds}"


def _drawn(axes: Axes) -> list[Any]:
    """Lines and areas; of bars the axis tells what they are, and of images the legend or a bar of colours."""
    if not axes.axison:
        return []
    lines = [line for line in axes.lines if len(np.ravel(line.get_xdata()))]
    areas = [one for one in axes.collections if isinstance(one, PolyCollection)]
    return [one for one in (*lines, *areas) if one.get_visible()]


def _look(one: Any) -> tuple[str, ...]:
    if isinstance(one, Line2D):
        return to_hex(one.get_color()), str(one.get_linestyle()), str(one.get_marker())
    faces = getattr(one, "get_facecolor", lambda: "none")()
    return (to_hex(np.reshape(faces, (-1, 4))[0][:3]) if np.size(faces) > 3 else "none", "area")


def _is_named(one: Any) -> bool:
    return bool(one.get_label()) and not str(one.get_label()).startswith("_")


def _is_guide(one: Any) -> bool:
    return isinstance(one, Line2D) and _lightness(to_hex(one.get_color())) > GUIDE


def _at_zero(one: Any) -> bool:
    return isinstance(one, Line2D) and any(
        np.all(np.asarray(values, dtype=float) == 0) and len(np.ravel(values)) == 2
        for values in (one.get_xdata(), one.get_ydata())
    )


def _alike(axes: Axes) -> Iterator[str]:
    """Named curves with the same dashes and no marks differ in lightness, for prints in grey."""
    lines = [line for line in _drawn(axes) if isinstance(line, Line2D) and _is_named(line)]
    for one, other in combinations(lines, 2):
        (colour, *dashes), (second, *others) = _look(one), _look(other)
        apart = abs(_lightness(colour) - _lightness(second))
        if colour != second and dashes == others and apart < GREYS:
            yield f"{_name(axes)}: {one.get_label()!r} and {other.get_label()!r} are alike in grey"


def _lightness(colour: str) -> float:
    return float(np.dot(to_rgb(colour), (0.299, 0.587, 0.114)))


def _texts(figure: Figure) -> list[Text]:
    """Every text that is seen, numbers along axes with them."""
    texts = [t for t in figure.findobj(Text) if t.get_text().strip() and t.get_visible() and _seen(t)]
    return [text for text in texts if _is_drawn(text)]


def _cut(figure: Figure) -> Iterator[str]:
    """To the dot, as the fonts here are those of the canvas."""
    for text in _texts(figure):
        box, whole = text.get_window_extent(), figure.bbox
        if min(box.x0, box.y0) < -OVER or box.x1 > whole.x1 + OVER or box.y1 > whole.y1 + OVER:
            yield f"cut at the edge, by a little: {text.get_text()!r}"


def _texts_over_texts(figure: Figure) -> Iterator[str]:
    """Any two; turned ones have no box of their own."""
    shown = [text for text in _texts(figure) if text.get_rotation() % 90 == 0]
    boxes = [text.get_window_extent() for text in shown]
    for (one, first), (other, second) in combinations(zip(shown, boxes, strict=True), 2):
        wide = min(first.x1, second.x1) - max(first.x0, second.x0)
        high = min(first.y1, second.y1) - max(first.y0, second.y0)
        if wide > OVER and high > OVER:
            yield f"{one.get_text()!r} lies over {other.get_text()!r}"


def _is_drawn(text: Text) -> bool:
    """Not a number of an axis beyond its end, nor one of an axis without numbers."""
    for axes in text.figure.axes:
        for axis in (axes.xaxis, axes.yaxis):
            for tick in (*axis.majorTicks, *axis.minorTicks):
                if text in (tick.label1, tick.label2):
                    low, high = sorted(axis.get_view_interval())
                    return bool(axes.axison and axes.get_visible() and low <= tick.get_loc() <= high)
    return text.axes is None or text.axes.axison or text in text.axes.texts


def _small(figure: Figure) -> Iterator[str]:
    """Letters where a page of the docs, 7.2 inches wide, shows the picture."""
    shrunk = min(1.0, WIDEST / figure.get_figwidth())
    for size, text in sorted({(t.get_fontsize() * shrunk, t.get_text()) for t in words(figure)}):
        if size < SMALL - 1e-6:
            yield f"letters of {size:.3g} points: {text!r}"


def _empty(figure: Figure) -> Iterator[str]:
    """Axes with their numbers, labels and legends, and texts, fill the canvas, and each quarter of it."""
    grid = np.zeros((100, 100), dtype=bool)
    boxes = [axes.get_tightbbox(bbox_extra_artists=[]) for axes in figure.axes if axes.get_visible()]
    boxes += [axes.bbox for axes in figure.axes]
    boxes += [one.get_window_extent() for one in (*figure.texts, *_legends(figure))]
    if figure._suptitle is not None:
        boxes.append(figure._suptitle.get_window_extent())
    for box in boxes:
        x, y = (np.clip(np.round(100 * np.array(ends)), 0, 100).astype(int) for ends in (
            (box.x0 / figure.bbox.width, box.x1 / figure.bbox.width),
            (box.y0 / figure.bbox.height, box.y1 / figure.bbox.height),
        ))  # fmt: skip
        grid[y[0] : y[1], x[0] : x[1]] = True
    if grid.mean() < FILLED:
        yield f"filled to {grid.mean():.0%}"
    for word, quarters in (("across", np.split(grid, 4, axis=1)), ("up", np.split(grid, 4))):
        for place, quarter in enumerate(quarters):
            if quarter.mean() < PART_FILLED:
                yield f"quarter {place + 1} {word} is filled to {quarter.mean():.0%}"
