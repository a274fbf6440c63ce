"""Compensation of friction: a force in the direction of motion, computed once a sample.

    φ(v) = F tanh(v/v_s) + C v,        v the arm's own move over the last sample, over T

It makes an arm light to move and spends friction that a proof of passivity needs: F of the Coulomb
friction, C of the viscous one.  As the controllers of low-cost arms have it.
"""

from __future__ import annotations

from dataclasses import dataclass

from zwidth.quantity.exact import Exact
from zwidth.quantity.glossary import Quantity
from zwidth.quantity.parameter import Certain, Parametric, parameter

_DRIVES = "it helps the motion; what brakes it is the friction of the device, or its local damping"


@dataclass(frozen=True)
class FrictionCompensation(Parametric):
    """φ(v) = F tanh(v/v_s) + C v, a force that helps the motion, held for a sample.

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

    coulomb: Certain = parameter(
        Quantity("compensation_coulomb", "F", "N", "N*m", "Coulomb friction that is compensated"),
        0,
        kept=Exact,
        bound="≥ 0",
        why=_DRIVES,
    )
    viscous: Certain = parameter(
        Quantity("compensation_viscous", "C", "N*s/m", "N*m*s/rad", "viscous friction that is compensated"),
        0,
        kept=Exact,
        bound="≥ 0",
        why=_DRIVES,
    )
    speed: Certain = parameter(
        Quantity(
            "compensation_speed",
            "v_s",
            "m/s",
            "rad/s",
            "speed at which compensation of Coulomb friction has come to three quarters; 0: at any speed",
        ),
        0,
        kept=Exact,
        bound="≥ 0",
        why="0 stands for the sign of the speed",
    )

    def __bool__(self) -> bool:
        """False where it adds no force."""
        return bool(self.coulomb or self.viscous)

    def describe(self, motion: str = "linear") -> str:
        """The law with its numbers, in a few words."""
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
        return f"compensation of friction, {' and '.join(parts) or 'none'}"
