"""A hand that pushes as it was recorded."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from zwidth.errors import InputError
from zwidth.model.operator.column import read_column
from zwidth.model.operator.operator import Signals
from zwidth.model.operator.record import RecordedOperator, as_record
from zwidth.quantity.parameter import Parametric, Reads, part
from zwidth.quantity.text import told_quantity

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from zwidth.model.operator.operator import Signal


def _record(given: ArrayLike, name: str) -> Signal:
    return as_record(given, "recorded force", "N or N·m")


@dataclass(frozen=True, eq=False, repr=False)
class RecordedForce(Parametric, RecordedOperator):
    """``f_h = F_k`` from the sample instant kT to (k+1)T.

    Parameters
    ----------
    newtons
        F_k, positive into the wall, one value for each sample interval of the
        touch, so duration/T of them [N; N·m].
    """

    newtons: Reads[Signal, ArrayLike] = part("force record", _record, meaning="the force of each interval")

    @classmethod
    def from_file(cls, path: str | Path, column: str | int | None = None) -> RecordedForce:
        """The force in one column of a text file, one line per sample interval.

        Parameters
        ----------
        path
            A CSV file, or one number on each line; "#" starts a comment. The
            first line may be names.
        column
            Its name, or its number from 0; not needed where there is only one.
        """
        return cls(read_column(path, column))

    def signals(self, times: Signal) -> Signals:
        """The record; its length must be that of the touch."""
        given, wanted = len(self.newtons), len(times) - 1
        if given != wanted:
            duration = given * (times[1] - times[0])
            raise InputError(
                f"the recorded force has {given} values, but the touch has {wanted} sample intervals: each "
                f"interval holds one value; give {wanted} values, or a duration of {duration:.9g} s"
            )
        return Signals(force=self.newtons.copy())

    def describe(self, motion: str = "linear") -> str:
        """How long the record is and what it spans."""
        low, high = self.newtons.min(), self.newtons.max()
        highest = told_quantity(high, "force", motion)
        return f"recorded force, {len(self.newtons)} samples, {low:.6g} to {highest}"
