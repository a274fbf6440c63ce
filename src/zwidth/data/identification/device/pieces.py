"""A log cut into pieces of some seconds, each turned into pulses; never more than that in memory."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import chain
from typing import NamedTuple

import numpy as np

from zwidth.data.identification.device.pulses import Pulse, weighed
from zwidth.data.identification.device.strokes import (
    Strokes,
    count_without_steps,
    counted,
    find_strokes,
    positions,
)
from zwidth.data.logs import Block, Log
from zwidth.data.logs.block import joined
from zwidth.data.logs.stops import beyond
from zwidth.native.compiled import Array

SECONDS = 10.0
"""Length of a piece: within it the zero of the load cell may drift along a straight line [s]."""


class Piece(NamedTuple):
    """A stretch of a run.

    Parameters
    ----------
    position
        Inside the strokes, between ticks by a cubic [m; rad].
    strokes
        Where the device surely moves.
    block
        What was recorded.
    """

    position: Array
    strokes: Strokes
    block: Block

    def pulses(self, shape: Pulse, period: float) -> Array:
        """A row for each pulse, see `pulses`."""
        return weighed(
            shape, self.position, self.strokes, period, self.block.hand_force, self.block.actuator_force
        )


def pieces(log: Log) -> Iterator[Piece]:
    """The log in pieces of `SECONDS`, shorter at the end of a run."""
    size = max(round(SECONDS / log.sample_period), 1)
    count = log.resolution
    for block in _cut(log.blocks(), size):
        if not count:
            count = count_without_steps(block.position)
        yield _piece(block, log.resolution, count, log.stops)


def _piece(block: Block, resolution: float, count: float, stops: tuple[float, float]) -> Piece:
    if count == 0:  # it does not move
        return Piece(block.position, find_strokes(np.zeros(block.position.size)), block)
    origin = block.position[0]
    if resolution == 0:
        strokes = find_strokes(counted(block.position - origin, count))
        return Piece(block.position, _within_range(strokes, block, stops), block)
    counts = np.rint((block.position - origin) / resolution)
    strokes = _within_range(find_strokes(counts), block, stops)
    return Piece(positions(counts, strokes) * resolution + origin, strokes, block)


def _within_range(strokes: Strokes, block: Block, stops: tuple[float, float]) -> Strokes:
    """The strokes in which the sensor of the hand's force is never at the end of its range.

    A stroke goes as a whole: which of its pulses stay must not depend on the force that they show.
    """
    if block.hand_force is None or not np.isfinite(stops).any():
        return strokes
    so_far = np.cumsum(beyond(block.hand_force, stops))
    clear = so_far[strokes.last] == np.where(strokes.first > 0, so_far[strokes.first - 1], 0)
    return strokes._replace(first=strokes.first[clear], last=strokes.last[clear], side=strokes.side[clear])


def _cut(blocks: Iterator[Block], size: int) -> Iterator[Block]:
    """The same samples in stretches of `size`, each within a run."""
    kept: list[Block] = []
    held = 0
    for block in chain(blocks, [None]):
        if kept and (block is None or block.run != kept[0].run):
            yield joined(kept)
            kept, held = [], 0
        if block is None:
            return
        while held + block.time.size >= size:
            at = size - held
            taken, block = block.part(slice(None, at)), block.part(slice(at, None))
            yield joined([*kept, taken])
            kept, held = [], 0
        if block.time.size:
            kept.append(block)
            held += block.time.size
