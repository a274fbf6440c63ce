"""A loop in one line: its phase and law, its rate, the force now, how late it is and what it has missed."""

from __future__ import annotations

from collections import deque

import numpy as np

from zwidth.machine.servo.connection import GOOD
from zwidth.machine.servo.live.rows import FORCE, LATENESS, MARGIN, POSITION, News, Rows
from zwidth.machine.servo.ring import PHASES

_WITHIN = 1.0
"""Over how long the rate is taken [s]."""


class Tally:
    """Counts what is seen of a loop.

    Parameters
    ----------
    rows
        Of the loop: it tells the names of the columns, and the motion.
    """

    def __init__(self, rows: Rows) -> None:
        self._at = {name: i for i, name in enumerate(rows.COLUMNS)}
        self._units = ("mrad", "mN·m") if rows.motion == "rotary" else ("mm", "N")
        self._force_scale = 1e3 if rows.motion == "rotary" else 1.0
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
            f"margin {1e3 * curve[MARGIN]:+.3f} mJ",
            f"late by {1e6 * curve[LATENESS]:.0f} µs, {1e6 * self._longest:.0f} µs at most",
            f"{self._missed} deadlines missed",
        ]
        parts[2:2] = [f"{rate:.4g} Hz"] if (rate := self._rate) else []
        parts += [f"{self._bad} bad answers"] if self._bad else []
        parts += [f"{self._skipped} samples not shown"] if self._skipped else []
        return " · ".join(parts).replace("-", "−")

    @property
    def _rate(self) -> float:
        """Rows a second; 0 where it is not known yet."""
        (began, first), (ended, last) = self._counted[0], self._counted[-1]
        return (last - first) / (ended - began) if ended > began else 0.0
