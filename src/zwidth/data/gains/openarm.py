"""OpenArm (enactic/openarm_teleop): lists Kp, Kd, Fc, k, Fv, Fo of LeaderArmParam and FollowerArmParam.

    τ = Kp (q' − q) + Kd (q̇' − q̇) + gravity + Fc tanh(0.1 k q̇) + Fv q̇ + Fo

on both sides, q' the other arm's position: Kd is of the speed of one arm against the other.  The factor 0.1
is in the code (ComputeFriction), although the comment beside the numbers says tanh(k q̇).  Source: the file
src/controller/control.cpp of that repository, function bilateral_step.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

from zwidth.data.gains.arms import ArmGains
from zwidth.data.gains.file import GainTable
from zwidth.data.gains.joint import NONE, Gains, JointGains
from zwidth.data.gains.published import family
from zwidth.errors import InputError
from zwidth.model.rendering.friction_compensation import FrictionCompensation
from zwidth.quantity.exact import Exact

NAME = "openarm"

_SIDES = {"leader": "LeaderArmParam", "follower": "FollowerArmParam"}
_OBSERVER = ("Dn", "Jn", "gn")
_FRICTION = ("Fc", "k", "Fv")
_SLOPE = Fraction(1, 10)
"""What k is multiplied by in the code."""

_NOTES = (
    "Kd is of the speed of one arm against the other: v_des is the partner's speed on both sides "
    "(enactic/openarm_teleop, bilateral_step); it damps nothing when both arms move together",
    "friction is compensated by Fc tanh(0.1 k v) + Fv v: the factor 0.1 is in the code, although the comment "
    "in the file says tanh(k v); taken as computed once in a sample period, from the move before; the offset "
    "Fo gives back what it takes, like a weight",
    "of the gripper the code takes the speed in the compensation from beyond the end of its list "
    "(bilateral_step): what is added there is not known, and it is decided as the file means it",
    "the speed in the law is the drive's estimate, of an unknown filter; here it is the difference of two "
    "positions",
    "the threads of both arms are not in step, so that readings are 1 to 4.3 ms old, now more and now less: "
    "a constant age is decided",
)


def fits(table: GainTable) -> bool:
    """True where one of its keys is there."""
    return any(key in table for key in (*_SIDES.values(), "Bilateral"))


def read(tables: Sequence[GainTable]) -> ArmGains:
    """Both sides from one file or two; where one side is missing it is taken as the other."""
    found: dict[str, list[Gains]] = {}
    for table in tables:
        for side, key in _SIDES.items():
            if key in table:
                if side in found:
                    raise InputError(f"{table.where(key)}: the {side}'s gains are given twice")
                found[side] = _gains(table.table(key))
    bilateral = [table.table("Bilateral") for table in tables if "Bilateral" in table]
    notes = list(_NOTES)
    if bilateral:
        found["leader"] = _on_the_host(bilateral[0], found.get("leader"))
        notes += [
            "the leader's gains are those of Bilateral, K (q' − q) − Kd v, computed on the host: Kd is of "
            "its own speed; the follower's are taken as in openarm_teleop, v_des the leader's speed",
            "both arms are taken as computed once in a sample period, the follower too, which in the fork "
            "has a loop in its drive: with that it is another pair, which is not decided here",
        ]
    if not found:
        raise InputError(f"{tables[0].label}: neither {' nor '.join(_SIDES.values())} is there")
    for side, other in (("leader", "follower"), ("follower", "leader")):
        if side not in found:
            found[side] = found[other]
            notes.append(
                f"no file gives the {side}'s gains: taken as the {other}'s; give both files where they differ"
            )
    leader, follower = found["leader"], found["follower"]
    if len(leader) != len(follower):
        raise InputError(
            f"{tables[0].label}: the leader has {len(leader)} joints and the follower {len(follower)}; "
            "each joint is coupled to its own"
        )
    motors = family(NAME).motors
    names = _names(len(leader))
    joints = tuple(
        JointGains(name, first, second, motors[n] if len(motors) == len(leader) else "")
        for n, (name, first, second) in enumerate(zip(names, leader, follower, strict=True))
    )
    return ArmGains(NAME, joints, tuple(notes), drives=not bilateral)


def _gains(table: GainTable) -> list[Gains]:
    for key in _OBSERVER:
        if key in table:
            raise InputError(
                f"{table.where(key)}: gains of a law with disturbance observers (an early openarm_teleop, or "
                "openarm_bilateral): its Kp and Kd are per unit of inertia, and no spring and damper joins "
                "the arms; not decided here"
            )
    stiffness = table.numbers("Kp", "N*m/rad")
    count = len(stiffness)
    damping = table.numbers("Kd", "N*m*s/rad", count)
    offset = table.numbers("Fo", "N*m", count) if "Fo" in table else [Fraction(0)] * count
    rows = zip(stiffness, damping, _compensation(table, count), offset, strict=True)
    return [
        Gains(k, damping=b, compensation=law, offset=o, source=f"{table.label}, Kp[{n}]")
        for n, (k, b, law, o) in enumerate(rows)
    ]


def _compensation(table: GainTable, count: int) -> list[FrictionCompensation]:
    if not any(key in table for key in _FRICTION):
        return [NONE] * count
    coulomb = table.numbers("Fc", "N*m", count)
    steepness = table.numbers("k", "s/rad", count)
    viscous = table.numbers("Fv", "N*m*s/rad", count)
    for key, values in (("Fc", coulomb), ("k", steepness), ("Fv", viscous)):
        for n, value in enumerate(values):
            if value < 0:
                raise InputError(
                    f"{table.where(key)}[{n}] must be ≥ 0, got {float(value):g}: what is compensated is "
                    "friction, and that is not negative"
                )
    return [
        FrictionCompensation(
            coulomb=Exact(f) if k else 0, viscous=Exact(c), speed=Exact(1 / (_SLOPE * k)) if k else 0
        )
        for f, k, c in zip(coulomb, steepness, viscous, strict=True)
    ]


def _on_the_host(table: GainTable, stock: list[Gains] | None) -> list[Gains]:
    """The leader of a fork over two computers (IS0moto/openarm_teleop)."""
    stiffness = table.numbers("Kp", "N*m/rad")
    local = table.numbers("Kd", "N*m*s/rad", len(stiffness))
    if "Kf" in table and any(table.numbers("Kf", "1", len(stiffness))):
        raise InputError(
            f"{table.where('Kf')}: the leader is also given the follower's measured torque; that is no "
            "spring and damper between the arms, and is not decided here. Set Kf to 0 for the rest of the law"
        )
    laws: list[FrictionCompensation] = [NONE] * len(stiffness)
    if stock is not None and len(stock) == len(stiffness):
        laws = [gains.compensation for gains in stock]
    return [
        Gains(k, local_damping=d, compensation=law, source=f"{table.label}, Kp[{n}]")
        for n, (k, d, law) in enumerate(zip(stiffness, local, laws, strict=True))
    ]


def _names(count: int) -> list[str]:
    names = [f"J{n + 1}" for n in range(count)]
    return [*names[:7], "gripper"] if count == 8 else names
