"""A log in short pieces, and the means of what was recorded over the pulses inside each.

Within a piece what is slow is taken out of every mean as a cubic of time: where the finger
wants to be, the zero of the load cell, gravity.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from scipy.interpolate import BSpline
from scipy.signal import cont2discrete, lfilter

from zwidth.data.identification.device.pulses import count_without_steps, find_strokes
from zwidth.data.logs import Log
from zwidth.data.logs.sensors import beyond
from zwidth.data.logs.table import whole_runs
from zwidth.errors import InputError
from zwidth.native.compiled import Array
from zwidth.quantity.text import shown

if TYPE_CHECKING:
    from numpy.typing import NDArray


class Pieces(NamedTuple):
    """What was recorded, a row for each piece."""

    position: Array
    expected: Array | None
    """[m; rad] as read, and as the perturbation alone would have it."""
    hand: Array | None
    actuator: Array | None
    """[N; N·m]; None where there is none."""
    side: Array
    """sgn ẋ inside strokes; 0 between, where the device turns or rests."""
    runs: tuple[int, ...]
    """How many pieces of each run follow each other."""
    clear: NDArray[np.bool_]
    """Of which pieces the means are taken."""


class Means(NamedTuple):
    """Means over pulses, a row for each."""

    even: Array
    odd: Array
    """ẍ, ẋ, x by the even and by the odd samples."""
    expected: Array | None
    """The same as the perturbation alone would have it; None where it is not known."""
    hand: Array | None
    actuator: Array | None
    actuator_slope: Array | None
    """f_a as it was held, and its rate."""
    side: Array
    turning: Array
    moving: Array
    """sgn ẋ, 0 in turns; the same with a change of sign in the middle of turns; and the part inside
    strokes."""
    piece: NDArray[np.int64]


def pieces_of(log: Log, seconds: float, by_hand: bool) -> Pieces:
    """The log cut into pieces of so many seconds, each within a run; what is left over is not used. Where the
    hand's force answers, no means are taken of a piece in which its sensor is at an end of its range: as a
    whole, since which of its pulses stay must not depend on the force that they show."""
    size = round(seconds / log.sample_period)
    runs = [run for run in whole_runs(log.blocks()) if run.position.size >= size]
    if not runs:
        raise InputError(
            f"{log.source} has no run of {shown(seconds, 's', 6)} without a hole: {log.runs} runs in "
            f"{shown(log.duration, 's', 3)}; record a minute, lose no samples, or take shorter pieces"
        )

    def rows(columns: Iterable[Array | None]) -> Array | None:
        parts = [_cut(c, size) for c in columns if c is not None]
        return np.concatenate(parts) if parts else None

    position, side = rows(r.position for r in runs), rows(_side(r.position, log) for r in runs)
    assert position is not None  # every log has positions
    assert side is not None
    hand, actuator = rows(r.hand_force for r in runs), rows(r.actuator_force for r in runs)
    clear: NDArray[np.bool_] = np.ones(len(position), dtype=bool)
    if by_hand and hand is not None:
        clear = np.logical_not(np.any(beyond(hand, log.stops), axis=1))
    return Pieces(position, None, hand, actuator, side, tuple(r.position.size // size for r in runs), clear)


def response(log: Log, pieces: Pieces, total: Array, delay: float) -> Array:
    """The position that the actuator's force alone would make of mass, damping and stiffness. It only serves
    as instrument and need not be exact: the delay is taken in whole samples."""
    mass, damping, stiffness = (max(float(v), 1e-9) for v in total)
    numerator, denominator, _ = cont2discrete(([-1.0], [mass, damping, stiffness]), log.sample_period, "zoh")
    late = round(delay / log.sample_period)
    assert pieces.actuator is not None  # it is the instrument
    found, first = [], 0
    for count in pieces.runs:
        force = pieces.actuator[first : first + count].ravel()
        force = np.concatenate([np.full(late, force[0]), force])[: force.size] - force.mean()
        found.append(lfilter(numerator[0], denominator, force).reshape(count, -1))
        first += count
    return np.concatenate(found)


def _side(position: Array, log: Log) -> Array:
    """sgn ẋ of each sample inside a stroke, 0 between strokes."""
    count = log.resolution or count_without_steps(position) or 1.0
    strokes = find_strokes(np.floor((position - position[0]) / count + 0.5))
    found = np.zeros(position.size)
    for first, last, side in zip(strokes.first, strokes.last, strokes.side, strict=True):
        found[first:last] = side
    return found


def _cut(values: Array, size: int) -> Array:
    count = values.size // size
    return values[: count * size].reshape(count, size)


def means(pieces: Pieces, shape: Weights, period: float) -> Means | None:
    """Over every pulse inside the pieces; None where none fits."""
    reach = shape.reach
    start = reach + shape.lag
    centres = _centres(pieces.position.shape[1], shape)
    if not centres.size or not pieces.clear.any():
        return None
    odd = (np.arange(-reach, reach + 1) & 1).astype(float)
    hand, actuator = pieces.hand, pieces.actuator
    clear = slice(None) if pieces.clear.all() else pieces.clear  # without a copy where none is left out

    def mean(rows: Array, weights: Array, before: int = reach) -> Array:
        windows = sliding_window_view(rows[clear], weights.size, axis=1)[:, centres - before]
        return np.asarray((windows @ weights).ravel())

    def motion(rows: Array, some: Array | float) -> Array:
        near = rows - rows[:, :1]  # against rounding
        columns = [mean(near, some * w) for w in shape.motion]
        return np.stack(columns, axis=1) / (period**2, period, 1.0)

    return Means(
        motion(pieces.position, 2 * (1 - odd)),
        motion(pieces.position, 2 * odd),
        None if pieces.expected is None else motion(pieces.expected, 1.0),
        None if hand is None else mean(hand, shape.force),
        None if actuator is None else mean(actuator, shape.held, start),
        None if actuator is None else mean(actuator, shape.steps, start) / period,
        mean(pieces.side, shape.force),
        mean(_turning(pieces.side), shape.force),
        mean(np.abs(pieces.side), shape.force),
        np.repeat(np.flatnonzero(pieces.clear), centres.size),
    )


def later(rows: Means, pieces: Pieces, shape: Weights, samples: int) -> Means:
    """The same means with the force of the hand read so many samples later, where the pieces go on so
    long."""
    assert pieces.hand is not None  # it is what may be late
    size, reach = pieces.position.shape[1], shape.reach
    centres = _centres(size, shape)
    inside = centres + reach + samples < size
    hand = pieces.hand[pieces.clear]
    windows = sliding_window_view(hand, shape.force.size, axis=1)[:, centres[inside] - reach + samples]
    kept = np.tile(inside, len(hand))
    found = Means(*(None if column is None else column[kept] for column in rows))  # type: ignore[arg-type]
    return found._replace(hand=(windows @ shape.force).ravel())


def _centres(size: int, shape: Weights) -> NDArray[np.int64]:
    """The samples in the middle of the pulses of a piece."""
    return np.arange(shape.reach + shape.lag, size - shape.reach, shape.piece)


def _turning(side: Array) -> Array:
    """Each 0 replaced by the nearest sign in its row. A count is left by the edge by which it was entered,
    and a device that only turns, under a force that hardly changes, turns in the middle between the two."""
    at = np.broadcast_to(np.arange(side.shape[1]), side.shape)
    before = np.maximum.accumulate(np.where(side != 0, at, 0), axis=1)
    after = np.minimum.accumulate(np.where(side != 0, at, side.shape[1] - 1)[:, ::-1], axis=1)[:, ::-1]
    early, late = (np.take_along_axis(side, where, axis=1) for where in (before, after))
    found: Array = np.where(
        at - before < after - at, early, np.where(at - before > after - at, late, (early + late) / 2)
    )
    return found


# Pulses for a shaken finger: straight between samples, so that sums are integrals.
#
#     φ_k of a cubic B-spline, φ(t) straight between:
#     ∫ φ ẍ = Σ φ_k (x_{k+1} − 2x_k + x_{k−1})/T         whatever x does between
#     ∫ φ x = T Σ φ_k (x_{k−1} + 10 x_k + x_{k+1})/12     where ẍ is constant between, as under a held force
#     ∫ φ ẋ = Σ ½(φ_{k−1} − φ_{k+1}) (14 x_k − x_{k−1} − x_{k+1})/12     the same, ẍ smooth enough
#
# A hand that moves a device in strokes of some hertz does not tell such sums from those of smooth pulses, as
# `pulses` has them; a perturbation of 50 Hz at 1 kHz does, by (ωT)²/12, a per cent of the finger's mass.

_SPLINE = BSpline.basis_element(np.arange(-2.0, 3.0), extrapolate=False)


class Weights(NamedTuple):
    """A pulse as weights of samples, in the mean over it."""

    piece: int
    """h, even: samples of each of its four pieces."""
    reach: int
    """2h + 1: samples from the middle to the first and to the last weight."""
    motion: tuple[Array, Array, Array]
    """Weights that make ẍ T², ẋ T and x."""
    force: Array
    held: Array
    steps: Array
    """Of a held force, and of its rate times T, from −reach − lag on."""
    lag: int
    """Samples by which these begin earlier, for the force that was held comes later than its sample."""


def weights(piece: int, delay: float) -> Weights:
    """The pulse of pieces of h samples, h ≥ 2 and even; `delay` from one to its actuator force [samples]."""
    reach = 2 * piece + 1
    value = np.nan_to_num(_SPLINE(np.arange(-reach, reach + 1) / piece)) / piece
    bend = np.convolve(value, (1, -2, 1), "same")
    slope = np.convolve(np.convolve(value, (-0.5, 0, 0.5), "same"), (-1 / 12, 14 / 12, -1 / 12), "same")
    lag = int(np.ceil(delay)) + 1
    begins = np.arange(-reach - lag, reach + 2) + delay
    steps = -np.diff(np.interp(begins, np.arange(-reach, reach + 1), value))
    place = value + bend / 12
    return Weights(
        piece, reach, (bend, slope, place), place, np.diff(_integral(value, begins + reach)), steps, lag
    )


def _integral(value: Array, at: NDArray[np.floating[Any]]) -> Array:
    """Of the pulse from its first sample on, straight between samples."""
    whole = np.append(0.0, np.cumsum((value[1:] + value[:-1]) / 2))
    inside = np.clip(at, 0.0, value.size - 1.0)
    k = np.minimum(inside.astype(np.int64), value.size - 2)
    u = inside - k
    return np.asarray(whole[k] + value[k] * u + (value[k + 1] - value[k]) * u * u / 2)
