"""Compensation of friction: a force in the direction of motion, computed once a sample.

    f ← f − F tanh(v/v_s) − C v,        v = Δx/T of the move since the last sample

It makes an arm light to move and spends friction that a proof of passivity needs: F of the Coulomb
friction, C of the viscous one.  As the controllers of low-cost arms have it.

tanh lies below its tangents, F tanh(v/v_s) ≤ h + s v, so that it gives no more than h of Coulomb friction and
C + s of damping take (docs/theory/pairs.md).  Behind a wall such a force is covered where h of the
device's friction is left beside the encoder and C + s of its damping beside the wall.

Its step is in `compensation_step`: two arms that follow each other have this law too, and are decided
without a compiler.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from fractions import Fraction
from typing import ClassVar

from zwidth.model.device.device import Device
from zwidth.model.rendering.rendering_law import LoopContext, RenderingLaw
from zwidth.quantity.exact import Exact, RealLike
from zwidth.quantity.parameter import Certain, exact

FRICTION_COMPENSATION = 18.0

_DRIVES = "it helps the motion; what brakes it is the friction of the device, or its local damping"


@dataclass(frozen=True)
class FrictionCompensation(RenderingLaw):
    """φ(v) = F tanh(v/v_s) + C v, a force that helps the motion, held for a sample.

    Of the arms of a `Pair`, or in a chain behind an environment, where it acts on both sides of the surface.

    Parameters
    ----------
    coulomb
        F ≥ 0, the largest share of it that does not grow with speed [N; N·m].
    viscous
        C ≥ 0 [N·s/m; N·m·s/rad].
    speed
        v_s ≥ 0, at which tanh reaches three quarters of F [m/s; rad/s]; 0: F in the direction of the last
        move, whatever the speed.

    Raises
    ------
    InputError
        If a number is below 0, or an interval.
    """

    code: ClassVar[float] = FRICTION_COMPENSATION
    state_size: ClassVar[int] = 1

    coulomb: Certain = exact("compensated_coulomb_friction", 0, "≥ 0", _DRIVES)
    viscous: Certain = exact("compensated_damping", 0, "≥ 0", _DRIVES)
    speed: Certain = exact("compensation_speed", 0, "≥ 0", "0 stands for the sign of the speed")

    def __bool__(self) -> bool:
        """False where it adds no force."""
        return bool(self.coulomb or self.viscous)

    def replace(self, **changes: RealLike) -> FrictionCompensation:
        """The same law with some numbers changed."""
        return replace(self, **changes)

    def scaled(self, share: Fraction) -> FrictionCompensation:
        """So many times the force at every speed."""
        if share == 1:
            return self
        return self.replace(coulomb=share * self.coulomb.fraction, viscous=share * self.viscous.fraction)

    def numbers(self, at: LoopContext) -> list[float]:
        """F, C, v_s, T."""
        return [float(self.coulomb), float(self.viscous), float(self.speed), at.period]

    def most_damping(self, device: Device, spring: Exact | None) -> Fraction | None:
        """C where that is all; F grows with no power of the move."""
        return None if self.coulomb else self.viscous.fraction

    def describe(self, motion: str = "linear") -> str:
        return f"compensation of friction by {self.force_in_words(motion)}"

    def force_in_words(self, motion: str = "linear") -> str:
        """φ with its numbers."""
        parts = []
        if self.coulomb:
            over = (
                f" tanh(v/({self.with_unit('speed', motion)}))"
                if self.speed
                else " in the direction of motion"
            )
            parts.append(self.with_unit("coulomb", motion) + over)
        if self.viscous:
            parts.append(f"{self.with_unit('viscous', motion)} of its own speed")
        return " and ".join(parts) or "nothing"
