"""A force that changes no faster than a motor's current can.

    f_k ← clamp(f_k, f_{k−1} − R T … f_{k−1} + R T)

f_{k−1} is what this law gave, not what converter and limit made of it: a step of R T below half
a converter step still adds up.  Where the wall asks for more than the motor gives, put
`Saturation()` before it; it would else first come down from a force that never was.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from zwidth.errors import InputError
from zwidth.model.device.amplifier import VoltageLimited
from zwidth.model.rendering.rendering_law import LoopContext, RenderingLaw
from zwidth.native.compiled import Array, compiled
from zwidth.quantity.exact import Exact
from zwidth.quantity.glossary import Quantity
from zwidth.quantity.parameter import CertainOrNone, parameter

SLEW_LIMIT = 14.0

_STEP = 0
_BEGUN, _LAST = range(2)


@dataclass(frozen=True)
class SlewLimit(RenderingLaw):
    """The force changes by R T a sample at most.

    Parameters
    ----------
    rate
        R > 0 [N/s; N·m/s]; None: what the device's winding allows, (F_max/I_max) U/L.

    Raises
    ------
    InputError
        If R is not positive; later, if it is not given and the device's motor is not known.
    """

    code: ClassVar[float] = SLEW_LIMIT
    state_size: ClassVar[int] = 2

    rate: CertainOrNone = parameter(
        Quantity("rate", "R", "N/s", "N*m/s", "R, by default what the device's winding allows"),
        None,
        kept=Exact,
        bound="> 0",
        why="a force that never changes renders nothing",
    )

    def numbers(self, at: LoopContext) -> list[float]:
        """R T."""
        return [self._rate(at) * at.period]

    def _rate(self, at: LoopContext) -> float:
        if self.rate is not None:
            return float(self.rate)
        try:
            return VoltageLimited().actuation(at.device).slew
        except InputError as error:
            raise InputError(f"rate was not given and is otherwise the motor's: {error}") from None

    def initial_state(self, reading: float) -> list[float]:
        """The first force is taken as it is: it has been there for ever."""
        return [0.0, 0.0]

    def describe(self, motion: str = "linear") -> str:
        """The law with its numbers, in a few words."""
        return f"slew limit of {self.with_unit('rate', motion) or 'the motor'}"


@compiled
def step(p: Array, i: int, s: Array, j: int, x: float, force: float, applied: float) -> float:
    """One sample; p from i and s from j on are this law's."""
    if s[j + _BEGUN] > 0.0:
        last, most = s[j + _LAST], p[i + _STEP]
        force = min(max(force, last - most), last + most)
    s[j + _BEGUN], s[j + _LAST] = 1.0, force
    return force
