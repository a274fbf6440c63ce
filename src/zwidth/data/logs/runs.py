"""The clock of a log; and rows cut into runs: a new one after lost samples and where time starts again."""

from __future__ import annotations

from bisect import bisect
from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from zwidth.data.logs.rows import Rows, joined
from zwidth.errors import InputError
from zwidth.quantity.text import from_to, shown

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from zwidth.native.compiled import Array

    Indices = NDArray[np.intp]

MOST_SCRAPS = 64
"""Runs of a sample or two, one after the other, that no lost samples explain."""


class Segment(NamedTuple):
    """Rows that follow each other; `begins` says that a run starts with them."""

    run: int
    begins: bool
    rows: Rows


class Cutter:
    """Cuts a stream of rows; the tally counts gaps, lost samples, restarts and repeated samples."""

    def __init__(self, clock: Clock, source: str, tally: Counter[str]) -> None:
        self.clock, self.source, self.tally = clock, source, tally
        self.longest_gap = 0.0
        self._run, self._begins = 0, True
        self._start = self._last = np.nan  # stamps at which the run began, and of its newest sample
        self._context = np.empty(0)
        self._waiting: Rows | None = None
        self._length = self._scraps = 0

    def segments(self, rows: Iterable[Rows]) -> Iterator[Segment]:
        waiting: Rows | None = None
        for new in rows:
            piece = new if waiting is None else joined(waiting, new)
            yield from self._cut(piece, last=False)
            waiting = self._waiting
        if waiting is not None:
            yield from self._cut(waiting, last=True)

    def _cut(self, rows: Rows, last: bool) -> Iterator[Segment]:
        """Cut what can be decided; the rest waits for the rows after it."""
        done, reach = self._context.size, self.clock.reach
        time = np.concatenate((self._context, rows.time)) if done else rows.time
        where, kinds = jumps(time, max(0, done - 1), self.clock)
        self._waiting = None
        if not last and where.size and where[-1] >= time.size - 1 - reach:
            near = where[where >= time.size - 1 - reach][0]
            cut = int(near) + 1 - done
            if rows.time.size - cut <= 4 * reach:
                self._waiting = rows.part(slice(cut, None))
                rows, time = rows.part(slice(0, cut)), time[: near + 1]
                where, kinds = where[where < near], kinds[where < near]
        self._context = time[-reach:].copy()
        yield from self._pieces(rows, where + 1 - done, kinds)

    def _pieces(self, rows: Rows, where: NDArray[np.intp], kinds: NDArray[np.intp]) -> Iterator[Segment]:
        repeated = where[kinds == REPEATED]
        repeated = repeated[repeated > 0]
        same = _same_as_before(rows, repeated)
        self.tally["twice"] += int(np.count_nonzero(~same))
        repeated = repeated[same]
        if repeated.size:
            self.tally["repeated"] += repeated.size
            kept = np.ones(rows.time.size, dtype=bool)
            kept[repeated] = False
            where, kinds = where - np.searchsorted(repeated, where), kinds
            rows = rows.part(kept)
        begin = 0
        for place, kind in zip(where.tolist(), kinds.tolist(), strict=True):
            if kind == REPEATED:
                continue
            yield from self._piece(rows.part(slice(begin, place)))
            if place < rows.time.size:
                self._end(kind, float(rows.time[place]))
            begin = place
        yield from self._piece(rows.part(slice(begin, None)))

    def _piece(self, rows: Rows) -> Iterator[Segment]:
        if rows.time.size == 0:
            return
        if self._begins:
            self._start = float(rows.time[0])
        self._last = float(rows.time[-1])
        self._length += rows.time.size
        yield Segment(self._run, self._begins, rows)
        self._begins = False

    def _end(self, kind: int, stamp: float) -> None:
        """The run is over: samples are lost, or time starts again at `stamp`."""
        self._scraps = self._scraps + 1 if self._length <= 2 else 0
        self._length = 0
        if self._scraps > MOST_SCRAPS:
            raise InputError(
                f"{self.source}: the sample period is no longer {shown(self.clock.period, 's', 6)} around t "
                f"= {shown(stamp, 's', 6)}, and a log has one; cut the file where the rate changes"
            )
        if kind == GAP:
            gap = stamp - self._last
            self.tally["gaps"] += 1
            self.tally["lost"] += max(1, round(gap / self.clock.period) - self.clock.group)
            self.longest_gap = max(self.longest_gap, gap)
        elif kind == BACK:
            if self._last - stamp < 0.5 * (self._last - self._start):
                raise InputError(
                    f"{self.source}: time goes back from {shown(self._last, 's', 9)} to "
                    f"{shown(stamp, 's', 9)}, not to another start; sort the rows or cut the file there"
                )
            self.tally["restarts"] += 1
        self._run += 1
        self._begins = True


def _same_as_before(rows: Rows, places: NDArray[np.intp]) -> NDArray[np.bool_]:
    same = np.ones(places.size, dtype=bool)
    for column in rows[1:]:
        if column is not None:
            same &= column[places] == column[places - 1]
    return same


# The clock of a log: the sample period from its stamps, and where the samples do not follow each other.
#
# A stamp says when a sample was written down, T says when it was taken:
#
#     t(k) = k T + r(k)
#
# Where r jumps and stays, samples are lost (up) or written twice (down); where it comes back, the stamp alone
# was late.  Levels are compared by the median of a few samples on each side; where stamps come in groups (a
# coarse clock, packets), by their lowest, since a stamp in a packet is late and never early.

_SIDE, _NOISY_SIDE = 7, 31
"""Samples on each side of a jump that say where r was and is; more where stamps vary by a tenth of T."""

_REPEATS = 0.005
"""Share of stamps that come twice beyond which the clock is a coarse one."""

_WIDEST = 4096
"""Samples over which stamps in groups are averaged."""

GAP, REPEATED, BACK = 1, 2, 3

OF_PARTS = '; where most was cut out, state it: sample_rate=1000, --rate "1 kHz"'


@dataclass(frozen=True, kw_only=True)
class Clock:
    period: float
    group: int
    """Most samples between two stamps that differ; 1 where every sample has its own."""
    noisy: bool = False
    """Intervals vary by a tenth of T or more."""

    @property
    def reach(self) -> int:
        if self.group > 1:
            return 8 * self.group
        return _NOISY_SIDE if self.noisy else _SIDE


def clock_of(time: Array, source: str, stated: float | None = None) -> Clock:
    """The period [s] that most of the intervals between stamps have, or have on average; where that is the
    stated one, most of the log may have been cut out."""
    steps = np.diff(time)
    if steps.size == 0 or not (steps > 0).any():
        raise InputError(
            f"{source}: time stands still or goes backwards in every row; which column is the time?"
        )
    usual = float(np.median(steps))
    width = max(1, min(steps.size // 2, _WIDEST))
    period = float(np.median(time[width:] - time[:-width])) / width
    is_stated = stated is not None and abs(usual - stated) < 0.25 * stated
    single = (period < 2.5 * usual or is_stated) and np.mean(np.abs(steps) < 0.25 * usual) <= _REPEATS
    if usual > 0 and single and np.mean(np.abs(steps - usual) < 0.25 * usual) > 0.5:
        low, high = np.quantile(steps, (0.25, 0.75))
        return Clock(period=usual, group=1, noisy=bool(high - low > 0.1 * usual))
    group = _longest_group(steps, period)
    if period <= 0 or group > width // 4 or _wanders(time, period, width):
        raise InputError(
            f"{source}: the stamps have no common period, they are "
            f"{from_to(steps.min(), steps.max(), 's', 3)} apart; a log needs one fixed rate{OF_PARTS}"
        )
    return Clock(period=period, group=group)


def _wanders(time: Array, period: float, width: int) -> bool:
    """True where r(k) goes farther the longer one waits, as it does if the samples have no clock."""

    def spread(apart: int) -> float:
        low, high = np.quantile(time[apart:] - time[:-apart], (0.25, 0.75))
        return float(high - low)

    return width >= 64 and spread(width) > max(period, 2 * spread(width // 16))


def _longest_group(steps: Array, period: float) -> int:
    """Of the stretches between steps longer than T/2, the length below which nearly all lie."""
    ends = np.flatnonzero(steps > 0.5 * period)
    if ends.size < 2:
        return max(2, steps.size)
    return max(2, int(np.quantile(np.diff(ends), 0.99)))


def jumps(time: Array, first: int, clock: Clock) -> tuple[Indices, Indices]:
    """Where a sample k + 1 does not follow k, from k = `first` on: k, and GAP, REPEATED or BACK."""
    steps = np.diff(time)
    period = clock.period
    if steps.size == 0 or (steps.min() > 0.5 * period and steps.max() < 1.5 * period):
        none = np.empty(0, dtype=np.intp)
        return none, none
    odd = (steps > 1.5 * period) | (steps < (0.5 if clock.group == 1 else -0.5) * period)
    where = np.flatnonzero(odd)
    where = where[where >= first]
    residual = time - period * np.arange(time.size)
    shift = _shift(residual, where, clock) / period
    kind = np.zeros(where.size, dtype=np.intp)
    least = 0.5 if clock.group == 1 else max(0.6, clock.group / 8)
    kind[(steps[where] > 1.5 * period) & (shift > least)] = GAP
    if clock.group == 1:
        kind[(steps[where] < 0.5 * period) & (shift < -0.5)] = REPEATED
    kind[(steps[where] < -0.5 * period) & (shift < -least)] = BACK
    real = kind > 0
    if clock.group > 1:
        real = _widest_of_each(where, real, steps, clock.reach)
    elif clock.noisy:
        real = _told_apart(where, real, steps, residual, clock)
    return where[real], kind[real]


def _shift(residual: Array, where: Indices, clock: Clock) -> Array:
    """How much r(k) differs after each place from before it."""
    reach = clock.reach
    if clock.group == 1:
        before = sliding_window_view(np.concatenate((np.full(reach - 1, np.nan), residual)), reach)
        after = sliding_window_view(np.concatenate((residual[1:], np.full(reach, np.nan))), reach)
        return np.asarray(np.nanmedian(after[where], axis=1) - np.nanmedian(before[where], axis=1))
    total = np.concatenate(([0.0], np.cumsum(residual)))
    low, high = np.maximum(where + 1 - reach, 0), np.minimum(where + 1 + reach, residual.size)
    left = (total[where + 1] - total[low]) / (where + 1 - low)
    right = (total[high] - total[where + 1]) / (high - where - 1)
    known = np.minimum(where + 1 - low, high - where - 1) >= 2 * clock.group
    return np.where(known, right - left, 0.0)


def _widest_of_each(where: Indices, real: NDArray[np.bool_], steps: Array, reach: int) -> NDArray[np.bool_]:
    """Of marks so near each other that they see the same jump, the one with the widest step."""
    kept = np.zeros_like(real)
    marked = np.flatnonzero(real)
    for near in np.split(marked, np.flatnonzero(np.diff(where[marked]) > reach) + 1):
        if near.size:
            kept[near[np.argmax(np.abs(steps[where[near]]))]] = True
    return kept


def _told_apart(
    where: Indices, real: NDArray[np.bool_], steps: Array, residual: Array, clock: Clock
) -> NDArray[np.bool_]:
    """Of marks near each other, those that still jump when no level reaches across a wider jump."""
    kept = np.zeros_like(real)
    accepted: list[int] = []
    marked = np.flatnonzero(real)
    for mark in marked[np.argsort(-np.abs(steps[where[marked]]), kind="stable")]:
        k = int(where[mark])
        place = bisect(accepted, k)
        low = max(k + 1 - clock.reach, 0, accepted[place - 1] + 1 if place else 0)
        high = min(k + 1 + clock.reach, residual.size)
        if place < len(accepted):
            high = min(high, accepted[place] + 1)
        shift = float(np.median(residual[k + 1 : high]) - np.median(residual[low : k + 1]))
        if abs(shift) > 0.5 * clock.period:
            accepted.insert(place, k)
            kept[mark] = True
    return kept


def settled(period: float, uncertainty: float) -> float:
    """T as a whole rate [Hz] or a whole number of ns if one lies within the uncertainty, else as it is."""
    for candidate in (1 / max(1, round(1 / period)), round(period * 1e6) / 1e6, round(period * 1e9) / 1e9):
        if candidate > 0 and abs(candidate - period) <= uncertainty:
            return float(candidate)
    return period
