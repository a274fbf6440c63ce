"""Several traces beside each other: what each touch was like, in a few numbers."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from math import isnan
from typing import TYPE_CHECKING, Any

from zwidth.errors import InputError
from zwidth.lazy import above
from zwidth.loop.energy import ledger
from zwidth.loop.traces.measures import COLUMNS, keyed, measure, units_of
from zwidth.quantity.documented import Documented
from zwidth.quantity.spoken import spoken
from zwidth.quantity.text import unit_text
from zwidth.showing import Part, Table

if TYPE_CHECKING:
    import xarray as xr


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
        return units_of(self.motion)

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
        return {label: keyed(row, self.motion) for label, row in self.rows.items()}

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

    def figure(self) -> Any:
        """All traces in one figure."""
        figure = above("plots").comparison_figure(self.traces)
        return figure

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


def _written(value: float) -> str:
    return "not known" if isnan(value) else f"{value:.4g}"
