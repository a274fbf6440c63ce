"""Several traces beside each other: what each touch was like, in a few numbers."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from math import isnan
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from zwidth.energy import ledger
from zwidth.errors import InputError
from zwidth.loop.trace import UNITS
from zwidth.passivity.result import Documented
from zwidth.quantity.spoken import spoken
from zwidth.quantity.text import unit_text
from zwidth.showing import Part, Table

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure
    from numpy.typing import NDArray

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


@dataclass(frozen=True, eq=False, repr=False)
class Comparison(Documented):
    """A few numbers of each trace, one row per trace.

    Parameters
    ----------
    traces
        By label.
    """

    traces: Mapping[str, xr.Dataset]

    @property
    def rows(self) -> dict[str, dict[str, float]]:
        """The numbers of each trace by label, SI."""
        return {label: measure(trace) for label, trace in self.traces.items()}

    @property
    def motion(self) -> str:
        """ "linear" or "rotary"."""
        return str(next(iter(self.traces.values())).attrs["motion"])

    def units(self) -> dict[str, str]:
        """The unit of each column."""
        units = (*UNITS[self.motion], "J", "")
        return {name: units[column.kind] for name, column in COLUMNS.items()}

    def to_xarray(self) -> xr.Dataset:
        """The numbers as a Dataset along `trace`."""
        import xarray as xr

        rows, units = self.rows, self.units()
        return xr.Dataset(
            {
                name: (
                    "trace",
                    [row[name] for row in rows.values()],
                    {"units": units[name] or "1", "long_name": column.heading},
                )
                for name, column in COLUMNS.items()
            },
            coords={"trace": list(rows)},
        )

    def to_dict(self) -> dict[str, Any]:
        """The numbers by label, units in the keys."""
        keys = {"N*m": "N_m"}
        names = {n: f"{n}_{keys.get(u, u)}" if u else n for n, u in self.units().items()}
        return {
            label: {names[n]: None if isnan(v) else v for n, v in row.items()}
            for label, row in self.rows.items()
        }

    def table(self) -> list[list[str]]:
        """Headings, then one line of text per trace."""
        told = {name: spoken(unit) for name, unit in self.units().items()}
        head = [
            "trace",
            *(
                f"{c.heading} [{unit_text(told[n][1])}]" if told[n][1] else c.heading
                for n, c in COLUMNS.items()
            ),
        ]
        lines = [
            [label, *(_written(told[name][0] * row[name]) for name in COLUMNS)]
            for label, row in self.rows.items()
        ]
        return [head, *lines]

    def figure(self) -> Figure:
        """All traces in one figure."""
        from zwidth.plots.trace import comparison_figure  # matplotlib takes its time

        return comparison_figure(self.traces)

    def report(self) -> Iterable[Part]:
        """The table."""
        head, *rows = self.table()
        yield Table(heads=[head], rows=rows, lefts=1)


def compare_traces(*traces: xr.Dataset | Mapping[str, xr.Dataset]) -> Comparison:
    """Several traces beside each other.

    Parameters
    ----------
    traces
        One mapping {label: trace}, or traces; these are labelled by their environment and operator.

    Raises
    ------
    InputError
        If there is none, one is no trace, or linear and rotary devices are mixed.
    """
    if len(traces) == 1 and isinstance(traces[0], Mapping) and not hasattr(traces[0], "attrs"):
        named = {str(label): trace for label, trace in traces[0].items()}
    else:
        named = {}
        for number, trace in enumerate(traces, 1):
            attributes = getattr(trace, "attrs", {})
            label = (
                f"{attributes.get('environment', '?')}; {str(attributes.get('operator', '?')).split(',')[0]}"
            )
            named[label if label not in named else f"{label} ({number})"] = trace  # type: ignore[assignment]
    if not named:
        raise InputError("give one trace at least to compare")
    for trace in named.values():
        ledger(trace)  # refuses what is no trace
    if len({trace.attrs.get("motion") for trace in named.values()}) > 1:
        raise InputError("a linear and a rotary device have no unit in common: compare them apart")
    return Comparison(named)


def measure(trace: xr.Dataset) -> dict[str, float]:
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


def _written(value: float) -> str:
    return "not known" if isnan(value) else f"{value:.4g}"


def _chatter(time: Array, force: Array, inside: NDArray[np.bool_]) -> float:
    """RMS, over the samples inside, of the force without its parts below 30 Hz."""
    if not inside.any() or time.size < 4:
        return 0.0
    period = (time[-1] - time[0]) / (time.size - 1)
    spectrum = np.fft.rfft(force)
    spectrum[np.fft.rfftfreq(force.size, period) < CHATTER_ABOVE_HZ] = 0.0
    quick = np.fft.irfft(spectrum, force.size)
    return float(np.sqrt(np.mean(quick[inside] ** 2)))
