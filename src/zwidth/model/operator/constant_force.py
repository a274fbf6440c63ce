"""A hand that only pushes, always equally hard."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from zwidth.model.operator.operator import Signals
from zwidth.model.operator.parameter import ParametricOperator
from zwidth.model.operator.quantities import FORCE
from zwidth.quantity.parameter import parameter
from zwidth.quantity.text import told

if TYPE_CHECKING:
    from zwidth.model.operator.operator import Signal


@dataclass(frozen=True)
class ConstantForce(ParametricOperator):
    """``f_h = F``, whatever the handle does.

    No hand is so indifferent: this is the push of theory, without mass, spring
    or damper.

    Parameters
    ----------
    force
        F, positive into the wall [N; N·m].
    """

    force: float = parameter(FORCE, 1.0, kept=float)

    def signals(self, times: Signal) -> Signals:
        """F over every interval."""
        return Signals(force=np.full(len(times) - 1, self.force))

    def describe(self, motion: str = "linear") -> str:
        """The push on one line."""
        return f"constant force, {told(self.force, FORCE.unit_for(motion))}"
