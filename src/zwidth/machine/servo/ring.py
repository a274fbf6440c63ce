"""What the loop writes down, and how it is read beside it: a ring of rows, one for each sample.

The loop writes a row and then counts it; whoever reads copies the rows below the count, and throws away those
that were written over meanwhile.  Nobody waits for anybody.
"""

from __future__ import annotations

from math import log2
from typing import Any

import numpy as np
from numpy.typing import NDArray

from zwidth.data.logs.contents import COLUMNS
from zwidth.errors import InputError
from zwidth.machine.servo.connection import MOST_TOLD, Connection
from zwidth.native.compiled import Array, compiled

(
    SAMPLE, AT, LATE, POSITION, WISHED, GIVEN, ENERGY_OUT, FRICTION_LOSS, STATUS, PHASE, LAW, LIMITED,
    EXCHANGE, TELLS,
) = range(14)  # fmt: skip
WIDTH = TELLS + MOST_TOLD

MEASURING, WAITING, SERVING, ENDED = range(4)
"""Phases: force 0 and no law; a law that waits for a force near 0; the law's force; force 0 for good."""

PHASES = ("measuring", "waiting", "serving", "ended")

FORCE_LIMITED, SLEW_LIMITED = 1, 2
"""In LIMITED: the force was cut to its limit, or to what it may change in a sample; 3 for both."""

_LEAST_ROWS = 1 << 14
_KEPT = 4.0
"""How long a row is kept at least [s]."""

_SPARE = 8
"""Rows before the oldest that may be written over while they are copied."""


def ring(period: float) -> Array:
    """Rows for some seconds; touched once, so that the loop waits for no page of memory."""
    rows = _LEAST_ROWS
    while rows * period < _KEPT:
        rows *= 2
    return np.full((rows, WIDTH), np.nan)


def column_names(connection: Connection) -> tuple[str, ...]:
    """Names of the columns, units in them."""
    x, f = COLUMNS[connection.motion]
    own = ("sample", "time_s", "late_s", x, f"wished_{f}", f, "energy_out_J", "friction_loss_J")
    return (*own, "status", "phase", "law", "limited", "exchange_s", *connection.tells)


class Rows:
    """The rows of a loop, as live graphs and recordings read them.

    Parameters
    ----------
    connection
        Which tells the names of the columns.
    kept, written
        The ring, and the array whose element `at` counts its rows.
    period
        T [s].
    title
        What is served, in words.
    about
        The same for a file: texts and numbers, units in the keys.
    """

    def __init__(
        self,
        connection: Connection,
        kept: Array,
        written: np.ndarray[Any, Any],
        at: int,
        *,
        period: float,
        title: str,
        about: dict[str, Any],
    ) -> None:
        if len(connection.tells) > MOST_TOLD:
            raise InputError(
                f"a connection tells {MOST_TOLD} numbers at most besides the position, this one "
                f"{len(connection.tells)}: a row of the ring has room for so many"
            )
        self.COLUMNS = column_names(connection)
        self._kept, self._written, self._at = kept, written, at
        self.period, self.motion, self.title, self.about = period, connection.motion, title, about
        self.events: list[dict[str, Any]] = []

    @property
    def count(self) -> int:
        """Rows written so far."""
        return int(self._written[self._at])

    def after(self, count: int) -> tuple[int, Array]:
        """The rows after the first `count`, as far as they are kept; and how many there are now.

        Rows that came too fast for the reader are left out: their `sample` shows it.
        """
        written, size = self.count, self._kept.shape[0]
        first = max(count, written - size + _SPARE)
        found = self._kept[np.arange(first, written) % size, : len(self.COLUMNS)]
        gone = self.count - size + _SPARE - first  # written over while they were copied
        return written, found[max(0, gone) :]

    def column(self, name: str) -> int:
        """Where a column is."""
        return self.COLUMNS.index(name)


# How times are spread, counted while the loop runs: in bins that are each a sixteenth of an octave wide.


_PER_OCTAVE = 16
BINS = 40 * _PER_OCTAVE
"""Up to 2⁴⁰ ns, 18 minutes."""


@compiled
def count(bins: NDArray[np.int64], nanoseconds: float) -> None:
    """Count a time."""
    at = int(log2(nanoseconds) * _PER_OCTAVE) if nanoseconds > 1.0 else 0
    bins[min(at, bins.shape[0] - 1)] += 1


def quantile(bins: NDArray[np.int64], share: float) -> float:
    """The time that this share of those counted does not exceed [s], 4.4 % too long at most; 0 of none."""
    total = int(bins.sum())
    if total == 0:
        return 0.0
    upto = np.cumsum(bins)
    at = int(np.searchsorted(upto, np.ceil(share * total)))
    return float(2.0 ** ((at + 1) / _PER_OCTAVE) * 1e-9)
