"""The command `workspace`: where an arm renders a wall passively, and what to change where not."""

from __future__ import annotations

import argparse
import json
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from zwidth.cli.options import IN_FULL, output
from zwidth.cli.output import print_found, targets
from zwidth.cli.workspace.arm import (
    JOINTS,
    WALL,
    arm_of,
    by_name,
    cartesian_of,
    is_of_controllers,
    left_out,
    wall_of,
)
from zwidth.cli.workspace.report import print_null_space, print_postures, print_workspace
from zwidth.errors import InputError
from zwidth.quantity.text import to_json
from zwidth.quantity.units import parse_number

if TYPE_CHECKING:
    from zwidth.data.gains import BorneImpedance
    from zwidth.model.arms import Arm
    from zwidth.passivity.workspace import NullSpace, PostureMap, Workspace


_RATE = "1 kHz"
_SAVED = (".json", ".nc")
_GAINS = (".yaml", ".yml")


USAGE = (
    "ARM --stiffness K [--pose --rotational-stiffness K] [--wall FILE] [--joint-damping B] "
    "[--joint-friction F] [--joint-resolution STEP] [--joints FILE] [--largest-force FORCE] "
    "[--rate RATE] [--virtual-damping B] [--delay TIME] [--points N] [--postures N] [--null-stiffness K] "
    "[--null-rest JOINTS] [--within DISTANCE] [--all] [--json] "
    "[--plot FILE] [-o FILE] [--force]"
)
_OF_NULL_SPACE = {
    "--null-damping VALUE": "of the joints in the null space [N*m*s/rad] (default: 0)",
    "--null-rest JOINTS": "where the null-space spring rests, as --hold (default: middle of the ranges)",
    "--regularization VALUE": "λ of the controller's pseudo-inverse, 0.2 in Franka's (default: 0)",
    "--within VALUE": "how far from that rest is asked about [rad] (default: the joints' ranges)",
}
OPTIONS = (
    {
        "arm=ARM": "hapkit, two-link, haply-2diy, falcon, or a .urdf, .xml or .mjcf file",
        **JOINTS,
        "--frame NAME": "frame of the description at which the hand is (default: the last)",
        "--hold JOINTS": "joints of the description that stay, as in wrist=0.2,grip=0 [rad; m]",
        "--rest JOINTS": "where the rotation of a wall in pose rests, as --hold, or middle (default: "
        "anywhere)",
        **WALL,
        "--rate VALUE": f"samples per second [Hz] (default: {_RATE})",
        "--delay VALUE": "from reading to force, whole samples [s] (default: 0)",
        "--torque-held-up-to FORCE": "the torque is computed once a sample, for forces up to this [N]; in "
        "pose with a moment: 5,0.2",
        "--largest-force FORCE": "of the wall, up to which encoder steps are to be counted [N]; in pose with "
        "a moment: 5,0.2 (default: as far as the joints' Coulomb friction covers them)",
        "--points N": "cells along each side of the map (default: 100)",
        "--postures N": "of a description: so many postures over the ranges of all joints in the place of a "
        "map of two, such as 20000",
        "--null-stiffness VALUE": "asks about the spring of the joints in the null space of a redundant arm, "
        "too [N*m/rad]; wall: with its damping as in the .yaml of --wall",
        **{f"({words})": meaning for words, meaning in _OF_NULL_SPACE.items()},
        "--pose": "the hand turns with the end, and the wall resists that too",
        "--share S": "with -o FILE.yaml: of the joints' damping, that the impedance may use (default: 0.8)",
    },
    "output",
    {
        **output(
            "the verdict",
            "the map",
            "the verdict with its certificate, for zwidth verify (.json), or the map as NetCDF (.nc); with "
            "--postures and --wall FILE.yaml an impedance that they bear (.yaml)",
        ),
        **IN_FULL,
    },
)


def run(arguments: argparse.Namespace) -> int:
    """`zwidth workspace`: 0 passive, 1 active, 3 undecided, 4 by a proof on paper alone."""
    plot, save = targets(arguments.plot, arguments.save, arguments.force)
    _check_gains(arguments, save)
    if save is not None and save.suffix.lower() not in (*_SAVED, *_GAINS):
        raise InputError(
            f"--save: a file must end in .json for the verdict with its certificate, or in .nc for the map; "
            f"got {save.name!r}"
        )
    if arguments.null_stiffness is not None:
        return _null_space(arguments, plot, save)
    refuse_without(arguments)
    if arguments.postures is not None:
        return _postures(arguments, plot, save)
    space = _verdict(arguments)
    without = left_out(arguments, space.arm.turns)
    if save is not None:
        _save(space, save)
    report = partial(print_workspace, space, arguments.in_full, without)
    written = partial(json.dumps, indent=2, ensure_ascii=False)
    return _give_out(space, arguments, without, report, save, plot, written)


def _give_out(
    found: Workspace | PostureMap | NullSpace,
    arguments: argparse.Namespace,
    without: Sequence[str],
    report: Callable[[], None],
    save: Path | None,
    plot: Path | None,
    written: Callable[[dict[str, Any]], str] = to_json,
) -> int:
    """The picture, and what is told; the status says the outcome."""
    from zwidth.passivity.scope import TOLD

    if plot is not None:
        found.plot(plot)
    more = {"wall_leaves_out": without} if without else {}
    print_found(arguments.json, lambda: written({**found.to_dict(), **more}), report, save, plot)
    return TOLD[found.outcome].status


def _verdict(arguments: argparse.Namespace) -> Workspace:
    from zwidth.passivity.workspace import workspace

    arm = arm_of(arguments)
    return workspace(
        arm,
        wall_of(arguments, arm.turns),
        **_timing(arguments),
        points=_whole(arguments.points or "100", "points"),
        torque_held_up_to=_largest(arguments.torque_held_up_to, "torque-held-up-to"),
        largest_force=_largest(arguments.largest_force, "largest-force"),
    )


def _timing(arguments: argparse.Namespace) -> dict[str, Any]:
    return {
        "rate": float(parse_number(arguments.rate or _RATE, "Hz", "rate")),
        "delay": float(parse_number(arguments.delay or "0", "s", "delay")),
    }


def _postures(arguments: argparse.Namespace, plot: Path | None, save: Path | None) -> int:
    """All joints over their ranges: no region is proved, and the report says so."""
    from zwidth.passivity.workspace import stiffness_over_postures

    for option in ("torque_held_up_to", "largest_force", "points"):
        if getattr(arguments, option) is not None:
            name = option.replace("_", "-")
            raise InputError(f"--{name} is of a map of two joints; leave it out with --postures")
    arm = arm_of(arguments)
    found = stiffness_over_postures(
        arm,
        wall_of(arguments, arm.turns),
        **_timing(arguments),
        postures=_whole(arguments.postures, "postures"),
    )
    better = None
    if save is not None and save.suffix.lower() in _GAINS:
        better = _borne(arguments, arm)
        better.save(save)
    elif save is not None:
        _save(found, save)
    without = left_out(arguments, arm.turns)
    report = partial(print_postures, found, arguments.in_full, without, better)
    return _give_out(found, arguments, without, report, save, plot)


def _check_gains(arguments: argparse.Namespace, save: Path | None) -> None:
    """An impedance is written of postures and of a file alone, and never over that file."""
    wanted = save is not None and save.suffix.lower() in _GAINS
    if not wanted:
        if arguments.share is not None:
            raise InputError("--share is of an impedance that is written: add -o passive.yaml")
        return
    wall = None if arguments.wall is None else Path(arguments.wall)
    if arguments.postures is None or wall is None or not is_of_controllers(wall):
        raise InputError(
            "-o: a .yaml is an impedance that all postures bear: it needs --postures, and --wall with the "
            ".yaml of a controller whose names it takes; the verdict is saved as .json, the map as .nc"
        )
    assert save is not None
    if save.exists() and save.samefile(wall):
        raise InputError(f"{save} is the file that is read, and has more than gains; choose another name")


def _borne(arguments: argparse.Namespace, arm: Arm) -> BorneImpedance:
    from zwidth.data.gains import borne_impedance

    return borne_impedance(
        cartesian_of(Path(arguments.wall)),
        arm,
        **_timing(arguments),
        postures=_whole(arguments.postures, "postures"),
        **({} if arguments.share is None else {"share": arguments.share}),
    )


def _null_space(arguments: argparse.Namespace, plot: Path | None, save: Path | None) -> int:
    """Wall and null-space spring together; there is no map of it to save."""
    if save is not None and save.suffix.lower() != ".json":
        raise InputError(f"of a null-space spring there is no map: save as .json, got {save.name!r}")
    found = null_space_of(arguments)
    without = left_out(arguments, found.question.arm.turns)
    if save is not None:
        found.save(save)
    report = partial(print_null_space, found, arguments.in_full, without)
    return _give_out(found, arguments, without, report, save, plot)


def _save(space: Workspace | PostureMap, path: Path) -> None:
    if path.suffix.lower() == ".json":
        space.save(path)
    else:
        from zwidth.loop.traces.files import save_netcdf  # xarray takes its time

        save_netcdf(space.data, path)


def _largest(text: str | None, option: str) -> list[float] | None:
    if text is None:
        return None
    parts, units = text.split(","), ("N", "N*m")
    if len(parts) > len(units):
        raise InputError(f"--{option}: a force, and in pose a moment, got {text[:60]!r}")
    return [
        float(parse_number(part.strip(), unit, option.replace("-", "_")))
        for part, unit in zip(parts, units, strict=False)
    ]


def _whole(text: str, what: str) -> int:
    number = parse_number(text, "1", what).fraction
    if number.denominator != 1:
        raise InputError(f"{what} must be a whole number, got {text}")
    return int(number)


_FROM_WALL = "wall"
_OF_OTHERS = ("rest", "torque_held_up_to", "largest_force", "points", "postures")


def refuse_without(arguments: argparse.Namespace) -> None:
    """What is of a null-space spring, where none is given."""
    for option in (words.partition(" ")[0] for words in _OF_NULL_SPACE):
        if getattr(arguments, option[2:].replace("-", "_")) is not None:
            raise InputError(f"{option} is of a null-space spring; give its --null-stiffness")


def null_space_of(arguments: argparse.Namespace) -> NullSpace:
    from zwidth.passivity.workspace import null_space

    for key in _OF_OTHERS:
        if getattr(arguments, key) is not None:
            raise InputError(f"--{key.replace('_', '-')} is not asked with --null-stiffness; leave it out")
    arm = arm_of(arguments)
    stiffness, damping = _gains(arguments)
    return null_space(
        arm,
        wall_of(arguments, arm.turns),
        stiffness=stiffness,
        damping=damping,
        rest=by_name(arguments.null_rest, "null-rest"),
        regularization=float(parse_number(arguments.regularization or "0", "1", "regularization")),
        **_timing(arguments),
        within=arguments.within,
    )


def _gains(arguments: argparse.Namespace) -> tuple[Any, Any]:
    if arguments.null_stiffness != _FROM_WALL:
        return arguments.null_stiffness, arguments.null_damping or "0"
    if arguments.wall is None or not is_of_controllers(Path(arguments.wall)):
        raise InputError("--null-stiffness wall takes the gains of a .yaml file that --wall names")
    if arguments.null_damping is not None:
        raise InputError("--null-stiffness wall takes the damping of the file, too; leave out --null-damping")
    one = cartesian_of(Path(arguments.wall))
    if not one.nullspace:
        raise InputError(f"--wall {Path(arguments.wall).name}: it has no null-space stiffness")
    return one.nullspace, one.nullspace_damping
