"""A prescribed position: the hand goes there, whatever force that takes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import KW_ONLY, dataclass
from typing import TYPE_CHECKING

from zwidth.errors import InputError
from zwidth.model.operator.motion import UNIT, as_path, first, sampled
from zwidth.model.operator.operator import Signals
from zwidth.model.operator.record import RecordedOperator, as_record
from zwidth.quantity.parameter import Parametric, Reads, part
from zwidth.quantity.text import told_quantity

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from zwidth.model.operator.motion import Path
    from zwidth.model.operator.operator import Signal


def _switches(given: ArrayLike | None, name: str) -> Signal | None:
    return None if given is None else as_record(given, "switch positions", UNIT)


@dataclass(frozen=True, eq=False, repr=False)
class PrescribedMotion(Parametric, RecordedOperator):
    """``x(kT) = x_k``, at constant velocity between the samples.

    Parameters
    ----------
    positions
        x_k [m; rad], one for each sample instant of the touch, so duration/T + 1
        of them; or a function of the time [s] that gives them.
    switch_positions
        Position in each interval when the force changes, duration/T of them
        [m; rad]; None for a straight line.
    """

    positions: Reads[Signal | Callable[[float], float], Path] = part(
        "positions",
        lambda given, _: as_path(given),
        meaning="where the handle is at the samples",
    )
    _: KW_ONLY
    switch_positions: Reads[Signal | None, ArrayLike | None] = part(
        "positions", _switches, None, meaning="where it is when the force changes"
    )

    @property
    def kinematic(self) -> bool:
        """True."""
        return True

    @property
    def initial_position(self) -> float:
        """x_0 [m; rad]."""
        return first(self.positions)

    def signals(self, times: Signal) -> Signals:
        """The positions; a record's length must be that of the touch."""
        if not callable(self.positions):
            _same_length("positions", len(self.positions), len(times), "sample instants")
        if self.switch_positions is not None:
            _same_length("switch_positions", len(self.switch_positions), len(times) - 1, "sample intervals")
        switches = None if self.switch_positions is None else self.switch_positions.copy()
        return Signals(position=sampled(self.positions, times), switch_position=switches)

    def describe(self, motion: str = "linear") -> str:
        """How long the motion is and where it starts."""
        if callable(self.positions):
            start = told_quantity(self.initial_position, "position", motion)
            return f"prescribed motion, a function of time, from {start}"
        low, high = (
            told_quantity(x, "position", motion) for x in (self.positions.min(), self.positions.max())
        )
        return f"prescribed motion, {len(self.positions)} positions, {low} to {high}"


def _same_length(what: str, given: int, wanted: int, of: str) -> None:
    if given != wanted:
        raise InputError(
            f"{what} has {given} values, but the touch has {wanted} {of}: each has one position; "
            f"give {wanted} values, or another duration"
        )
