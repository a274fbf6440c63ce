"""`trace.zwidth`: the ledger, the stiffness felt, the plot, the files and the sound of a trace."""

from __future__ import annotations

from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING

import xarray as xr

from zwidth.bench.perceived import WEBER, noticeable_differences
from zwidth.bench.scores import static_stiffness
from zwidth.energy import Ledger, ledger
from zwidth.errors import InputError
from zwidth.loop.trace import FORMAT
from zwidth.traces.files import save_trace
from zwidth.traces.sound import save_sound

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@xr.register_dataset_accessor("zwidth")  # type: ignore[no-untyped-call]
class TraceAccessor:
    """What zwidth adds to the Dataset of a trace.

    Raises
    ------
    InputError
        If the Dataset is no trace.
    """

    def __init__(self, trace: xr.Dataset) -> None:
        if trace.attrs.get("format") != FORMAT:
            raise InputError(
                f"this Dataset is no zwidth trace: its attribute format is {trace.attrs.get('format')!r}, "
                f"not {FORMAT!r}; traces come from zwidth.simulate and zwidth.traces.load_trace"
            )
        self._trace = trace

    @property
    def energy(self) -> Ledger:
        """The energy ledger."""
        return ledger(self._trace)

    @property
    def felt_stiffness(self) -> float:
        """Mean force of the wall over mean depth in the last half, when the hand rests [N/m; N·m/rad].

        nan where that is not contact.
        """
        return static_stiffness(self._trace)

    def stiffness_jnds(self, wanted: float, weber: float = WEBER) -> float:
        """How many just-noticeable differences this is from a stiffness, see `noticeable_differences`."""
        return noticeable_differences(self.felt_stiffness, wanted, weber)

    def plot(self, path: str | PathLike[str] | None = None) -> Figure:
        """Position, force and energy against time, as the papers draw them; saved if a path is given."""
        from zwidth.plots.files import save_figure  # matplotlib takes its time
        from zwidth.plots.trace import trace_figure

        figure = trace_figure(self._trace)
        if path is not None:
            save_figure(lambda: figure, Path(path), overwrite=True)
        return figure

    def save(self, path: str | PathLike[str], *, force: bool = False) -> None:
        """Save as .nc, .parquet or .csv, see `save_trace`."""
        save_trace(self._trace, path, force=force)

    def sound(self, path: str | PathLike[str], *, force: bool = False) -> None:
        """Save the actuator force as sound, see `save_sound`."""
        save_sound(self._trace, path, force=force)
