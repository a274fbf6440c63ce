"""i2rt YAM: lists kp, kd and motor_list, a file for an arm.

    follower  τ = kp (q_l − q_f) − kd q̇_f + gravity
    leader    τ = β kp (q_f − q_l) + gravity

with β the bilateral_kp that a person gives when the arms are started, 0.2 by default here.  v_des is 0: kd is
of the follower's own speed, and the leader has no damping of its own.  Source: i2rt-robotics/i2rt,
examples/minimum_gello and robots/motor_chain_robot.py.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

from zwidth.data.gains.arms import ArmGains
from zwidth.data.gains.file import GainTable
from zwidth.data.gains.joint import NONE, Gains, JointGains
from zwidth.errors import InputError
from zwidth.model.rendering.friction_compensation import FrictionCompensation
from zwidth.quantity.exact import Exact

NAME = "i2rt"

_NOTES = (
    "kd is of the follower's own speed: v_des is 0 (i2rt-robotics/i2rt, minimum_gello); the leader has no "
    "damping of its own",
    "the loop runs freely, 4 to 7 ms a time, and so does the age of readings: constant ones are decided",
    "grav_comp_kd, of an arm that floats by itself, plays no part between the arms",
)


def fits(table: GainTable) -> bool:
    """True for an arm or a gripper of i2rt."""
    return ("kp" in table and "kd" in table and "motor_list" in table) or "motor_kp" in table


def read(tables: Sequence[GainTable], bilateral_kp: Fraction) -> ArmGains:
    """One arm's file for both, or those of leader and follower; a gripper's beside them is left out."""
    arms = [table for table in tables if "kp" in table]
    if not arms:
        raise InputError(
            f"{tables[0].label}: a gripper alone; its motor is coupled to no motor of the leader. Give the "
            "arm's file"
        )
    if len(arms) > 2:
        raise InputError(f"a pair has two arms, got files of {len(arms)}")
    leader, follower = arms[0], arms[-1]
    stiffness, damping = _lists(follower)
    pulled = _lists(leader)[0]
    if len(pulled) != len(stiffness):
        raise InputError(
            f"{leader.label} has {len(pulled)} joints and {follower.label} {len(stiffness)}; each joint is "
            "coupled to its own"
        )
    notes = [*_NOTES, f"the leader's kp is {float(bilateral_kp):g} times the file's, --bilateral-kp"]
    if not bilateral_kp:
        notes.append("with bilateral_kp = 0 the leader feels nothing: this is no pair")
    if len(arms) < len(tables):
        notes.append("the gripper is left out: its motor is coupled to no motor of the leader")
    if any("coulomb_friction" in table for table in arms):
        notes.append(
            "coulomb_friction is added only with use_coulomb_friction, which is off by default: left out"
        )
    its, mine = _compensation(follower, len(stiffness)), _compensation(leader, len(stiffness))
    joints = tuple(
        JointGains(
            f"J{n + 1}",
            Gains(bilateral_kp * pulled[n], compensation=mine[n], source=f"{leader.label}, kp[{n}]")
            if bilateral_kp
            else None,
            Gains(
                stiffness[n],
                local_damping=damping[n],
                compensation=its[n],
                source=f"{follower.label}, kp[{n}]",
            ),
            _motor(follower, n),
        )
        for n in range(len(stiffness))
    )
    return ArmGains(NAME, joints, tuple(notes), drives=True)


def _lists(table: GainTable) -> tuple[list[Fraction], list[Fraction]]:
    stiffness = table.numbers("kp", "N*m/rad")
    return stiffness, table.numbers("kd", "N*m*s/rad", len(stiffness))


def _compensation(table: GainTable, count: int) -> list[FrictionCompensation]:
    """breakaway tanh(v/eps), of the versions that had it."""
    if "friction_comp" not in table:
        return [NONE] * count
    inner = table.table("friction_comp")
    if str(inner.values.get("enable", "false")).lower() != "true":
        return [NONE] * count
    speed = inner.number("eps", "rad/s") if "eps" in inner else Fraction(0)
    coulomb = inner.numbers("breakaway", "N*m", count)
    if speed < 0 or min(coulomb) < 0:
        raise InputError(f"{inner.label}: breakaway and eps must be ≥ 0: what is compensated is friction")
    return [FrictionCompensation(coulomb=Exact(f), speed=Exact(speed)) for f in coulomb]


def _motor(table: GainTable, joint: int) -> str:
    listed = table.values.get("motor_list")
    row = listed[joint] if isinstance(listed, list) and joint < len(listed) else None
    return str(row[1]) if isinstance(row, list) and len(row) == 2 else ""
