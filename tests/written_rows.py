"""Rows as a loop gives them, without a loop: a simulated touch, or numbers drawn at random."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

COLUMNS = (
    "sample",
    "time_s",
    "late_s",
    "position_m",
    "wished_force_N",
    "force_N",
    "energy_out_J",
    "friction_loss_J",
    "status",
    "phase",
    "law",
    "limited",
    "exchange_s",
)


class WrittenRows:
    """A ring of so many rows, into which a test writes when it wants to."""

    COLUMNS = COLUMNS

    def __init__(self, table: Array, *, kept: int = 1 << 14, period: float = 1e-3, motion: str = "linear"):
        self._table, self._kept = table, kept
        self.written = 0
        self.period, self.motion, self.title = period, motion, "a wall on a stand-in"
        self.about: dict[str, Any] = {"device": {"damping": "0.15 N*s/m"}, "safety": ["3 N", None, 1.5]}
        self.events: list[dict[str, Any]] = []

    def after(self, count: int) -> tuple[int, Array]:
        """As the ring of the loop does."""
        first = max(count, self.written - self._kept)
        return self.written, self._table[first : self.written].copy()


def drawn(rows: int, seed: int = 3) -> Array:
    """Any numbers at all, but for those that the loop counts."""
    table = np.random.default_rng(seed).normal(size=(rows, len(COLUMNS)))
    table[:, COLUMNS.index("sample")] = np.arange(rows)
    table[:, COLUMNS.index("time_s")] = 1e-3 * np.arange(rows)
    table[:, COLUMNS.index("late_s")] = 0.0
    for name in ("status", "law", "limited"):
        table[:, COLUMNS.index(name)] = 0.0
    table[:, COLUMNS.index("phase")] = 2.0
    return table
