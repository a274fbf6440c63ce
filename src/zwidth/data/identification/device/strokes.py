"""Strokes: where the device surely moves, and which way.

A tick is a sample at which the encoder reads another count than before.  From the first to the
last tick of a row in one direction the device moves, and its friction is f_c + b |v| against it.
Between a row and the next it turns; there, and wherever ticks come late, it may stick: friction
is then whatever holds it, anything up to f_c, and nothing is concluded from such samples.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from zwidth.native.compiled import Array, compiled

if TYPE_CHECKING:
    from numpy.typing import NDArray

SLOWEST = 0.05
"""Speed, in parts of the mean speed, below which the device may have stopped between two ticks."""

LATER = 3
"""Times the neighbouring gap after which a tick is late, and one sample more for each.

From rest at a constant acceleration the first tick takes √2 + 1 times as long as the second."""

NOISE_COUNTS = 8
"""Where the position has no steps: standard deviations of its noise that make a count."""

MEDIAN = 0.6745
"""Of the absolute value of Gaussian noise, in standard deviations."""

FINEST = 1e-5
"""A count where the position has neither steps nor noise, in parts of its range."""

HYSTERESIS = 0.5
"""Parts of a count by which a position without steps must pass an edge."""


class Strokes(NamedTuple):
    """Rows of ticks in one direction.

    Parameters
    ----------
    first, last
        Sample of the first and of the last tick of each.
    side
        +1 into the wall, −1 out of it.
    ticks
        Every tick, as samples.
    """

    first: NDArray[np.int64]
    last: NDArray[np.int64]
    side: Array
    ticks: NDArray[np.int64]


def find_strokes(counts: Array) -> Strokes:
    """The strokes of a run of readings [counts]."""
    change = np.diff(counts)
    before = np.nonzero(change)[0]
    ticks = before + 1
    side = np.sign(change[before])
    if ticks.size < 2:
        nothing = np.empty(0, dtype=np.int64)
        return Strokes(nothing, nothing, np.empty(0), ticks)
    gap = np.diff(ticks)
    mean = np.abs(change).mean()  # counts per sample
    longest = max(LATER, 1 / (SLOWEST * mean))
    endless = np.iinfo(np.int64).max // (2 * LATER)
    beside = np.minimum(np.append(gap[1:], endless), np.append(endless, gap[:-1]))
    cut = (side[1:] != side[:-1]) | (gap > longest) | (gap > LATER * beside + LATER)
    starts = np.append(0, np.nonzero(cut)[0] + 1)
    ends = np.append(np.nonzero(cut)[0], ticks.size - 1)
    return Strokes(ticks[starts], ticks[ends], side[starts], ticks)


def positions(counts: Array, strokes: Strokes) -> Array:
    """The position inside the strokes [counts]; elsewhere the middle of the count.

    Where every sample brings a tick, the middle of the count is all that is known.  Where
    ticks come seldom, each says more: at half a sample before it the device was at the edge.
    Between such edges the position is taken as a cubic with the slopes of the parabolas through
    three of them.
    """
    edges = (counts[strokes.ticks - 1] + counts[strokes.ticks] + 1) / 2
    found = counts + 0.5
    _between_ticks(found, strokes.ticks, edges, strokes.first, strokes.last)
    return found


@compiled
def _between_ticks(
    found: Array,
    ticks: NDArray[np.int64],
    edges: Array,
    first: NDArray[np.int64],
    last: NDArray[np.int64],
) -> None:
    at = 0
    for stroke in range(first.size):
        while ticks[at] < first[stroke]:
            at += 1
        begin = at
        while ticks[at] < last[stroke]:
            at += 1
        if at - begin < 2:
            continue
        for i in range(begin, at):
            gap = ticks[i + 1] - ticks[i]
            if gap == 1:
                continue
            rise = edges[i + 1] - edges[i]
            here = _slope(ticks, edges, begin, at, i) * gap
            there = _slope(ticks, edges, begin, at, i + 1) * gap
            for k in range(ticks[i], ticks[i + 1]):
                u = (k - ticks[i] + 0.5) / gap
                bend = here * (1.0 - u) ** 2 * u - there * u * u * (1.0 - u)
                found[k] = edges[i] + rise * u * u * (3.0 - 2.0 * u) + bend


@compiled
def _slope(ticks: NDArray[np.int64], edges: Array, begin: int, end: int, i: int) -> float:
    """Of the parabola through three edges, at the i-th [counts per sample]."""
    c = min(max(i, begin + 1), end - 1)
    before = (edges[c] - edges[c - 1]) / (ticks[c] - ticks[c - 1])
    after = (edges[c + 1] - edges[c]) / (ticks[c + 1] - ticks[c])
    bend = (after - before) / (ticks[c + 1] - ticks[c - 1])
    slope: float = before + bend * (2 * ticks[i] - ticks[c - 1] - ticks[c])
    return slope


def count_without_steps(position: Array) -> float:
    """What serves as a count where the position has no steps: above its noise [m; rad]."""
    noise = 0.0
    if position.size > 3:  # third differences leave no motion; the median is not led astray by jumps
        noise = float(np.median(np.abs(np.diff(position, 3)))) / (MEDIAN * np.sqrt(20.0))
    return max(NOISE_COUNTS * noise, FINEST * float(np.ptp(position)))


def counted(position: Array, count: float) -> Array:
    """Readings of a position without steps, [counts]: an edge is passed by half a count or not at all."""
    readings = np.empty(position.size)
    _count(position, count, readings)
    return readings


@compiled
def _count(position: Array, count: float, readings: Array) -> None:
    reading = np.floor(position[0] / count)
    for k in range(position.size):
        inside = position[k] / count - reading
        if inside < -HYSTERESIS or inside > 1.0 + HYSTERESIS:
            reading = np.floor(position[k] / count)
        readings[k] = reading
