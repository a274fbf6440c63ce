"""Gain files as they are found, recognised by their keys."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from types import MappingProxyType

from zwidth.data.gains import families
from zwidth.data.gains.arms import ArmGains
from zwidth.data.gains.families import FEETECH, I2RT, LEROBOT, OPENARM, PIPER
from zwidth.data.gains.file import GainTable, read_table
from zwidth.errors import InputError
from zwidth.missing import suggestion
from zwidth.model.specification.table import quoted
from zwidth.quantity.exact import RealLike
from zwidth.quantity.units import parse_number

BILATERAL_KP = "0.2"
"""How much softer the leader's spring is than the follower's where nothing is given: of i2rt alone."""

FAMILIES: Mapping[str, Callable[[GainTable], bool]] = MappingProxyType(
    {
        OPENARM: families.fits_openarm,
        I2RT: families.fits_i2rt,
        FEETECH: families.fits_feetech,
        LEROBOT: families.fits_lerobot,
        PIPER: families.fits_piper,
    }
)

_WANTED = {
    OPENARM: "LeaderArmParam, FollowerArmParam or Bilateral",
    I2RT: "kp, kd and motor_list",
    FEETECH: "position_p_coefficient, or type: so101_follower",
    LEROBOT: "position_kp",
    PIPER: "piper",
}


def read_gains(
    *paths: str | Path,
    family: str | None = None,
    bilateral_kp: RealLike | None = None,
    supply_voltage: RealLike | None = None,
    both: bool = False,
) -> ArmGains:
    """Read the gain files of two arms.

    Parameters
    ----------
    paths
        One file, or two of leader and follower: YAML, JSON or TOML.
    family
        "openarm", "i2rt", "lerobot-damiao", "lerobot-feetech" or "piper"; None: by the keys.
    bilateral_kp
        Of i2rt: the leader's kp in multiples of the file's, ≥ 0; None: 0.2.
    supply_voltage
        Of servos whose stiffness goes with it [V].
    both
        True: take the follower's gains on both sides of an arm whose leader is limp.

    Returns
    -------
    ArmGains
        The gains joint by joint in the units of the joint, with what each is and what is not known.

    Raises
    ------
    InputError
        If a file cannot be read, is of no known family, or lacks a number.
    """
    if not 1 <= len(paths) <= 2:
        raise InputError(
            f"gains are read from one file, or from two of leader and follower, got {len(paths)}"
        )
    tables = [read_table(path) for path in paths]
    name = _recognised(tables) if family is None else _known(family, tables)
    if bilateral_kp is not None and name != I2RT:
        raise InputError(f"--bilateral-kp belongs to gains of {I2RT}, these are of {name}; leave it out")
    if supply_voltage is not None and name != FEETECH:
        raise InputError(f"--supply-voltage belongs to gains of {FEETECH}, these are of {name}; leave it out")
    if both and name in (OPENARM, I2RT):
        raise InputError("--both is for gains of a follower alone; these are of both arms: leave it out")
    if name == I2RT:
        share = parse_number(BILATERAL_KP if bilateral_kp is None else bilateral_kp, "1", "bilateral_kp")
        if share < 0:
            raise InputError(f"bilateral_kp must be ≥ 0, got {float(share):g}: a spring pulls back")
        return families.read_i2rt(tables, share.fraction)
    if name == FEETECH:
        volts = None if supply_voltage is None else parse_number(supply_voltage, "V", "supply_voltage")
        return families.read_feetech(tables, None if volts is None else volts.fraction, both)
    if name == OPENARM:
        return families.read_openarm(tables)
    return (families.read_lerobot if name == LEROBOT else families.read_piper)(tables, both)


def _recognised(tables: list[GainTable]) -> str:
    found = []
    for table in tables:
        name = next((name for name, fits in FAMILIES.items() if fits(table)), None)
        if name is None:
            raise _nothing(table, None)
        found.append(name)
    if len(set(found)) > 1:
        raise InputError(f"the files are of {' and '.join(found)}; give leader and follower of one kind")
    return found[0]


def _known(family: str, tables: list[GainTable]) -> str:
    """A family that is given; its law is then taken of files that lack what it is recognised by."""
    if family not in FAMILIES:
        raise InputError(
            f"there is no family {quoted(str(family))} of gain files; {suggestion(str(family), FAMILIES)}"
        )
    for table in tables:
        if not (FAMILIES[family](table) or (family == I2RT and "kp" in table)):
            raise _nothing(table, family)
    return family


def _nothing(table: GainTable, family: str | None) -> InputError:
    """Says what a file is that has no gains of a family, or of any."""
    for inner in table.below():
        families.refuse_observers(inner)
    if any("homing_offset" in inner for inner in table.below()):
        return InputError(
            f"{table.label}: a LeRobot calibration (homing_offset, range_min, range_max), which holds no "
            "gains. They are in the robot's configuration: position_p_coefficient of bus servos, 16 where it "
            'is not there, so that {"type": "so101_follower"} is such a file; position_kp and position_kd of '
            "Damiao motors"
        )
    if family is not None:
        return InputError(f"{table.label}: no gains of {family}; there should be {_WANTED[family]}")
    wanted = "; ".join(f"{name}: {keys}" for name, keys in _WANTED.items())
    return InputError(
        f"{table.label}: no gains of a known arm. Read are files with these keys. {wanted}; one arm in ROS: "
        "gains or pid with p, i, d, k_gains, stiffness, below a type or ros__parameters. Which arm a file is "
        "of --family says, too; kp and kd of one joint take zwidth pair: --stiffness and --virtual-damping"
    )
