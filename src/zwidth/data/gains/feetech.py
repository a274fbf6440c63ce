"""LeRobot SO-100, SO-101: position_p_coefficient of STS3215 servos, a register that is no stiffness yet.

    K = 0.166 e P U k_t/R        b = k_t²/R + viscous friction

P counts, U the supply voltage, k_t and R the motor's constants at the output, e the efficiency.  Source:
Rhoban/bam, bam/feetech/actuator.py and its fitted parameters; 0.166 was measured there.  LeRobot drives the
follower alone: the leader is limp.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fractions import Fraction

from zwidth.data.gains.arms import ArmGains
from zwidth.data.gains.file import GainTable
from zwidth.data.gains.joint import Gains, JointGains
from zwidth.data.gains.published import servo
from zwidth.errors import InputError

NAME = "lerobot-feetech"

_P = "position_p_coefficient"
_TYPES = ("so100_follower", "so101_follower", "so_follower")
_DEFAULT = 16
"""Of LeRobot where the file gives none."""

_NOTES = (
    "LeRobot moves the follower alone and the leader is limp: there is no law of both arms",
    "the position loop is in the servo: its rate, its filter and what position_d_coefficient does are not "
    "published; the D coefficient is left out",
    "Minimum_Startup_Force and the dead zone of the servo are left out, and so is its backlash of about 1°",
)


def fits(table: GainTable) -> bool:
    """True where the coefficient, or a follower of this type, stands somewhere."""
    return next(_servos(table), None) is not None


def read(tables: Sequence[GainTable], supply_voltage: Fraction | None, both: bool) -> ArmGains:
    """Every joint has the same coefficients; of two arms each is a row."""
    if supply_voltage is None:
        raise InputError(
            "position_p_coefficient is no stiffness by itself: K goes with the servo's voltage; give "
            "--supply-voltage, such as '7.4 V' or '12 V'"
        )
    motor = servo(supply_voltage)
    joints = []
    notes = [
        *_NOTES,
        f"K = {float(motor.stiffness(Fraction(1), supply_voltage)):.4g} N·m/rad for each count of P at "
        f"{float(supply_voltage):g} V, and in proportion to the voltage, which sags under load "
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
    return ArmGains(NAME, tuple(joints), tuple(notes), drives=True, follows=True)


def _servos(table: GainTable) -> Iterator[GainTable]:
    return (place for place in table.below() if _P in place or place.values.get("type") in _TYPES)
