"""The poles of a sampled wall, by matrices that share no code with it: `from stepped_loop import radius`."""

from __future__ import annotations

import numpy as np
from scipy.linalg import expm


def radius(flow: np.ndarray, stiffness: float, damping: float, period: float, delay: float = 0.0) -> float:
    """Largest |pole| of a spring and a damper by the backward difference, late by `delay`.

    `flow` is the continuous motion of device and hand, x first and the force of the wall last; the x of the
    last sample and the forces of the last ones are states.
    """
    n, late = len(flow) - 1, int(delay / period + 1e-9)
    part = delay - late * period
    before, after = expm(flow * part), expm(flow * (period - part))
    unit = np.eye(n + 2 + late)
    force = (stiffness + damping / period) * unit[0] - damping / period * unit[n]
    held = [force, *unit[n + 1 :]]  # of now, of one sample ago, …
    middle = before[:n] @ np.vstack([unit[:n], held[late + 1]])
    step = np.vstack([after[:n] @ np.vstack([middle, held[late]]), unit[0], force, unit[n + 1 : -1]])
    return float(np.abs(np.linalg.eigvals(step)).max())
