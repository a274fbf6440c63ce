"""The gains of one joint, on both sides, in the units of the joint."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from zwidth.model.rendering.friction_compensation import FrictionCompensation
from zwidth.quantity.text import exact_text

NONE = FrictionCompensation()
"""No compensation of friction."""


@dataclass(frozen=True)
class Gains:
    """τ = K (q' − q) + B (q̇' − q̇) − D q̇ + φ(q̇) + F_o of one side of a joint, q' the other arm's position.

    Attributes
    ----------
    stiffness
        K [N·m/rad].
    damping
        B, of the speed against the other arm's [N·m·s/rad].
    local_damping
        D, of the arm's own speed [N·m·s/rad].
    compensation
        φ, of friction.
    offset
        F_o [N·m]; like a weight it gives back what it takes.
    source
        The file and the key that the stiffness is from.
    """

    stiffness: Fraction
    damping: Fraction = Fraction(0)
    local_damping: Fraction = Fraction(0)
    compensation: FrictionCompensation = NONE
    offset: Fraction = Fraction(0)
    source: str = ""

    def to_dict(self) -> dict[str, object]:
        """As plain data, the unit in each key."""
        found: dict[str, object] = {
            "stiffness_N_m_per_rad": exact_text(self.stiffness),
            "damping_N_m_s_per_rad": exact_text(self.damping),
            "local_damping_N_m_s_per_rad": exact_text(self.local_damping),
            "source": self.source,
        }
        if self.compensation:
            law = self.compensation
            found["compensation"] = {
                "coulomb_N_m": str(law.coulomb),
                "viscous_N_m_s_per_rad": str(law.viscous),
                "speed_rad_per_s": str(law.speed),
                "offset_N_m": exact_text(self.offset),
            }
        return found


@dataclass(frozen=True)
class JointGains:
    """A joint of both arms; `leader` is None where the leader feels nothing.

    Attributes
    ----------
    name
        Such as J1.
    leader, follower
        The gains of each side.
    motor
        Its motor, where that is known.
    """

    name: str
    leader: Gains | None
    follower: Gains
    motor: str = ""

    def to_dict(self) -> dict[str, object]:
        """As plain data, units in the keys."""
        return {
            "name": self.name,
            "leader": None if self.leader is None else self.leader.to_dict(),
            "follower": self.follower.to_dict(),
        }
