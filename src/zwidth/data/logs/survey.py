"""The first look at a log, once through: samples, stamps, range, step; what was odd is said or refused."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator
from math import inf
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from zwidth.data.logs.runs import OF_PARTS, Cutter, Segment, settled
from zwidth.data.logs.sensors import FEWEST, Grid, Jumps, Stops, at_ends, grid_of, offset_on, on_grid
from zwidth.data.logs.table import Finding
from zwidth.errors import InputError
from zwidth.quantity.text import shown

if TYPE_CHECKING:
    from zwidth.native.compiled import Array

_LEVELS = 64
"""Different positions after which the step is looked for."""

_LONG = 4096
"""Samples whose mean interval shows that the rate is another one."""


class Intervals(NamedTuple):
    """Sums over the intervals between stamps."""

    number: int = 0
    elapsed: float = 0.0
    """[s] of all together."""
    squares: float = 0.0
    """[s²] of how much each is longer than T."""
    shortest: float = inf
    longest: float = -inf
    """[s] of them."""
    latest: float = 0.0
    """[s] stamp that is farthest from 0."""

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
    """What the segments of a log have in common: `period` [s] is roughly T, `resolution` [m; rad] as stated,
    `unit` [m; rad] that of the numbers in the file."""

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
            f"{source}: at t = {shown(time[other[0] * _LONG], 's', 6)} the sample period changes from "
            f"{shown(period, 's', 6)} to {shown(means[other[0]], 's', 6)}; cut the file there{OF_PARTS}"
        )


_LITTLE, _LOT = 1e-4, 0.02
"""Between them a stated period that differs from the stamps' is used and reported; beyond, refused."""

_COUNTED = {
    "dates": ("dates", "the stamps are dates; time counts from the first of them", ""),
    "missing": ("missing", "{missing} of {rows} rows lack a number and are left out", "missing"),
    "infinite": (
        "infinite",
        "{infinite} of {rows} rows hold an infinite number and are left out",
        "infinite",
    ),
    "gaps": (
        "gap",
        "{gaps} gaps, about {lost} samples, the longest {longest}; a new run begins after each",
        "lost",
    ),
    "restarts": (
        "restart",
        "time starts again, {restarts} ×: recordings one after the other, a run each",
        "",
    ),
    "repeated": (
        "repeated",
        "{repeated} rows come twice while the clock goes on; the second is left out",
        "repeated",
    ),
    "twice": (
        "stamp twice",
        "{twice} stamps come twice with different numbers; they are taken for two samples",
        "twice",
    ),
}
"""What the rows were counted for: the finding's kind, its sentence, and the count of its samples."""


class Still(InputError):
    """A position that never changes: of a target it may be so."""


def refuse_survey(survey: Survey, tally: Counter[str], source: str) -> None:
    if survey.samples < 2:
        raise InputError(
            f"{source} holds {survey.samples} samples; a log needs two at least, and many to say something"
        )
    usable = tally["rows"] - tally["missing"] - tally["infinite"]
    if usable < 0.5 * tally["rows"]:
        raise InputError(
            f"{source}: only {usable} of {tally['rows']} rows have a number in every column that is used; "
            "were the columns recorded at different rates? Choose columns of one rate"
        )
    if survey.runs > 16 and survey.samples < 8 * survey.runs:
        raise InputError(
            f"{source}: {survey.samples} samples in {survey.runs} runs: the stamps have no common period "
            f"(intervals around {shown(survey.period, 's')}); a log needs samples at a fixed rate"
        )
    if survey.jumps.low == survey.jumps.high:
        raise Still(
            f"{source}: the position never changes, it is {survey.jumps.low:g} throughout; is it the right "
            "column?"
        )
    low, high = survey.ranges.get("hand_force", (0.0, 1.0))
    if low == high:
        raise InputError(
            f"{source}: the hand force never changes, it is {low:g} throughout; is the sensor connected, and "
            "is it the right column? To go without: columns={'hand_force': None}"
        )


def period_found(survey: Survey, stated: float | None, timed: bool, source: str) -> tuple[float, Finding]:
    """T [s], and where it comes from."""
    if not timed:
        assert stated is not None
        text = f"sample period {shown(stated, 's', 9)} as stated; there are no stamps to compare with"
        return stated, Finding(kind="sample period", text=text)
    mean, count = survey.mean_interval, max(1, survey.intervals.number)
    uncertainty = (
        2 * survey.deviation * survey.runs**0.5 + 4e-16 * survey.intervals.latest
    ) / count + 1e-12 * mean
    inferred = settled(mean, uncertainty)
    if stated is None:
        text = f"sample period {shown(inferred, 's', 9)} from the stamps"
        return inferred, Finding(kind="sample period", text=text)
    off = mean / stated - 1
    if abs(off) > _LOT:
        raise InputError(
            f"{source}: the stamps are {shown(mean, 's', 6)} apart, stated are {shown(stated, 's', 6)}; "
            "check the rate and the unit of the time column"
        )
    if abs(off) > _LITTLE + uncertainty / stated:
        text = (
            f"sample period {shown(stated, 's', 9)} as stated; the stamps are {shown(mean, 's', 9)} apart, "
            f"{shown(abs(off), '%', 2)} {'more' if off > 0 else 'less'}: one of the two clocks is off"
        )
        return stated, Finding(kind="stated period", text=text)
    text = f"sample period {shown(stated, 's', 9)}, stated and by the stamps"
    return stated, Finding(kind="sample period", text=text)


def clock_findings(survey: Survey, cutter: Cutter, tally: Counter[str]) -> Iterator[Finding]:
    numbers = {**tally, "longest": shown(cutter.longest_gap, "s")}
    for what, (kind, text, samples) in _COUNTED.items():
        if tally[what]:
            yield Finding(kind=kind, text=text.format_map(numbers), samples=tally[samples] if samples else 0)
    supposed = (
        "supposed: the samples were taken evenly and only the stamps vary, so the row's number is the clock"
    )
    if cutter.clock.group > 1:
        text = (
            f"the stamps come in groups of up to {cutter.clock.group} samples, or vary as much (a coarse "
            f"clock, packets); {supposed}"
        )
        yield Finding(kind="grouped stamps", text=text)
    elif survey.deviation > 1e-3 * survey.period:
        text = (
            f"intervals between stamps are {shown(survey.intervals.shortest, 's', 6)} to "
            f"{shown(survey.intervals.longest, 's', 6)}, σ {shown(survey.deviation, 's', 3)}; {supposed}"
        )
        yield Finding(kind="jitter", text=text)


def position_findings(survey: Survey, wrap: float, unit: str) -> Iterator[Finding]:
    """The step of the encoder, its offset, and its overflows."""
    grid, found, stated = survey.grid, survey.found, survey.stated
    if stated is not None and grid is None:
        text = (
            f"the positions do not lie on the stated step of {shown(stated, unit, 6)}: filtered or "
            "interpolated before they were logged; they are left as they are"
        )
        yield Finding(kind="no step", text=text)
    elif grid is None:
        yield Finding(kind="no step", text="the positions show no step; the resolution is taken as 0")
    elif stated is not None and grid.step != stated:
        times = grid.step / stated
        multiple = times > 1.5 and abs(times - round(times)) < 1e-3
        whole = f", {round(times)} times that: the steps between are never seen" if multiple else ""
        seen, given = shown(grid.step, unit, 6), shown(stated, unit, 6)
        text = f"resolution {seen} by the positions; stated is {given}{whole}"
        yield Finding(kind="stated resolution", text=text)
    else:
        how = (
            "from the positions"
            if stated is None
            else "as stated" + (", and by the positions" if found else "")
        )
        yield Finding(kind="resolution", text=f"resolution {shown(grid.step, unit, 6)} {how}")
    if grid is not None and grid.offset:
        text = f"the positions are whole steps plus {shown(grid.offset, unit)}, which is taken off"
        yield Finding(kind="offset", text=text)
    if survey.off_grid:
        text = f"{survey.off_grid} positions lie between the steps"
        yield Finding(kind="between steps", text=text, samples=survey.off_grid)
    if wrap:
        text = f"the position overflows at {shown(wrap, unit, 6)}; it is continued beyond"
        yield Finding(kind="overflow", text=text)


def force_findings(survey: Survey, unit: str) -> Iterator[Finding]:
    """Forces that are not there, say nothing, or are more than the sensor can say."""
    if "hand_force" not in survey.ranges:
        yield Finding(kind="no hand force", text="no column of the hand's force is used")
    low, high = survey.ranges.get("actuator_force", (0.0, 1.0))
    if low == high:
        yield Finding(kind="constant", text=f"the actuator force is {low:g} throughout")
    stops, samples = survey.stops.found()
    ends = at_ends(stops, unit)
    if ends:
        text = (
            f"the hand's force stays at {ends} in {samples} samples, "
            f"{shown(samples / survey.samples, '%', 2)}: the sensor is at the end of its range, and larger "
            "forces are not known; strokes, or pieces of a shaken finger, with such samples are left out"
        )
        yield Finding(kind="saturated", text=text, samples=samples)
