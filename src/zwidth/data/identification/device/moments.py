"""Sums over strokes, all that an estimate needs, in an amount of memory that does not grow.

    G_s = ½ Σ (A_even A_oddᵀ + A_odd A_evenᵀ)   over the pulses of stroke s,   A = (a, v, sgn v, …, f)

G = Σ_s G_s gives the parameters, and Σ_s G_s ⊗ G_s how much the strokes differ among themselves, which is
what their uncertainty is taken from.  The zero of a load cell drifts: from each piece of some seconds a
straight line is taken out of every column first, so that a line in the force means nothing.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from itertools import chain
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from zwidth.data.identification.device import pulses
from zwidth.data.identification.device.pulses import (
    Pulse,
    Strokes,
    count_without_steps,
    counted,
    find_strokes,
    positions,
    weighed,
)
from zwidth.data.logs import Block, Log
from zwidth.data.logs.sensors import beyond
from zwidth.data.logs.table import joined
from zwidth.native.compiled import Array, compiled

REGRESSORS = (
    "mass",
    "damping",
    "coulomb_friction",
    "spring",
    "quadratic",
    "force_lag",
    "asymmetry",
    "quadratic_asymmetry",
    "slow",
)
"""What a force may be made of: m a, b v, f_c sgn v, k x, c v |v|, −τ df/dt of one that came late; a |v| of
damping that is b + a into the wall and b − a out of it, e v² likewise of c; and s sgn v (1 − |v|/v_s) of
friction that is larger at speeds below v_s (Stribeck)."""

COLUMNS = len(REGRESSORS) + 1

_UPPER = np.triu_indices(COLUMNS)

PAIRS: NDArray[np.int64] = np.zeros((COLUMNS, COLUMNS), dtype=np.int64)
"""Where a pair of columns stands among all pairs, in either order."""
PAIRS[_UPPER] = np.arange(_UPPER[0].size)
PAIRS.T[_UPPER] = PAIRS[_UPPER]


@dataclass
class Moments:
    knee: float
    """v_s [m/s; rad/s]."""
    sum: Array = field(default_factory=lambda: np.zeros((COLUMNS, COLUMNS)))
    """G."""
    square: Array = field(default_factory=lambda: np.zeros((_UPPER[0].size, _UPPER[0].size)))
    """Σ_s G_s ⊗ G_s, as a matrix over the `PAIRS` of columns."""
    strokes: int = 0
    pulses: int = 0
    lines: int = 0
    """Numbers that were fitted to take the lines out."""
    means: Array = field(default_factory=lambda: np.zeros(COLUMNS))
    """Sum over the pieces of the means of the columns."""
    pieces: int = 0

    def add(self, rows: Array, zero: str) -> None:
        """Count in the pulses of one piece, its zero taken out."""
        if not len(rows):
            return
        even, odd = halves(rows, self.knee)
        self.means += (even + odd).mean(axis=0) / 2
        self.pieces += 1
        basis = line(rows, zero)
        even = even - basis @ (basis.T @ even)
        odd = odd - basis @ (basis.T @ odd)
        self.lines += basis.shape[1]
        _, stroke = np.unique(rows[:, pulses.STROKE], return_inverse=True)
        count = int(stroke[-1]) + 1
        parts = np.zeros((count, COLUMNS, COLUMNS))
        _products(parts, even, odd, stroke)
        flat = parts[:, _UPPER[0], _UPPER[1]]
        self.sum += parts.sum(axis=0)
        self.square += flat.T @ flat
        self.strokes += count
        self.pulses += len(rows)


def line(rows: Array, zero: str) -> Array:
    """What the zero of a piece may be, as orthonormal columns: a line, a constant, or nothing."""
    time = rows[:, pulses.TIME]
    columns = {"drifts": 2, "constant": 1, "exact": 0}[zero]
    basis = np.stack([np.ones(len(rows)), time - time.mean()], axis=1)[:, : min(columns, len(rows))]
    return np.linalg.qr(basis)[0]


def halves(rows: Array, knee: float) -> tuple[Array, Array]:
    """The columns of the pulses by the even samples and by the odd ones."""
    found = []
    for a, v in (
        (pulses.EVEN_ACCELERATION, pulses.EVEN_VELOCITY),
        (pulses.ODD_ACCELERATION, pulses.ODD_VELOCITY),
    ):
        speed, side = rows[:, v], rows[:, pulses.SIDE]
        columns = (
            rows[:, a],
            speed,
            side,
            rows[:, pulses.POSITION],
            speed * np.abs(speed),
            -rows[:, pulses.FORCE_SLOPE],
            speed * side,
            speed * speed,
            side * np.maximum(1 - np.abs(speed) / knee, 0.0),
            rows[:, pulses.FORCE],
        )
        found.append(np.stack(columns, axis=1))
    return found[0], found[1]


@compiled
def _products(parts: Array, even: Array, odd: Array, stroke: NDArray[np.int64]) -> None:
    for n in range(even.shape[0]):
        part = parts[stroke[n], :, :]
        for i in range(even.shape[1]):
            for j in range(even.shape[1]):
                part[i, j] += 0.5 * (even[n, i] * odd[n, j] + odd[n, i] * even[n, j])


SECONDS = 10.0
"""Length of a piece: within it the zero of the load cell may drift along a straight line [s]."""


class Piece(NamedTuple):
    position: Array
    """Inside the strokes, between ticks by a cubic [m; rad]."""
    strokes: Strokes
    """Where the device surely moves."""
    block: Block

    def pulses(self, shape: Pulse, period: float) -> Array:
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
    """The strokes in which the sensor of the hand's force is never at the end of its range. A stroke goes as
    a whole: which of its pulses stay must not depend on the force that they show."""
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
