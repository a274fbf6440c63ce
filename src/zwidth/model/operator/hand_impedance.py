"""A hand that is known: a mass on a spring and a damper to where it wants to be.

    f_h = −k x − c ẋ − m_h ẍ        (about the point of rest)

The criterion of passivity stands against every hand; a loop that fails it may still be
stable with this one.  Each number may be an interval: a claim then holds for every hand in it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from zwidth.errors import InputError
from zwidth.quantity.exact import ends
from zwidth.quantity.parameter import Parametric, Uncertain, parameter
from zwidth.quantity.text import told_quantity

_DRIVES = "a passive hand has no energy of its own to give; 0 where it has none"


@dataclass(frozen=True, kw_only=True)
class HandImpedance(Parametric):
    """``f_h = −k x − c ẋ − m_h ẍ``, each number certain or an interval.

    Parameters
    ----------
    mass
        m_h ≥ 0, moves with the handle [kg; kg·m²]. Default 0.
    stiffness
        k ≥ 0 [N/m; N·m/rad]. Default 0.
    damping
        c ≥ 0 [N·s/m; N·m·s/rad]. Default 0.
    """

    mass: Uncertain = parameter("mass", 0, bound="≥ 0", why=_DRIVES, meaning="of the hand")
    stiffness: Uncertain = parameter("stiffness", 0, bound="≥ 0", why=_DRIVES, meaning="of the hand")
    damping: Uncertain = parameter("damping", 0, bound="≥ 0", why=_DRIVES, meaning="of the hand")

    @property
    def is_nobody(self) -> bool:
        """True where there is no hand at all."""
        return not any(ends(v)[1] for v in (self.mass, self.stiffness, self.damping))

    def describe(self, motion: str = "linear") -> str:
        """The hand with its numbers, on one line, in linear or rotary units."""
        parts = [
            f"{symbol} = {told_quantity(value, name, motion)}"
            for symbol, name, value in (
                ("m_h", "mass", self.mass),
                ("k", "stiffness", self.stiffness),
                ("c", "damping", self.damping),
            )
            if ends(value)[1]
        ]
        return ", ".join(parts) if parts else "no hand"


def as_hand(hand: Any) -> HandImpedance:
    """Read a hand: None for none, a `HandImpedance`, or an operator whose linear part is meant."""
    if hand is None:
        return HandImpedance()
    if isinstance(hand, HandImpedance):
        return hand
    linear = getattr(hand, "hand", None)
    if linear is None or getattr(hand, "kinematic", False):
        raise InputError(
            f"a known hand is None, a HandImpedance or a linear operator such as Finger(), got "
            f"{type(hand).__name__}: a prescribed motion leaves nothing that could become unstable"
        )
    return HandImpedance(mass=linear.mass, stiffness=linear.stiffness, damping=linear.damping)
