"""The motions that prove a wall active: one sample in, one sample out."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from zwidth.errors import InputError
from zwidth.model.operator.operator import Signals
from zwidth.model.operator.parameter import ParametricOperator
from zwidth.quantity.glossary import Quantity
from zwidth.quantity.parameter import parameter

if TYPE_CHECKING:
    from zwidth.model.operator.operator import Signal


@dataclass(frozen=True, kw_only=True)
class Cycle(ParametricOperator):
    """``x(kT) = low`` for even k, ``high`` for odd k: one sample in, one sample out.

    The two motions by which Abbott & Okamura (2005, section III-C) prove that
    their condition is necessary:

        K > 2b/T:    low = −ε,       high = n Δ + ε,   n large
        K > 2f_c/Δ:  low = Δ − ε/2,  high = Δ + ε/2,   ε small

    Every round takes energy out.

    Parameters
    ----------
    low, high
        The two positions, low < high [m; rad].
    """

    called = "cycle"

    low: float = parameter(
        Quantity("low", "x_low", "m", "rad", "position at even samples"), -1e-6, kept=float
    )
    high: float = parameter(
        Quantity("high", "x_high", "m", "rad", "position at odd samples"), 1e-3, kept=float
    )

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.low >= self.high:
            raise InputError(
                f"low must be < high, got {self.low:g} and {self.high:g}: "
                "the cycle goes in and comes out again"
            )

    @property
    def kinematic(self) -> bool:
        """True."""
        return True

    @property
    def initial_position(self) -> float:
        """low [m; rad]."""
        return self.low

    def signals(self, times: Signal) -> Signals:
        """low and high in turn."""
        return Signals(position=np.where(np.arange(len(times)) % 2, self.high, self.low))
