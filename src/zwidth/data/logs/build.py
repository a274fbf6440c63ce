"""From a table to a log: the first pass through it, and every later one."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from itertools import chain
from typing import TYPE_CHECKING, Any

import numpy as np

from zwidth.data.logs import findings
from zwidth.data.logs.block import Block
from zwidth.data.logs.rows import Recording
from zwidth.data.logs.runs import Cutter, Segment
from zwidth.data.logs.scales import Meaning
from zwidth.data.logs.stamps import Clock, clock_of
from zwidth.data.logs.steps import Grid
from zwidth.data.logs.survey import Survey
from zwidth.data.logs.table import Table, listed
from zwidth.data.logs.wraps import Unwrapper
from zwidth.errors import InputError
from zwidth.quantity.text import quantity_unit
from zwidth.quantity.units import parse_number

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

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
        raise InputError(
            f"{table.source} holds fewer than two rows with numbers in the columns that are used"
        )
    clock = clock_of(start.time, table.source) if timed else Clock(period=stated or 0.0, group=1)
    cutter = Cutter(clock, table.source, tally)
    survey = Survey(clock.period, meaning.resolution, meaning.factors["position"], table.source)
    survey.look(cutter.segments(chain([start], rows)))
    findings.refuse(survey, tally, table.source)
    return _contents(recording, cutter, survey, tally, stated)


def _contents(
    recording: Recording, cutter: Cutter, survey: Survey, tally: Counter[str], stated: float | None
) -> dict[str, Any]:
    source, meaning = recording.table.source, recording.meaning
    timed = recording.period is None
    length, force = (quantity_unit(name, meaning.motion) for name in ("position", "force"))
    period, about_period = findings.period(survey, stated, timed, source)
    snapped = survey.grid if survey.off_grid <= 0.01 * survey.samples else None
    step = survey.grid.step if survey.grid is not None else (meaning.resolution or 0.0)
    wrap = survey.jumps.period(step, meaning.motion == "rotary")
    said = (
        *recording.table.notes.values(),
        about_period,
        *findings.clock(survey, cutter, tally),
        *findings.position(survey, wrap, length),
        *findings.forces(survey, force),
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
    """Whole multiples of the step."""
    if grid is None:
        return position
    counts = position - grid.offset if grid.offset else position.copy()
    counts /= grid.step
    np.rint(counts, out=counts)
    counts *= grid.step
    return counts
