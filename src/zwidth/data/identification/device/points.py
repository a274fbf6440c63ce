"""What the friction was at which speed, for pictures and for curves: a bounded sample of the pulses."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from zwidth.data.identification.device import pulses
from zwidth.data.identification.device.moments import REGRESSORS, halves, line
from zwidth.loop.trace import Labelled, Trace
from zwidth.native.compiled import Array
from zwidth.quantity.glossary import GLOSSARY

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from zwidth.data.identification.device.regression import Regression

MOST = 50_000
"""Pulses that are kept."""

_ABOUT = {
    "force": ("force", "force, without its zero"),
    "friction": ("force", "friction"),
    "residual": ("force", "left over"),
    "speed": ("speed", "velocity"),
    "time": ("s", "time in the piece"),
    "stroke": ("1", "number of the stroke"),
    "piece": ("1", "number of the piece"),
}
"""What is told of each pulse: its unit or the kind of it, its name."""


class Points:
    """Pieces of pulses, every one at first, then every second, every fourth, …"""

    def __init__(self, knee: float) -> None:
        self._knee = knee
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

    def labelled(self, fit: Regression, mass: float | None, motion: str) -> Trace:
        """Force, friction and what the fit leaves, along `pulse`; with speed, time, stroke and piece."""
        found: dict[str, list[NDArray[Any]]] = {key: [] for key in _ABOUT}
        strokes = 0
        for piece, (rows, basis) in enumerate(self._kept):
            even, odd = halves(rows, self._knee)
            columns = (even + odd) / 2
            terms = {name: fit.value(name) * columns[:, REGRESSORS.index(name)] for name in fit.names}
            if mass is not None:
                terms["mass"] = mass * columns[:, 0]
            explained = sum(terms.values(), np.zeros(len(rows)))
            left = columns[:, -1] - explained
            left = left - basis @ (basis.T @ left)
            _, stroke = np.unique(rows[:, pulses.STROKE], return_inverse=True)
            found["force"].append(explained + left)
            found["friction"].append(
                sum((terms[n] for n in ("damping", "coulomb_friction", "slow") if n in terms), left)
            )
            found["residual"].append(left)
            found["speed"].append(columns[:, 1])
            found["time"].append(rows[:, pulses.TIME])
            found["stroke"].append(stroke + strokes)
            found["piece"].append(np.full(len(rows), piece))
            strokes += int(stroke[-1]) + 1
        units = {
            "force": GLOSSARY["force"].unit_for(motion),
            "speed": GLOSSARY["friction_speed"].unit_for(motion),
        }
        data = {
            key: Labelled(
                ("pulse",),
                np.concatenate(parts),
                {"units": units.get(_ABOUT[key][0], _ABOUT[key][0]), "long_name": _ABOUT[key][1]},
            )
            for key, parts in found.items()
        }
        along = {key: data.pop(key) for key in ("speed", "time", "stroke", "piece")}
        return Trace(data, along, {})
