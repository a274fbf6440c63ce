"""Motions that a one-sided wall sustains: periodic, each sample inside or outside, solved and not simulated.

    f = K max(x − g, 0),    x(j) = −Σ G_n(j − i) f(i),    i, j over one period of n samples

For a given pattern of samples inside this is linear in x.  The pattern is guessed from simulated motions and
corrected until the solution has the pattern it was computed for (Newton's method for a piecewise linear
equation).  Then it is solved once more with error bounds, and the signs of all x − g are certain.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from flint import arb, arb_mat, ctx, fmpq
from numpy.typing import NDArray
from scipy.signal import tf2ss

from zwidth.passivity.absolute.plant import Plant
from zwidth.passivity.checker.absolute_plant import read_plant

_STARTS = 36
_SETTLING = 6000
_CANDIDATES = 10
_CORRECTIONS = 40
_HALVINGS = 14
_PRECISION = 256
_RUNS = 4
_LARGEST = 1e6
_LOST = 1e300
_NEAR = (1.001, 1.002, 1.005, 1.01, 1.02, 1.05, 1.12, 1.25, 1.5)
_FACTORS = (*_NEAR, 1.75, 2.0, 2.5, 3.0, 4.0, 5.0, 5.5, 6.0, 7.0, 8.0, 10.0)
_SMALLEST = 1e-6
"""Of |gap|: a smaller swing is rest."""

Array = NDArray[np.float64]


class PeriodicMotion(NamedTuple):
    """A motion that repeats itself for ever, without any force from outside.

    `positions` are from where the hand rests without a wall; the wall begins at `gap`. `growth` is the
    largest factor by which a small deviation grows in one period: below 1 the motion attracts. `basin` is the
    share of the simulated starts that did not come to rest.
    """

    slope: float
    gap: float
    positions: tuple[float, ...]
    growth: float
    basin: float

    @property
    def period(self) -> int:
        """In samples."""
        return len(self.positions)

    @property
    def inside(self) -> tuple[bool, ...]:
        """Which samples find the wall."""
        return tuple(x > self.gap for x in self.positions)

    @property
    def swing(self) -> float:
        """From the outermost to the innermost sample."""
        return max(self.positions) - min(self.positions)


def periodic_motion(plant: Plant, slope: float, gap: float, longest: int = 120) -> PeriodicMotion | None:
    """A periodic motion of at most `longest` samples, its pattern certain; None if none was found.

    Parameters
    ----------
    plant
        G.
    slope
        K > 0 of the wall.
    gap
        From where the hand rests to the surface, ≠ 0; < 0 for a hand that presses.
    longest
        Longest period tried [samples].
    """
    runs = _simulated(plant, slope, gap)
    alive = [run for run in runs if np.ptp(run) > _SMALLEST * abs(gap)]
    finite = [run for run in alive if np.abs(run).max() < _LARGEST * abs(gap)]
    found: PeriodicMotion | None = None
    for run in finite[:: max(1, len(finite) // _RUNS)]:
        for period in _returns(run, longest):
            positions = _corrected(plant, slope, gap, run[-period:])
            if positions is None or np.ptp(positions) <= _SMALLEST * abs(gap):
                continue
            growth = _growth(plant, slope, positions > gap)
            if found is not None and growth >= min(found.growth, 1.0):
                continue
            if _is_certain(plant, slope, gap, positions > gap):
                share = len(alive) / len(runs)
                found = PeriodicMotion(slope, gap, tuple(positions.tolist()), growth, share)
                if growth < 1:
                    return found
    return found


def smallest_motion(plant: Plant, low: float, gap: float, longest: int = 120) -> PeriodicMotion | None:
    """The periodic motion of the smallest slope found, a few slopes from `low` up to ten times as much tried.

    Not the smallest there is: between those slopes, and with longer periods, there are others.
    """
    for factor in _FACTORS:
        found = periodic_motion(plant, low * factor, gap, longest)
        if found is not None:
            return _softened(plant, found, low)
    return None


def _softened(plant: Plant, motion: PeriodicMotion, low: float) -> PeriodicMotion:
    """The same motion, followed to the smallest slope down to which it exists."""
    best = motion
    for _ in range(_HALVINGS):
        slope = (low + best.slope) / 2
        positions = _corrected(plant, slope, motion.gap, np.array(best.positions))
        if positions is None or not _moves(plant, slope, motion.gap, positions):
            low = slope
            continue
        growth = _growth(plant, slope, positions > motion.gap)
        best = motion._replace(slope=slope, positions=tuple(positions.tolist()), growth=growth)
    return best


def _moves(plant: Plant, slope: float, gap: float, positions: Array) -> bool:
    """True for a motion, not rest, whose pattern is certain."""
    if np.ptp(positions) <= _SMALLEST * abs(gap):
        return False
    return _is_certain(plant, slope, gap, positions > gap)


def _simulated(plant: Plant, slope: float, gap: float) -> list[Array]:
    """The last samples of motions from starts all around."""
    a, b, c, _ = tf2ss(plant.numerator, plant.denominator)
    rng = np.random.default_rng(0)
    state = rng.normal(size=(len(a), _STARTS))
    reach = np.zeros(_STARTS)
    free = state.copy()
    for _ in range(200):  # the scale of a start is how far it would swing without a wall
        reach = np.maximum(reach, np.abs(c @ free)[0])
        free = a @ free
    state *= abs(gap) * np.logspace(0.2, 3.5, _STARTS) / reach
    kept = np.empty((_SETTLING, _STARTS))
    with np.errstate(over="ignore", invalid="ignore"):
        for j in range(_SETTLING):
            kept[j] = (c @ state)[0]
            state = a @ state - b @ (slope * np.maximum(kept[j] - gap, 0.0))[None, :]
    kept = np.nan_to_num(kept[-_SETTLING // 4 :], nan=_LOST, posinf=_LOST, neginf=-_LOST)
    return [kept[:, i] for i in range(_STARTS)]


def _returns(run: Array, longest: int) -> list[int]:
    """Periods after which the run nearly repeats, the best first."""
    errors = {n: float(np.abs(run[n:] - run[:-n]).max()) for n in range(2, longest + 1)}
    return sorted(errors, key=errors.__getitem__)[:_CANDIDATES]


def _corrected(plant: Plant, slope: float, gap: float, positions: Array) -> Array | None:
    n = len(positions)
    angles = 2 * np.pi * np.arange(n) / n
    kernel = np.fft.ifft(plant.response(angles)).real
    moved = kernel[(np.arange(n)[:, None] - np.arange(n)[None, :]) % n]
    inside = positions > gap
    tried: set[bytes] = set()
    while inside.tobytes() not in tried and len(tried) < _CORRECTIONS:
        tried.add(inside.tobytes())
        force = moved * (slope * inside)
        try:
            positions = np.linalg.solve(np.eye(n) + force, gap * force.sum(axis=1))
        except np.linalg.LinAlgError:
            return None
        if ((positions > gap) == inside).all():
            return positions
        inside = positions > gap
    return None


def _is_certain(plant: Plant, slope: float, gap: float, inside: NDArray[np.bool_]) -> bool:
    """D x + K N s (x − g) = 0 around the period, solved in balls: every sample on its side of the surface."""
    enclosed = read_plant(plant.source)
    n = len(inside)
    saved = ctx.prec
    try:
        ctx.prec = _PRECISION
        top, bottom = (
            [arb(_ball(m), _ball(r)) for m, r in zip(part.middle, part.radius, strict=True)]
            for part in enclosed
        )
        rows = [[arb(0)] * n for _ in range(n)]
        right = [arb(0) for _ in range(n)]
        stiff, far = arb(slope), arb(gap)
        for j in range(n):
            for lead, own in enumerate(bottom):
                rows[j][(j + lead) % n] += own
            for lead, own in enumerate(top):
                i = (j + lead) % n
                if inside[i]:
                    rows[j][i] += stiff * own
                    right[j] += stiff * own * far
        try:
            found = arb_mat(rows).solve(arb_mat([[x] for x in right]))
        except ZeroDivisionError:
            return False
        return all(bool(found[j, 0] > far if inside[j] else found[j, 0] < far) for j in range(n))
    finally:
        ctx.prec = saved


def _ball(value: object) -> arb:
    return arb(fmpq(value.numerator, value.denominator))  # type: ignore[attr-defined]


def _growth(plant: Plant, slope: float, inside: NDArray[np.bool_]) -> float:
    a, b, c, _ = tf2ss(plant.numerator, plant.denominator)
    total = np.eye(len(a))
    for touches in inside:
        total = (a - slope * b @ c if touches else a) @ total
    return float(np.abs(np.linalg.eigvals(total)).max())
