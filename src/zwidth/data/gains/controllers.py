"""Parameter files of ROS: springs of joints, and Cartesian impedance, of one arm held at a target.

    joint      τ = p e + i ∫e dt + d ė,   e = q_d − q      joint_trajectory_controller, pid_controller: gains;
                                                            ROS 1, effort_controllers: pid
               τ = k (q_d − q) − d q̇                        franka_ros2, example controllers: k_gains, d_gains
               τ = k (q_d − q) − ζ √k q̇                     TRLC-DK1: joints with kp, damping_ratio
    Cartesian  f = K (x_d − x) − D ẋ,  D = 2 ζ √K           Cartesian-Impedance-Controller: stiffness, damping
                                       D or 2 √K            CRISP: task with k_pos_x … k_rot_z, d_pos_x …

To a hand that moves the arm while the target rests, each is a virtual wall on both sides of it.  Sources:
ros-controls/ros2_controllers, joint_trajectory_controller_parameters.yaml; ros-controls/ros_controllers,
effort_controllers; frankarobotics/franka_ros2, franka_bringup/config/controllers.yaml;
matthias-mayr/Cartesian-Impedance-Controller, its parameters.yaml and cartesian_impedance_controller.cpp
(dampingRule); utiasDSL/crisp_controllers, cartesian_controller.yaml and .cpp (setStiffnessAndDamping);
robot-learning-co/trlc-dk1, the impedance follower (JointImpedanceParams);
fzi-forschungszentrum-informatik/cartesian_controllers.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from math import sqrt
from pathlib import Path
from typing import Any

import numpy as np

from zwidth.data.gains.families import refuse_observers
from zwidth.data.gains.file import GainTable, read_table
from zwidth.errors import InputError
from zwidth.model.arms.wall import MatrixWall
from zwidth.model.specification.table import quoted
from zwidth.quantity.answered import answered, data_of
from zwidth.quantity.text import shown
from zwidth.showing import Lines, Part, Shown, Table

AXES = ("x", "y", "z")
_OF_JOINT = ("N·m/rad", "N·m/(rad·s)", "N·m·s/rad")
_MANAGER = ("controller_manager", "ros__parameters")
_MOTIONS = tuple(f"{kind}_{axis}" for kind in ("trans", "rot") for axis in AXES)
_OF_ADMITTANCE = ("stiffness", "pd_gains", "pid_gains")
"""Tables with keys for such motions are of FZI's cartesian_controllers: positions are commanded, no force."""

_OF_TASK = {"N/m": [f"pos_{axis}" for axis in AXES], "N*m/rad": [f"rot_{axis}" for axis in AXES]}
"""Of CRISP, what it calls motions, by the unit of their springs."""

_MOST_KP, _MOST_KD = Fraction(500), Fraction(5)
"""What the drives of a TRLC-DK1 take [N·m/rad, N·m·s/rad]; more is cut off there."""

_JOINT_NOTES = (
    "the target rests: each joint is a spring and a damper to the ground, on both sides",
    "the speed of the d gain is taken as the difference of two readings; what the hardware reports is "
    "filtered in a way of its own",
)
_OF_RATIOS = (
    "d is damping_ratio √kp of the numbers, at most 5 N·m·s/rad, and kp at most 500 N·m/rad, as in the code "
    "of TRLC-DK1; both act in the motor drives: the rate is of their loop"
)
_READ = (
    "gains or pid with p, i, d of each joint, k_gains with d_gains, joints with kp and damping_ratio; at the "
    "end stiffness with translation and rotation, task with k_pos_x … k_rot_z"
)

_INTERFACES = ("command_interfaces", "command_interface", "interface_name")
"""What a controller of ROS 2 commands: of a trajectory, a PID, what is passed on."""

_MOVES = re.compile(r"(?!.*(effort|torque)).*(position|velocity|acceleration|pos_vel)", re.IGNORECASE)
"""Of commands that a drive follows by a loop of its own."""

_OF_DRIVE = (
    "a hand there feels the drive's own loop, of which this file has no gain. Give its spring and damper, "
    "from its maker, its impedance mode or a test, as {arm: {ros__parameters: {gains: {JOINT: {p: …, d: "
    "…}}}}} in N·m/rad and N·m·s/rad, and its --rate; why an arm shakes, zwidth diagnose RECORDING tells"
)


class _OtherLaw(InputError):
    """Of gains of a law that is none of a spring and a damper."""


@dataclass(frozen=True)
class JointLaw:
    """The law of one joint. `keys` leads to the table of its controller, and `form` is how it has the gains:
    "gains" or "joints" below the joint's name, "k_gains" in a list for all joints, "pid" of its one joint."""

    name: str = answered("of the joint")
    stiffness: Fraction = answered("p", unit="N*m/rad")
    integral: Fraction = answered("i [N·m/(rad·s)]", key="integral_N_m_per_rad_s")
    damping: Fraction = answered("d", unit="N*m*s/rad")
    source: str = answered("where they stand")
    keys: tuple[str, ...] = ()
    form: str = "gains"


@dataclass(frozen=True)
class CartesianGains:
    """The diagonal of K and D of an impedance at the end: x, y, z, and about them."""

    stiffness: tuple[float, ...]
    damping: tuple[float, ...]
    """[N/m], [N·m/rad]; [N·s/m], [N·m·s/rad]."""
    nullspace: float
    nullspace_damping: float
    """Of the joints, projected into what does not move the end [N·m/rad], [N·m·s/rad]; 0: none."""
    rate: Fraction | None
    """Of the controller [Hz]; None where the file does not say."""
    source: str
    factors: tuple[float, ...] = (1.0,) * 6
    """ζ of each."""
    keys: tuple[str, ...] = ()
    of_task: bool = False
    """Of CRISP, which has a key for each axis."""

    def wall(self, turns: int) -> MatrixWall:
        """As a wall for a hand at a point, 0 turns, or in pose, 3."""
        size = 3 + turns
        return MatrixWall(np.diag(self.stiffness[:size]), np.diag(self.damping[:size]), turns=turns)

    def notes(self, turns: int, with_null_space: bool = False) -> Iterator[str]:
        """What the wall leaves out of the controller."""
        if not turns and any(self.stiffness[3:]):
            yield "its rotational springs: ask in pose"
        if turns:
            yield (
                "its moments go with the rotation vector, the wall's with 2 sin(φ/2): the same at small "
                "angles"
            )
        if any(self.damping):
            yield (
                "how it makes speeds: a difference of two readings is taken; a robot that filters them is "
                "another loop"
            )
        if self.of_task:
            yield (
                "CRISP's filters of positions, speeds and torques, by default half of each new value, its "
                "clip of errors and its springs at the ends of joints: a lag is more --delay; weights in the "
                "null space are taken as 1"
            )
        if self.nullspace and not with_null_space:
            yield (
                f"its null-space spring of {shown(self.nullspace, 'N*m/rad')}: it has no potential and may "
                "give out energy by itself; --null-stiffness wall asks about both"
            )


@dataclass(frozen=True, repr=False)
class Controllers(Shown):
    """What a parameter file says of one arm.

    Attributes
    ----------
    joints
        Springs of joints, by controller; empty where there are none.
    cartesian
        Impedances at the end.
    rate
        Of the controller manager [Hz]; None where the file does not say.
    notes
        What the numbers are.
    manager
        The keys that lead to the controller manager's parameters.
    """

    joints: tuple[JointLaw, ...]
    cartesian: tuple[CartesianGains, ...]
    rate: Fraction | None
    notes: tuple[str, ...]
    manager: tuple[str, ...] = _MANAGER

    def report(self) -> Iterable[Part]:
        """The gains, the rate, and what the numbers are."""
        if self.joints:
            numbers = ((j.name, (j.stiffness, j.integral, j.damping)) for j in self.joints)
            heads = (("joint", "stiffness", "integral", "damping"), ("", *_OF_JOINT))
            yield _gains(heads, numbers)
        for one in self.cartesian:
            rows = (("stiffness [N/m, N·m/rad]", one.stiffness), ("damping [N·s/m, N·m·s/rad]", one.damping))
            yield _gains((("at the end", *AXES, *(f"about {axis}" for axis in AXES)),), rows)
        yield f"rate: {'not said' if self.rate is None else shown(float(self.rate), 'Hz')}"
        yield Lines(self.notes)

    def to_dict(self) -> dict[str, Any]:
        """As plain data, units in the keys."""
        return {
            "joints": [data_of(joint) for joint in self.joints],
            "cartesian": [
                {
                    "stiffness_N_per_m": list(one.stiffness[:3]),
                    "rotational_stiffness_N_m_per_rad": list(one.stiffness[3:]),
                    "damping_N_s_per_m": list(one.damping[:3]),
                    "rotational_damping_N_m_s_per_rad": list(one.damping[3:]),
                    "nullspace_stiffness_N_m_per_rad": one.nullspace,
                    "nullspace_damping_N_m_s_per_rad": one.nullspace_damping,
                    "rate_Hz": None if one.rate is None else float(one.rate),
                    "source": one.source,
                    "left_out": list(one.notes(3)),
                }
                for one in self.cartesian
            ],
            "rate_Hz": None if self.rate is None else float(self.rate),
            "notes": list(self.notes),
        }


def _gains(heads: Sequence[Sequence[str]], rows: Iterable[tuple[str, Sequence[float | Fraction]]]) -> Table:
    numbers = [(name, *(f"{float(x):g}" for x in row)) for name, row in rows]
    return Table(rows=numbers, heads=heads, lefts=1)


def read_controllers(path: str | Path) -> Controllers:
    """Read a parameter file of ROS, YAML; what is no spring and damper is left out, and said in the notes.

    Raises
    ------
    InputError
        If it cannot be read, has no gains that are known, or a law that is none of a spring and a damper.
    """
    table = read_table(path)
    joints, cartesian = list[JointLaw](), list[CartesianGains]()
    seen, others = list[tuple[str, ...]](), list[str]()
    for inner in table.below():
        if _fits(inner) and (_admittance(inner) or not _MOVES.match(_commanded(inner))):
            try:
                joints += _joints(inner)
                cartesian += _cartesian(inner)
            except _OtherLaw as error:
                others.append(str(error))
            seen.append(inner.keys)
    if not joints and not cartesian:
        for inner in table.below():
            refuse_observers(inner)
        moved = [name for name, _, what in _controllers(table) if _MOVES.match(what)]
        raise InputError(
            others[0]
            if others
            else f"{table.label}: positions or speeds are commanded by {', '.join(moved)}: {_OF_DRIVE}"
            if moved
            else f"{table.label}: no gains of a controller that are known; read are {_READ}. Write others in "
            "one of these forms, {arm: {ros__parameters: {gains: {JOINT: {p: …, d: …}}}}}, or ask zwidth "
            "workspace ARM.urdf --pose --stiffness … --rotational-stiffness …"
        )
    notes = list(_JOINT_NOTES) if joints else []
    if any(joint.form == "joints" for joint in joints):
        notes.append(_OF_RATIOS)
    if joints and cartesian:
        others += [
            f"{one.source}: zwidth workspace ARM.urdf --pose --wall FILE decides it" for one in cartesian
        ]
    for name, keys, what in _controllers(table):
        if not any(own[: len(keys)] == keys for own in seen):
            drive = f"it commands {quoted(what)} of a drive, whose own loop is not in the file"
            others.append(f"{name}: {drive if _MOVES.match(what) else 'it has no gains that are read'}")
    notes += [f"left out: {text}" for text in others]
    found = Controllers(tuple(joints), tuple(cartesian), None, tuple(notes))
    for inner in table.below():
        if inner.keys[-2:] == _MANAGER and "update_rate" in inner:
            return replace(found, rate=inner.number("update_rate", "Hz"), manager=inner.keys)
    return found


def is_of_controllers(table: GainTable) -> bool:
    return next(_controllers(table), None) is not None or any(_fits(inner) for inner in table.below())


def _controllers(table: GainTable) -> Iterator[tuple[str, tuple[str, ...], str]]:
    """The controllers by name, of ROS 1 by their `type`, of ROS 2 that of the manager; what each commands."""
    every = [*table.below()]
    types = {inner.keys[-1]: _commanded(inner) for inner in every if inner.keys and "type" in inner}
    for inner in every:
        kind, name = inner.values.get("type"), "/".join(inner.keys)
        if name.endswith("controller_manager") or "ros__parameters" in inner.keys:
            continue
        if "ros__parameters" in inner:
            own = _commanded(inner.table("ros__parameters")) if _inner(inner, "ros__parameters") else ""
            yield name, inner.keys, own or types.get(name.rsplit("/", 1)[-1], "")
        elif isinstance(kind, str) and "/" in kind:
            yield f"{name} ({kind})", inner.keys, kind


def _commanded(table: GainTable) -> str:
    """What a controller commands, as its interfaces say it, else its type; nothing where neither is there."""
    given = next((table.values[key] for key in (*_INTERFACES, "type") if key in table), "")
    return ", ".join(map(str, given)) if isinstance(given, list) else str(given)


def _inner(table: GainTable, key: str) -> Mapping[str, Any]:
    """What stands below a key; nothing where no keys do."""
    inner = table.values.get(key)
    return inner if isinstance(inner, Mapping) else {}


def _fits(table: GainTable) -> bool:
    return (
        bool("k_gains" in table or _inner(table, "pid") or _inner(table, "pid_gains"))
        or _rows(table, "gains", "p")
        or _rows(table, "joints", "damping_ratio")
        or _is_cartesian(table)
        or _admittance(table) is not None
    )


def _rows(table: GainTable, key: str, inside: str) -> bool:
    """True where a table has a key in it for each joint, with `inside` in that."""
    return any(isinstance(row, Mapping) and inside in row for row in _inner(table, key).values())


def _is_cartesian(table: GainTable) -> bool:
    task = any(str(key).startswith(("k_pos_", "k_rot_")) for key in _inner(table, "task"))
    return task or "translation" in _inner(table, "stiffness")


def _admittance(table: GainTable) -> str | None:
    found = (key for key in _OF_ADMITTANCE if not _inner(table, key).keys().isdisjoint(_MOTIONS))
    return next(found, "admittance" if _inner(table, "admittance") else None)


def _joints(table: GainTable) -> Iterator[JointLaw]:
    if (key := _admittance(table)) is not None:
        raise _OtherLaw(
            f"{table.where(key)}: of an admittance, as in FZI's cartesian_controllers: it commands "
            "positions from a force that is measured, and no wall of a spring and a damper is that "
            "controller; read are impedance controllers; of admittances the documentation has a page"
        )
    if "pid_gains" in table:
        raise _OtherLaw(
            f"{table.where('pid_gains')}: of a servo that Gazebo simulates (gazebo_ros_control); no machine "
            "runs it"
        )
    if "k_gains" in table:
        for n, (k, d) in enumerate(zip(*table.springs("k_gains", "d_gains"), strict=True)):
            where = table.where(f"k_gains[{n}]")
            yield JointLaw(f"joint{n + 1}", k, Fraction(0), d, where, table.keys, "k_gains")
    if _inner(table, "pid"):
        _commands_efforts(table, "pid")
        name = table.values.get("joint", table.keys[-1] if table.keys else "joint")
        yield _pid(str(name), table.table("pid"), table, "pid")
    if _rows(table, "gains", "p"):
        _commands_efforts(table, "gains")
        gains = table.table("gains")
        yield from (_pid(name, gains.table(name), table, "gains") for name in gains.values)
    if _rows(table, "joints", "damping_ratio"):
        joints = table.table("joints")
        yield from (_of_ratio(name, joints.table(name), table) for name in joints.values)


def _commands_efforts(table: GainTable, key: str) -> None:
    """Elsewhere gains make something else of an error, or an effort of the error of a speed."""
    commands, of = _commanded(table) or "effort", table.values.get("reference_and_state_interfaces")
    if isinstance(of, list) and of and of[0] != "position":
        commands += " by " + ", ".join(map(str, of))
    if "effort" not in commands or " by " in commands or commands.endswith("VelocityController"):
        where = table.where(next((name for name in _INTERFACES if name in table), key))
        raise _OtherLaw(
            f"{where}: gains act on {quoted(commands)}; they are a spring and a damper where the command is "
            "an effort made of positions"
        )


def _pid(name: str, row: GainTable, table: GainTable, form: str) -> JointLaw:
    p, i, d = (
        row.number(key, unit) if key in row else Fraction(0)
        for key, unit in (("p", "N*m/rad"), ("i", "1"), ("d", "N*m*s/rad"))
    )
    return JointLaw(name, p, i, d, row.where("p"), table.keys, form)


def _of_ratio(name: str, row: GainTable, table: GainTable) -> JointLaw:
    for key in ("kp", "damping_ratio"):
        if key not in row or row.number(key, "1") < 0:
            raise InputError(f"{row.where(key)}: give a number ≥ 0; TRLC-DK1 has defaults in its own code")
    kp, ratio = row.number("kp", "N*m/rad"), row.number("damping_ratio", "1")
    d = min(Fraction(float(ratio) * sqrt(kp)), _MOST_KD)
    return JointLaw(name, min(kp, _MOST_KP), Fraction(0), d, row.where("kp"), table.keys, "joints")


def _cartesian(table: GainTable) -> Iterator[CartesianGains]:
    if not _is_cartesian(table):
        return
    of_task = "task" in table
    k, factors = (_of_task if of_task else _of_factors)(table)
    if min(k) < 0 or min(factors) < 0:
        raise InputError(f"{table.label}: stiffness and damping factors must be ≥ 0: a spring pulls back")
    rate = table.number("update_frequency", "Hz") if "update_frequency" in table else None
    *d, d_null = (2 * factor * sqrt(value) for factor, value in zip(factors, k, strict=True))
    yield CartesianGains(
        tuple(k[:6]),
        tuple(d),
        k[6],
        d_null,
        rate,
        table.where("task" if of_task else "stiffness"),
        tuple(factors[:6]),
        table.keys,
        of_task,
    )


def _of_factors(table: GainTable) -> tuple[list[float], list[float]]:
    """K and ζ of the six motions and of the null space."""
    stiffness = table.table("stiffness")
    k = [
        *_three(stiffness, "translation", "N/m"),
        *(_three(stiffness, "rotation", "N*m/rad") if "rotation" in stiffness else (0.0,) * 3),
    ]
    factors = [1.0] * 7
    if "damping" in table:
        damping = table.table("damping")
        if "nullspace_damping" in damping:
            factors[6] = float(damping.number("nullspace_damping", "1"))
        for place, part in ((0, "translation"), (3, "rotation")):
            if part in damping:
                factors[place : place + 3] = _three(damping, part, "1")
    null = stiffness.number("nullspace_stiffness", "N*m/rad") if "nullspace_stiffness" in stiffness else 0
    return [*k, float(null)], factors


def _of_task(table: GainTable) -> tuple[list[float], list[float]]:
    """The same of CRISP, which takes 2 √K for a damping that is not > 0."""
    if str(table.values.get("use_operational_space", "false")).lower() == "true":
        raise _OtherLaw(
            f"{table.where('use_operational_space')}: the spring is multiplied by the arm's mass; no wall is"
        )
    task = table.table("task")
    null = table.table("nullspace") if "nullspace" in table else GainTable(f"{table.label}, nullspace", {})
    keys = [(task, f"k_{name}", f"d_{name}", unit) for unit, names in _OF_TASK.items() for name in names]
    k, factors = list[float](), list[float]()
    for part, stiff, damped, unit in [*keys, (null, "stiffness", "damping", "N*m/rad")]:
        if part is task and stiff not in part:
            raise InputError(f"{part.where(stiff)} is missing; give k_pos_x … k_rot_z [N/m; N·m/rad]")
        value = float(part.number(stiff, unit)) if stiff in part else 1.0
        d = float(part.number(damped, "1")) if damped in part else -1.0
        if d > 0 >= value:
            raise _OtherLaw(f"{part.where(damped)}: a damper without a spring is not read")
        k.append(value)
        factors.append(d / (2 * sqrt(value)) if d > 0 else 1.0)
    return k, factors


def _three(table: GainTable, key: str, unit: str) -> Sequence[float]:
    inner = table.table(key)
    missing = [axis for axis in AXES if axis not in inner]
    if missing:
        raise InputError(f"{inner.label}: {missing[0]} is missing; give x, y and z [{unit}]")
    return [float(inner.number(axis, unit)) for axis in AXES]
