"""LeRobot with Damiao motors (openarm_follower): lists position_kp, position_kd.

    τ = kp (q_des − q) − kd q̇

v_des is 0: kd is of the follower's own speed.  The leader is limp: there is no law of both arms.  Source:
huggingface/lerobot, robots/openarm_follower.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from zwidth.data.gains.arms import ArmGains
from zwidth.data.gains.file import GainTable
from zwidth.data.gains.joint import Gains, JointGains
from zwidth.data.gains.published import family
from zwidth.errors import InputError

NAME = "lerobot-damiao"

_NOTES = (
    "LeRobot moves the follower alone and the leader is limp: there is no law of both arms",
    "position_kd is of the arm's own speed: v_des is 0 (huggingface/lerobot, openarm_follower)",
)


def fits(table: GainTable) -> bool:
    """True where the lists stand somewhere."""
    return next(_places(table), None) is not None


def read(tables: Sequence[GainTable], both: bool) -> ArmGains:
    """The follower's lists, on both sides where that is asked for."""
    places = [place for table in tables for place in _places(table)]
    if len(places) > 1:
        raise InputError(
            f"{places[1].label}: position_kp is given more than once; give the arm that is meant in a file "
            "of its own"
        )
    (place,) = places
    stiffness = place.numbers("position_kp", "N*m/rad")
    damping = place.numbers("position_kd", "N*m*s/rad", len(stiffness))
    motors = family(NAME).motors
    joints = []
    for n, (k, d) in enumerate(zip(stiffness, damping, strict=True)):
        gains = Gains(k, local_damping=d, source=f"{place.label}, position_kp[{n}]")
        name = "gripper" if len(stiffness) == 8 and n == 7 else f"J{n + 1}"
        motor = motors[n] if len(motors) == len(stiffness) else ""
        joints.append(JointGains(name, gains if both else None, gains, motor))
    return ArmGains(NAME, tuple(joints), _NOTES, drives=True, follows=True)


def _places(table: GainTable) -> Iterator[GainTable]:
    return (place for place in table.below() if "position_kp" in place)
