"""What is looked at while a loop runs: the rows that it has written so far, and the curves made of them.

Whoever looks asks for the rows after those it has, at its own pace.  The loop never waits for it and is never
asked anything: who looks too seldom gets the rows that are still kept, and who has died asks no more.

    margin         E − W_a     friction loss less energy out: what the hand has put in at least, but for the
                               device's kinetic energy and the encoder's steps
    missed         k − r       row r tells of sample k: the samples between were not taken
    lateness       l + m T     late_s, and a period more for each deadline missed just before
"""

from __future__ import annotations

from typing import NamedTuple, Protocol

import numpy as np

from zwidth.native.compiled import Array


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
    """Rows, and how many of them were seen; for one who looks.

    Parameters
    ----------
    rows
        Of the loop.
    """

    def __init__(self, rows: Rows) -> None:
        position, force = names_of(rows.motion)
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


def names_of(motion: str) -> tuple[str, str]:
    """Of the columns of position and force."""
    return ("position_rad", "force_N_m") if motion == "rotary" else ("position_m", "force_N")
