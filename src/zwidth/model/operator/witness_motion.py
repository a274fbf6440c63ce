"""The motion of a witness, prescribed."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from zwidth.model.operator.motion import check_period, held, listed
from zwidth.model.operator.operator import Operator, Signals
from zwidth.quantity.text import told_quantity

if TYPE_CHECKING:
    from zwidth.model.operator.operator import Signal


@dataclass(frozen=True, kw_only=True)
class WitnessMotion(Operator):
    """``x(kT) = x_k`` of a witness: the motion that `check` or `available_storage` found to take energy out.

    After its end the hand stays where it is; of a longer motion the touch sees the beginning.

    Parameters
    ----------
    witness
        A witness, `zw.check(device, environment).witness` or that of `zw.available_storage`, or its motion.
    rounds
        How often its repeated parts are done, ≥ 1; None as in the witness.
    """

    witness: Any = field(kw_only=False)
    rounds: int | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "_listed", listed(self.witness, self.rounds))

    @property
    def intervals(self) -> int:
        """Sample intervals of the whole motion: its duration is so many T."""
        return len(self._positions) - 1

    @property
    def kinematic(self) -> bool:
        """True."""
        return True

    @property
    def initial_position(self) -> float:
        """x_0 [m; rad]."""
        return float(self._positions[0])

    def signals(self, times: Signal) -> Signals:
        """The positions of the witness, and between the samples when the force changes."""
        check_period(getattr(self.witness, "sample_period", None), times)
        switches: Signal | None = self.__dict__["_listed"][1]
        if switches is not None:
            rest = np.full(max(len(times) - 1 - len(switches), 0), self._positions[-1])
            switches = np.concatenate([switches[: len(times) - 1], rest])
        return Signals(position=held(self._positions, len(times)), switch_position=switches)

    def describe(self, motion: str = "linear") -> str:
        """How long the motion is and how deep."""
        deepest = told_quantity(self._positions.max(), "position", motion)
        return f"motion of a witness, {self.intervals} samples, to {deepest}"

    @property
    def _positions(self) -> Signal:
        positions: Signal = self.__dict__["_listed"][0]
        return positions
