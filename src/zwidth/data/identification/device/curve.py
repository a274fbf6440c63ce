"""A friction curve that lies below the data: lower bounds of the mean friction, in bins of speed and each
way.

    f_i = f̄_i − t σ_i        σ_i² = n/(n − 1) Σ_s (Σ_{k ∈ s} r_k)² / N_i²

with f̄_i the mean friction of the N_i pulses against their motion, r_k what a straight line of speed leaves
of that of pulse k, s the n strokes that have pulses in the bin.  What one stroke has too much of counts
once, however many pulses it has.  Where friction bends up, a mean over a bin lies above it by ½ f″ var v,
and the chord to the next bin by f″ h²/8 at most: both are taken off, with f″ from three neighbouring bins.
A first point, at rest, is a lower bound of where a parabola through the slower half begins.

A line f_c + b |v| is below friction to and fro where

    f_c ≤ ½ min_v (f_in(v) − b v) + ½ min_v (f_out(v) − b v):

only the mean of both directions counts, as what they differ by does no work to and fro, but each has a
speed of its own: a hand may be quick one way and slow the other.  So the curve that counts is f((v + v′)/2)
= ½ (f_in(v) + f_out(v′)), the smallest over all such pairs.

Half the risk is that of the slope at the largest speed; the bounds share the other half (Bonferroni).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from scipy.special import stdtrit

from zwidth.errors import InputError
from zwidth.model.device.friction import FrictionCurve

if TYPE_CHECKING:
    import xarray as xr

    from zwidth.loop.trace import AnyTrace
    from zwidth.native.compiled import Array

FEWEST_STROKES = 8
"""In a bin: fewer say too little about their own scatter."""

STROKES_BEYOND = 32
"""Strokes that went beyond a speed up to which friction is known: the slope there is then known too."""

SHARE_BEYOND = 4
"""Of fewer strokes in all, one in so many."""

DIRECTIONS = ("inward", "outward")


class Side(NamedTuple):
    """The pulses of one direction, slow ones first."""

    speed: Array
    """|v| of each [m/s; rad/s]."""
    friction: Array
    """Against the motion [N; N·m]."""
    stroke: Array
    """To which each belongs."""

    def parts(self, bins: int) -> list[Side]:
        """The same in bins of speed, each with as many pulses."""
        return [Side(*part) for part in zip(*(np.array_split(c, bins) for c in self), strict=True)]


def sides(points: AnyTrace) -> tuple[Side, Side]:
    velocity = points["speed"].values
    order = np.argsort(np.abs(velocity), kind="stable")
    friction = (points["friction"].values * np.sign(velocity))[order]
    speed, stroke, inward = np.abs(velocity)[order], points["stroke"].values[order], velocity[order] > 0
    into, out = (Side(speed[way], friction[way], stroke[way]) for way in (inward, ~inward))
    return into, out


def fastest(points: AnyTrace) -> tuple[float, float]:
    """The speed that 32 strokes, or a quarter of them, went beyond, into the wall and out of it [m/s; rad/s].
    0 where there are none."""
    into, out = (_fastest(side) for side in sides(points))
    return into, out


def _fastest(side: Side) -> float:
    if not side.speed.size:
        return 0.0
    _, member = np.unique(side.stroke, return_inverse=True)
    most = np.zeros(int(member.max()) + 1)
    np.maximum.at(most, member, side.speed)
    rank = min(STROKES_BEYOND, -(-most.size // SHARE_BEYOND))
    return float(np.sort(most)[-rank])


def friction_bins(points: AnyTrace, bins: int) -> xr.Dataset:
    """Mean speed and mean friction by direction and speed, each bin with as many pulses of its direction. So
    many bins each way, fewer where one would have less than eight strokes; along `direction`, "inward" and
    "outward", and `bin`: speed, friction, its standard error, and the strokes in it."""
    import xarray as xr

    table = np.array([[mean[:4] for mean in way] for way in _binned(sides(points), bins)], dtype=np.float64)
    about = {
        "speed": (points["speed"].attrs["units"], "mean speed"),
        "friction": (points["friction"].attrs["units"], "mean friction"),
        "error": (points["friction"].attrs["units"], "standard error"),
        "strokes": ("1", "strokes in the bin"),
    }
    along = ("direction", "bin")
    columns = {
        name: (along, table[:, :, k], {"units": unit, "long_name": text})
        for k, (name, (unit, text)) in enumerate(about.items())
    }
    return xr.Dataset(columns, coords={"direction": list(DIRECTIONS)})


class _Mean(NamedTuple):
    """Friction of some pulses at one speed, by a polynomial through them."""

    speed: float
    friction: float
    error: float
    strokes: int
    variance: float

    def low(self, confidence: float) -> float:
        """What it is at least."""
        return self.friction - float(stdtrit(max(self.strokes - 1, 1), confidence)) * self.error


def _binned(ways: tuple[Side, Side], bins: int) -> list[list[_Mean]]:
    """Friction in the bins of each direction, as many both ways."""
    while True:
        found = [[_mean(part, part.speed.mean(), 1) for part in side.parts(bins)] for side in ways]
        if bins == 1 or min(mean.strokes for way in found for mean in way) >= FEWEST_STROKES:
            return found
        bins -= 1


def _mean(side: Side, speed: float, degree: int) -> _Mean:
    """Friction at a speed, by a polynomial of this degree; its error from the scatter of the strokes."""
    if side.speed.size <= degree:
        raise InputError("the strokes are too few for a friction curve: record longer, to and fro")
    away = (side.speed - speed) / (float(np.ptp(side.speed)) or 1.0)
    columns = np.stack([away**k for k in range(degree + 1)], axis=1)
    inverse = np.linalg.pinv(columns)
    values = inverse @ side.friction
    pulls = inverse[0] * (side.friction - columns @ values)
    _, member = np.unique(side.stroke, return_inverse=True)
    sums = np.bincount(member, pulls)
    error = float(np.sqrt(sums.size / max(sums.size - 1, 1) * (sums @ sums)))
    return _Mean(float(speed), float(values[0]), error, sums.size, float(side.speed.var()))


def _bend_up(means: list[_Mean]) -> Array:
    """By how much the bins may lie above friction where it bends up [N; N·m]."""
    if len(means) < 3:
        return np.zeros(len(means))
    speed, friction = (np.array([mean[k] for mean in means]) for k in (0, 1))
    gap = np.diff(speed)
    half_bend = np.diff(np.diff(friction) / gap) / (speed[2:] - speed[:-2])
    nearby = np.pad(half_bend, 1, mode="edge")
    wide = np.maximum(np.append(gap, 0.0), np.append(0.0, gap))
    variance = np.array([mean.variance for mean in means])
    return np.asarray(np.maximum(nearby, 0.0) * (variance + wide**2 / 4))


def curve_below(points: AnyTrace, confidence: float, bins: int, steepest: float) -> FrictionCurve:
    """The lower bounds as a friction curve with this slope [N·s/m; N·m·s/rad] beyond the largest speed."""
    if not 0 < confidence < 1:
        raise InputError(
            f"confidence must be between 0 and 1, got {confidence!r}: it is how often all the bounds hold"
        )
    if not bins >= 2:
        raise InputError(f"a friction curve needs two bins of speed or more, got {bins!r}")
    into, out = (_bounds(*both) for both in lower_bounds(points, confidence, bins))
    pairs = np.array([[(v + w) / 2, (f + g) / 2] for v, f in into for w, g in out])
    speeds, forces = _hull(pairs)
    end = 1.01 * speeds[-1]
    last = forces[-1] + max(steepest, 0.0) * (end - speeds[-1])
    return FrictionCurve([*speeds, end], np.maximum([*forces, last], 0.0).tolist())


def _bounds(speed: Array, low: Array) -> list[tuple[float, float]]:
    return list(zip(speed.tolist(), low.tolist(), strict=True))


def lower_bounds(points: AnyTrace, confidence: float, bins: int) -> list[tuple[Array, Array]]:
    """Each way, the speeds from rest on, and what friction is at least, all together [N; N·m]."""
    ways = sides(points)
    found = _binned(ways, bins)
    each = 1 - (1 - confidence) / 2 / sum(len(way) + 1 for way in found)
    below = []
    for side, means in zip(ways, found, strict=True):
        rest = _mean(side.parts(2)[0], 0.0, 2)
        low = np.array([mean.low(each) for mean in means]) - _bend_up(means)
        below.append((np.array([0.0, *(mean.speed for mean in means)]), np.append(rest.low(each), low)))
    return below


def _hull(points: Array) -> tuple[list[float], list[float]]:
    """The corners of the largest convex curve that is not above any point."""
    kept: list[Array] = []
    for point in points[np.lexsort((points[:, 1], points[:, 0]))]:
        if kept and point[0] <= kept[-1][0]:
            continue
        while len(kept) > 1 and _above(kept[-2], kept[-1], point):
            kept.pop()
        kept.append(point)
    speeds, forces = np.array(kept).T.tolist()
    return speeds, forces


def _above(before: Array, middle: Array, after: Array) -> bool:
    """True where the middle one is not below the chord."""
    (x0, y0), (x1, y1), (x2, y2) = before, middle, after
    return bool((y1 - y0) * (x2 - x0) >= (y2 - y0) * (x1 - x0))
