"""What a touch was like in numbers, each computed from a trace and nothing else."""

from __future__ import annotations

from math import isfinite, isnan, log, nan
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from zwidth.errors import InputError
from zwidth.loop.energy import ledger
from zwidth.loop.trace import UNITS
from zwidth.quantity.glossary import unit_suffix

if TYPE_CHECKING:
    from zwidth.loop.trace import AnyTrace

Array = NDArray[np.float64]


CHATTER_ABOVE_HZ = 30.0
"""Below, a hand may move the force of its own will; above, it is the loop."""


class Column(NamedTuple):
    """One number of the comparison: its heading, its kind of unit (0 position, 2 force, 3 energy, 4 none)."""

    heading: str
    kind: int


COLUMNS = {
    "deepest_position": Column("deepest", 0),
    "peak_actuator_force": Column("peak force", 2),
    "peak_hand_force": Column("peak hand force", 2),
    "chatter": Column("chatter", 2),
    "energy_extracted": Column("energy got out", 3),
    "contacts": Column("contacts", 4),
    "stops": Column("stops", 4),
    "last_swing": Column("swing at the end", 0),
}
"""What is compared.

chatter: RMS of the actuator force above 30 Hz over the samples inside the wall;
contacts: how often the encoder went from outside to inside; stops: how often
the mass came to rest or turned round; last swing: range of the position over
the last quarter of the time.
"""


def units_of(motion: str) -> dict[str, str]:
    """The unit of each number."""
    units = (*UNITS[motion], "J", "")
    return {name: units[column.kind] for name, column in COLUMNS.items()}


def keyed(row: dict[str, float], motion: str) -> dict[str, float | None]:
    """The numbers with their units in the keys; None for what is not known."""
    units = units_of(motion)
    names = {name: f"{name}_{unit_suffix(unit)}" if unit else name for name, unit in units.items()}
    return {names[name]: None if isnan(value) else value for name, value in row.items()}


def measure(trace: AnyTrace) -> dict[str, float]:
    """The numbers of one trace, SI; see `COLUMNS`."""
    x, force = trace["position"].values, trace["actuator_force"].values
    sampled = trace["sampled"].values
    inside = trace["measured_position"].values[sampled] > 0
    last = x[x.size - 1 - x.size // 4 :]
    return {
        "deepest_position": float(x.max()),
        "peak_actuator_force": float(np.abs(force).max()),
        "peak_hand_force": float(np.abs(trace["hand_force"].values).max()),
        "chatter": _chatter(trace["time"].values[sampled], force[sampled], inside),
        "energy_extracted": ledger(trace).extracted,
        "contacts": float(np.count_nonzero(inside[1:] & ~inside[:-1]) + int(inside[0])),
        "stops": float(trace.attrs["stops"]),
        "last_swing": float(last.max() - last.min()),
    }


def _chatter(time: Array, force: Array, inside: NDArray[np.bool_]) -> float:
    """RMS, over the samples inside, of the force without its parts below 30 Hz."""
    if not inside.any() or time.size < 4:
        return 0.0
    period = (time[-1] - time[0]) / (time.size - 1)
    spectrum = np.fft.rfft(force)
    spectrum[np.fft.rfftfreq(force.size, period) < CHATTER_ABOVE_HZ] = 0.0
    quick = np.fft.irfft(spectrum, force.size)
    return float(np.sqrt(np.mean(quick[inside] ** 2)))


# How far the stiffness that is felt is from the one that was wanted, in steps that a person can just tell.
#
#     n = ln(K_felt / K_wanted) / ln(1 + w)
#
# w is Weber's fraction: two stiffnesses are just told apart where they differ by this part.  Between −1 and 1
# a person would hardly know; a wall of n = −3 is softer by three such steps.


WEBER, SOURCE = 0.23, "Jones & Hunter 1990"
"""Of stiffness, by matching one forearm against the other: 23 %.

L. A. Jones, I. W. Hunter, A perceptual analysis of stiffness, Experimental Brain Research 79 (1990) 150–156.
By pinching, 22 % with the end force of no use as a cue: Tan, Durlach, Beauregard & Srinivasan, Perception &
Psychophysics 57 (1995) 495–510.  Where force and travel are told exactly, less: force by itself is told to
some 7 % (Pang, Tan & Durlach, Perception & Psychophysics 49, 1991, 531–540).
"""


def noticeable_differences(felt: float, wanted: float, weber: float = WEBER) -> float:
    """n, how many just-noticeable differences lie between two stiffnesses; negative: felt softer.

    Parameters
    ----------
    felt
        K_felt [N/m; N·m/rad]; nan comes out where it is not > 0, as of a wall that was not touched.
    wanted
        K_wanted > 0, in the same unit.
    weber
        w > 0, the smallest part by which two stiffnesses are told apart.
    """
    for name, value in (("wanted", wanted), ("weber", weber)):
        if not (isfinite(value) and value > 0):
            raise InputError(
                f"{name} must be finite and > 0, got {value!r}: what is felt is compared by ratios; "
                f"{'give the stiffness that was asked for' if name == 'wanted' else f'published: {WEBER}'}"
            )
    return log(felt / wanted) / log(1 + weber) if 0 < felt < float("inf") else nan


CHATTER = 30.0
"""Frequency above which force in sustained contact is felt as chatter [Hz]."""

FIRST = 0.01
"""Time after the first contact in which hardness is judged [s]."""

SETTLED = 0.05
"""Part of the final depth within which the hand must stay to be at rest."""


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


def _last_half(trace: AnyTrace, name: str) -> tuple[Array, float]:
    values, time = trace[name].values, trace["time"].values
    return np.asarray(values[values.size // 2 :]), float(time[1] - time[0])
