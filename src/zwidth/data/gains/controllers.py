"""Parameter files of ros2_control: springs of joints, and Cartesian impedance, of one arm held at a target.

    joint      τ = p e + i ∫e dt + d ė,   e = q_d − q      joint_trajectory_controller, pid_controller: gains
               τ = k (q_d − q) − d q̇                        franka_ros2, example controllers: k_gains, d_gains
    Cartesian  f = K (x_d − x) − D ẋ,  D = 2 ζ √K           Cartesian-Impedance-Controller: stiffness, damping

To a hand that moves the arm while the target rests, each is a virtual wall on both sides of it.  Sources:
ros-controls/ros2_controllers, joint_trajectory_controller_parameters.yaml; frankarobotics/franka_ros2,
franka_bringup/config/controllers.yaml; matthias-mayr/Cartesian-Impedance-Controller, its parameters.yaml and
cartesian_impedance_controller.cpp (dampingRule); fzi-forschungszentrum-informatik/cartesian_controllers.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import sqrt
from pathlib import Path
from typing import Any

import numpy as np

from zwidth.data.gains.file import GainTable, read_table
from zwidth.errors import InputError
from zwidth.model.arms.wall import MatrixWall
from zwidth.model.specification.table import quoted
from zwidth.quantity.text import shown

_AXES = ("x", "y", "z")
_MOTIONS = tuple(f"{kind}_{axis}" for kind in ("trans", "rot") for axis in _AXES)
_OF_ADMITTANCE = ("stiffness", "pd_gains", "pid_gains")
"""Tables with keys for such motions are of FZI's cartesian_controllers: positions are commanded, no force."""

_JOINT_NOTES = (
    "the target rests: each joint is a spring and a damper to the ground, on both sides",
    "the speed of the d gain is taken as the difference of two readings; what the hardware reports is "
    "filtered "
    "in a way of its own",
)


@dataclass(frozen=True)
class JointLaw:
    """p, i and d of one joint [N·m/rad, N·m/(rad·s), N·m·s/rad], and where they stand.

    `keys` leads to the table of its controller; `by_joint` is True of gains below the joint's name, False of
    a list for all joints.
    """

    name: str
    stiffness: Fraction
    integral: Fraction
    damping: Fraction
    source: str
    keys: tuple[str, ...] = ()
    by_joint: bool = True


@dataclass(frozen=True)
class CartesianGains:
    """The diagonal of K and D of an impedance at the end: x, y, z, and about x, y, z.

    Attributes
    ----------
    stiffness
        [N/m], [N·m/rad].
    damping
        [N·s/m], [N·m·s/rad].
    nullspace, nullspace_damping
        Of the joints, projected into what does not move the end [N·m/rad], [N·m·s/rad]; 0: none.
    rate
        Of the controller [Hz]; None where the file does not say.
    source
        Where they stand.
    factors
        ζ of each.
    keys
        That lead to the table of the controller.
    """

    stiffness: tuple[float, ...]
    damping: tuple[float, ...]
    nullspace: float
    nullspace_damping: float
    rate: Fraction | None
    source: str
    factors: tuple[float, ...] = (1.0,) * 6
    keys: tuple[str, ...] = ()

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
        if self.nullspace and not with_null_space:
            yield (
                f"its null-space spring of {shown(self.nullspace, 'N*m/rad')}: it has no potential and may "
                "give out energy by itself; --null-stiffness wall asks about both"
            )


@dataclass(frozen=True)
class Controllers:
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
    manager: tuple[str, ...] = ("controller_manager", "ros__parameters")

    def to_dict(self) -> dict[str, Any]:
        """As plain data, units in the keys."""
        return {
            "joints": [
                {
                    "name": joint.name,
                    "stiffness_N_m_per_rad": float(joint.stiffness),
                    "integral_N_m_per_rad_s": float(joint.integral),
                    "damping_N_m_s_per_rad": float(joint.damping),
                    "source": joint.source,
                }
                for joint in self.joints
            ],
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
        }


def read_controllers(path: str | Path) -> Controllers:
    """Read a parameter file of ros2_control, YAML.

    Raises
    ------
    InputError
        If it cannot be read, has no gains that are known, or a law that is none of a spring and a damper.
    """
    table = read_table(path)
    found = [inner for inner in table.below() if _fits(inner)]
    if not found:
        raise InputError(
            f"{table.label}: no gains of a controller; read are gains with p, i, d for each joint, "
            "k_gains with "
            "d_gains, and stiffness with translation and rotation, below ros__parameters"
        )
    joints = tuple(joint for inner in found for joint in _joints(inner))
    cartesian = tuple(_cartesian(inner) for inner in found if _is_cartesian(inner))
    manager = _manager(table)
    notes = _JOINT_NOTES if joints else ()
    if manager is None:
        return Controllers(joints, cartesian, None, notes)
    return Controllers(joints, cartesian, manager.number("update_rate", "Hz"), notes, manager.keys)


def is_of_controllers(table: GainTable) -> bool:
    """True for a file with gains of ros2_control."""
    return any(_fits(inner) for inner in table.below())


def _fits(table: GainTable) -> bool:
    return "k_gains" in table or _is_pid(table) or _is_cartesian(table) or _admittance(table) is not None


def _is_pid(table: GainTable) -> bool:
    gains = table.values.get("gains")
    return isinstance(gains, dict) and any(isinstance(row, dict) and "p" in row for row in gains.values())


def _is_cartesian(table: GainTable) -> bool:
    inner = table.values.get("stiffness")
    return isinstance(inner, dict) and "translation" in inner


def _admittance(table: GainTable) -> str | None:
    """The key by which an admittance is known."""
    for key in _OF_ADMITTANCE:
        inner = table.values.get(key)
        if isinstance(inner, dict) and any(motion in inner for motion in _MOTIONS):
            return key
    return None


def _joints(table: GainTable) -> Iterator[JointLaw]:
    if (key := _admittance(table)) is not None:
        raise InputError(
            f"{table.where(key)}: of an admittance, as in FZI's cartesian_controllers: it commands "
            "positions from a force that is measured, and no wall of a spring and a damper is that "
            "controller; read are impedance controllers; of admittances the documentation has a page"
        )
    if "k_gains" in table:
        stiffness = table.numbers("k_gains", "N*m/rad")
        damping = table.numbers("d_gains", "N*m*s/rad", len(stiffness))
        for n, (k, d) in enumerate(zip(stiffness, damping, strict=True)):
            where = table.where(f"k_gains[{n}]")
            yield JointLaw(f"joint{n + 1}", k, Fraction(0), d, where, table.keys, by_joint=False)
    if _is_pid(table):
        yield from _pids(table)


def _pids(table: GainTable) -> Iterator[JointLaw]:
    interfaces = table.values.get("command_interfaces")
    if isinstance(interfaces, list) and "effort" not in interfaces:
        raise InputError(
            f"{table.where('command_interfaces')}: gains act on "
            f"{quoted(', '.join(map(str, interfaces)))}; they are "
            "a spring and a damper where the command is an effort"
        )
    gains = table.table("gains")
    for name in gains.values:
        row = gains.table(name)

        def number(key: str, unit: str, row: GainTable = row) -> Fraction:
            return row.number(key, unit) if key in row else Fraction(0)

        p, i, d = number("p", "N*m/rad"), number("i", "1"), number("d", "N*m*s/rad")
        yield JointLaw(str(name), p, i, d, row.where("p"), table.keys)


def _cartesian(table: GainTable) -> CartesianGains:
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
    k.append(float(null))
    if min(k) < 0 or min(factors) < 0:
        raise InputError(f"{table.label}: stiffness and damping factors must be ≥ 0: a spring pulls back")
    rate = table.number("update_frequency", "Hz") if "update_frequency" in table else None
    *d, d_null = (2 * factor * sqrt(value) for factor, value in zip(factors, k, strict=True))
    return CartesianGains(
        tuple(k[:6]),
        tuple(d),
        k[6],
        d_null,
        rate,
        table.where("stiffness"),
        tuple(factors[:6]),
        table.keys,
    )


def _three(table: GainTable, key: str, unit: str) -> Sequence[float]:
    inner = table.table(key)
    missing = [axis for axis in _AXES if axis not in inner]
    if missing:
        raise InputError(f"{inner.label}: {missing[0]} is missing; give x, y and z [{unit}]")
    return [float(inner.number(axis, unit)) for axis in _AXES]


def _manager(table: GainTable) -> GainTable | None:
    """The parameters of the controller manager, where its update_rate stands."""
    for inner in table.below():
        if inner.keys[-2:] == ("controller_manager", "ros__parameters") and "update_rate" in inner:
            return inner
    return None
