"""The velocity estimators as the compiled laws call them: packed as kind, then the estimator's numbers."""

from __future__ import annotations

from typing import Any

from zwidth.errors import InputError
from zwidth.model.rendering.rendering_law import LoopContext
from zwidth.model.rendering.velocity import adaptive_window, kalman, tick_time
from zwidth.model.rendering.velocity.adaptive_window import ADAPTIVE_WINDOW, AdaptiveWindow
from zwidth.model.rendering.velocity.estimator import Estimator
from zwidth.model.rendering.velocity.kalman import KALMAN
from zwidth.model.rendering.velocity.tick_time import TICK_TIME
from zwidth.native.compiled import Array, compiled
from zwidth.quantity.parameter import part

_windowed, _ticked, _filtered = adaptive_window.step, tick_time.step, kalman.step


def as_estimator(velocity: Estimator | None) -> Estimator:
    """The estimator; by default the adaptive window."""
    chosen: Any = AdaptiveWindow() if velocity is None else velocity
    if not isinstance(chosen, Estimator):
        raise InputError(
            f"velocity is AdaptiveWindow(), TickTime() or Kalman(), got {type(chosen).__name__}; the linear "
            "ones are a wall's velocity_filter, and AdaptiveWindow(longest=1) is the backward difference"
        )
    return chosen


def estimated() -> Any:
    """The field `velocity` of a law that needs one."""
    return part(
        "velocity",
        lambda given, _: as_estimator(given),
        None,
        meaning="adaptive-window (default), tick-time, kalman, or a table of one of them",
    )


def packed(estimator: Estimator, at: LoopContext) -> list[float]:
    """The numbers that `estimate` reads."""
    return [estimator.kind, *estimator.numbers(at)]


@compiled
def estimate(p: Array, i: int, s: Array, j: int, x: float) -> float:
    """v̂ of one sample [m/s; rad/s]; p from i and s from j on are the estimator's."""
    kind = p[i]
    if kind == ADAPTIVE_WINDOW:
        return _windowed(p, i + 1, s, j, x)
    if kind == TICK_TIME:
        return _ticked(p, i + 1, s, j, x)
    if kind == KALMAN:
        return _filtered(p, i + 1, s, j, x)
    return 0.0
