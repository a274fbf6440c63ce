"""Gain files of arms, family by family: what recognises one, what its numbers mean, and its law."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from fractions import Fraction

from zwidth.data.gains.arms import ArmGains
from zwidth.data.gains.file import GainTable
from zwidth.data.gains.joint import NONE, Gains, JointGains
from zwidth.data.gains.plant import family, servo
from zwidth.errors import InputError
from zwidth.model.rendering.friction_compensation import FrictionCompensation
from zwidth.quantity.exact import Exact
from zwidth.quantity.text import shown

# LeRobot with Damiao motors (openarm_follower): lists position_kp, position_kd.
#
#     τ = kp (q_des − q) − kd q̇
#
# v_des is 0: kd is of the follower's own speed.  The leader is limp: there is no law of both arms.  Source:
# huggingface/lerobot, robots/openarm_follower.

LEROBOT = "lerobot-damiao"

_LEROBOT_NOTES = (
    "LeRobot moves the follower alone and the leader is limp: there is no law of both arms",
    "position_kd is of the arm's own speed: v_des is 0 (huggingface/lerobot, openarm_follower)",
)


def fits_lerobot(table: GainTable) -> bool:
    return next(_places(table), None) is not None


def read_lerobot(tables: Sequence[GainTable], both: bool) -> ArmGains:
    """The follower's lists, on both sides where that is asked for."""
    places = [place for table in tables for place in _places(table)]
    if len(places) > 1:
        raise InputError(
            f"{places[1].label}: position_kp is given more than once; give the arm that is meant in a file "
            "of its own"
        )
    (place,) = places
    stiffness, damping = place.springs("position_kp", "position_kd")
    motors = family(LEROBOT).motors
    joints = []
    for n, (k, d) in enumerate(zip(stiffness, damping, strict=True)):
        gains = Gains(k, local_damping=d, source=f"{place.label}, position_kp[{n}]")
        name = "gripper" if len(stiffness) == 8 and n == 7 else f"J{n + 1}"
        motor = motors[n] if len(motors) == len(stiffness) else ""
        joints.append(JointGains(name, gains if both else None, gains, motor))
    return ArmGains(LEROBOT, tuple(joints), _LEROBOT_NOTES, drives=True, follows=True)


def _places(table: GainTable) -> Iterator[GainTable]:
    return (place for place in table.below() if "position_kp" in place)


# LeRobot SO-100, SO-101: position_p_coefficient of STS3215 servos, a register that is no stiffness yet.
#
#     K = 0.166 e P U k_t/R        b = k_t²/R + viscous friction
#
# P counts, U the supply voltage, k_t and R the motor's constants at the output, e the efficiency.  Source:
# Rhoban/bam, bam/feetech/actuator.py and its fitted parameters; 0.166 was measured there.  LeRobot drives the
# follower alone: the leader is limp.

FEETECH = "lerobot-feetech"

_P = "position_p_coefficient"
_TYPES = ("so100_follower", "so101_follower", "so_follower")
_DEFAULT = 16
"""Of LeRobot where the file gives none."""

_FEETECH_NOTES = (
    "LeRobot moves the follower alone and the leader is limp: there is no law of both arms",
    "the position loop is in the servo: its rate, its filter and what position_d_coefficient does are not "
    "published; the D coefficient is left out",
    "Minimum_Startup_Force and the dead zone of the servo are left out, and so is its backlash of about 1°",
)


def fits_feetech(table: GainTable) -> bool:
    """True where the coefficient, or a follower of this type, stands somewhere."""
    return next(_servos(table), None) is not None


def read_feetech(tables: Sequence[GainTable], supply_voltage: Fraction | None, both: bool) -> ArmGains:
    """Every joint has the same coefficients; of two arms each is a row."""
    if supply_voltage is None:
        raise InputError(
            "position_p_coefficient is no stiffness by itself: K goes with the servo's voltage; give "
            '--supply-voltage, such as "7.4 V" or "12 V"'
        )
    motor = servo(supply_voltage)
    joints = []
    notes = [
        *_FEETECH_NOTES,
        f"K = {shown(motor.stiffness(Fraction(1), supply_voltage), 'N*m/rad')} for each count of P at "
        f"{shown(supply_voltage, 'V', 6)}, and in proportion to the voltage, which sags under load "
        f"({motor.source})",
    ]
    places = [place for table in tables for place in _servos(table)]
    for place in places:
        if _P in place:
            counts = place.number(_P, "1")
        else:
            counts = Fraction(_DEFAULT)
            notes.append(f"{place.label}: no {_P}, LeRobot's default of {_DEFAULT} is taken")
        if not 0 < counts <= 255:
            raise InputError(
                f"{place.where(_P)} must be 1 to 255, one byte of the servo, got {float(counts):g}"
            )
        if "position_i_coefficient" in place and place.number("position_i_coefficient", "1"):
            notes.append(f"{place.label}: the integral part is left out")
        gains = Gains(motor.stiffness(counts, supply_voltage), source=place.where(_P))
        name = f"each of {place.label}" if len(places) > 1 else "each joint"
        joints.append(JointGains(name, gains if both else None, gains, motor.name))
    return ArmGains(FEETECH, tuple(joints), tuple(notes), drives=True, follows=True)


def _servos(table: GainTable) -> Iterator[GainTable]:
    return (place for place in table.below() if _P in place or place.values.get("type") in _TYPES)


# AgileX Piper: no gain file is published; kp and kd of each JointMitCtrl, written below `piper`.
#
#     τ = κ (kp (q_des − q) + kd (v_des − q̇)),    κ in 1 … 4 on J1 to J3, 1 on the others
#
# κ is not documented for kp and kd: of the feed-forward torque it is 4 on J1 to J3.  Where κ is not known a
# row is made for either end.  Source: agilexrobotics/piper_sdk, asserts/Q&A.MD; agilexrobotics/pyAgxArm#52,
# #59.

PIPER = "piper"

_UNSURE = 3
"""Joints from the first on that may have the factor."""

_HIDDEN = Fraction(4)
_PIPER_NOTES = (
    "Piper publishes no law of both arms: its own leader sends targets, and its gains are in the firmware",
    "on J1 to J3 the motor may multiply kp and kd by a factor of up to 4 that is not documented: a row for "
    "either end (agilexrobotics/pyAgxArm#52)",
    "kd is of the arm's own speed, v_des = 0",
)


def fits_piper(table: GainTable) -> bool:
    return "piper" in table


def read_piper(tables: Sequence[GainTable], both: bool) -> ArmGains:
    if len(tables) > 1:
        raise InputError("one file gives the numbers of a Piper; with --both they are taken for both arms")
    table = tables[0].table("piper")
    joints = []
    for n, (k, d) in enumerate(zip(*table.springs("kp", "kd"), strict=True)):
        for factor in (Fraction(1), _HIDDEN) if n < _UNSURE else (Fraction(1),):
            gains = Gains(k * factor, local_damping=d * factor, source=table.where(f"kp[{n}]"))
            name = f"J{n + 1}" + (f" ×{factor}" if n < _UNSURE else "")
            joints.append(JointGains(name, gains if both else None, gains))
    return ArmGains(PIPER, tuple(joints), _PIPER_NOTES, drives=True, follows=True)


# i2rt YAM: lists kp, kd and motor_list, a file for an arm.
#
#     follower  τ = kp (q_l − q_f) − kd q̇_f + gravity
#     leader    τ = β kp (q_f − q_l) + gravity
#
# with β the bilateral_kp that a person gives when the arms are started, 0.2 by default here.  v_des is 0: kd
# is of the follower's own speed, and the leader has no damping of its own.  Source: i2rt-robotics/i2rt,
# examples/minimum_gello and robots/motor_chain_robot.py.

I2RT = "i2rt"

_I2RT_NOTES = (
    "kd is of the follower's own speed: v_des is 0 (i2rt-robotics/i2rt, minimum_gello); the leader has no "
    "damping of its own",
    "the loop runs freely, 4 to 7 ms a time, and so does the age of readings: constant ones are decided",
    "grav_comp_kd, of an arm that floats by itself, plays no part between the arms",
)


def fits_i2rt(table: GainTable) -> bool:
    return ("kp" in table and "kd" in table and "motor_list" in table) or "motor_kp" in table


def read_i2rt(tables: Sequence[GainTable], bilateral_kp: Fraction) -> ArmGains:
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
    (stiffness, damping), (pulled, _) = (arm.springs("kp", "kd") for arm in (follower, leader))
    if len(pulled) != len(stiffness):
        raise InputError(
            f"{leader.label} has {len(pulled)} joints and {follower.label} {len(stiffness)}; each joint is "
            "coupled to its own"
        )
    notes = [*_I2RT_NOTES, f"the leader's kp is {float(bilateral_kp):g} times the file's, --bilateral-kp"]
    if not bilateral_kp:
        notes.append("with bilateral_kp = 0 the leader feels nothing: this is no pair")
    if len(arms) < len(tables):
        notes.append("the gripper is left out: its motor is coupled to no motor of the leader")
    if any("coulomb_friction" in table for table in arms):
        notes.append(
            "coulomb_friction is added only with use_coulomb_friction, which is off by default: left out"
        )
    its, mine = _compensation_of_i2rt(follower, len(stiffness)), _compensation_of_i2rt(leader, len(stiffness))
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
    return ArmGains(I2RT, joints, tuple(notes), drives=True)


def _compensation_of_i2rt(table: GainTable, count: int) -> list[FrictionCompensation]:
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


# OpenArm (enactic/openarm_teleop): lists Kp, Kd, Fc, k, Fv, Fo of LeaderArmParam and FollowerArmParam.
#
#     τ = Kp (q' − q) + Kd (q̇' − q̇) + gravity + Fc tanh(0.1 k q̇) + Fv q̇ + Fo
#
# on both sides, q' the other arm's position: Kd is of the speed of one arm against the other.  The factor 0.1
# is in the code (ComputeFriction), although the comment beside the numbers says tanh(k q̇).  Source: the file
# src/controller/control.cpp of that repository, function bilateral_step.
#
# Bilateral, of a fork over a network (IS0moto/openarm_teleop, the same file: leader_step, unilateral_step):
#
#     leader    τ = K (q' − q) − Kd q̇ + gravity + 0.3 (Fc tanh(0.1 k q̇) + Fv q̇ + Fo)
#     follower  τ = Kp (q' − q) + Kd (q̇' − q̇) + gravity

OPENARM = "openarm"

_SIDES = {"leader": "LeaderArmParam", "follower": "FollowerArmParam"}
_OBSERVER = ("Dn", "Jn", "gn")
_FRICTION = ("Fc", "k", "Fv")
_SLOPE = Fraction(1, 10)
"""What k is multiplied by in the code."""

_OPENARM_NOTES = (
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
_BILATERAL_NOTES = (
    "the leader's gains are those of Bilateral, K (q' − q) − Kd v, computed on the host: Kd is of its own "
    "speed; the follower's Kd is of its speed against the leader's, which is its v_des "
    "(IS0moto/openarm_teleop, leader_step and unilateral_step)",
    *_OPENARM_NOTES[1:4:2],
    "of that compensation the leader has 0.3, and the follower none",
    "both arms are taken as computed once in a sample period, the follower too, which in the fork has a loop "
    "in its drive: with that it is another pair, which is not decided here",
    "the fork runs at 500 Hz, and its leader.yaml tells of 3 ms there and back over a wire: give --rate 500 "
    "and your --link-delay; what is not given is taken from openarm_teleop",
)


def fits_openarm(table: GainTable) -> bool:
    return any(key in table for key in (*_SIDES.values(), "Bilateral"))


def read_openarm(tables: Sequence[GainTable]) -> ArmGains:
    """Both sides from one file or two; where one side is missing it is taken as the other."""
    found: dict[str, list[Gains]] = {}
    for table in tables:
        for side, key in _SIDES.items():
            if key in table:
                if side in found:
                    raise InputError(f"{table.where(key)}: the {side}'s gains are given twice")
                found[side] = _gains(table.table(key))
    bilateral = [table.table("Bilateral") for table in tables if "Bilateral" in table]
    notes = list(_BILATERAL_NOTES if bilateral else _OPENARM_NOTES)
    for side, other in (("leader", "follower"), ("follower", "leader")):
        if side not in found and other in found and not (bilateral and side == "leader"):
            found[side] = found[other]
            notes.append(
                f"no file gives the {side}'s gains: taken as those of {_SIDES[other]}; give both files where "
                "they differ"
            )
    if bilateral:
        if "follower" not in found:
            raise InputError(
                f"{bilateral[0].label}: the leader's law alone; give the file with FollowerArmParam, too"
            )
        found["leader"] = _on_the_host(bilateral[0], found.get("leader"))
        found["follower"] = [replace(gains, compensation=NONE) for gains in found["follower"]]
    leader, follower = found["leader"], found["follower"]
    if len(leader) != len(follower):
        raise InputError(
            f"{tables[0].label}: the leader has {len(leader)} joints and the follower {len(follower)}; "
            "each joint is coupled to its own"
        )
    motors = family(OPENARM).motors
    names = _names(len(leader))
    joints = tuple(
        JointGains(name, first, second, motors[n] if len(motors) == len(leader) else "")
        for n, (name, first, second) in enumerate(zip(names, leader, follower, strict=True))
    )
    return ArmGains(OPENARM, joints, tuple(notes), drives=not bilateral)


def refuse_observers(table: GainTable) -> None:
    """Of a law whose Kp is no spring."""
    for key in _OBSERVER:
        if key in table:
            raise InputError(
                f"{table.where(key)}: gains of a law with disturbance observers (an early openarm_teleop, or "
                "openarm_bilateral): its Kp and Kd are per unit of inertia, and no spring and damper joins "
                "the arms; not decided here"
            )


def _gains(table: GainTable) -> list[Gains]:
    refuse_observers(table)
    stiffness, damping = table.springs("Kp", "Kd")
    count = len(stiffness)
    offset = table.numbers("Fo", "N*m", count) if "Fo" in table else [Fraction(0)] * count
    rows = zip(stiffness, damping, _compensation_of_openarm(table, count), offset, strict=True)
    return [
        Gains(k, damping=b, compensation=law, offset=o, source=f"{table.label}, Kp[{n}]")
        for n, (k, b, law, o) in enumerate(rows)
    ]


def _compensation_of_openarm(table: GainTable, count: int) -> list[FrictionCompensation]:
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
    """The leader of the fork over two computers, `stock` what its LeaderArmParam says."""
    stiffness, local = table.springs("Kp", "Kd")
    if "Kf" in table and any(table.numbers("Kf", "1", len(stiffness))):
        raise InputError(
            f"{table.where('Kf')}: the leader is also given the follower's measured torque; that is no "
            "spring and damper between the arms, and is not decided here. Set Kf to 0 for the rest of the law"
        )
    laws: list[FrictionCompensation] = [NONE] * len(stiffness)
    if stock is not None and len(stock) == len(stiffness):
        laws = [gains.compensation.scaled(Fraction(3, 10)) for gains in stock]
    return [
        Gains(k, local_damping=d, compensation=law, source=f"{table.label}, Kp[{n}]")
        for n, (k, d, law) in enumerate(zip(stiffness, local, laws, strict=True))
    ]


def _names(count: int) -> list[str]:
    names = [f"J{n + 1}" for n in range(count)]
    return [*names[:7], "gripper"] if count == 8 else names
