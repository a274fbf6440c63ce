"""A scene as a drawing: bodies in boxes, springs, dampers and contacts between them, the ground below.

Nodes stand from left to right by how many elements are between them and the port.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from zwidth.model.scene import Element, Scene
from zwidth.model.scene.element import GROUND
from zwidth.show.plots.style import (
    BLACK,
    BLUE,
    GREEN,
    GREY,
    LOOK,
    ORANGE,
    PURPLE,
    RED,
    SMALL,
    WIDEST,
    new_figure,
    verbatim,
)

Array = NDArray[np.float64]

_MOST_LABELS = 40
"""Elements that are labelled; of more the drawing shows what hangs together."""


@rc_context(LOOK)
def plot_scene(scene: Scene, motion: str = "linear") -> Figure:
    """The scene, every element with its number.

    Parameters
    ----------
    scene
        What is drawn.
    motion
        "linear" or "rotary", for the units.
    """
    figure = new_figure(*size_of(scene))
    draw_scene(figure.add_subplot(), scene, motion)
    return figure


def size_of(scene: Scene) -> tuple[float, float]:
    """Width and height of its drawing [inch]."""
    x, y = zip(*placed(scene).values(), strict=True)
    return min(WIDEST, 2.5 + 1.9 * max(x)), min(10.0, 2.6 + 1.6 * (max(y) - min(y)))


def draw_scene(axes: Axes, scene: Scene, motion: str = "linear") -> None:
    """The same on axes of one's own."""
    places = placed(scene)
    labelled = len(scene.elements) <= _MOST_LABELS
    beside: dict[frozenset[str], int] = {}
    many = Counter(frozenset(e.nodes) for e in _joining(scene))
    for element in _joining(scene):
        key = frozenset(element.nodes)
        turn = beside.get(key, 0)
        beside[key] = turn + 1
        begin, end, leads = _ends(element, places, turn, many[key])
        colour = _COLOUR[element.symbol]
        strokes = (_along(begin, end, shape) for shape in _DRAWN[element.symbol])
        for line in [*leads, *strokes]:
            axes.plot(line[:, 0], line[:, 1], color=colour, lw=1.4, solid_capstyle="butt")
        if GROUND in element.nodes:
            _ground(axes, end)
        if labelled:
            _name(axes, element, begin, end, motion)
    for node, (x, y) in places.items():
        bodies = [e for e in scene.elements if e.reflection < 0 and e.nodes[0] == node]
        text = "\n".join([verbatim(node), *(_number(e, motion) for e in bodies)])
        held = node == scene.port
        axes.text(
            x, y, text if labelled or held else "", ha="center", va="center",
            fontsize=SMALL, color=BLACK, zorder=5,
            bbox={
                "boxstyle": "square,pad=0.35" if bodies else "round,pad=0.15",
                "fc": "#dbe9f4" if bodies else "white",
                "ec": RED if held else BLACK, "lw": 1.6 if held else 0.8,
            },
        )  # fmt: skip
    axes.set_axis_off()
    axes.set_aspect("equal", adjustable="datalim")
    axes.margins(0.15)


def placed(scene: Scene) -> dict[str, tuple[float, float]]:
    """Where each node stands: its column by its distance to the port, its row as it is named."""
    near: dict[str, list[str]] = {node: [] for node in scene.nodes}
    for element in scene.elements:
        if GROUND not in element.nodes:
            for here, there in (element.nodes, element.nodes[::-1]):
                near[here].append(there)
    column: dict[str, int] = {}
    for start in [*([scene.port] if scene.port else []), *scene.nodes]:
        if start in column:
            continue
        row = [start]
        column[start] = 0
        while row:
            after = [n for node in row for n in near[node] if n not in column]
            column.update(dict.fromkeys(after, column[row[0]] + 1))
            row = list(dict.fromkeys(after))
    found = {}
    for at in set(column.values()):
        own = [node for node in scene.nodes if column[node] == at]
        found.update({node: (float(at), 1.0 * ((len(own) - 1) / 2 - i)) for i, node in enumerate(own)})
    return found


def _joining(scene: Scene) -> list[Element]:
    return [e for e in scene.elements if e.reflection >= 0]


def _ends(
    element: Element, places: Mapping[str, tuple[float, float]], turn: int, many: int
) -> tuple[Array, Array, list[Array]]:
    """Two points, and the leads to them; elements between the same nodes stand beside each other."""
    first, second = element.nodes
    aside = (0.5 if GROUND in element.nodes else 0.45) * (turn - (many - 1) / 2)
    if GROUND in (first, second):
        x, y = places[second if first == GROUND else first]
        begin = np.array([x + aside, y - 0.2])
        return begin, np.array([x + aside, y - 0.75]), [_shape((x, y), (x, y - 0.2), (x + aside, y - 0.2))]
    aside *= 1 if first < second else -1  # from there to here the other side is on the left
    a, b = np.array(places[first]), np.array(places[second])
    across = aside * np.array([a[1] - b[1], b[0] - a[0]]) / max(float(np.hypot(*(b - a))), 1e-9)
    near, far = a + 0.2 * (b - a), b - 0.2 * (b - a)
    leads = [np.array([a, near, near + across]), np.array([far + across, far, b])]
    return near + across, far + across, leads


def _along(begin: Array, end: Array, shape: Array) -> Array:
    """A shape drawn from (0, 0) to (1, 0), turned to lie between two points; its height stays."""
    way = end - begin
    length = max(float(np.hypot(*way)), 1e-9)
    across = np.array([-way[1], way[0]]) / length
    points: Array = begin + shape[:, :1] * way + shape[:, 1:] * across
    return points


def _shape(*points: tuple[float, float]) -> Array:
    return np.array(points)


_SPRING = [
    _shape((0, 0), (0.22, 0), *((0.26 + 0.06 * i, 0.06 * (-1) ** i) for i in range(9)), (0.78, 0), (1, 0))
]

_DRAWN: Mapping[str, list[Array]] = {
    "K": _SPRING,
    "N": _SPRING,
    "B": [  # the cup, its rod and its plate
        _shape((0.42, 0.08), (0.62, 0.08), (0.62, -0.08), (0.42, -0.08)), _shape((0, 0), (0.52, 0)),
        _shape((0.52, 0.06), (0.52, -0.06)), _shape((0.62, 0), (1, 0)),
    ],
    "C": [
        _shape((0, 0), (0.47, 0)), _shape((0.47, 0.1), (0.47, -0.1)),
        _shape((0.55, 0.1), (0.55, -0.1)), _shape((0.55, 0), (1, 0)),
    ],
    "F": [_shape((0, 0.03), (0.6, 0.03)), _shape((0.4, -0.03), (1, -0.03))],
    "r": [_shape((0, h), (1, h)) for h in (-0.02, 0.02)],
    "w": [_shape((low, 0), (high, 0)) for low, high in np.linspace(0, 1, 12).reshape(-1, 2)],
}  # fmt: skip
"""Of each symbol the strokes, drawn from (0, 0) to (1, 0)."""

_COLOUR = {"K": BLUE, "N": PURPLE, "B": GREEN, "C": RED, "F": ORANGE, "r": BLACK, "w": GREY}


def _ground(axes: Axes, at: Array) -> None:
    x, y = at
    axes.plot([x - 0.1, x + 0.1], [y, y], color=GREY, lw=1.2)
    for i in range(4):
        axes.plot([x - 0.07 + 0.05 * i, x - 0.11 + 0.05 * i], [y, y - 0.06], color=GREY, lw=0.8)


def _number(element: Element, motion: str) -> str:
    return verbatim(element.describe(motion).removeprefix(element.title).strip().replace("*", "·"))


def _name(axes: Axes, element: Element, begin: Array, end: Array, motion: str) -> None:
    x, y = (begin + end) / 2
    upright = abs(end[0] - begin[0]) < abs(end[1] - begin[1])
    axes.annotate(
        _number(element, motion).replace(", ", "\n"),
        (x + 0.12, y) if upright else (x, y + 0.11), (2, 0) if upright else (0, 1),
        textcoords="offset points", ha="left" if upright else "center", va="center" if upright else "bottom",
        fontsize=SMALL, color=_COLOUR[element.symbol], zorder=4,
        bbox={"boxstyle": "square,pad=0.05", "fc": "white", "ec": "none", "alpha": 0.85},
    )  # fmt: skip
