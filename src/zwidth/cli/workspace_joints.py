"""The joints of `zwidth workspace`: by options, one value for all or one for each, or from a file.

    [joints]
    damping = [["0.02 N*m*s/rad", 0.005], [0.005, 0.01]]    # or [0.02, 0.01], one for each joint
    coulomb_friction = [0.01, 0.01]

Numbers are in N, m, s and rad.  Joints that damp each other have a matrix.
"""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any

from zwidth.cli.options import Once
from zwidth.cli.workspace_wall import rows_in_words
from zwidth.errors import InputError
from zwidth.model.specification.table import located
from zwidth.quantity.units import parse_number

if TYPE_CHECKING:
    from zwidth.model.arms.arm import Arm

_JOINT_OPTIONS = (
    ("--joint-damping", "damping", "N*m*s/rad", "viscous friction of the joints"),
    ("--joint-friction", "coulomb_friction", "N*m", "Coulomb friction of the joints"),
    ("--joint-resolution", "resolution", "rad", "encoder step of the joints"),
    ("--torque-limit", "torque_limit", "N*m", "largest torque of the motors"),
)
_UNITS = {key: unit for _, key, unit, _ in _JOINT_OPTIONS}


def add_joint_options(parser: argparse.ArgumentParser) -> None:
    """Friction, encoders and motors of the joints."""
    for option, _, unit, meaning in _JOINT_OPTIONS:
        words = f"{meaning}, one value for all or one for each: 0.001,0.002 [{unit}]"
        parser.add_argument(option, metavar="VALUES", action=Once, help=words)
    words = f"a .toml file whose [joints] has some of {', '.join(_UNITS)}; damping may be a matrix"
    parser.add_argument("--joints", metavar="FILE", action=Once, help=words)


def joints_of(arguments: argparse.Namespace) -> dict[str, Any]:
    """What is given of the joints, a list for each kind; of damping perhaps the rows of a matrix."""
    by_option = {
        key: [float(parse_number(part.strip(), unit, option[2:])) for part in text.split(",")]
        for option, key, unit, _ in _JOINT_OPTIONS
        if (text := getattr(arguments, option[2:].replace("-", "_"))) is not None
    }
    in_file = {} if arguments.joints is None else read_joints(Path(arguments.joints))
    for option, key, _, _ in _JOINT_OPTIONS:
        if key in by_option and key in in_file:
            raise InputError(f"--joints FILE says {key} already; leave out {option}")
    return in_file | by_option


def read_joints(path: Path) -> dict[str, Any]:
    """The table [joints] of a TOML file."""
    from zwidth.model.specification.read import read_tables

    table = read_tables([path], ("joints",))["joints"]
    table.check_keys(_UNITS, "joints")
    with located(table.label):
        return {key: _values(entry, key) for key, entry in table.values.items()}


def damping_in_words(arm: Arm) -> str:
    """Of each joint, or the matrix of joints that damp each other; and where it comes from."""
    source = getattr(arm, "damping_source", "")
    return f"{_damping(arm)}, {source}" if source else _damping(arm)


def _damping(arm: Arm) -> str:
    import numpy as np

    values, slides = np.asarray(arm.damping), arm.sliding
    if values.ndim == 2:
        unit = "N·s/m" if all(slides) else "N·m·s/rad" if not any(slides) else "in N, m, s, rad"
        return f"{rows_in_words(values)} {unit}"
    if len(set(slides)) == 1:
        return ", ".join(f"{b:.6g}" for b in values) + (" N·s/m" if slides[0] else " N·m·s/rad")
    each = zip(values, slides, strict=True)
    return ", ".join(f"{b:.6g} {'N·s/m' if slid else 'N·m·s/rad'}" for b, slid in each)


def _values(entry: object, key: str) -> list[Any]:
    if not isinstance(entry, list):
        raise InputError(f"{key} is a list, one number for each joint; got {str(entry)[:60]}")
    if key == "damping" and any(isinstance(row, list) for row in entry):
        if not all(isinstance(row, list) and len(row) == len(entry) for row in entry):
            raise InputError("damping is one number for each joint, or a square matrix, [[…, …], […, …]]")
        return [[float(parse_number(x, _UNITS[key], key)) for x in row] for row in entry]
    return [float(parse_number(x, _UNITS[key], key)) for x in entry]
