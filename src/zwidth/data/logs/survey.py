"""The first look at a log, once through: how many samples, how even their stamps, what range, which step."""

from __future__ import annotations

from collections.abc import Iterable
from math import inf
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from zwidth.data.logs.runs import Segment
from zwidth.data.logs.steps import FEWEST, Grid, grid_of, offset_on, on_grid
from zwidth.data.logs.stops import Stops
from zwidth.data.logs.wraps import Jumps
from zwidth.errors import InputError

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

_LEVELS = 64
"""Different positions after which the step is looked for."""

_LONG = 4096
"""Samples whose mean interval shows that the rate is another one."""


class Intervals(NamedTuple):
    """Sums over the intervals between stamps.

    Parameters
    ----------
    number
        How many.
    elapsed
        [s] of all together.
    squares
        [s²] of how much each is longer than T.
    shortest, longest
        [s] of them.
    latest
        [s] stamp that is farthest from 0.
    """

    number: int = 0
    elapsed: float = 0.0
    squares: float = 0.0
    shortest: float = inf
    longest: float = -inf
    latest: float = 0.0

    def and_those(self, time: Array, before: float, period: float) -> Intervals:
        """With those of a stretch, which begins after the stamp `before`; NaN where it begins a run."""
        start = float(time[0] if np.isnan(before) else before)
        steps = np.diff(time)
        if not np.isnan(before):
            steps = np.append(steps, time[0] - before)
        latest = max(self.latest, abs(float(time[-1])), abs(start))
        if steps.size == 0:
            return self._replace(latest=latest)
        late = steps - period
        return Intervals(
            self.number + steps.size,
            self.elapsed + float(time[-1] - start),
            self.squares + float(late @ late),
            min(self.shortest, float(steps.min())),
            max(self.longest, float(steps.max())),
            latest,
        )


class Survey:
    """What the segments of a log have in common.

    Parameters
    ----------
    period
        [s] roughly T.
    resolution
        [m; rad] as stated, or None.
    unit
        [m; rad] of the numbers in the file.
    source
        For messages.
    """

    def __init__(self, period: float, resolution: float | None, unit: float, source: str) -> None:
        self.period, self.stated, self.unit, self.source = period, resolution, unit, source
        self.samples = self.runs = 0
        self.intervals = Intervals()
        self.ranges: dict[str, tuple[float, float]] = {}
        self.jumps = Jumps()
        self.stops = Stops()
        self.grid: Grid | None = None
        self.found: Grid | None = None
        self.sought, self.off_grid = False, 0
        self._levels = np.empty(0)
        self._before = np.nan

    def look(self, segments: Iterable[Segment]) -> None:
        """Look at every segment, in their order."""
        for segment in segments:
            self.samples += segment.rows.time.size
            self.runs += segment.begins
            self._stamps(segment.rows.time, segment.begins)
            self.jumps.take(segment.rows.position, follows=not segment.begins)
            self._position(segment.rows.position)
            for name in ("hand_force", "actuator_force"):
                self._force(name, getattr(segment.rows, name))
        if not self.sought:
            self._seek()

    @property
    def mean_interval(self) -> float:
        """[s] over all runs."""
        return self.intervals.elapsed / self.intervals.number if self.intervals.number else self.period

    @property
    def deviation(self) -> float:
        """[s] standard deviation of the intervals between stamps."""
        if not self.intervals.number:
            return 0.0
        mean = self.intervals.squares / self.intervals.number
        return float(np.sqrt(max(0.0, mean - (self.mean_interval - self.period) ** 2)))

    def _stamps(self, time: Array, begins: bool) -> None:
        self.intervals = self.intervals.and_those(time, np.nan if begins else self._before, self.period)
        self._before = float(time[-1])
        _refuse_other_rate(time, self.period, self.source)

    def _position(self, position: Array) -> None:
        if not self.sought:
            self._levels = np.unique(np.concatenate((self._levels, position)))
            if self._levels.size >= _LEVELS:
                self._seek()
        elif self.grid is not None:
            self.off_grid += position.size - on_grid(position, self.grid)

    def _seek(self) -> None:
        """Find the step in the positions so far; a stated one holds if they lie on it."""
        self.sought = True
        self.grid = self.found = grid_of(self._levels, self.unit)
        if self.stated is None or self._levels.size == 0:
            return
        stated = Grid(self.stated, offset_on(self._levels, self.stated))
        fits = on_grid(self._levels, stated) > 0.995 * self._levels.size
        coarser = self.found is not None and self.found.step > 1.5 * self.stated
        if fits and not coarser:
            self.grid = stated
        elif self._levels.size < FEWEST or (self.found is not None and self.found.step < 0.3 * self.stated):
            self.grid = stated if fits else None

    def _force(self, name: str, force: Array | None) -> None:
        if force is not None:
            low, high = self.ranges.get(name, (np.inf, -np.inf))
            self.ranges[name] = min(low, float(force.min())), max(high, float(force.max()))
            if name == "hand_force":
                self.stops.take(force)


def _refuse_other_rate(time: Array, period: float, source: str) -> None:
    """Refuse stamps that many samples later have another mean interval."""
    means = np.diff(time[::_LONG]) / _LONG
    other = np.flatnonzero(np.abs(means - period) > 0.01 * period)
    if other.size:
        raise InputError(
            f"{source}: the sample period changes: roughly {period:.6g} s, but {means[other[0]]:.6g} s after "
            f"t = {time[other[0] * _LONG]:.6g} s; cut the file where it changes"
        )
