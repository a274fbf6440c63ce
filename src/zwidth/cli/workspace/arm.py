"""The arm of `zwidth workspace`: a built-in one by its name, or one that a file describes."""

from __future__ import annotations

import argparse
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from zwidth.errors import InputError
from zwidth.model.specification.table import located
from zwidth.quantity.text import shown
from zwidth.quantity.units import parse_number

if TYPE_CHECKING:
    from zwidth.data.gains.controllers import CartesianGains
    from zwidth.model.arms import Arm
    from zwidth.model.arms.wall import MatrixWall
    from zwidth.model.environment.wall import Wall
    from zwidth.quantity.exact import Exact


def arm_of(arguments: argparse.Namespace) -> Arm:
    """The arm, with what is given of its joints."""
    from zwidth.model.arms import BUILT_IN

    joints = joints_of(arguments)
    if arguments.rest is not None and not arguments.pose:
        raise InputError("--rest is where the rotation of a wall in pose rests; add --pose")
    return (_built_in if arguments.arm in BUILT_IN else _described)(arguments, joints)


def arm_in_words(arm: Arm, rate: float) -> str:
    """Its name, how many joints it has, of a description where the hand is, and the rate [Hz]."""
    count = f"{arm.joint_count} joint{'s' if arm.joint_count > 1 else ''}"
    frame = getattr(arm, "frame", None)
    return ", ".join(
        [arm.name, count, shown(rate, "Hz"), *([f"hand at {frame}{_idle(arm)}"] if frame else [])]
    )


def _idle(arm: Any) -> str:
    """Joints that do not move the hand: a link's frame is at its first joint, and not at its tip."""
    import numpy as np

    low, high = np.array(arm.joint_range).T
    inside = low + np.outer((0.3, 0.6), high - low)
    moves = (np.abs(arm.jacobian(inside)).max(axis=(0, 1)) > 1e-9) | (low == high)
    idle = [one.name for one, moved in zip(arm.model.coordinates, moves, strict=True) if not moved]
    more = f" and {len(idle) - 3} others" if len(idle) > 3 else ""
    return f", which {', '.join(idle[:3])}{more} cannot move (--frame says where the hand is)" if idle else ""


def _built_in(arguments: argparse.Namespace, joints: Mapping[str, Any]) -> Arm:
    from zwidth.model.arms import built_in

    if any(option is not None for option in (arguments.frame, arguments.hold, arguments.rest)):
        raise InputError("--frame, --hold and --rest are for descriptions; the built-in arms have none")
    if "damping" not in joints:
        raise InputError(
            f"no source gives the joint damping of {arguments.arm}, and no verdict exists without it; "
            "measure and give it [N*m*s/rad], for example --joint-damping 0.003"
        )
    for_all = {key: v[0] if len(v) == 1 else v for key, v in joints.items()}
    return built_in(arguments.arm, **for_all, **({"pose": True} if arguments.pose else {}))


def _described(arguments: argparse.Namespace, joints: Mapping[str, Any]) -> Arm:
    from zwidth.model.arms import BUILT_IN, read_arm

    path = Path(arguments.arm)
    if not path.suffix:
        raise InputError(
            f"there is no arm {arguments.arm[:40]!r}; built in are {', '.join(BUILT_IN)}; "
            "or name a .urdf file"
        )
    return read_arm(
        path,
        frame=arguments.frame,
        hold=by_name(arguments.hold, "hold"),
        pose=arguments.pose,
        rest={} if arguments.rest == "middle" else by_name(arguments.rest, "rest"),
        whole=arguments.postures is not None or arguments.null_stiffness is not None,
        **joints,
    )


def by_name(text: str | None, option: str) -> dict[str, str] | None:
    """Joints with values, as in wrist=0.2,grip=0."""
    if text is None:
        return None
    pairs = [part.partition("=") for part in text.split(",")]
    if not all(name.strip() and equals for name, equals, _ in pairs):
        raise InputError(f"--{option}: joints and values, as in wrist=0.2,grip=0; got {text[:60]!r}")
    return {name.strip(): value.strip() for name, _, value in pairs}


# The joints of `zwidth workspace`: by options, one value for all or one for each, or from a file.

_JOINT_OPTIONS = (
    ("--joint-damping", "damping", "N*m*s/rad", "viscous friction of the joints"),
    ("--joint-friction", "coulomb_friction", "N*m", "Coulomb friction of the joints"),
    ("--joint-resolution", "resolution", "rad", "encoder step of the joints"),
    ("--torque-limit", "torque_limit", "N*m", "largest torque of the motors"),
)
_KEYS = tuple(key for _, key, _, _ in _JOINT_OPTIONS)
JOINTS = {
    **{
        f"{option} VALUES": f"{meaning}, one value for all or one for each: 0.001,0.002 [{unit}]"
        for option, _, unit, meaning in _JOINT_OPTIONS
    },
    "--joints FILE": f"a .toml file whose [joints] has some of {', '.join(_KEYS)}, "
    "transmission; damping may be a matrix",
}
"""Friction, encoders and motors of the joints."""


def joints_of(arguments: argparse.Namespace) -> dict[str, Any]:
    """What is given of the joints, a list for each kind; of damping perhaps the rows of a matrix."""
    by_option = {
        key: [part.strip() for part in text.split(",")]
        for option, key, _, _ in _JOINT_OPTIONS
        if (text := getattr(arguments, option[2:].replace("-", "_"))) is not None
    }
    in_file = {} if arguments.joints is None else read_joints(Path(arguments.joints))
    for option, key, _, _ in _JOINT_OPTIONS:
        if key in by_option and key in in_file:
            raise InputError(f"--joints FILE says {key} already; leave out {option}")
    return in_file | by_option


def read_joints(path: Path) -> dict[str, Any]:
    from zwidth.model.specification.read import read_tables
    from zwidth.model.specification.values import joint_transmissions

    table = read_tables([path], ("joints",))["joints"]
    table.check_keys((*_KEYS, "transmission"), "joints")
    found: dict[str, Any] = {key: entry for key, entry in table.values.items() if key in _KEYS}
    for key, entry in found.items():
        if not isinstance(entry, list):
            raise InputError(f"{table.label}: {key} is a list, one for each joint; got {str(entry)[:60]}")
    if "transmission" in table.values:
        found["transmission"] = joint_transmissions(table.values["transmission"], table.label)
    return found


def damping_in_words(arm: Arm) -> str:
    """Of each joint, or the matrix of joints that damp each other; and where it comes from."""
    source = getattr(arm, "damping_source", "")
    text = f"{_damping(arm)}, {source}" if source else _damping(arm)
    return (
        f"{text}; of the motors' side, which feels {_damping(arm.at_motors)}" if arm.transmissions else text
    )


_FEW = 3
"""Joints whose damping is told without their names."""


def _damping(arm: Arm) -> str:
    import numpy as np

    values, slides = np.asarray(arm.damping), arm.sliding
    if values.ndim == 2:
        unit = "N·s/m" if all(slides) else "N·m·s/rad" if not any(slides) else "in N, m, s, rad"
        return f"{rows_in_words(values)} {unit}"
    each = [shown(b, "N*s/m" if slid else "N*m*s/rad", 6) for b, slid in zip(values, slides, strict=True)]
    if len(set(each)) == 1 < len(each):
        return f"{each[0]} in each"
    if len(each) > _FEW:
        return ", ".join(f"{name} {told}" for name, told in zip(arm.joint_names, each, strict=True))
    return ", ".join(each)


# The wall of `zwidth workspace`: as stiff in every direction by options, or given by matrices in a file.


WALL = {
    "--stiffness VALUE": "of the wall, in every direction [N/m]",
    "--rotational-stiffness VALUE": "of a wall in pose, about every axis [N*m/rad] (default: 0)",
    "--virtual-damping VALUE": "of the wall, in every direction [N*s/m] (default: 0)",
    "--rotational-damping VALUE": "of a wall in pose, about every axis [N*m*s/rad] (default: 0)",
    "--wall FILE": "in the place of these: matrices from a .toml file with [wall], or the impedance of a "
    "ros2_control .yaml",
}
_CONTROLLERS = (".yaml", ".yml")
_ROWS = 2
"""Of a matrix that is shown whole even where it is diagonal."""
_WALL_UNITS = {"stiffness": ("N/m", "N/rad", "N*m/rad"), "damping": ("N*s/m", "N*s/rad", "N*m*s/rad")}
"""Of translations, between the two, of rotations."""


def wall_of(arguments: argparse.Namespace, turns: int) -> Wall | MatrixWall:
    """The wall for a hand with so many rotations, 0: a point."""
    from zwidth.model.arms.wall import MatrixWall
    from zwidth.model.environment.wall import Wall

    given = {
        key: getattr(arguments, key)
        for key in ("stiffness", "rotational_stiffness", "virtual_damping", "rotational_damping")
        if getattr(arguments, key) is not None
    }
    if arguments.wall is not None:
        if given:
            option = next(iter(given)).replace("_", "-")
            raise InputError(f"--wall FILE says what the wall is; leave out --{option}")
        path = Path(arguments.wall)
        if is_of_controllers(path):
            return _of_controllers(path, turns, arguments.rate)
        return read_wall(path, turns)
    if not turns and (found := [key for key in given if key.startswith("rotational")]):
        raise InputError(f"--{found[0].replace('_', '-')}: a point does not turn; add --pose")
    if not {"stiffness", "rotational_stiffness"} & given.keys():
        raise InputError("which wall? Give its stiffness [N/m], for example --stiffness 500")

    def value(key: str, unit: str) -> Exact:
        return parse_number(given.get(key, "0"), unit, key)

    k, b = value("stiffness", "N/m"), value("virtual_damping", "N*s/m")
    if not turns:
        return Wall(stiffness=k, damping=b)
    k_turn = value("rotational_stiffness", "N*m/rad")
    b_turn = value("rotational_damping", "N*m*s/rad")
    return MatrixWall.in_pose(float(k), float(k_turn), float(b), float(b_turn), planar=turns == 1)


def is_of_controllers(path: Path) -> bool:
    return path.suffix.lower() in _CONTROLLERS


def cartesian_of(path: Path) -> CartesianGains:
    """The impedance of a parameter file of ros2_control, with its rate, where the file says one."""
    from zwidth.data.gains import read_controllers

    found, name = read_controllers(path), f"--wall {path.name}"
    if len(found.cartesian) != 1:
        raise InputError(
            f"{name}: it has {len(found.cartesian)} Cartesian impedances, and a wall is one; joint gains are "
            "decided by zwidth gains"
        )
    return replace(found.cartesian[0], rate=found.cartesian[0].rate or found.rate)


def _of_controllers(path: Path, turns: int, rate: str | None) -> MatrixWall:
    """The impedance as a wall; its rate is that of the loop, and is given there."""
    one, name = cartesian_of(path), f"--wall {path.name}"
    if turns not in (0, len(one.stiffness) - 3):
        raise InputError(f"{name}: it has three rotations; a hand in the plane has one")
    if rate is None and one.rate is not None:
        hertz = shown(float(one.rate), "Hz", 6)
        raise InputError(f'{name}: its controller runs at {hertz}; give --rate "{hertz}"')
    return one.wall(turns)


def left_out(arguments: argparse.Namespace, turns: int) -> list[str]:
    """What the wall of a controller's file leaves out of that controller."""
    if arguments.wall is None or not is_of_controllers(Path(arguments.wall)):
        return []
    return list(cartesian_of(Path(arguments.wall)).notes(turns, arguments.null_stiffness is not None))


def read_wall(path: Path, turns: int) -> MatrixWall:
    """A `MatrixWall` from the table [wall] of a TOML file."""
    from zwidth.model.arms.wall import MatrixWall
    from zwidth.model.specification.read import read_tables

    table = read_tables([path], ("wall",))["wall"]
    table.check_keys(_WALL_UNITS, "a wall given by matrices")
    if "stiffness" not in table.values:
        raise InputError(f"{table.label}: stiffness = [[…], …] is missing")
    with located(table.label):
        matrices = {key: _matrix(rows, key, turns) for key, rows in table.values.items()}
        return MatrixWall(matrices["stiffness"], matrices.get("damping"), turns=turns)


def _matrix(rows: object, key: str, turns: int) -> list[list[float]]:
    if not isinstance(rows, list) or not all(isinstance(row, list) and len(row) == len(rows) for row in rows):
        raise InputError(f"{key} is a square matrix, [[…, …], […, …]]")
    point = len(rows) - turns
    return [
        [
            float(parse_number(entry, _WALL_UNITS[key][(i >= point) + (j >= point)], key))
            for j, entry in enumerate(row)
        ]
        for i, row in enumerate(rows)
    ]


def wall_in_words(wall: Wall | MatrixWall) -> str:
    """Stiffness and virtual damping, of one direction or as matrices."""
    from zwidth.model.environment.wall import Wall

    if isinstance(wall, Wall):
        damper = float(wall.damping)  # no interval: an arm refuses them
        more = f", {shown(damper, 'N*s/m', 6)}" if damper else ""
        return f"{shown(float(wall.stiffness), 'N/m', 6)}{more} in every direction"
    import numpy as np

    units = ("N, m, rad", "N, m, s, rad") if wall.turns else ("N/m", "N·s/m")
    matrix = np.asarray(wall.damping)
    more = f"; virtual damping {_matrix_in_words(matrix)} {units[1]}" if matrix.any() else ""
    return f"stiffness {_matrix_in_words(np.asarray(wall.stiffness))} {units[0]}{more}"


def _matrix_in_words(matrix: Any) -> str:
    """A large one that is diagonal by its diagonal."""
    import numpy as np

    diagonal = matrix.diagonal()
    if len(diagonal) > _ROWS and np.count_nonzero(matrix) == np.count_nonzero(diagonal):
        return f"diag({', '.join(f'{x:g}' for x in diagonal)})"
    return rows_in_words(matrix)


def rows_in_words(matrix: Any) -> str:
    return "[" + ", ".join("[" + ", ".join(f"{x:g}" for x in row) + "]" for row in matrix) + "]"
