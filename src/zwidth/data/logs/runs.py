"""Rows cut into runs: a new one after lost samples and where time starts again; no row twice."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from zwidth.data.logs.rows import Rows, joined
from zwidth.data.logs.stamps import BACK, GAP, REPEATED, Clock, jumps
from zwidth.errors import InputError

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]


MOST_SCRAPS = 64
"""Runs of a sample or two, one after the other, that no lost samples explain."""


class Segment(NamedTuple):
    """Rows that follow each other; `begins` says that a run starts with them."""

    run: int
    begins: bool
    rows: Rows


class Cutter:
    """Cuts a stream of rows.

    Parameters
    ----------
    clock
        What the stamps should look like.
    source
        For messages.
    tally
        Counts gaps, lost samples, restarts and repeated samples.
    """

    def __init__(self, clock: Clock, source: str, tally: Counter[str]) -> None:
        self.clock, self.source, self.tally = clock, source, tally
        self.longest_gap = 0.0
        self._run, self._begins = 0, True
        self._start = self._last = np.nan  # stamps at which the run began, and of its newest sample
        self._context = np.empty(0)
        self._waiting: Rows | None = None
        self._length = self._scraps = 0

    def segments(self, rows: Iterable[Rows]) -> Iterator[Segment]:
        """The rows in order, cut."""
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
                f"{self.source}: the sample period is no longer {self.clock.period:.6g} s around t = "
                f"{stamp:.6g} s; a log needs samples at a fixed rate; cut the file where the rate changes"
            )
        if kind == GAP:
            gap = stamp - self._last
            self.tally["gaps"] += 1
            self.tally["lost"] += max(1, round(gap / self.clock.period) - self.clock.group)
            self.longest_gap = max(self.longest_gap, gap)
        elif kind == BACK:
            if self._last - stamp < 0.5 * (self._last - self._start):
                raise InputError(
                    f"{self.source}: time goes back from {self._last:.9g} s to {stamp:.9g} s, and not to the "
                    "start of another recording; sort the rows or cut the file there"
                )
            self.tally["restarts"] += 1
        self._run += 1
        self._begins = True


def _same_as_before(rows: Rows, places: NDArray[np.intp]) -> NDArray[np.bool_]:
    """Where a row holds the numbers of the one before it."""
    same = np.ones(places.size, dtype=bool)
    for column in rows[1:]:
        if column is not None:
            same &= column[places] == column[places - 1]
    return same
