"""The gains of one joint, on both sides, in the units of the joint."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from zwidth.quantity.text import exact_text


@dataclass(frozen=True)
class Compensation:
    """φ(v) = F tanh(v/v_s) + C v + F_o, a torque in the direction of motion that an arm adds itself.

    Attributes
    ----------
    coulomb, viscous, speed
        F [N·m], C [N·m·s/rad], v_s [rad/s]; v_s = 0 for the sign of the speed.
    offset
        F_o [N·m]: like a weight it gives back what it takes.
    """

    coulomb: Fraction
    viscous: Fraction
    speed: Fraction
    offset: Fraction = Fraction(0)


@dataclass(frozen=True)
class Gains:
    """τ = K (q' − q) + B (q̇' − q̇) − D q̇ + φ(q̇) of one side of a joint, q' the other arm's position.

    Attributes
    ----------
    stiffness
        K [N·m/rad].
    damping
        B, of the speed against the other arm's [N·m·s/rad].
    local_damping
        D, of the arm's own speed [N·m·s/rad].
    compensation
        Of friction; None where there is none.
    source
        The file and the key that the stiffness is from.
    """

    stiffness: Fraction
    damping: Fraction = Fraction(0)
    local_damping: Fraction = Fraction(0)
    compensation: Compensation | None = None
    source: str = ""

    def to_dict(self) -> dict[str, object]:
        """As plain data, the unit in each key."""
        found: dict[str, object] = {
            "stiffness_N_m_per_rad": exact_text(self.stiffness),
            "damping_N_m_s_per_rad": exact_text(self.damping),
            "local_damping_N_m_s_per_rad": exact_text(self.local_damping),
            "source": self.source,
        }
        if self.compensation is not None:
            found["compensation"] = {
                "coulomb_N_m": exact_text(self.compensation.coulomb),
                "viscous_N_m_s_per_rad": exact_text(self.compensation.viscous),
                "speed_rad_per_s": exact_text(self.compensation.speed),
                "offset_N_m": exact_text(self.compensation.offset),
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
