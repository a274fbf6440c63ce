"""A wooden dowel between hand and device.

"The wooden dowel embodies an impedance that the human finger is unable to
achieve" (Abbott & Okamura 2005, section IV-C): a little mass and next to no
damping.  Nothing of the hand behind it reaches the device but its push.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi
from typing import TYPE_CHECKING, Any

import numpy as np

from zwidth.errors import InputError
from zwidth.model.operator.operator import LinearHand, Signals
from zwidth.model.operator.parameter import ParametricOperator
from zwidth.model.operator.quantities import (
    DAMPING,
    FORCE,
    MASS,
    NO_NEGATIVE_DAMPING,
    NO_NEGATIVE_MASS,
    OUTSIDE,
    START,
)
from zwidth.quantity.parameter import parameter

if TYPE_CHECKING:
    from zwidth.model.operator.operator import Signal

WOOD_DENSITY = 650.0
"""Dry birch, beech or maple, 600 to 700 kg/m³ [kg/m³] (Roth, Timber, U.S. Forest Service Bulletin 10,
as printed in Noyes, Wood and Forest, 1912: the middle of the range)."""


@dataclass(frozen=True, kw_only=True)
class Dowel(ParametricOperator):
    """``f_h = F − c ẋ − m_h ẍ``: a rod's mass, pushed with a constant force.

    The default mass is that of a dowel of 8 mm and 150 mm, π/4 d² L ρ = 4.9 g
    with ρ = 650 kg/m³ (see `of_size`). Abbott & Okamura (2005, section IV-C) give neither
    its size nor the force; size, force and start are chosen. On the haptic
    paddle a dowel sustains what the hold gives, K T/2 > b, if it is pushed so
    hard that the contact is kept, about F = K · 4 f_c/(π ω (K T/2 − b)) with
    ω = √(K/(m + m_h)), 3.7 N at 770 N/m.

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
    mass: float = parameter(MASS, 0.0049, bound="≥ 0", why=NO_NEGATIVE_MASS, kept=float)
    damping: float = parameter(DAMPING, 0.0, bound="≥ 0", why=NO_NEGATIVE_DAMPING, kept=float)
    start: float = parameter(START, -0.005, bound="≤ 0", why=OUTSIDE, kept=float)

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
        """m_h and c."""
        return LinearHand(mass=self.mass, damping=self.damping)

    @property
    def initial_position(self) -> float:
        """x_0 [m; rad]."""
        return self.start

    def signals(self, times: Signal) -> Signals:
        """F over every interval; a grip that damps is at rest."""
        anchor = np.full(len(times), self.start) if self.damping else None
        return Signals(force=np.full(len(times) - 1, self.force), anchor=anchor)
