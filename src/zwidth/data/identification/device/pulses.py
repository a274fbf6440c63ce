"""Pulses: the equation of motion in mean values, so that nothing is differentiated.

    m ∫φ″ x dt − b ∫φ′ x dt + f_c ∫φ sgn v dt = ∫φ (f_h − f_a) dt

holds for every smooth pulse φ that is zero outside a stroke: integrate m ẍ + b ẋ + f_c sgn ẋ =
f_h − f_a by parts.  The derivatives fall on the pulse, which is known, and not on encoder
counts.  Pulses are cubic B-splines four pieces of h samples long, one every h samples.  Sums
over samples stand for the integrals: to T⁴ and better for φ and φ′, which are smooth enough; for
φ″, which has bends at the ends of the pieces, after the first term of Euler and Maclaurin
has been taken out.

Each mean of the position is taken twice, over the even and over the odd samples.  The error of
the counts is not the same in both, so that products of the two are free of its bias.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from zwidth.data.identification.device.strokes import Strokes
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
    """A pulse as weights of the samples, and of the forces that go with them.

    Parameters
    ----------
    piece
        h, even: samples of each of its four pieces.
    value, slope, bend
        h φ, h² φ′, h³ φ″ at the samples from −2h − 1 to 2h + 1, the last with its correction.
    hand, hand_slope
        h φ and h² φ′ for a force at the samples, `pad` more of them to either side.
    held, held_slope
        The same for a force that is held, in the mean over the time from one to the next.
    pad
        Samples by which the forces reach farther than the positions.
    """

    piece: int
    value: Array
    slope: Array
    bend: Array
    hand: Array
    hand_slope: Array
    held: Array
    held_slope: Array
    pad: int


def pulse(piece: int, delay: float = 0.0, late: float = 0.0) -> Pulse:
    """The pulse of pieces of so many samples.

    Parameters
    ----------
    piece
        h ≥ 2, even, so that even and odd samples see the same pulse.
    delay
        From a sample to its actuator force [samples], ≥ 0.
    late
        By which forces were recorded later than positions [samples], either sign.
    """
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
    """What makes the sums of φ″ x over every second sample as good as the integral.

    φ‴ jumps by (1, −4, 6, −4, 1)/(hT)⁴ at the ends of the pieces.  A sum with step 2T is too small by
    (2T)²/12 of the jump where a sample falls on it, and by −(2T)²/24 where it is half way between two.
    """
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
