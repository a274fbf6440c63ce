"""Pulses: the equation of motion in mean values, so that nothing is differentiated.

    m ∫φ″ x dt − b ∫φ′ x dt + f_c ∫φ sgn v dt = ∫φ (f_h − f_a) dt

holds for every smooth pulse φ that is zero outside a stroke: integrate m ẍ + b ẋ + f_c sgn ẋ = f_h − f_a by
parts.  The derivatives fall on the pulse, which is known, and not on encoder counts.  Pulses are cubic
B-splines four pieces of h samples long, one every h samples.  Sums over samples stand for the integrals: to
T⁴ and better for φ and φ′, which are smooth enough; for φ″, which has bends at the ends of the pieces, after
the first term of Euler and Maclaurin has been taken out.

Each mean of the position is taken twice, over the even and over the odd samples.  The error of the counts is
not the same in both, so that products of the two are free of its bias.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from zwidth.native.compiled import Array, compiled

if TYPE_CHECKING:
    from numpy.typing import NDArray

PIECES = 4
"""Of a cubic B-spline."""

_FINE = 64
"""Steps of a sample in the mean of a pulse over the time for which a force is held."""

ROWS = 10
(
    EVEN_ACCELERATION,
    ODD_ACCELERATION,
    EVEN_VELOCITY,
    ODD_VELOCITY,
    SIDE,
    POSITION,
    FORCE,
    FORCE_SLOPE,
    TIME,
    STROKE,
) = range(ROWS)
"""Columns of what the pulses give."""


class Pulse(NamedTuple):
    """A pulse as weights of the samples, and of the forces that go with them."""

    piece: int
    """h, even: samples of each of its four pieces."""
    value: Array
    slope: Array
    bend: Array
    """h φ, h² φ′, h³ φ″ at the samples from −2h − 1 to 2h + 1, the last with its correction."""
    hand: Array
    hand_slope: Array
    """h φ and h² φ′ for a force at the samples, `pad` more of them to either side."""
    held: Array
    held_slope: Array
    """The same for a force that is held, in the mean over the time from one to the next."""
    pad: int
    """Samples by which the forces reach farther than the positions."""


def pulse(piece: int, delay: float = 0.0, late: float = 0.0) -> Pulse:
    """The pulse of pieces of h samples, h ≥ 2 and even, so that even and odd samples see the same pulse.
    `delay` ≥ 0 is from a sample to its actuator force, `late` of either sign how much later than positions
    forces were recorded [samples]."""
    reach = _reach(piece)
    at = np.arange(-reach, reach + 1) / piece
    pad = int(np.ceil(delay + abs(late))) + 1
    wide = np.arange(-reach - pad, reach + pad + 1) - late
    fine = wide[:, None] + delay + (np.arange(_FINE) + 0.5) / _FINE
    hand, hand_slope = (shape(wide / piece) for shape in (_value, _slope))
    held, held_slope = (shape(fine / piece).mean(axis=1) for shape in (_value, _slope))
    bend = _bend(at) + _corrections(piece)
    return Pulse(piece, _value(at), _slope(at), bend, hand, hand_slope, held, held_slope, pad)


def _reach(piece: int) -> int:
    """Samples from the middle of a pulse to its last weight."""
    return 2 * piece + 1


def _corrections(piece: int) -> Array:
    """What makes the sums of φ″ x over every second sample as good as the integral. φ‴ jumps by (1, −4, 6,
    −4, 1)/(hT)⁴ at the ends of the pieces. A sum with step 2T is too small by (2T)²/12 of the jump where a
    sample falls on it, and by −(2T)²/24 where it is half way between two."""
    found = np.zeros(2 * _reach(piece) + 1)
    for end, jump in zip(range(-2, 3), (1, -4, 6, -4, 1), strict=True):
        at = _reach(piece) + end * piece
        found[at] += jump / (6 * piece)
        found[at - 1] -= jump / (24 * piece)
        found[at + 1] -= jump / (24 * piece)
    return found


def _value(u: Array) -> Array:
    a = np.abs(u)
    near, far = 2 / 3 - a * a + a**3 / 2, (2 - a) ** 3 / 6
    return np.where(a < 1, near, np.where(a < 2, far, 0.0))


def _slope(u: Array) -> Array:
    a = np.abs(u)
    near, far = -2 * u + 1.5 * u * a, -np.sign(u) * (2 - a) ** 2 / 2
    return np.where(a < 1, near, np.where(a < 2, far, 0.0))


def _bend(u: Array) -> Array:
    a = np.abs(u)
    return np.where(a < 1, 3 * a - 2, np.where(a < 2, 2 - a, 0.0))


def weighed(
    shape: Pulse,
    position: Array,
    strokes: Strokes,
    period: float,
    hand_force: Array | None,
    actuator_force: Array | None,
) -> Array:
    """What each pulse gives, a row for each: of positions inside the strokes [m; rad] and forces [N; N·m]."""
    reach = _reach(shape.piece)
    room = strokes.last - strokes.first - 1 - 2 * reach
    most = int(np.maximum(room // shape.piece + 1, 0).sum())
    rows = np.empty((max(most, 1), ROWS))
    nothing = np.empty(0)
    found = _weigh(
        rows,
        position,
        nothing if hand_force is None else hand_force,
        nothing if actuator_force is None else actuator_force,
        strokes.first,
        strokes.last,
        strokes.side,
        *shape,
        period,
    )
    return rows[:found]


@compiled
def _weigh(
    rows: Array,
    x: Array,
    hand: Array,
    actuator: Array,
    first: NDArray[np.int64],
    last: NDArray[np.int64],
    side: Array,
    h: int,
    value: Array,
    slope: Array,
    bend: Array,
    hand_value: Array,
    hand_slope: Array,
    held: Array,
    held_slope: Array,
    pad: int,
    period: float,
) -> int:
    reach, found, width = 2 * h + 1, 0, h * period
    for stroke in range(first.size):
        begin, end = first[stroke], last[stroke] - 1
        room = end - begin - 2 * reach
        if room < 0:
            continue
        count = room // h + 1
        centre = begin + reach + (room - (count - 1) * h) // 2
        for _ in range(count):
            if centre - reach - pad < 0 or centre + reach + pad >= x.size:
                centre += h
                continue
            middle = x[centre]
            a0, a1, v0, v1, mean, f, df = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
            for k in range(-reach, reach + 1):
                at = k + reach
                moved = x[centre + k] - middle
                mean += value[at] * moved
                if k & 1:
                    a1 += bend[at] * moved
                    v1 -= slope[at] * moved
                else:
                    a0 += bend[at] * moved
                    v0 -= slope[at] * moved
            for k in range(-reach - pad, reach + pad + 1):
                at = k + reach + pad
                if hand.size > 0:
                    f += hand_value[at] * hand[centre + k]
                    df -= hand_slope[at] * hand[centre + k]
                if actuator.size > 0:
                    f -= held[at] * actuator[centre + k]
                    df += held_slope[at] * actuator[centre + k]
            row = rows[found, :]
            row[EVEN_ACCELERATION] = 2.0 * a0 / (h * width * width)
            row[ODD_ACCELERATION] = 2.0 * a1 / (h * width * width)
            row[EVEN_VELOCITY] = 2.0 * v0 / (h * width)
            row[ODD_VELOCITY] = 2.0 * v1 / (h * width)
            row[SIDE] = side[stroke]
            row[POSITION] = middle + mean / h
            row[FORCE] = f / h
            row[FORCE_SLOPE] = df / (h * width)
            row[TIME] = centre * period
            row[STROKE] = stroke
            found += 1
            centre += h
    return found


# Strokes: where the device surely moves, and which way.
#
# A tick is a sample at which the encoder reads another count than before.  From the first to the last tick of
# a row in one direction the device moves, and its friction is f_c + b |v| against it.  Between a row and the
# next it turns; there, and wherever ticks come late, it may stick: friction is then whatever holds it,
# anything up to f_c, and nothing is concluded from such samples.

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
    """Rows of ticks in one direction."""

    first: NDArray[np.int64]
    last: NDArray[np.int64]
    """Sample of the first and of the last tick of each."""
    side: Array
    """+1 into the wall, −1 out of it."""
    ticks: NDArray[np.int64]
    """Every tick, as samples."""


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

    Where every sample brings a tick, the middle of the count is all that is known.  Where ticks come seldom,
    each says more: at half a sample before it the device was at the edge.  Between such edges the position is
    taken as a cubic with the slopes of the parabolas through three of them.
    """
    edges = (counts[strokes.ticks - 1] + counts[strokes.ticks] + 1) / 2
    found = counts + 0.5
    _between_ticks(found, strokes.ticks, edges, strokes.first, strokes.last)
    return found


@compiled
def _between_ticks(
    found: Array, ticks: NDArray[np.int64], edges: Array, first: NDArray[np.int64], last: NDArray[np.int64]
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
            here = _slope_at(ticks, edges, begin, at, i) * gap
            there = _slope_at(ticks, edges, begin, at, i + 1) * gap
            for k in range(ticks[i], ticks[i + 1]):
                u = (k - ticks[i] + 0.5) / gap
                bend = here * (1.0 - u) ** 2 * u - there * u * u * (1.0 - u)
                found[k] = edges[i] + rise * u * u * (3.0 - 2.0 * u) + bend


@compiled
def _slope_at(ticks: NDArray[np.int64], edges: Array, begin: int, end: int, i: int) -> float:
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
