"""What is looked at while a loop runs: the rows that it has written so far, and the curves made of them.

Whoever looks asks for the rows after those it has, at its own pace.  The loop never waits for it and is never
asked anything: who looks too seldom gets the rows that are still kept, and who has died asks no more.

    margin         E − W_a     friction loss less energy out: what the hand has put in at least, but for the
                               device's kinetic energy and the encoder's steps
    missed         k − r       row r tells of sample k: the samples between were not taken
    lateness       l + m T     late_s, and a period more for each deadline missed just before
"""

from __future__ import annotations

import re
from collections import deque
from collections.abc import Sequence
from math import isnan
from threading import Lock
from typing import NamedTuple, Protocol

import numpy as np

from zwidth.data.logs.contents import COLUMNS
from zwidth.machine.servo.connection import GOOD
from zwidth.machine.servo.ring import PHASES
from zwidth.native.compiled import Array
from zwidth.quantity.text import shown


class Rows(Protocol):
    """Rows of a served loop, one for each sample that it took."""

    @property
    def COLUMNS(self) -> tuple[str, ...]:
        """Names of the columns, units in them: "time_s", "position_m"."""

    @property
    def period(self) -> float:
        """T [s]."""

    @property
    def motion(self) -> str:
        """ "linear" or "rotary"."""

    @property
    def title(self) -> str:
        """What is served, in words."""

    def after(self, count: int) -> tuple[int, Array]:
        """How many rows were written so far, and those after the first `count` that are still kept."""


CURVES = ("position", "wished_force", "force", "energy_out", "friction_loss", "margin", "lateness")
POSITION, WISHED_FORCE, FORCE, ENERGY_OUT, FRICTION_LOSS, MARGIN, LATENESS = range(len(CURVES))


class News(NamedTuple):
    """Rows that were not seen before."""

    rows: Array
    """As the loop wrote them."""
    times: Array
    """Since the loop began [s]."""
    curves: Array
    """A column for each of `CURVES`, in SI units."""
    missed: int
    """Deadlines missed since the loop began."""
    skipped: int
    """Rows that were gone before they were asked for."""


class Watched:
    """Rows, and how many of them were seen; for one who looks."""

    def __init__(self, rows: Rows) -> None:
        position, force = COLUMNS[rows.motion]
        self._rows = rows
        self._seen = self._missed = 0
        wanted = (position, f"wished_{force}", force, "energy_out_J", "friction_loss_J", "late_s")
        self._columns = [rows.COLUMNS.index(name) for name in wanted]
        self._time, self._sample = rows.COLUMNS.index("time_s"), rows.COLUMNS.index("sample")

    def news(self) -> News:
        """What was written since the last call, as far as it is kept."""
        count, rows = self._rows.after(self._seen)
        skipped = count - self._seen - len(rows)
        self._seen = count
        x, wished, force, out, loss, late = rows[:, self._columns].T
        missed = rows[:, self._sample] - np.arange(count - len(rows), count)
        newly = np.diff(missed, prepend=self._missed if not skipped else missed[:1])
        if len(rows):
            self._missed = int(missed[-1])
        lateness = late + np.maximum(newly, 0.0) * self._rows.period
        curves = np.column_stack([x, wished, force, out, loss, loss - out, lateness])
        return News(rows, rows[:, self._time], curves, self._missed, skipped)


def field_name(column: str) -> str:
    """What ROS 2 and Foxglove accept as the name of a field: force_n for force_N."""
    return re.sub("[^a-z0-9]+", "_", column.lower()).strip("_")


def ros2_schema(columns: Sequence[str]) -> bytes:
    """The definition of a row as a message of ROS 2."""
    return "".join(f"float64 {field_name(name)}  # {name}\n" for name in columns).encode()


# The last seconds as they are drawn, lowest and highest in equal spans of time: one sample for each point
# of a graph would hide a buzz, or show it as a slow wave that is not there.  What is kept does not grow.


SPAN = 10.0
"""How long a graph goes back [s]."""


def scales_of(motion: str) -> tuple[str, str, float]:
    """Units of position and force in a graph, and how many of the latter are in one SI unit."""
    return ("mrad", "mN·m", 1e3) if motion == "rotary" else ("mm", "N", 1.0)


class Band(NamedTuple):
    """Lowest and highest of each curve in each span."""

    times: Array
    """Middle of each span [s]."""
    low: Array
    high: Array
    newest: int
    """Number of the newest span in it, to ask for what comes after."""


class Envelope:
    """Lowest and highest of so many curves in so many spans, the last `SPAN` seconds in all."""

    def __init__(self, curves: int, spans: int) -> None:
        self._width = SPAN / spans
        self._number = np.full(spans, -1, np.int64)
        self._low, self._high = np.full((2, spans, curves), np.nan)
        self._newest = -1
        self._lock = Lock()

    def add(self, times: Array, curves: Array) -> None:
        """Samples, one a row, later than those before."""
        if not len(times):
            return
        numbers = np.floor(times / self._width).astype(np.int64)
        first = np.flatnonzero(np.diff(numbers, prepend=numbers[0] - 1))
        low = np.fmin.reduceat(curves, first, axis=0)
        high = np.fmax.reduceat(curves, first, axis=0)
        with self._lock:
            self._keep(numbers[first], low, high)

    def _keep(self, numbers: np.ndarray[tuple[int], np.dtype[np.int64]], low: Array, high: Array) -> None:
        size = len(self._number)
        if numbers[0] == self._newest:  # a span that is not over yet
            at = numbers[0] % size
            low[0], high[0] = np.fmin(low[0], self._low[at]), np.fmax(high[0], self._high[at])
        numbers, low, high = numbers[-size:], low[-size:], high[-size:]
        at = numbers % size
        self._number[at], self._low[at], self._high[at] = numbers, low, high
        self._newest = int(numbers[-1])

    def after(self, number: int) -> Band:
        """The spans that are over and later than a number; none twice."""
        with self._lock:
            wanted = np.arange(max(number + 1, self._newest - len(self._number) + 1, 0), max(self._newest, 0))
            at = wanted[self._number[wanted % len(self._number)] == wanted]
            found = at % len(self._number)
            newest = max(self._newest - 1, number)
            return Band((at + 0.5) * self._width, self._low[found], self._high[found], newest)

    def drawn(self, columns: int) -> tuple[Array, Array]:
        """Lowest and highest of each curve in so many equal parts of the last `SPAN` seconds; else NaN."""
        size = len(self._number)
        with self._lock:
            numbers = np.arange(self._newest - size + 1, self._newest + 1)
            held = (self._number[numbers % size] == numbers)[:, None]
            low = np.where(held, self._low[numbers % size], np.nan)
            high = np.where(held, self._high[numbers % size], np.nan)
        edges = np.arange(columns) * size // columns
        if columns > size:
            return low[edges], high[edges]
        return np.fmin.reduceat(low, edges, axis=0), np.fmax.reduceat(high, edges, axis=0)


_WITHIN = 1.0
"""Over how long the rate is taken [s]."""


class Tally:
    """What is seen of a loop, in one line: its phase and law, its rate, the force now, how late it is."""

    def __init__(self, rows: Rows) -> None:
        self._at = {name: i for i, name in enumerate(rows.COLUMNS)}
        *self._units, self._force_scale = scales_of(rows.motion)
        self._counted: deque[tuple[float, int]] = deque()
        self._seen = self._bad = self._missed = self._skipped = 0
        self._longest = 0.0
        self._last: News | None = None

    def add(self, news: News) -> None:
        """Count what was not counted before."""
        self._skipped += news.skipped
        if not len(news.rows):
            return
        self._seen += len(news.rows) + news.skipped
        self._bad += int(np.count_nonzero(news.rows[:, self._at["status"]] != GOOD))
        self._missed = news.missed
        self._longest = max(self._longest, float(news.curves[:, LATENESS].max()))
        self._counted.append((float(news.times[-1]), self._seen))
        while len(self._counted) > 2 and self._counted[1][0] <= news.times[-1] - _WITHIN:
            self._counted.popleft()
        self._last = news

    @property
    def line(self) -> str:
        """All of it in words."""
        if self._last is None:
            return "no sample yet"
        row, curve = self._last.rows[-1], self._last.curves[-1]
        phase = PHASES[int(row[self._at["phase"]])]
        law = int(row[self._at["law"]])
        parts = [
            f"{phase}, law {law}" if law >= 0 else phase,
            f"at {self._last.times[-1]:.1f} s",
            f"{1e3 * curve[POSITION]:+.3f} {self._units[0]}",
            f"{self._force_scale * curve[FORCE]:+.3f} {self._units[1]}",
            "margin not seen" if isnan(curve[MARGIN]) else f"margin {1e3 * curve[MARGIN]:+.3f} mJ",
            f"late by {1e6 * curve[LATENESS]:.0f} µs, {1e6 * self._longest:.0f} µs at most",
            f"{self._missed} deadlines missed",
        ]
        parts[2:2] = [shown(rate, "Hz")] if (rate := self._rate) else []
        parts += [f"{self._bad} bad answers"] if self._bad else []
        parts += [f"{self._skipped} samples not shown"] if self._skipped else []
        return " · ".join(parts).replace("-", "−")

    @property
    def _rate(self) -> float:
        """Rows a second; 0 where it is not known yet."""
        (began, first), (ended, last) = self._counted[0], self._counted[-1]
        return (last - first) / (ended - began) if ended > began else 0.0
