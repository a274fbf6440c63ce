"""One chunk of a sweep: springs by closed conditions, walls line by line, every other loop by itself."""

from __future__ import annotations

from collections import defaultdict

import numpy as np

from zwidth.errors import InputError
from zwidth.study.chunks.layout import Layers, Place
from zwidth.study.sweeps.columns import REFUSED
from zwidth.study.sweeps.questions import Line
from zwidth.study.sweeps.request import Request
from zwidth.study.sweeps.walls import FEWEST, parts

Cell = tuple[tuple[int, ...], tuple[int, ...]]
"""Where a loop is in its chunk, and among all."""


def compute(asked: Request, place: Place) -> Layers:
    """Every layer of one chunk, by the name of its array."""
    cells = asked.cells(place)
    ranges = [range(*one.indices(len(own.values))) for one, own in zip(cells, asked.axes, strict=True)]
    shape = tuple(map(len, ranges))
    if asked.springs is None:
        layers: Layers = {name: np.zeros(shape, own.kind) for name, own in asked.columns.items()}
        left = list(np.ndindex(shape))
    else:
        decided = asked.springs.layers(cells, shape, asked.columns)
        layers, left = decided.layers, list(map(tuple, np.argwhere(~decided.sure)))
    lines: defaultdict[tuple[int, ...], list[Cell]] = defaultdict(list)
    for cell in left:
        place = tuple(own[n] for own, n in zip(ranges, cell, strict=True))
        lines[tuple(n for k, n in enumerate(place) if k != asked.stiffness_axis)].append((cell, place))
    for loops in lines.values():
        line: Line = {}
        for cell, place in _alone(asked, layers, loops, line):
            _one(asked, layers, cell, place, line)
    return layers


def _alone(asked: Request, layers: Layers, loops: list[Cell], line: Line) -> list[Cell]:
    """The loops of a line that must be asked by themselves, once what is known of walls is filled in."""
    if not asked.of_walls or len(loops) < FEWEST:
        return loops
    assert asked.stiffness_axis is not None
    values = asked.axes[asked.stiffness_axis].values
    try:
        known = parts(asked.at(loops[0][1]), np.array([values[p[asked.stiffness_axis]] for _, p in loops]))
    except InputError:
        return loops
    left = np.ones(len(loops), bool)
    for part in known:
        cell, place = loops[int(part.places.min())]
        _one(asked, layers, cell, place, line)
        told = {name: layers[name][cell] for name in asked.columns}
        if any(told[name] != asked.columns[name].kept(word) for name, word in part.about.items()):
            continue
        sure = part.binding > 0
        cells = tuple(np.array([loops[n][0] for n in part.places[sure]]).T)
        for name, value in told.items():
            layers[name][cells] = part.binding[sure] if name == "binding" else value
        left[part.places[sure]] = False
    return [loop for loop, alone in zip(loops, left, strict=True) if alone]


def _one(asked: Request, layers: Layers, cell: tuple[int, ...], place: tuple[int, ...], line: Line) -> None:
    """Ask about one loop; one that cannot be has no answer."""
    columns = asked.columns
    try:
        answer = {**asked.question.answer(asked.at(place), line), REFUSED: False}
    except InputError:
        answer = {name: () if own.several else None for name, own in columns.items()} | {REFUSED: True}
    for name, own in columns.items():
        layers[name][cell] = own.kept(answer[name])
