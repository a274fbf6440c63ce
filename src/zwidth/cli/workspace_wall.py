"""The wall of `zwidth workspace`: as stiff in every direction by options, or given by matrices in a file.

    [wall]
    stiffness = [["500 N/m", 0, 0], [0, "200 N/m", 0], [0, 0, "5 N*m/rad"]]
    damping = [[0.1, 0, 0], [0, 0, 0], [0, 0, 0.002]]

Numbers are in N, m, s and rad.  In pose the last rows and columns are rotations.
"""

from __future__ import annotations

import argparse
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from zwidth.errors import InputError
from zwidth.model.specification.table import located
from zwidth.quantity.units import parse_number

if TYPE_CHECKING:
    from zwidth.data.gains.controllers import CartesianGains
    from zwidth.model.arms.wall import MatrixWall
    from zwidth.model.environment.wall import Wall
    from zwidth.quantity.exact import Exact

WALL_OPTIONS = (
    ("--stiffness", "VALUE", "of the wall, in every direction [N/m]"),
    ("--rotational-stiffness", "VALUE", "of a wall in pose, about every axis [N*m/rad] (default: 0)"),
    ("--virtual-damping", "VALUE", "of the wall, in every direction [N*s/m] (default: 0)"),
    ("--rotational-damping", "VALUE", "of a wall in pose, about every axis [N*m*s/rad] (default: 0)"),
    (
        "--wall",
        "FILE",
        "in the place of these: matrices from a .toml file with [wall], or the impedance of a "
        "ros2_control .yaml",
    ),
)
_CONTROLLERS = (".yaml", ".yml")
_ROWS = 2
"""Of a matrix that is shown whole even where it is diagonal."""
_UNITS = {
    "stiffness": ("N/m", "N/rad", "N*m/rad"),
    "damping": ("N*s/m", "N*s/rad", "N*m*s/rad"),
}
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
    """Whether the file is one of ros2_control."""
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
        hertz = f"{float(one.rate):g} Hz"
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
    table.check_keys(_UNITS, "a wall given by matrices")
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
            float(parse_number(entry, _UNITS[key][(i >= point) + (j >= point)], key))
            for j, entry in enumerate(row)
        ]
        for i, row in enumerate(rows)
    ]


def wall_in_words(wall: Wall | MatrixWall) -> str:
    """Stiffness and virtual damping, of one direction or as matrices."""
    from zwidth.model.environment.wall import Wall

    if isinstance(wall, Wall):
        damper = float(wall.damping)  # type: ignore[arg-type]  # no interval: an arm refuses them
        more = f", {damper:g} N·s/m" if damper else ""
        return f"{float(wall.stiffness):g} N/m{more} in every direction"  # type: ignore[arg-type]
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
    """A matrix on one line."""
    return "[" + ", ".join("[" + ", ".join(f"{x:g}" for x in row) + "]" for row in matrix) + "]"
