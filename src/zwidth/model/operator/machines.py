"""What pushes in the place of a finger: a dowel, a constant force, and machines that prescribe a position.

"The wooden dowel embodies an impedance that the human finger is unable to achieve" (Abbott & Okamura 2005,
section IV-C): a little mass and next to no damping.  Nothing of the hand behind it reaches the device but
its push.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi
from typing import TYPE_CHECKING, Any

import numpy as np

from zwidth.errors import InputError
from zwidth.model.operator.operator import (
    FORCE,
    SPEED,
    START,
    LinearHand,
    ParametricOperator,
    Signals,
    hand_damping,
    hand_mass,
    start_at,
)
from zwidth.quantity.glossary import Quantity
from zwidth.quantity.parameter import parameter
from zwidth.quantity.text import shown

if TYPE_CHECKING:
    from zwidth.model.operator.operator import Signal


WOOD_DENSITY = 650.0
"""Dry birch, beech or maple, 600 to 700 kg/m³ [kg/m³] (Roth, Timber, U.S. Forest Service Bulletin 10,
as printed in Noyes, Wood and Forest, 1912: the middle of the range)."""


@dataclass(frozen=True, kw_only=True)
class Dowel(ParametricOperator):
    """``f_h = F − c ẋ − m_h ẍ``: a rod's mass, pushed with a constant force.

    The default mass is that of a dowel of 8 mm and 150 mm, π/4 d² L ρ = 4.9 g with ρ = 650 kg/m³ (see
    `of_size`). Abbott & Okamura (2005, section IV-C) give neither its size nor the force; size, force and
    start are chosen. On the haptic paddle a dowel sustains what the hold gives, K T/2 > b, if it is pushed so
    hard that the contact is kept, about F = K · 4 f_c/(π ω (K T/2 − b)) with ω = √(K/(m + m_h)), 3.7 N at 770
    N/m.

    The rod is joined to the device: it does not bounce off the load cell.

    Parameters
    ----------
    force
        F, positive into the wall [N; N·m].
    mass
        m_h ≥ 0, of the rod [kg; kg·m²].
    damping
        c ≥ 0, what a firmer grip adds [N·s/m; N·m·s/rad]. Default 0.
    start
        x_0 ≤ 0, where the handle starts from rest [m; rad].
    """

    called = "dowel"

    force: float = parameter(FORCE, 4.0, kept=float)
    mass: float = hand_mass(0.0049)
    damping: float = hand_damping(0.0)
    start: float = start_at(-0.005)

    @classmethod
    def of_size(cls, length: float, diameter: float, density: float = WOOD_DENSITY, **others: Any) -> Dowel:
        """A dowel from its size: m_h = ρ π/4 d² L.

        Parameters
        ----------
        length, diameter
            L and d, > 0 [m].
        density
            ρ > 0 [kg/m³].
        others
            The other arguments of `Dowel`.
        """
        for name, value in {"length": length, "diameter": diameter, "density": density}.items():
            if not 0 < value < np.inf:
                raise InputError(f"{name} must be > 0 and finite, got {value:g}: a rod has a size and a mass")
        return cls(mass=float(density * pi / 4 * diameter**2 * length), **others)

    @property
    def hand(self) -> LinearHand:
        return LinearHand(mass=self.mass, damping=self.damping)

    def signals(self, times: Signal) -> Signals:
        """F over every interval; a grip that damps is at rest."""
        anchor = np.full(len(times), self.start) if self.damping else None
        return Signals(force=np.full(len(times) - 1, self.force), anchor=anchor)


@dataclass(frozen=True)
class ConstantForce(ParametricOperator):
    """``f_h = F``, whatever the handle does.

    No hand is so indifferent: this is the push of theory, without mass, spring or damper.

    Parameters
    ----------
    force
        F, positive into the wall [N; N·m].
    """

    force: float = parameter(FORCE, 1.0, kept=float)

    def signals(self, times: Signal) -> Signals:
        return Signals(force=np.full(len(times) - 1, self.force))

    def describe(self, motion: str = "linear") -> str:
        return f"constant force, {shown(self.force, FORCE.unit_for(motion), 6)}"


@dataclass(frozen=True, kw_only=True)
class Cycle(ParametricOperator):
    """``x(kT) = low`` for even k, ``high`` for odd k: one sample in, one sample out.

    The two motions by which Abbott & Okamura (2005, section III-C) prove that their condition is necessary:

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

    kinematic = True

    @property
    def initial_position(self) -> float:
        return self.low

    def signals(self, times: Signal) -> Signals:
        return Signals(position=np.where(np.arange(len(times)) % 2, self.high, self.low))


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

    kinematic = True

    def signals(self, times: Signal) -> Signals:
        return Signals(position=np.minimum(self.start + self.speed * times, self.depth))
