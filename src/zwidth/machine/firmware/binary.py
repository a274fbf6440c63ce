"""Binary floating point: every result is rounded to the nearest of 53 or of 24 bits."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf

import numpy as np

from zwidth.machine.firmware.bound import Bound
from zwidth.machine.firmware.evaluation import Rounded
from zwidth.machine.firmware.program import Constant, Operation, Statement
from zwidth.machine.firmware.simplified import FOLDED

_ROUNDED = {"+", "-", "*", "/", "sqrt", "real"}
_DOUBLE = 2.0**-53
_TINY = 2.0**-40
"""Three factors of this size leave a count far above the least float."""


@dataclass(frozen=True)
class Binary:
    """The rounding of a format.

    Parameters
    ----------
    unit
        u: a result v is off by u |v| at most.
    least
        By which it is off at most where it is very small.
    largest
        Beyond it nothing is kept.
    single
        True where the law's numbers, which are double, are rounded again.
    """

    unit: float
    least: float
    largest: float
    single: bool

    def constant(self, value: float, statement: Statement | None) -> float:
        """A number of the law is the double nearest to the exact one."""
        own = (FOLDED if self.single else _DOUBLE) * abs(value)
        if not self.single:
            return own
        if abs(value) > self.largest:  # endless: it can be compared with, no more
            computes = isinstance(statement, Operation) and statement.operator in _ROUNDED
            return inf if computes else own
        return own + max(abs(float(np.float32(value)) - value), min(abs(value), self.least))

    def rounding(self, statement: Rounded, of: tuple[Bound, ...], result: Bound) -> float:
        """u of the computed result, where there is a rounding."""
        if not isinstance(statement, Operation) or statement.operator not in _ROUNDED:
            return 0.0
        if statement.result.kind != "real":
            return 0.0
        size = result.computed_size
        if not size < self.largest:
            return inf
        if statement.operator == "real" and size * self.unit <= 0.5:
            return 0.0
        if size == 0.0:
            return 0.0
        return self.unit * size * (1 + 2 * self.unit) + self.least

    def keeps_sign(self, statement: Rounded) -> bool:
        """Of products with known numbers that are not tiny."""
        if not isinstance(statement, Operation) or statement.operator not in ("*", "/", "real"):
            return False
        known = [abs(float(o.value)) for o in statement.operands if isinstance(o, Constant)]
        if statement.operator == "/":  # the divisor
            return isinstance(statement.operands[1], Constant) and 0.0 < known[-1] < 1 / _TINY
        return statement.operator == "real" or any(k == 0.0 or k > _TINY for k in known)


DOUBLE = Binary(_DOUBLE, 2.0**-1074, 1.7e308, False)
FLOAT = Binary(2.0**-24, 2.0**-126, 3.4e38, True)
"""Numbers below 2⁻¹²⁶ may be taken for 0 by a machine."""
