"""The command `workspace`: where an arm renders a wall passively, and what to change where not."""

from __future__ import annotations

import argparse
import json
from collections.abc import Iterable, Iterator
from math import isfinite
from pathlib import Path
from typing import TYPE_CHECKING, Any

from zwidth.cli.options import Once
from zwidth.cli.output import print_json, targets, writing
from zwidth.errors import InputError
from zwidth.quantity.units import parse_number
from zwidth.writing import writing_whole

if TYPE_CHECKING:
    from rich.table import Table

    from zwidth.passivity.arms import Workspace

STATUS = {"passive": 0, "theorem": 0, "active": 1, "undecided": 3}
_RATE = "1 kHz"
_SAVED = (".json", ".nc")

_JOINT_OPTIONS = (
    ("--joint-damping", "damping", "N*m*s/rad", "viscous friction of the joints"),
    ("--joint-friction", "coulomb_friction", "N*m", "Coulomb friction of the joints"),
    ("--joint-resolution", "resolution", "rad", "encoder step of the joints"),
    ("--torque-limit", "torque_limit", "N*m", "largest torque of the motors"),
)


def configure_workspace(parser: argparse.ArgumentParser) -> None:
    """The arguments of `zwidth workspace`."""
    parser.usage = (
        "%(prog)s ARM --stiffness K [--joint-damping B] [--rate RATE] [--virtual-damping B] [--delay TIME] "
        "[--points N] [--json] [--plot FILE] [-o FILE] [--force]"
    )
    parser.add_argument(
        "arm", metavar="ARM", help="hapkit, two-link, haply-2diy, falcon, or a .urdf, .xml or .mjcf file"
    )
    for option, _, unit, meaning in _JOINT_OPTIONS:
        words = f"{meaning}, one value for all or one for each: 0.001,0.002 [{unit}]"
        parser.add_argument(option, metavar="VALUES", action=Once, help=words)
    for option, metavar, meaning in (
        ("--frame", "NAME", "frame of the description at which the hand is (default: the last)"),
        ("--hold", "JOINTS", "joints of the description that stay, as in wrist=0.2,grip=0 [rad; m]"),
        ("--stiffness", "VALUE", "of the wall, in every direction [N/m]"),
        ("--virtual-damping", "VALUE", "of the wall, in every direction [N*s/m] (default: 0)"),
        ("--rate", "VALUE", f"samples per second [Hz] (default: {_RATE})"),
        ("--delay", "VALUE", "from reading to force, whole samples [s] (default: 0)"),
        (
            "--torque-held-up-to",
            "FORCE",
            "the torque is computed once a sample, for wall forces up to this [N]",
        ),
        ("--points", "N", "cells along each side of the map (default: 100)"),
    ):
        parser.add_argument(option, metavar=metavar, action=Once, help=meaning)
    output = parser.add_argument_group("output")
    output.add_argument("--json", action="store_true", help="print the verdict as JSON, units in the keys")
    output.add_argument("--plot", metavar="FILE", action=Once, help="save the map: .png, .svg or .pdf")
    output.add_argument(
        "-o",
        "--save",
        metavar="FILE",
        action=Once,
        help="save the verdict with its certificate, for zwidth verify (.json), or the map as NetCDF (.nc)",
    )
    output.add_argument("--force", action="store_true", help="replace files that exist")


def run_workspace(arguments: argparse.Namespace) -> int:
    """`zwidth workspace`: 0 passive, 1 active, 3 undecided, as `check`."""
    plot, save = targets(arguments.plot, arguments.save, arguments.force)
    if save is not None and save.suffix.lower() not in _SAVED:
        raise InputError(
            f"--save: a file must end in .json for the verdict with its certificate, or in .nc for the map; "
            f"got {save.name!r}"
        )
    from zwidth.environment.wall import Wall
    from zwidth.passivity.arms import workspace

    if arguments.stiffness is None:
        raise InputError("which wall? Give its stiffness [N/m], for example --stiffness 500")
    held = arguments.torque_held_up_to
    space = workspace(
        _arm(arguments),
        Wall(
            stiffness=parse_number(arguments.stiffness, "N/m", "stiffness"),
            damping=parse_number(arguments.virtual_damping or "0", "N*s/m", "virtual_damping"),
        ),
        rate=float(parse_number(arguments.rate or _RATE, "Hz", "rate")),
        delay=float(parse_number(arguments.delay or "0", "s", "delay")),
        points=_whole(arguments.points or "100"),
        torque_held_up_to=None if held is None else float(parse_number(held, "N", "torque_held_up_to")),
    )
    if save is not None:
        with writing(save):
            if save.suffix.lower() == ".json":
                space.save(save)
            else:
                with writing_whole(save) as unfinished:
                    space.data.to_netcdf(unfinished, engine="h5netcdf")
    if plot is not None:
        from zwidth.plots.workspace import save_workspace  # matplotlib takes its time

        save_workspace(space, plot, overwrite=True)
    if arguments.json:
        print_json(json.dumps(space.to_dict(), indent=2, ensure_ascii=False))
    else:
        print_workspace(space)
    return STATUS[space.outcome]


def _arm(arguments: argparse.Namespace) -> Any:
    from zwidth.device.arm import BUILT_IN, built_in, read_arm

    given = {
        key: _values(text, unit, option[2:])
        for option, key, unit, _ in _JOINT_OPTIONS
        if (text := getattr(arguments, option[2:].replace("-", "_"))) is not None
    }
    single = {key: v[0] if len(v) == 1 else v for key, v in given.items()}
    if arguments.arm in BUILT_IN:
        if arguments.frame is not None or arguments.hold is not None:
            raise InputError("--frame and --hold are for descriptions; the built-in arms have neither")
        if "damping" not in given:
            raise InputError(
                f"no source gives the joint damping of {arguments.arm}, and no verdict exists without it; "
                "measure and give it [N*m*s/rad], for example --joint-damping 0.003"
            )
        return built_in(arguments.arm, **single)
    path = Path(arguments.arm)
    if not path.suffix:
        raise InputError(
            f"there is no arm {arguments.arm[:40]!r}; built in are {', '.join(BUILT_IN)}; "
            "or name a .urdf file"
        )
    return read_arm(path, frame=arguments.frame, hold=_held(arguments.hold), **given)


def _values(text: str, unit: str, what: str) -> list[float]:
    return [float(parse_number(part.strip(), unit, what)) for part in text.split(",")]


def _held(text: str | None) -> dict[str, float] | None:
    if text is None:
        return None
    pairs = [part.partition("=") for part in text.split(",")]
    if not all(name.strip() and equals for name, equals, _ in pairs):
        raise InputError(f"--hold: joints and values, as in wrist=0.2,grip=0; got {text[:60]!r}")
    return {name.strip(): float(parse_number(value.strip(), "1", "hold")) for name, _, value in pairs}


def _whole(text: str) -> int:
    number = parse_number(text, "1", "points").fraction
    if number.denominator != 1:
        raise InputError(f"points must be a whole number, got {text}")
    return int(number)


def print_workspace(space: Workspace) -> None:
    """Print the verdict and what to change on standard output."""
    from rich.padding import Padding
    from rich.table import Table
    from rich.text import Text

    from zwidth.cli.report import COLOURS, page, section

    with page() as out:
        head = Table.grid(padding=(0, 1))
        badge = Text(f" {space.outcome.upper()} ", style=f"bold white on {COLOURS[space.outcome]}")
        head.add_row(badge, Text(space.claim, style="bold"))
        out.print(Padding(head, (0, 0, 1, 0)))
        out.print(Padding(_grid(_numbers(space)), (0, 0, 1, 0)))
        changes = list(_changes(space))
        section(out, "what to change", [_grid(changes)] if changes else [])


def _grid(rows: Iterable[tuple[str, str]]) -> Table:
    from rich.table import Table
    from rich.text import Text

    grid = Table.grid(padding=(0, 2))
    for name, text in rows:
        grid.add_row(Text(name, style="dim"), Text(text))
    return grid


def _numbers(space: Workspace) -> Iterator[tuple[str, str]]:
    from zwidth.cli.numerals import shown

    data, motion = space.data, space.motion
    low, high = (shown(float(v), "N*s/m") for v in (data["margin"].min(), data["margin"].max()))
    best = shown(float(data["largest_stiffness"].max()), "N/m")
    count = f"{space.arm.joint_count} joint{'s' if space.arm.joint_count > 1 else ''}"
    yield "arm", f"{space.arm.name}, {count}, {shown(1 / space.sample_period, 'Hz')}"
    yield "margin", f"{low} to {high} at the hand"
    yield "largest stiffness", f"{shown(space.largest_stiffness, 'N/m')} everywhere, {best} at the best point"
    if motion is not None:
        middle = ", ".join(f"{q:.4g}" for q in motion.joints.mean(axis=0))
        gain = shown(-motion.energy, "J")
        yield "motion", f"{len(motion.joints)} samples round the joints at {middle} take {gain} out"
    if "resolution" in data:
        yield "encoder step", f"up to {shown(float(data['resolution'].max()), 'm')} at the hand"
    if "friction_margin" in data:
        least = float(data["friction_margin"].min())
        words = "covers" if least >= 0 else "does not cover"
        yield "Coulomb friction", f"{words} the encoder steps, {shown(least, 'N*m')} in the worst joint"


def _changes(space: Workspace) -> Iterator[tuple[str, str]]:
    from zwidth.cli.numerals import shown

    if space.addition_to_all == 0:
        return
    if space.largest_stiffness > 0:
        yield "wall", f"no stiffer than {shown(space.largest_stiffness, 'N/m')}"
    yield "all joints", f"{shown(space.addition_to_all, 'N*m*s/rad')} more damping in each"
    for joint, addition in enumerate(space.additions, start=1):
        if isfinite(addition):
            yield f"joint {joint} alone", f"{shown(addition, 'N*m*s/rad')} more damping"
