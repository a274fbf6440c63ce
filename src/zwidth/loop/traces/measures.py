"""What a touch was like, in a few numbers."""

from __future__ import annotations

from math import isnan
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from zwidth.loop.energy import ledger
from zwidth.loop.trace import UNITS

if TYPE_CHECKING:
    from numpy.typing import NDArray

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


_KEYS = {"N*m": "N_m"}


def units_of(motion: str) -> dict[str, str]:
    """The unit of each number."""
    units = (*UNITS[motion], "J", "")
    return {name: units[column.kind] for name, column in COLUMNS.items()}


def keyed(row: dict[str, float], motion: str) -> dict[str, float | None]:
    """The numbers with their units in the keys; None for what is not known."""
    units = units_of(motion)
    names = {name: f"{name}_{_KEYS.get(unit, unit)}" if unit else name for name, unit in units.items()}
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
