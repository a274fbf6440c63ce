"""One law more between the environment and the actuator, a step per sample.

    f ← step(x, f)        x the reading, f the force so far
    x ← step(x)           for a law that comes before the environment

`rendered.Rendered` puts them in a row.  Each is a frozen data class with its law in
its docstring, and a compiled `step` that the simulator runs.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from fractions import Fraction
from typing import ClassVar, NamedTuple

from zwidth.model.device.device import Device
from zwidth.model.environment.environment import Environment
from zwidth.model.rendering.theorem import Theorem
from zwidth.quantity.exact import Exact
from zwidth.quantity.parameter import Parametric


class LoopContext(NamedTuple):
    """What a law is told once, before the loop runs.

    Parameters
    ----------
    device
        What the hand holds.
    environment
        What it meets.
    single
        True where the machine keeps its numbers in 24 bits, not in 53.
    """

    device: Device
    environment: Environment
    single: bool = False

    @property
    def period(self) -> float:
        """T [s]."""
        return float(self.device.exact("sample_period"))

    @property
    def stiffness(self) -> float:
        """Of the environment per depth, the hand at rest; 0 where it has no such number [N/m; N·m/rad]."""
        return float(getattr(self.environment, "stiffness", 0.0))


@dataclass(frozen=True, kw_only=True)
class RenderingLaw(Parametric, ABC):
    """A law that changes the force of an environment, or the reading before it."""

    code: ClassVar[float]
    """Which step the compiled chain takes; its own for each law."""

    state_size: ClassVar[int]
    """Numbers that it remembers."""

    bounds_the_force: ClassVar[bool] = False
    """True for force bounding: last in a row, it keeps to what the device pays for, whatever came before."""

    @abstractmethod
    def numbers(self, at: LoopContext) -> list[float]:
        """The parameters of the step, defaults filled in from the device."""

    def initial_state(self, reading: float) -> list[float]:
        """What it remembers after the hand has been at a reading for ever."""
        return [reading] + [0.0] * (self.state_size - 1)

    def most_damping(self, device: Device, spring: Exact | None) -> Fraction | None:
        """α where what it adds is never more than α |Δx|/T; None where it is not so bounded.

        A wall with that much virtual damping, of either sign, covers the law then.  `spring` is K where the
        force that comes in is that of the wall's spring; None where a law before has changed it.
        """
        return None

    def theorem(self, at: LoopContext) -> Theorem | None:
        """Why no hand takes energy out with this law last in the row, by a proof on paper; None without one.

        What the proof counts of the device is in it; whether that is enough says `Theorem.unmet`.  No
        certificate comes with it: what can be checked by a machine says `check`.
        """
        return None

    @abstractmethod
    def describe(self, motion: str = "linear") -> str:
        """The law with its numbers, in a few words."""
