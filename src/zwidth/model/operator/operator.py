"""The operator: the hand on the device.

Two kinds.  A linear hand is a mass that moves with the handle, tied by a spring and a damper to an anchor,
the position that the muscles want, and pushed by a voluntary force:

    f_h = F(t) + k (x_a(t) − x) + c (ẋ_a(t) − ẋ) − m_h ẍ

F is held from sample to sample and x_a is straight between samples, so that the motion has a closed form.  A
kinematic operator prescribes x itself, at constant velocity between samples, whatever force that takes.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import MISSING, dataclass, fields, replace
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple, Self

from zwidth.quantity.glossary import Quantity
from zwidth.quantity.parameter import Parametric, parameter, parameters_of
from zwidth.quantity.text import shown

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Signal = NDArray[np.float64]


class LinearHand(NamedTuple):
    """What of the hand is the same at all times.

    Parameters
    ----------
    mass
        m_h ≥ 0, moves with the handle [kg; kg·m²].
    stiffness
        k ≥ 0, to the anchor [N/m; N·m/rad].
    damping
        c ≥ 0, to the anchor [N·s/m; N·m·s/rad].
    """

    mass: float = 0.0
    stiffness: float = 0.0
    damping: float = 0.0


class Signals(NamedTuple):
    """What the hand does over N sample intervals, from the instants t_0 … t_N.

    Parameters
    ----------
    force
        F over each interval, N values [N; N·m]; None for none.
    anchor
        x_a at each instant, N + 1 values [m; rad]; None where there is no spring or damper.
    position
        x at each instant, N + 1 values [m; rad]; None unless the operator is kinematic.
    switch_position
        x when the force changes within each interval, N values [m; rad]; None for a straight line.
    """

    force: Signal | None = None
    anchor: Signal | None = None
    position: Signal | None = None
    switch_position: Signal | None = None


@dataclass(frozen=True, kw_only=True)
class Operator(ABC):
    """A hand: its constants and what it does in time."""

    @property
    def hand(self) -> LinearHand:
        """Mass, stiffness and damping of a linear hand; all 0 for a pure force."""
        return LinearHand()

    @property
    def kinematic(self) -> bool:
        """True when the operator prescribes the position."""
        return False

    @property
    def initial_position(self) -> float:
        """Where the touch starts unless the caller says otherwise [m; rad]; x > 0 is inside the wall."""
        return 0.0

    @property
    def start_is_chosen(self) -> bool:
        """False where the touch may begin wherever the law is at rest."""
        return self.initial_position != 0.0

    def starting_at(self, position: float) -> Operator:
        """The same hand, whose touch begins here [m; rad], or at the surface if that is inside."""
        return self

    @abstractmethod
    def signals(self, times: Signal) -> Signals:
        """What the hand does, at the sample instants t_0 … t_N [s]."""

    @abstractmethod
    def describe(self, motion: str = "linear") -> str:
        """The hand with its numbers, on one line, in linear or rotary units."""


@dataclass(frozen=True, kw_only=True)
class ParametricOperator(Parametric, Operator):
    """An operator whose fields are numbers in SI, or texts with a unit, such as "3 N".

    The command line builds its options from them and the messages name them.
    """

    called: ClassVar[str] = ""
    """What it is in a word or two, as a line about it begins."""

    motion: ClassVar[str] = ""
    """ "rotary" of a hand on a device that turns, "linear" of one on a handle that moves; "" of either."""

    @classmethod
    def parameters(cls) -> dict[str, Quantity]:
        """The numbers it takes, by the name of the argument."""
        return {name: own.quantity for name, own in parameters_of(cls).items() if own.is_number}

    @property
    def initial_position(self) -> float:
        """Its `start`, 0 of one that has none [m; rad]."""
        return float(getattr(self, "start", 0.0))

    @property
    def start_is_chosen(self) -> bool:
        """True where `start` is not its default."""
        starts = [f.default for f in fields(self) if f.name == "start"]
        return self.initial_position != (starts[0] if starts else 0.0)

    def starting_at(self, position: float) -> Self:
        """The same hand, whose touch begins here [m; rad], or at the surface if that is inside."""
        changes: dict[str, Any] = {"start": min(position, 0.0)} if hasattr(self, "start") else {}
        return replace(self, **changes)

    def describe(self, motion: str = "linear") -> str:
        """What it is and its numbers, on one line, in linear or rotary units."""
        return f"{self.called}, {self.describe_parameters(motion)}"

    def describe_parameters(self, motion: str = "linear") -> str:
        """The numbers with their units, in linear or rotary units."""
        return ", ".join(
            f"{name.replace('_', ' ')} {shown(getattr(self, name), quantity.unit_for(motion), 6)}"
            for name, quantity in self.parameters().items()
        )


STIFFNESS = Quantity("stiffness", "k", "N/m", "N*m/rad", "of the hand, to the position that it wants")
FORCE = Quantity("force", "F", "N", "N*m", "of the hand, positive into the wall")
START = Quantity("start", "x_0", "m", "rad", "position where the touch starts; negative is outside")
SPEED = Quantity("speed", "v", "m/s", "rad/s", "of the approach")

_MASS = Quantity("mass", "m_h", "kg", "kg*m^2", "of the hand, moves with the handle")
_DAMPING = Quantity("damping", "c", "N*s/m", "N*m*s/rad", "of the hand, to the position that it wants")
_NO_MASS = "a body has inertia; 0 is a hand without mass"
_NO_DAMPING = "a hand with negative damping gives out energy by itself; 0 loses none"
_OUTSIDE = (
    "a touch starts outside the wall or at its surface, x = 0, so that what it finds there is contact; "
    "where the device starts is said by initial_position"
)


def hand_mass(default: float) -> Any:
    """m_h ≥ 0 as a field."""
    return parameter(_MASS, default, bound="≥ 0", why=_NO_MASS, kept=float)


def hand_damping(default: Any = MISSING) -> Any:
    """c ≥ 0 as a field."""
    return parameter(_DAMPING, default, bound="≥ 0", why=_NO_DAMPING, kept=float)


def start_at(default: float) -> Any:
    """x_0 ≤ 0 as a field."""
    return parameter(START, default, bound="≤ 0", why=_OUTSIDE, kept=float)
