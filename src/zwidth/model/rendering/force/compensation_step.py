"""The step of `friction_compensation`: f ← f − F tanh(v/v_s) − C v, v = Δx/T."""

from __future__ import annotations

from zwidth.native.compiled import Array, compiled
from zwidth.quantity.elementary.hyperbolic import tanh

_COULOMB, _VISCOUS, _SPEED, _PERIOD = range(4)


@compiled
def step(p: Array, i: int, s: Array, j: int, x: float, force: float, applied: float) -> float:
    """One sample; p from i and s from j on are this law's."""
    v = (x - s[j]) / p[i + _PERIOD]
    s[j] = x
    if v == 0.0:
        return force
    most, speed = p[i + _COULOMB], p[i + _SPEED]
    bent = tanh(v / speed) if speed > 0.0 else (1.0 if v > 0.0 else -1.0)
    return force - most * bent - p[i + _VISCOUS] * v
