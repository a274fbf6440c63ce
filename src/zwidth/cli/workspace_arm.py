"""The arm of `zwidth workspace`: a built-in one by its name, or one that a file describes."""

from __future__ import annotations

import argparse
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from zwidth.cli.workspace_joints import joints_of
from zwidth.errors import InputError
from zwidth.quantity.text import shown
from zwidth.quantity.units import parse_number

if TYPE_CHECKING:
    from zwidth.model.arms import Arm


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
    return ", ".join([arm.name, count, shown(rate, "Hz"), *([f"hand at {frame}"] if frame else [])])


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


def by_name(text: str | None, option: str) -> dict[str, float] | None:
    """Joints with values, as in wrist=0.2,grip=0."""
    if text is None:
        return None
    pairs = [part.partition("=") for part in text.split(",")]
    if not all(name.strip() and equals for name, equals, _ in pairs):
        raise InputError(f"--{option}: joints and values, as in wrist=0.2,grip=0; got {text[:60]!r}")
    return {name.strip(): float(parse_number(value.strip(), "1", option)) for name, _, value in pairs}
