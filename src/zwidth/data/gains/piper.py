"""AgileX Piper: no gain file is published; kp and kd of each JointMitCtrl, written below `piper`.

    τ = κ (kp (q_des − q) + kd (v_des − q̇)),    κ in 1 … 4 on J1 to J3, 1 on the others

κ is not documented for kp and kd: of the feed-forward torque it is 4 on J1 to J3.  Where κ is not known a row
is made for either end.  Source: agilexrobotics/piper_sdk, asserts/Q&A.MD; agilexrobotics/pyAgxArm#52, #59.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

from zwidth.data.gains.arms import ArmGains
from zwidth.data.gains.file import GainTable
from zwidth.data.gains.joint import Gains, JointGains
from zwidth.errors import InputError

NAME = "piper"

_UNSURE = 3
"""Joints from the first on that may have the factor."""

_HIDDEN = Fraction(4)
_NOTES = (
    "Piper publishes no law of both arms: its own leader sends targets, and its gains are in the firmware",
    "on J1 to J3 the motor may multiply kp and kd by a factor of up to 4 that is not documented: a row for "
    "either end (agilexrobotics/pyAgxArm#52)",
    "kd is of the arm's own speed, v_des = 0",
)


def fits(table: GainTable) -> bool:
    """True for a file with such a table."""
    return "piper" in table


def read(tables: Sequence[GainTable], both: bool) -> ArmGains:
    """The numbers of one file."""
    if len(tables) > 1:
        raise InputError("one file gives the numbers of a Piper; with --both they are taken for both arms")
    table = tables[0].table("piper")
    stiffness = table.numbers("kp", "N*m/rad")
    damping = table.numbers("kd", "N*m*s/rad", len(stiffness))
    joints = []
    for n, (k, d) in enumerate(zip(stiffness, damping, strict=True)):
        for factor in (Fraction(1), _HIDDEN) if n < _UNSURE else (Fraction(1),):
            gains = Gains(k * factor, local_damping=d * factor, source=table.where(f"kp[{n}]"))
            name = f"J{n + 1}" + (f" ×{factor}" if n < _UNSURE else "")
            joints.append(JointGains(name, gains if both else None, gains))
    return ArmGains(NAME, tuple(joints), _NOTES, drives=True, follows=True)
