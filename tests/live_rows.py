"""Rows of a loop that does not run: written down beforehand, and handed out as its ring would."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


class WrittenRows:
    """Rows of which the first `count` are written so far, and the last `kept` of those are still there.

    Row i belongs to sample `samples[i]`; the other columns are whatever a seed gives, but for `columns`.
    """

    def __init__(
        self,
        samples: Array,
        *,
        motion: str = "linear",
        period: float = 1e-3,
        kept: int = 10**9,
        **columns: object,
    ) -> None:
        x, f = ("position_rad", "force_N_m") if motion == "rotary" else ("position_m", "force_N")
        self.COLUMNS = (
            "sample", "time_s", "late_s", x, f"wished_{f}", f, "energy_out_J", "friction_loss_J",
            "status", "phase", "law", "limited", "exchange_s",
        )  # fmt: skip
        self.period, self.motion, self.title = period, motion, "a paddle <b>in a wall</b>"
        self.count, self._kept = 0, kept
        self.asked = 0
        late = np.asarray(columns.get("late_s", 0.1 * period)) * np.ones(len(samples))
        self.table = np.random.default_rng(4).normal(size=(len(samples), len(self.COLUMNS)))
        own = {"sample": samples, "time_s": samples * period + late, "late_s": late}
        own |= {"status": 0.0, "phase": 2.0, "law": 1.0, "limited": 0.0, "exchange_s": 2e-5}
        for name, values in {**own, **columns}.items():
            self.table[:, self.COLUMNS.index(name)] = values

    def after(self, count: int) -> tuple[int, Array]:
        """As the ring of a loop."""
        self.asked += 1
        written = self.count
        return written, self.table[max(count, written - self._kept) : written].copy()

    def column(self, name: str) -> Array:
        """All that there will be of a column."""
        return self.table[:, self.COLUMNS.index(name)]
