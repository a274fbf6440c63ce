"""What the friction was at which speed, for pictures and for curves: a bounded sample of the pulses."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from zwidth.compiled import Array
from zwidth.identification.device import pulses
from zwidth.identification.device.moments import REGRESSORS, halves, line

if TYPE_CHECKING:
    import xarray as xr

    from zwidth.identification.device.regression import Regression

MOST = 50_000
"""Pulses that are kept."""


class Points:
    """Pieces of pulses, every one at first, then every second, every fourth, …"""

    def __init__(self) -> None:
        self._kept: list[tuple[Array, Array]] = []
        self._seen, self._stride = 0, 1

    def add(self, rows: Array, zero: str) -> None:
        """Look at the pulses of the next piece."""
        if self._seen % self._stride == 0 and len(rows):
            self._kept.append((rows, line(rows, zero)))
            if sum(len(kept) for kept, _ in self._kept) > MOST:
                self._kept = self._kept[::2]
                self._stride *= 2
        self._seen += 1

    def dataset(self, fit: Regression, mass: float | None, motion: str) -> xr.Dataset:
        """Speed, friction, and what the fit leaves, along `pulse`."""
        import xarray as xr

        speeds, frictions, lefts, times = [], [], [], []
        for rows, basis in self._kept:
            even, odd = halves(rows)
            columns = (even + odd) / 2
            explained = sum(fit.value(name) * columns[:, REGRESSORS.index(name)] for name in fit.names)
            if mass is not None:
                explained = explained + mass * columns[:, 0]
            left = columns[:, -1] - explained
            left = left - basis @ (basis.T @ left)
            friction = sum(
                fit.value(name) * columns[:, REGRESSORS.index(name)]
                for name in ("damping", "coulomb_friction")
                if name in fit.names
            )
            speeds.append(columns[:, 1])
            frictions.append(friction + left)
            lefts.append(left)
            times.append(rows[:, pulses.TIME])
        speed, force = ("rad/s", "N*m") if motion == "rotary" else ("m/s", "N")
        return xr.Dataset(
            {
                "friction": ("pulse", np.concatenate(frictions), {"units": force, "long_name": "friction"}),
                "residual": ("pulse", np.concatenate(lefts), {"units": force, "long_name": "left over"}),
            },
            coords={
                "speed": ("pulse", np.concatenate(speeds), {"units": speed, "long_name": "velocity"}),
                "time": ("pulse", np.concatenate(times), {"units": "s", "long_name": "time in the piece"}),
            },
        )
