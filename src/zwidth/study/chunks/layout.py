"""Arrays over the same axes, computed and kept in blocks of cells: chunks."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from itertools import product
from typing import Any

import numpy as np
from numpy.typing import NDArray

Place = tuple[int, ...]
"""Which chunk, counted along each axis."""

Layers = dict[str, NDArray[Any]]
"""Numbers of one chunk, or of all cells, by the name of their array."""


@dataclass(frozen=True)
class Layout:
    """What arrays there are, over which axes, and what they are of.

    Parameters
    ----------
    what, format
        What the arrays are together, in a word for messages; the name and version of how they are kept.
    digest, request
        A name for what was asked, another for whatever has other numbers; the same as JSON holds it.
    axes
        The values along each axis, by its name.
    chunk
        Cells along each axis that are computed and kept at a time.
    types
        The arrays and the type of their numbers.
    about
        What is said of an array or an axis beside its numbers, such as its unit.
    """

    what: str
    format: str
    digest: str
    request: Mapping[str, Any]
    axes: Mapping[str, NDArray[np.float64]]
    chunk: tuple[int, ...]
    types: Mapping[str, str]
    about: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)

    @property
    def shape(self) -> tuple[int, ...]:
        """Cells along each axis."""
        return tuple(len(values) for values in self.axes.values())

    @property
    def chunks(self) -> tuple[int, ...]:
        """How many chunks there are along each axis."""
        return tuple(-(-cells // size) for cells, size in zip(self.shape, self.chunk, strict=True))

    @property
    def places(self) -> list[Place]:
        """Every chunk."""
        return list(product(*map(range, self.chunks)))

    def cells(self, place: Place) -> tuple[slice, ...]:
        """The cells of one chunk among all."""
        return cells(place, self.chunk)


def cells(place: Place, chunk: tuple[int, ...]) -> tuple[slice, ...]:
    """The cells of one chunk among all."""
    return tuple(slice(n * size, (n + 1) * size) for n, size in zip(place, chunk, strict=True))
