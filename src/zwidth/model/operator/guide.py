"""A motorized linear guide that pushes the handle into the wall.

So the limits of virtual walls were measured in the study of viscoelastic soft
tissue: the stiffness is increased while "the motorized linear guide is
simultaneously pushed into the virtual wall".
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from zwidth.model.operator.operator import Signals
from zwidth.model.operator.parameter import ParametricOperator
from zwidth.model.operator.quantities import SPEED, START
from zwidth.quantity.glossary import Quantity
from zwidth.quantity.parameter import parameter

if TYPE_CHECKING:
    from zwidth.model.operator.operator import Signal


@dataclass(frozen=True, kw_only=True)
class Guide(ParametricOperator):
    """``x(t) = min(x_0 + v t, x_end)``: a motorized guide pushes in at constant speed and holds.

    The numbers are chosen; of the guide in the study of viscoelastic soft tissue nothing is
    published but that it pushes into the wall.

    Parameters
    ----------
    start
        x_0 ≤ 0, where the push starts [m; rad].
    speed
        v > 0 [m/s; rad/s].
    depth
        x_end ≥ 0, where it stops [m; rad].
    """

    called = "linear guide"

    start: float = parameter(
        START, -0.005, bound="≤ 0", why="the push starts outside or at the surface, x = 0", kept=float
    )
    speed: float = parameter(
        SPEED, 0.02, bound="> 0", why="a guide that stands still meets no wall", kept=float
    )
    depth: float = parameter(
        Quantity("depth", "x_end", "m", "rad", "where the guide stops, inside the wall"),
        0.01,
        bound="≥ 0",
        why="the push ends inside or at the surface, x = 0",
        kept=float,
    )

    @property
    def kinematic(self) -> bool:
        """True."""
        return True

    @property
    def initial_position(self) -> float:
        """x_0 [m; rad]."""
        return self.start

    def signals(self, times: Signal) -> Signals:
        """The ramp at the sample instants."""
        return Signals(position=np.minimum(self.start + self.speed * times, self.depth))
