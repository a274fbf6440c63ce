"""What is stored in an element that is not linear: its potential, 0 at its least."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from zwidth.model.scene.mean_force import spring_at
from zwidth.model.scene.nonlinear import CONTACT, COULOMB

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]


def stored_in(p: Array, code: float, number: int, state: float) -> float:
    """½ K δ² of a contact, 0 of friction, the area below the points of a spring [J]."""
    if code == COULOMB:
        return 0.0
    if code == CONTACT:
        return float(0.5 * p[number] * max(0.0, state) ** 2)
    count = int(p[number])
    x, f = p[number + 1 : number + 1 + count], p[number + 1 + count : number + 1 + 2 * count]
    rest = float(np.interp(0.0, f, x)) if f[0] < 0.0 < f[-1] else float(x[np.abs(f).argmin()])
    low, high = min(rest, state), max(rest, state)
    places = np.array([low, *x[(x > low) & (x < high)], high])
    forces = np.array([spring_at(p, number, place) for place in places])
    return float(abs(np.trapezoid(forces, places)))
