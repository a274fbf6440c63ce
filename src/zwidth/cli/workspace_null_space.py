"""`zwidth workspace --null-stiffness`: the null-space spring of a redundant arm, and what it prints."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from zwidth.cli.workspace_arm import arm_in_words, arm_of, by_name
from zwidth.cli.workspace_joints import damping_in_words
from zwidth.cli.workspace_wall import cartesian_of, is_of_controllers, wall_in_words, wall_of
from zwidth.errors import InputError
from zwidth.quantity.text import shown
from zwidth.quantity.units import parse_number

if TYPE_CHECKING:
    from zwidth.passivity.workspace import NullSpace

NULL_OPTIONS = (
    (
        "--null-stiffness",
        "VALUE",
        "asks about the spring of the joints in the null space of a redundant arm, too [N*m/rad]; wall: with "
        "its damping as in the .yaml of --wall",
    ),
    ("--null-damping", "VALUE", "of the joints in the null space [N*m*s/rad] (default: 0)"),
    ("--null-rest", "JOINTS", "where the null-space spring rests, as --hold (default: middle of the ranges)"),
    ("--regularization", "VALUE", "λ of the controller's pseudo-inverse, 0.2 in Franka's (default: 0)"),
    ("--within", "VALUE", "how far from that rest is asked about [rad] (default: the joints' ranges)"),
)
_FROM_WALL = "wall"
_OF_OTHERS = ("rest", "torque_held_up_to", "largest_force", "points", "postures")


def refuse_without(arguments: argparse.Namespace) -> None:
    """What is of a null-space spring, where none is given."""
    for option, _, _ in NULL_OPTIONS[1:]:
        if getattr(arguments, option[2:].replace("-", "_")) is not None:
            raise InputError(f"{option} is of a null-space spring; give its --null-stiffness")


def null_space_of(arguments: argparse.Namespace, rate: float) -> NullSpace:
    """The answer that is asked for."""
    from zwidth.passivity.workspace import null_space

    for key in _OF_OTHERS:
        if getattr(arguments, key) is not None:
            raise InputError(f"--{key.replace('_', '-')} is not asked with --null-stiffness; leave it out")
    arm = arm_of(arguments)
    stiffness, damping = _gains(arguments)
    return null_space(
        arm,
        wall_of(arguments, arm.turns),
        rate=rate,
        stiffness=stiffness,
        damping=damping,
        rest=by_name(arguments.null_rest, "null-rest"),
        regularization=float(parse_number(arguments.regularization or "0", "1", "regularization")),
        delay=float(parse_number(arguments.delay or "0", "s", "delay")),
        within=arguments.within,
    )


def _gains(arguments: argparse.Namespace) -> tuple[Any, Any]:
    """k and d_n, as given or as in the file of the wall."""
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


def print_null_space(found: NullSpace, in_full: bool, without: Sequence[str]) -> None:
    """Print the verdict, the numbers and what is assumed on standard output."""
    from zwidth.cli.page import blocks, headline, items, more_with_all, page, section, small_print
    from zwidth.passivity.scope import TOLD
    from zwidth.passivity.wording import in_short

    asked, spring = found.question, found.spring
    rest = ", ".join(f"{value:.3g}" for value in spring.rest)
    about = [
        ("arm", arm_in_words(asked.arm, asked.rate)),
        ("joint damping", damping_in_words(asked.arm)),
        ("wall", wall_in_words(asked.wall)),
        (
            "null space",
            f"{shown(spring.stiffness, 'N*m/rad')}, {shown(spring.damping, 'N*m*s/rad')}, at rest at {rest}; "
            f"λ = {spring.regularization:g}; its torque is computed once a sample and held",
        ),
        *(("left out", text) for text in without),
    ]
    with page() as out:
        out.print(headline(found.outcome, TOLD[found.outcome].terminal, found.claim))
        if in_full:
            blocks(out, list(found.rows()), about)
            section(out, "assumes", items(found.assumptions, "dim"))
            return
        assumed = ("assumes", small_print(in_short(found.scope, found.outcome)))
        blocks(out, list(found.rows()), [*about, assumed])
        more_with_all(out, "assumptions in full")
