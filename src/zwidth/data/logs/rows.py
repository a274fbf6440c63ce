"""Rows of a table in SI units, without those that hold no number.

A row that is not finite in a column that is used is left out; the clock then sees a gap there.  Without a
time column the row's number is the clock.  Stamps that are dates are counted from the first one, since a
double has no room for microseconds in a year's worth of seconds.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from zwidth.data.logs.meaning import Meaning
from zwidth.data.logs.table import PIECE, Finding, Table, nearest, readable
from zwidth.errors import InputError

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from zwidth.native.compiled import Array

    _Columns = dict[str, NDArray[Any]]

DATE = 1e8
"""[s] Stamps beyond it, three years, are dates."""

MEMORY = 2**28
"""[bytes] A log whose numbers need no more is kept in memory after the first pass."""

FARTHEST = 0.1
"""[sample periods] On the median, of a force in another row than the position: at half a period the energy in
a vibration of 23 Hz, sampled at 1 kHz, is a seventh off."""

_FIRST = 2**14
"""Rows of the first piece, where there are as many: the clock is read from them."""


class Rows(NamedTuple):
    """Consecutive rows, finite, in SI units."""

    time: Array
    position: Array
    hand_force: Array | None
    actuator_force: Array | None

    def part(self, which: slice | Array) -> Rows:
        return Rows(*(None if column is None else column[which] for column in self))  # type: ignore[arg-type]


def joined(first: Rows, second: Rows) -> Rows:
    return Rows(*(None if a is None else np.concatenate((a, b)) for a, b in zip(first, second, strict=True)))  # type: ignore[arg-type]


class Recording:
    """The rows of a table, as often as wanted; `period` [s] apart where no time column says it, else None."""

    def __init__(self, table: Table, meaning: Meaning, period: float | None) -> None:
        self.table, self.meaning, self.period = table, meaning, period
        self._kept: list[Rows] | None = None

    def rows(self, tally: Counter[str] | None = None) -> Iterator[Rows]:
        """Every finite row, in pieces of at most `PIECE` but for the first; `tally` counts the others."""
        if self._kept is not None:
            yield from self._kept
            return
        kept: list[Rows] = []
        size = 0
        for piece in self._opened(Counter() if tally is None else tally):
            size += sum(column.nbytes for column in piece if column is not None)
            kept.append(piece)
            if size > MEMORY:
                kept.clear()
            yield piece
        self._kept = kept or None

    def _opened(self, tally: Counter[str]) -> Iterator[Rows]:
        """The pieces, enough of them joined at the beginning to read the clock from."""
        with readable(self.table.source):
            pieces = self._read(tally)
            if start := next(pieces, None):
                while start.time.size < _FIRST and (more := next(pieces, None)):
                    start = joined(start, more)
                yield start
            yield from pieces

    def _read(self, tally: Counter[str]) -> Iterator[Rows]:
        quantities = tuple(self.meaning.columns)
        names = tuple(self.meaning.columns[q] for q in quantities)
        simulated = str(self.table.attributes.get("format", "")).startswith("zwidth trace")
        damper = hand_damper(self.table) if simulated and "hand_force" in quantities else 0.0
        more = {"sampled": "sampled"} if simulated else {}
        anchor = anchor_column(self.table)
        if damper and anchor is not None:
            more["anchor"] = anchor
        origin = self.table.origin
        pieces = self.table.read((*names, *more.values()))
        for columns in self._whole(dict(zip((*quantities, *more), p, strict=True)) for p in pieces):
            if simulated:
                at_samples = columns.pop("sampled") != 0
                if not at_samples.all():
                    columns = {q: v[at_samples] for q, v in columns.items()}
            if damper:
                columns["hand_force"] = between_jumps(self.table, columns, damper)
                del columns["anchor"]
            if "time" in columns and not origin and columns["time"].size:
                origin.append(_origin(columns["time"], self.meaning.factors["time"]))
            tally["dates"] = bool(origin and origin[0])
            for k in range(0, columns["position"].size, PIECE):
                part = {q: v[k : k + PIECE] for q, v in columns.items()}
                yield self._finite(self._scaled(part, tally["rows"]), tally)

    def _whole(self, pieces: Iterator[_Columns]) -> Iterator[_Columns]:
        """Rows with what belongs to them, whether it stands there or in others."""
        first = next(pieces, {})
        if _in_turn(first):
            parts = [first, *pieces]
            first = {quantity: np.concatenate([part[quantity] for part in parts]) for quantity in first}
        if first:
            yield side_by_side(self.table, self.meaning.columns, first)
        yield from pieces

    def _scaled(self, columns: dict[str, Any], done: int) -> Rows:
        if "time" not in columns:
            assert self.period is not None
            time = (done + np.arange(columns["position"].size)) * self.period
        else:
            time = seconds(columns["time"], self.table.origin[0], self.meaning.factors["time"])
        others = (
            _times(columns[q], self.meaning.factors[q]) if q in columns else None
            for q in ("position", "hand_force", "actuator_force")
        )
        return Rows(time, *others)  # type: ignore[arg-type]

    def _finite(self, rows: Rows, tally: Counter[str]) -> Rows:
        tally["rows"] += rows.time.size
        used = [column for column in rows if column is not None]
        if all(
            np.isfinite(column.min(initial=0.0)) and np.isfinite(column.max(initial=0.0)) for column in used
        ):
            return rows
        finite = np.logical_and.reduce([np.isfinite(column) for column in used])
        infinite = np.logical_or.reduce([np.isinf(column) for column in used])
        tally["infinite"] += int(infinite.sum())
        tally["missing"] += int((~finite & ~infinite).sum())
        return rows.part(finite)


def _in_turn(columns: _Columns) -> bool:
    """Whether most rows of the second lack something else, and the first is a time to look for it by."""
    if len(columns) < 3 or "time" not in columns:
        return False
    finite = [np.isfinite(values) for values in columns.values()]
    return bool(2 * np.count_nonzero(np.logical_and.reduce(finite)) <= np.count_nonzero(finite[1]))


def side_by_side(table: Table, names: Mapping[str, str], columns: _Columns) -> _Columns:
    """Whole columns as they are; of topics that are written in turn the rows of the second, which follows the
    time, with the numbers nearest in time; refused where these may be of another sample."""
    if not _in_turn(columns):
        return columns
    _, main, *others = columns
    time = (columns["time"] - np.fmin.reduce(columns["time"])).astype(float)
    whole = {name: values[np.isfinite(columns[main])] for name, values in columns.items()}
    stamps = time[np.isfinite(columns[main])]
    period = np.nanmedian(np.diff(stamps)) if stamps.size > 1 else 1.0
    if (np.diff(stamps) < -10 * period).any():
        raise InputError(
            f'{table.source}: time starts again in "{names[main]}", and by it is found what stands in other '
            "rows; cut the file there"
        )
    for name in others:
        rows = np.isfinite(columns[name]) & np.isfinite(time)
        whole[name] = nearest(stamps, time[rows], columns[name][rows])
        at = nearest(stamps, time[rows], time[rows])
        found = np.isfinite(at)
        away = np.median(np.abs(at - stamps)[found]) / period if found.any() else 0.0
        said = f'"{names[name]}" stands in other rows, {away:.2g} periods from those of "{names[main]}"'
        if away > FARTHEST:
            raise InputError(
                f"{table.source}: {said}, and up to {FARTHEST} is read: damping and energy depend on whose "
                "sample a number is; leave it out, or give both one clock, as numpy.interp does"
            )
        left = int(rows.sum()) - np.unique(at[found]).size
        text = f"{said}; the nearest is taken, {left} of {rows.sum()} are left out"
        table.notes[name] = Finding(kind="rows in turn", text=text, samples=left)
    return whole


def _times(values: NDArray[Any], factor: float) -> Array:
    if values.dtype.kind not in "fiub":
        raise InputError(f"a column holds {values.dtype.name} where numbers belong")
    if factor == 1.0:
        return values.astype(np.float64, copy=False)
    if 0 < abs(factor) < 1 and (1 / factor).is_integer():
        return np.asarray(
            values / (1 / factor)
        )  # a decimal in mm divided by 1000 is the decimal in m, rounded once
    return np.asarray(values * np.float64(factor))


def _origin(time: NDArray[Any], factor: float) -> Any:
    """What to subtract from stamps: 0, or the first of them if they are dates."""
    if time.dtype.kind == "M":
        return next(iter(time[~np.isnat(time)]), np.datetime64(0, "ns"))
    finite = time[np.isfinite(time)] if time.dtype.kind == "f" else time
    first = finite[0] if finite.size else time.dtype.type(0)
    return first if abs(float(first)) * factor > DATE else time.dtype.type(0)


def seconds(time: NDArray[Any], origin: Any, factor: float) -> Array:
    """Stamps from an origin on [s]; NaN of a date that is none."""
    if time.dtype.kind == "M":
        steps = (time - origin).astype("timedelta64[ns]")
        since: Array = steps.astype(np.float64) / 1e9
        since[np.isnat(steps)] = np.nan
        return since
    if time.dtype.kind in "iu":
        return _times(time.astype(np.int64) - np.int64(origin), factor)
    return _times(time - origin if origin else time, factor)


# The force of a simulated hand whose damper follows an anchor: between its two sides where it jumps.
#
#     f_h = k (x_a − x) + c (ẋ_a − ẋ),      x_a straight from sample to sample
#
# At every sample the anchor changes its speed, and the force jumps by c Δẋ_a m/(m + m_h); a trace has what
# comes just after.  Whoever sums such samples for the impulse of the force counts the change half a sample
# early, which looks like a mass of c T/2 more: 1.5 g for 3 N·s/m at 1 kHz.  The mean of both sides has no
# such mass, and is what a load cell gives, which does not follow a jump.

ROUNDING = 1e-9
"""Of the largest force, below which a jump is none."""


def hand_damper(table: Table) -> float:
    """How much a simulated hand's force jumps for a change of its anchor's speed [N·s/m; N·m·s/rad]."""
    if anchor_column(table) is None:
        return 0.0
    own, hand = (_stated(table, (f"{whose}mass_", f"{whose}inertia_")) for whose in ("", "hand_"))
    share = own / (own + hand) if own + hand > 0 else 1.0
    return share * _stated(table, ("hand_damping_",))


def anchor_column(table: Table) -> str | None:
    """The column of the anchor, with its unit in the name where the format keeps it there."""
    return next((name for name in table.units if name.startswith("anchor_position")), None)


def _stated(table: Table, starts: tuple[str, ...]) -> float:
    """What the head of a trace says of a number whose name begins so; 0 where it says nothing."""
    return next((float(v) for key, v in table.attributes.items() if key.startswith(starts)), 0.0)


def between_jumps(table: Table, columns: Mapping[str, NDArray[Any]], damper: float) -> NDArray[Any]:
    """The mean of the hand's force before and after each sample; at both ends of a piece as it was."""
    force = columns["hand_force"].astype(float)
    if "time" not in columns or force.size < 3:
        return force
    speed = np.diff(columns["anchor"]) / np.diff(columns["time"])
    jumps = damper * np.diff(speed)
    if np.abs(jumps).max() <= ROUNDING * np.abs(force).max():
        return force
    force[1:-1] -= jumps / 2
    table.notes["jumps"] = Finding(
        kind="jumps",
        text="the force of this simulated hand jumps at the samples, as the speed of its anchor does: "
        "the mean of before and after is taken, as a load cell would",
    )
    return force
