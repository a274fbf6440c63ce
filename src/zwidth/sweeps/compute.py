"""One chunk of a sweep: springs by their closed conditions, every other loop by itself."""

from __future__ import annotations

from collections import defaultdict

import numpy as np

from zwidth.chunks.layout import Layers, Place
from zwidth.errors import InputError
from zwidth.sweeps.columns import REFUSED
from zwidth.sweeps.questions import Line
from zwidth.sweeps.request import Request


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
    lines: defaultdict[tuple[int, ...], Line] = defaultdict(dict)
    for cell in left:
        place = tuple(own[n] for own, n in zip(ranges, cell, strict=True))
        line = lines[tuple(n for k, n in enumerate(place) if k != asked.stiffness_axis)]
        _one(asked, layers, cell, place, line)
    return layers


def _one(asked: Request, layers: Layers, cell: tuple[int, ...], place: tuple[int, ...], line: Line) -> None:
    """Ask about one loop; one that cannot be has no answer."""
    columns = asked.columns
    try:
        answer = {**asked.question.answer(asked.at(place), line), REFUSED: False}
    except InputError:
        answer = {name: () if own.several else None for name, own in columns.items()} | {REFUSED: True}
    for name, own in columns.items():
        layers[name][cell] = own.kept(answer[name])
