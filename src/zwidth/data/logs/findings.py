"""What a survey found, in sentences; and what no estimate could be made from, refused."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

from zwidth.data.logs.block import Finding
from zwidth.data.logs.runs import Cutter
from zwidth.data.logs.stamps import settled
from zwidth.data.logs.stops import at_ends
from zwidth.data.logs.survey import Survey
from zwidth.errors import InputError
from zwidth.quantity.text import told

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
        "{gaps} gaps, about {lost} samples, the longest {longest:.4g} s; a new run begins after each",
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


def refuse(survey: Survey, tally: Counter[str], source: str) -> None:
    """Refuse a log that says nothing."""
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
            f"(intervals around {survey.period:.4g} s); a log needs samples at a fixed rate"
        )
    if survey.jumps.low == survey.jumps.high:
        raise InputError(
            f"{source}: the position never changes, it is {survey.jumps.low:g} throughout; is it the right "
            "column?"
        )
    low, high = survey.ranges.get("hand_force", (0.0, 1.0))
    if low == high:
        raise InputError(
            f"{source}: the hand force never changes, it is {low:g} throughout; is the sensor connected, and "
            "is it the right column? To go without: columns={'hand_force': None}"
        )


def period(survey: Survey, stated: float | None, timed: bool, source: str) -> tuple[float, Finding]:
    """T [s], and where it comes from."""
    if not timed:
        assert stated is not None
        text = f"sample period {stated:.9g} s as stated; there are no stamps to compare with"
        return stated, Finding(kind="sample period", text=text)
    mean, count = survey.mean_interval, max(1, survey.intervals.number)
    uncertainty = (
        2 * survey.deviation * survey.runs**0.5 + 4e-16 * survey.intervals.latest
    ) / count + 1e-12 * mean
    inferred = settled(mean, uncertainty)
    if stated is None:
        return inferred, Finding(kind="sample period", text=f"sample period {inferred:.9g} s from the stamps")
    off = mean / stated - 1
    if abs(off) > _LOT:
        raise InputError(
            f"{source}: the stamps are {mean:.6g} s apart, stated are {stated:.6g} s; check the rate and the "
            "unit of the time column"
        )
    if abs(off) > _LITTLE + uncertainty / stated:
        text = (
            f"sample period {stated:.9g} s as stated; the stamps are {mean:.9g} s apart, {100 * off:+.2g} %: "
            "one of the two clocks is off"
        )
        return stated, Finding(kind="stated period", text=text)
    return stated, Finding(
        kind="sample period", text=f"sample period {stated:.9g} s, stated and by the stamps"
    )


def clock(survey: Survey, cutter: Cutter, tally: Counter[str]) -> Iterator[Finding]:
    """Gaps, restarts, repetitions, jitter."""
    numbers = {**tally, "longest": cutter.longest_gap}
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
            f"intervals between stamps vary by {survey.deviation:.3g} s (standard deviation), from "
            f"{survey.intervals.shortest:.6g} to {survey.intervals.longest:.6g} s; {supposed}"
        )
        yield Finding(kind="jitter", text=text)


def position(survey: Survey, wrap: float, unit: str) -> Iterator[Finding]:
    """The step of the encoder, its offset, and its overflows."""
    grid, found, stated = survey.grid, survey.found, survey.stated
    if stated is not None and grid is None:
        text = (
            f"the positions do not lie on the stated step of {stated:.6g} {unit}: filtered or interpolated "
            "before they were logged; they are left as they are"
        )
        yield Finding(kind="no step", text=text)
    elif grid is None:
        yield Finding(kind="no step", text="the positions show no step; the resolution is taken as 0")
    elif stated is not None and grid.step != stated:
        times = grid.step / stated
        multiple = times > 1.5 and abs(times - round(times)) < 1e-3
        whole = f", {round(times)} times that: the steps between are never seen" if multiple else ""
        text = f"resolution {told(grid.step, unit)} by the positions; stated is {told(stated, unit)}{whole}"
        yield Finding(kind="stated resolution", text=text)
    else:
        how = (
            "from the positions"
            if stated is None
            else "as stated" + (", and by the positions" if found else "")
        )
        yield Finding(kind="resolution", text=f"resolution {told(grid.step, unit)} {how}")
    if grid is not None and grid.offset:
        text = f"the positions are whole steps plus {grid.offset:.4g} {unit}, which is taken off"
        yield Finding(kind="offset", text=text)
    if survey.off_grid:
        text = f"{survey.off_grid} positions lie between the steps"
        yield Finding(kind="between steps", text=text, samples=survey.off_grid)
    if wrap:
        text = f"the position overflows at {wrap:.6g} {unit}; it is continued beyond"
        yield Finding(kind="overflow", text=text)


def forces(survey: Survey, unit: str) -> Iterator[Finding]:
    """Forces that are not there, say nothing, or are more than the sensor can say."""
    if "hand_force" not in survey.ranges:
        yield Finding(kind="no hand force", text="no column of the hand's force is used")
    low, high = survey.ranges.get("actuator_force", (0.0, 1.0))
    if low == high:
        yield Finding(kind="constant", text=f"the actuator force is {low:g} throughout")
    stops, samples = survey.stops.found()
    ends = at_ends(stops, unit)
    if ends:
        share = 100 * samples / survey.samples
        text = (
            f"the hand's force stays at {ends} in {samples} samples, {share:.2g} %: the sensor is at the end "
            "of its range, and larger forces are not known; strokes, or pieces of a shaken finger, with such "
            "samples are left out"
        )
        yield Finding(kind="saturated", text=text, samples=samples)
