"""Scores of a law, each computed from a trace and nothing else."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from zwidth.loop.trace import AnyTrace

CHATTER = 30.0
"""Frequency above which force in sustained contact is felt as chatter [Hz]."""

FIRST = 0.01
"""Time after the first contact in which hardness is judged [s]."""

SETTLED = 0.05
"""Part of the final depth within which the hand must stay to be at rest."""

Floats = NDArray[np.float64]


def generated_energy(trace: AnyTrace) -> float:
    """max over t of ∫ f_a dx − E_s, the most that the law has given out in all [J]; 0 if it never did.

    E_s is what was stored at the start, where that is known.
    """
    stored = float(trace.attrs.get("stored_at_start_J", 0.0))
    return max(0.0, float(trace["actuator_work"].values.max()) - stored)


def peak_force(trace: AnyTrace) -> float:
    """Largest |f_a| [N]."""
    return float(np.abs(trace["actuator_force"].values).max())


def rms_force(trace: AnyTrace) -> float:
    """Root of the mean of f_a² in contact [N]; 0 without contact."""
    force = trace["actuator_force"].values[_inside(trace)]
    return float(np.sqrt(np.mean(force**2))) if force.size else 0.0


def chatter(trace: AnyTrace) -> float:
    """RMS of f_a above 30 Hz over the last half of the trace [N]."""
    force, period = _last_half(trace, "actuator_force")
    spectrum = np.fft.rfft(force - force.mean())
    fast = np.fft.rfftfreq(force.size, period) > CHATTER
    return float(np.sqrt(2 * np.sum(np.abs(spectrum[fast]) ** 2)) / force.size)


def static_stiffness(trace: AnyTrace) -> float:
    """Mean force over mean depth in the last half of the trace [N/m]; nan where that is not contact."""
    force, _ = _last_half(trace, "actuator_force")
    depth, _ = _last_half(trace, "position")
    return float(force.mean() / depth.mean()) if depth.mean() > 0 else float("nan")


def rate_hardness(trace: AnyTrace) -> float:
    """Largest rise of f_a from sample to sample in the first 10 ms of contact, over T and the speed of entry.

    [N/s per m/s = N/m] (Lawrence and others 2000); nan without contact.
    """
    start = _first_contact(trace)
    time = trace["time"].values
    period = float(time[1] - time[0])
    last = min(start + round(FIRST / period), time.size - 1)
    speed = float(trace["velocity"].values[start]) if start < time.size else 0.0
    if start + 1 >= time.size or speed <= 0:
        return float("nan")
    rise = np.diff(trace["actuator_force"].values[max(start - 1, 0) : last + 1]).max()
    return float(rise / period / speed)


def tracking_error(trace: AnyTrace) -> float:
    """Root of the mean of (x_l − x_f)² of a pair [m; rad]."""
    leader, follower = trace["position"].values
    return float(np.sqrt(np.mean((leader - follower) ** 2)))


def free_damping(trace: AnyTrace) -> float:
    """−∫ f_a dx over −∫ v² dt in free air: the damping that the law adds there [N·s/m]."""
    velocity = trace["velocity"].values
    time = trace["time"].values
    travelled = float(np.trapezoid(velocity**2, time))
    return -float(trace["actuator_work"].values[-1]) / travelled if travelled > 0 else 0.0


def penetration(trace: AnyTrace) -> float:
    """Deepest position [m]."""
    return max(0.0, float(trace["position"].values.max()))


def bounces(trace: AnyTrace) -> int:
    """How often contact is lost after the first touch."""
    inside = _inside(trace).astype(int)
    return int(np.sum(np.diff(inside) < 0))


def settling_time(trace: AnyTrace) -> float:
    """From the first contact until the hand stays within 5 % of its final depth [s]; inf if it never does."""
    start = _first_contact(trace)
    x, time = trace["position"].values, trace["time"].values
    if start >= time.size:
        return float("inf")
    final = float(x[-max(x.size // 4, 1) :].mean())
    away = np.flatnonzero(np.abs(x[start:] - final) > SETTLED * abs(final))
    if away.size == 0:
        return 0.0
    last = start + int(away[-1])
    return float("inf") if last > 0.9 * time.size else float(time[last] - time[start])


def _inside(trace: AnyTrace) -> NDArray[np.bool_]:
    return np.asarray(trace["position"].values > 0)


def _first_contact(trace: AnyTrace) -> int:
    inside = np.flatnonzero(_inside(trace))
    return int(inside[0]) if inside.size else trace["time"].values.size


def _last_half(trace: AnyTrace, name: str) -> tuple[Floats, float]:
    values, time = trace[name].values, trace["time"].values
    return np.asarray(values[values.size // 2 :]), float(time[1] - time[0])
