"""The operator: the hand on the device.

Two kinds.  A linear hand is a mass that moves with the handle, tied by a spring
and a damper to an anchor, the position that the muscles want, and pushed by a
voluntary force:

    f_h = F(t) + k (x_a(t) − x) + c (ẋ_a(t) − ẋ) − m_h ẍ

F is held from sample to sample and x_a is straight between samples, so that the
motion has a closed form.  A kinematic operator prescribes x itself, at constant
velocity between samples, whatever force that takes.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

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
