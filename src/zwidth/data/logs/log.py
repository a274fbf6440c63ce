"""A log: what a haptic device recorded, as runs of evenly spaced samples.

    t(k) = t₀ + k T        x(k) = n(k) q        for every k of a run

within a run no sample is missing.  A log is read in blocks, as often as wanted, so that it may be longer than
the memory.  A table is gone through once for the numbers of its log, and again for each reading of the
blocks.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import chain
from math import inf, isclose
from typing import TYPE_CHECKING, Any

import numpy as np

from zwidth.data.logs.columns import recognise
from zwidth.data.logs.meaning import Meaning, meaning_of
from zwidth.data.logs.rows import Recording
from zwidth.data.logs.runs import Clock, Cutter, Segment, clock_of
from zwidth.data.logs.sensors import Grid, Unwrapper
from zwidth.data.logs.survey import (
    Survey,
    clock_findings,
    force_findings,
    period_found,
    position_findings,
    refuse_survey,
)
from zwidth.data.logs.table import Block, Finding, Motion, Table, Values, check_lengths, listed
from zwidth.errors import InputError
from zwidth.quantity.glossary import GLOSSARY
from zwidth.quantity.text import in_words, quantity_unit, shown
from zwidth.quantity.units import parse_number
from zwidth.showing import Lines, Part, Shown, one_line

if TYPE_CHECKING:
    import xarray as xr
    from numpy.typing import ArrayLike

    from zwidth.native.compiled import Array

SAME = 1e-3
"""Relative difference below which two sample periods, or two resolutions, are one that was measured twice."""


@dataclass(frozen=True, kw_only=True, repr=False)
class Log(Shown):
    """A recording of a device, read in blocks.

    Parameters
    ----------
    source
        Name of the file, or "arrays".
    motion
        "linear" or "rotary".
    sample_period
        [s] T.
    resolution
        [m; rad] step q of the encoder, inferred or stated; 0 if no step is seen.
    samples
        In all blocks together.
    runs
        How many uninterrupted runs there are.
    channels
        Which of hand_force and actuator_force there are.
    findings
        What was odd, and what was done about it.
    stops
        [N; N·m] readings of the hand's force from which on its sensor is at the lower and at the upper end
        of its range; infinite where none is seen.
    """

    source: str
    motion: Motion
    sample_period: float
    resolution: float
    samples: int
    runs: int = 1
    channels: tuple[str, ...] = ()
    findings: tuple[Finding, ...] = ()
    stops: tuple[float, float] = (-inf, inf)
    _blocks: Callable[[], Iterator[Block]] = field(compare=False)

    def report(self) -> Iterable[Part]:
        """How long, how often, the encoder's step, which forces; and what was odd."""
        runs = f" in {self.runs} runs" if self.runs > 1 else ""
        step = (
            shown(self.resolution, GLOSSARY["position"].unit_for(self.motion)) if self.resolution else "none"
        )
        forces = " and ".join(in_words(name, self.motion) for name in self.channels) or "none"
        yield (
            f"{one_line(self.source)}: {shown(self.duration, 's')}{runs}, {self.samples} samples, one every "
            f"{shown(self.sample_period, 's')}; encoder step {step}; forces: {forces}"
        )
        yield Lines(self.findings)

    @classmethod
    def from_arrays(
        cls,
        data: xr.Dataset | None = None,
        /,
        *,
        time: ArrayLike | None = None,
        position: ArrayLike | None = None,
        hand_force: ArrayLike | None = None,
        actuator_force: ArrayLike | None = None,
        columns: Mapping[str, str | None] | None = None,
        units: Mapping[str, str] | None = None,
        scale: Mapping[str, object] | None = None,
        sample_rate: object = None,
        sample_period: object = None,
        resolution: object = None,
        counts_per_turn: object = None,
        motion: Motion | None = None,
    ) -> Log:
        """A log from arrays in SI units, or from the variables of a Dataset with their units.

        Parameters
        ----------
        data
            A Dataset whose variables have the attribute `units`, such as a trace; instead of the arrays.
        time
            [s] stamp of each sample; or leave it out and state the rate.
        position
            [m; rad] positive into the wall.
        hand_force
            [N; N·m] of the hand on the device, positive into the wall.
        actuator_force
            [N; N·m] of the actuator, positive out of the wall.
        columns, units, scale, sample_rate, sample_period, resolution, counts_per_turn
            As for `zwidth.read_log`.
        motion
            "linear", where nothing else is said, or "rotary".

        Raises
        ------
        InputError
            If the arrays are of different lengths, or nothing can be learnt from them.
        """
        given = {
            "time": time,
            "position": position,
            "hand_force": hand_force,
            "actuator_force": actuator_force,
        }
        arrays = {name: values for name, values in given.items() if values is not None}
        period = stated_period(sample_rate, sample_period)
        if motion is None and data is None:
            motion = "rotary" if counts_per_turn is not None else "linear"
        table, names = table_of(data, arrays, columns, units, motion or "linear")
        meaning = meaning_of(
            table,
            names,
            units=units,
            scale=scale,
            resolution=resolution,
            counts_per_turn=counts_per_turn,
            motion=motion,
        )
        return cls(**contents(table, meaning, period))

    @classmethod
    def concatenate(cls, logs: Sequence[Log]) -> Log:
        """One log of the runs of all, one after the other; none is read before it is wanted.

        Parameters
        ----------
        logs
            Of the same device: as often sampled, with the same encoder and the same forces.

        Raises
        ------
        InputError
            If there is none, or they differ in that.
        """
        if not logs:
            raise InputError("there is no log to join; give one at least")
        first = logs[0]
        for log in logs[1:]:
            _same(first, log)

        def blocks() -> Iterator[Block]:
            before = 0
            for log in logs:
                for block in log.blocks():
                    yield block._replace(run=block.run + before)
                before += log.runs

        return replace(
            first,
            source=", ".join(log.source for log in logs),
            samples=sum(log.samples for log in logs),
            runs=sum(log.runs for log in logs),
            findings=tuple(
                replace(finding, text=f"{log.source}: {finding.text}")
                for log in logs
                for finding in log.findings
            ),
            stops=(max(log.stops[0] for log in logs), min(log.stops[1] for log in logs)),
            _blocks=blocks,
        )

    def blocks(self) -> Iterator[Block]:
        """Every block from the start; may be called as often as needed."""
        return self._blocks()

    @property
    def duration(self) -> float:
        """[s] of all runs together."""
        return self.samples * self.sample_period


def _same(first: Log, log: Log) -> None:
    if not isclose(log.sample_period, first.sample_period, rel_tol=SAME):
        raise InputError(
            f"{first.source} has a sample period of {shown(first.sample_period, 's', 6)} and {log.source} of "
            f"{shown(log.sample_period, 's', 6)}, so 2b/T differs: identify them one by one"
        )
    for what in ("motion", "resolution", "channels"):
        one, other = getattr(first, what), getattr(log, what)
        if one != other and not (what == "resolution" and isclose(one, other, rel_tol=SAME)):
            raise InputError(
                f"{first.source} and {log.source} differ in their {what}, {one!r} and {other!r}: "
                "only logs of one device, recorded alike, can be joined"
            )


_START = 4096
"""Samples whose stamps say when a run began, where stamps vary."""


def stated_period(sample_rate: object, sample_period: object) -> float | None:
    """[s] T as stated by a rate or a period, or None."""
    if sample_rate is not None and sample_period is not None:
        raise InputError("sample_rate and sample_period say the same; give one of them")
    given, unit, name = (
        (sample_rate, "Hz", "sample_rate") if sample_period is None else (sample_period, "s", "sample_period")
    )
    if given is None:
        return None
    value = parse_number(given, unit, name)
    if value <= 0:
        raise InputError(f"{name} must be > 0 {unit}, got {float(value):g}")
    return float(1 / value.fraction) if unit == "Hz" else float(value)


def contents(table: Table, meaning: Meaning, stated: float | None) -> dict[str, Any]:
    """Go through a table once: the fields of its `Log`."""
    timed = "time" in meaning.columns
    if not timed and stated is None:
        raise InputError(
            f'{table.source}: no column is known to be the time; say which with columns={{"time": …}}, '
            f"or state sample_rate or sample_period; there are {listed(table.units)}"
        )
    recording = Recording(table, meaning, None if timed else stated)
    tally: Counter[str] = Counter()
    rows = recording.rows(tally)
    start = next(rows, None)
    if start is None or start.time.size < 2:
        names = meaning.columns.values()
        raise InputError(
            f"{table.source} holds fewer than two rows with numbers in all of {listed(list(names))}; what "
            "stands in other rows than the position is looked for at most half a period away, by a time"
        )
    clock = clock_of(start.time, table.source, stated) if timed else Clock(period=stated or 0.0, group=1)
    cutter = Cutter(clock, table.source, tally)
    survey = Survey(clock.period, meaning.resolution, meaning.factors["position"], table.source)
    survey.look(cutter.segments(chain([start], rows)))
    refuse_survey(survey, tally, table.source)
    return _contents(recording, cutter, survey, tally, stated)


def _contents(
    recording: Recording, cutter: Cutter, survey: Survey, tally: Counter[str], stated: float | None
) -> dict[str, Any]:
    source, meaning = recording.table.source, recording.meaning
    timed = recording.period is None
    length, force = (quantity_unit(name, meaning.motion) for name in ("position", "force"))
    period, about_period = period_found(survey, stated, timed, source)
    snapped = survey.grid if survey.off_grid <= 0.01 * survey.samples else None
    step = survey.grid.step if survey.grid is not None else (meaning.resolution or 0.0)
    wrap = survey.jumps.period(step, meaning.motion == "rotary")
    said = (
        *recording.table.notes.values(),
        about_period,
        *clock_findings(survey, cutter, tally),
        *position_findings(survey, wrap, length),
        *force_findings(survey, force),
    )
    varying = cutter.clock.group > 1 or survey.deviation > 1e-6 * period

    def blocks() -> Iterator[Block]:
        again = Cutter(cutter.clock, source, Counter())
        return _blocks(again.segments(recording.rows()), period, varying, snapped, Unwrapper(wrap))

    return {
        "source": source,
        "motion": meaning.motion,
        "sample_period": period,
        "resolution": step,
        "samples": survey.samples,
        "runs": survey.runs,
        "channels": tuple(survey.ranges),
        "findings": said,
        "stops": survey.stops.found()[0],
        "_blocks": blocks,
    }


def _blocks(
    segments: Iterator[Segment], period: float, varying: bool, grid: Grid | None, unwrapper: Unwrapper
) -> Iterator[Block]:
    start, done = 0.0, 0
    for run, begins, rows in segments:
        if begins:
            done = 0
            start = float(rows.time[0])
            if varying:
                stamps = rows.time[:_START]
                start = float(np.median(stamps - period * np.arange(stamps.size)))
        time = start + period * np.arange(done, done + rows.time.size, dtype=np.float64)
        done += rows.time.size
        position = unwrapper.take(_on(grid, rows.position))
        yield Block(run, time, position, rows.hand_force, rows.actuator_force)


def _on(grid: Grid | None, position: Array) -> Array:
    if grid is None:
        return position
    counts = position - grid.offset if grid.offset else position.copy()
    counts /= grid.step
    np.rint(counts, out=counts)
    counts *= grid.step
    return counts


def table_of(
    data: xr.Dataset | None,
    arrays: Mapping[str, Any],
    columns: Mapping[str, str | None] | None,
    units: Mapping[str, str] | None,
    motion: str,
) -> tuple[Table, dict[str, str]]:
    """The table of a Dataset, or of the arrays of each quantity; and the column of each quantity."""
    if data is not None:
        if arrays:
            raise InputError("give a Dataset or arrays, not both")
        table = _of_dataset(data)
        return table, recognise(table.units, columns, table.source)
    if columns is not None or units is not None:
        raise InputError(
            "columns and units are for a Dataset; arrays are in SI units, scale={…} changes them"
        )
    if "position" not in arrays:
        raise InputError("a log needs positions; give position=…")
    length, force = (GLOSSARY[name].unit_for(motion) for name in ("position", "force"))
    si = {"time": "s", "position": length, "hand_force": force, "actuator_force": force}
    return _table({name: _vector(name, values) for name, values in arrays.items()}, si, {}), {
        name: name for name in arrays
    }


def _vector(name: str, values: Any) -> Values:
    array = np.asarray(values)
    if array.ndim != 1 or array.dtype.kind not in "fiuM":
        raise InputError(
            f"{name} is a list of numbers, got an array of {array.ndim} dimensions of {array.dtype}"
        )
    return array


def _table(
    arrays: dict[str, Values], units: Mapping[str, str | None], attributes: Mapping[str, Any]
) -> Table:
    check_lengths("arrays", {name: values.size for name, values in arrays.items()})

    def read(names: tuple[str, ...]) -> Iterator[tuple[Values, ...]]:
        yield tuple(arrays[name] for name in names)

    stated = {name: units.get(name) for name in arrays}
    return Table(source="arrays", units=stated, read=read, attributes=attributes)


def _of_dataset(data: xr.Dataset) -> Table:
    dimension = next(iter(data.dims), None)
    variables = {
        str(name): variable
        for name, variable in data.variables.items()
        if variable.dims == (dimension,) and variable.dtype.kind in "fiubM"
    }
    if not variables:
        raise InputError("the Dataset has no variable of numbers along one dimension")
    units = {n: "ns" if v.dtype.kind == "M" else v.attrs.get("units") for n, v in variables.items()}
    arrays = {name: np.asarray(variable.values) for name, variable in variables.items()}
    return _table(arrays, units, dict(data.attrs))
