"""The gains of one joint, on both sides, in the units of the joint; and the joint of both arms as a pair."""

from __future__ import annotations

from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any

from zwidth.model.device import Device
from zwidth.model.pairs import Pair
from zwidth.model.rendering.friction_compensation import FrictionCompensation
from zwidth.quantity.answered import answered
from zwidth.quantity.exact import Exact
from zwidth.quantity.text import exact_text

NONE = FrictionCompensation()


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
    """A joint of both arms."""

    name: str = answered("of the joint, such as J1")
    leader: Gains | None = answered("the gains of the leader; null where it feels nothing")
    follower: Gains = answered("those of the follower")
    motor: str = answered("its motor, where that is known", default="", only_shown=True)


# One joint of both arms as a pair: its gains, its two devices, the link and the drives.
#
# A drive that takes the difference of its own position at its rate gains by itself where kd exceeds b, at
# half that rate: at thousands of hertz, where no arm moves and drives filter.  With an ideal drive its kd is
# a damper of the joint instead, at once and without steps; b is then b + B + D, and of the coupling stays
#
#     −B v'  of the other's speed as received, held: B on the pair, and −B of its own speed.


@dataclass(frozen=True)
class CoupledJoint:
    """A joint with all that its verdict needs; pairs are of leader and follower."""

    name: str
    gains: tuple[Gains, Gains]
    devices: tuple[Device, Device]
    """Without any controller."""
    delay: tuple[Exact, Exact]
    """Of the link, there and back [s]."""
    drive_rate: Exact | None
    """Of the loop in each drive [Hz]; None where there is none."""
    ideal_drive: bool = False
    """What a drive does with its own speed is a damper."""
    compensation: Fraction = Fraction(1)
    """How much of the compensation of friction in the gains there is: 1 for all, 0 for none."""
    largest_stiffness: Fraction | None = None
    largest_damping: Fraction | None = None
    """What a drive takes [N·m/rad, N·m·s/rad]; None where that is not known."""

    @property
    def is_ideal(self) -> bool:
        """True where there is a drive, and it is ideal."""
        return self.ideal_drive and self.drive_rate is not None

    @property
    def is_compensated(self) -> bool:
        """True where there is compensation of friction on a side, and it is not left out."""
        return bool(self.compensation) and any(gains.compensation for gains in self.gains)

    @property
    def damping(self) -> tuple[Fraction, Fraction]:
        """b of both arms, without the drives [N·m·s/rad]."""
        leader, follower = (device.exact("damping") for device in self.devices)
        return leader, follower

    def with_damping(self, leader: Fraction, follower: Fraction) -> CoupledJoint:
        """The same with other b."""
        pairs = zip(self.devices, (leader, follower), strict=True)
        first, second = (device.replace(damping=Exact(b)) for device, b in pairs)
        return replace(self, devices=(first, second))

    def pair(self) -> Pair:
        (leader, its_damping), (follower, damping) = map(self._side, self.devices, self.gains)
        mine, other = self.gains
        laws: dict[str, Any] = {}
        if self.is_compensated:
            first, second = (gains.compensation.scaled(self.compensation) for gains in self.gains)
            laws = {"compensation": first, "follower_compensation": second}
        return Pair(
            leader,
            follower,
            stiffness=Exact(mine.stiffness),
            damping=Exact(mine.damping),
            local_damping=Exact(its_damping),
            follower_stiffness=_other(other.stiffness, mine.stiffness),
            follower_damping=_other(other.damping, mine.damping),
            follower_local_damping=_other(damping, its_damping),
            delay=self.delay,
            drive_rate=self.drive_rate,
            **laws,
        )

    def to_dict(self) -> dict[str, Any]:
        return {
            side: {
                "stiffness_N_m_per_rad": float(own.stiffness),
                "damping_N_m_s_per_rad": float(own.damping),
                "local_damping_N_m_s_per_rad": float(own.local_damping),
            }
            for side, own in zip(("leader", "follower"), self.gains, strict=True)
        }

    def _side(self, device: Device, gains: Gains) -> tuple[Device, Fraction]:
        if not self.is_ideal:
            return device, gains.local_damping
        braked = device.exact("damping") + gains.damping + gains.local_damping
        return device.replace(damping=Exact(braked)), -gains.damping


def coupled(gains: JointGains, devices: tuple[Device, Device], **others: Any) -> CoupledJoint:
    """A joint whose leader feels the follower."""
    assert gains.leader is not None, "asked before"
    return CoupledJoint(gains.name, (gains.leader, gains.follower), devices, **others)


def _other(value: Fraction, leaders: Fraction) -> Exact | None:
    return None if value == leaders else Exact(value)
