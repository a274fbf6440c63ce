"""`trace.zwidth`: the ledger, the stiffness felt, the plot, the files and the sound of a trace."""

from __future__ import annotations

from os import PathLike
from pathlib import Path
from typing import Any

import xarray as xr

from zwidth.errors import InputError
from zwidth.lazy import above
from zwidth.loop.energy import Ledger, PairLedger, ledger, of_one_arm
from zwidth.loop.pair.simulate import FORMAT as OF_A_PAIR
from zwidth.loop.trace import FORMAT
from zwidth.loop.traces.files import save_sound, save_trace
from zwidth.loop.traces.measures import WEBER, noticeable_differences, static_stiffness, tracking_error


@xr.register_dataset_accessor("zwidth")  # type: ignore[no-untyped-call]
class TraceAccessor:
    """What zwidth adds to the Dataset of a trace.

    Raises
    ------
    InputError
        If the Dataset is no trace.
    """

    def __init__(self, trace: xr.Dataset) -> None:
        if trace.attrs.get("format") not in (FORMAT, OF_A_PAIR):
            raise InputError(
                f"this Dataset is no zwidth trace: its attribute format is {trace.attrs.get('format')!r}, "
                f"not {FORMAT!r}; traces come from zwidth.simulate and zwidth.traces.load_trace"
            )
        self._trace = trace

    @property
    def energy(self) -> Ledger | PairLedger:
        """The energy ledger; of a pair, that of both arms."""
        if self._both:
            return PairLedger(self._trace)
        if self._trace.attrs["format"] == OF_A_PAIR:
            return ledger(of_one_arm(self._trace.copy(deep=False)))
        return ledger(self._trace)

    @property
    def _both(self) -> bool:
        """True for the trace of a pair; False for that of one arm, also of one out of a pair's."""
        return "arm" in self._trace.dims

    @property
    def felt_stiffness(self) -> float:
        """Mean force of the wall over mean depth in the last half, when the hand rests [N/m; N·m/rad].

        Of a pair it is that of the leader.  nan where that is not contact.
        """
        return static_stiffness(self._one)

    @property
    def _one(self) -> xr.Dataset:
        return self._trace.sel(arm="leader") if self._both else self._trace

    @property
    def tracking_error(self) -> float:
        """Root of the mean of (x_l − x_f)² of a pair [m; rad].

        Raises
        ------
        InputError
            If it is no trace of a pair.
        """
        if not self._both:
            raise InputError("one arm alone tracks nothing: this is of the trace of a pair, both arms")
        return tracking_error(self._trace)

    def stiffness_jnds(self, wanted: float, weber: float = WEBER) -> float:
        """How many just-noticeable differences this is from a stiffness, see `noticeable_differences`."""
        return noticeable_differences(self.felt_stiffness, wanted, weber)

    def plot(self, path: str | PathLike[str] | None = None) -> Any:
        """Position, force and energy against time, as the papers draw them; saved if a path is given."""
        plots = above("plots")
        figure = (plots.pair_trace_figure if self._both else plots.trace_figure)(self._trace)
        if path is not None:
            plots.save_figure(lambda: figure, Path(path), overwrite=True)
        return figure

    def save(self, path: str | PathLike[str], *, force: bool = False) -> None:
        """Save as .nc, .parquet or .csv, see `save_trace`."""
        save_trace(self._trace, path, force=force)

    def sound(self, path: str | PathLike[str], *, force: bool = False) -> None:
        """Save the actuator force as sound, see `save_sound`; of a pair that of the leader."""
        save_sound(self._one, path, force=force)
