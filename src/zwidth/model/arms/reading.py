"""Arms by name and from robot descriptions, URDF and MJCF.

Viscous and Coulomb friction and the limits of motion and effort are those of the
description where they are not given.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from math import cos, pi, radians, sin
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np

from zwidth.errors import InputError
from zwidth.missing import did_you_mean
from zwidth.model.arms.arm import Arm, Damping, joint_damping, joint_numbers
from zwidth.model.arms.chain import PlanarChain
from zwidth.model.arms.described import MOST_MAPPED, DescribedArm, PosedArm
from zwidth.model.arms.formats import read_mjcf, read_urdf
from zwidth.model.arms.joints import as_matrix
from zwidth.model.arms.legs import Leg, LeggedArm
from zwidth.model.arms.mechanism import Coordinate, Mechanism, parsed
from zwidth.model.device.transmission import Transmission
from zwidth.quantity.text import from_to, shown
from zwidth.quantity.units import in_si

_ENDINGS = (".urdf", ".xml", ".mjcf")
_FAR = 1e3
"""Limits beyond are none [rad; m]."""


def read_arm(
    path: str | Path,
    *,
    frame: str | None = None,
    hold: Mapping[str, float | str] | None = None,
    damping: Damping | None = None,
    coulomb_friction: Sequence[float | str] | None = None,
    resolution: Sequence[float | str] = (),
    torque_limit: Sequence[float | str] | None = None,
    pose: bool = False,
    rest: Mapping[str, float | str] | None = None,
    whole: bool = False,
    transmission: Transmission | Sequence[Transmission] | None = None,
) -> DescribedArm:
    """Read an arm from a URDF or MJCF file.

    Parameters
    ----------
    path
        The file, .urdf, .xml or .mjcf. Meshes are not read.
    frame
        The frame at whose origin the hand is; None: the last one of an arm that does not branch.
    hold
        Joints that stay at a value [rad; m], by name; one without damping is locked there. A map moves the
        first two of the others, and holds the rest in the middle of their ranges.
    damping, coulomb_friction, torque_limit
        Of each joint, or of each that moves the hand [N·m·s/rad], [N·m], [N·m], or one number in a list for
        all; None: those of the description. Damping may be a matrix, as of `Arm`, in the order of the
        description's joints. Joints without damping that do not move the hand are left out.
    resolution
        Encoder step of each joint [rad; m]; descriptions have none.
    pose
        The hand holds the frame and turns with it: six coordinates, `PosedArm`. Default: it holds a point.
    rest
        In pose, by name: joints at which the wall's rotation is at rest [rad; m]; those that are not named,
        in the middle of their ranges. None: in every orientation, for walls as stiff about every axis.
    whole
        Every joint that is not held goes over its whole range, for `zwidth.stiffness_over_postures`.
    transmission
        Of joints that give way, as of `Arm`: damping of the description is then taken as the motors' side's.

    Raises
    ------
    InputError
        If the file cannot be read, a name is not in it, or it gives a joint that moves the hand no damping.
    """
    path = Path(path)
    model = read_mechanism(path)
    every, names, slides = model.coordinates, model.names, tuple(one.slides for one in model.coordinates)
    m, held = len(every), _values(every, hold or {}, "hold")
    own = [one.damping for one in every]
    if damping is None and not any(own):
        raise InputError(
            f"{path.name} gives no joint any damping, and without damping no wall is passive; "
            f"measure it and give damping, on the command line --joint-damping, or write {model.advice}"
        )
    frame = _last_frame(model, path.name) if frame is None else frame
    way = sorted(set(model.moves(model.frame(frame, path.name))))
    if not way:
        raise InputError(f"{path.name}: no joint moves {frame!r}: take a frame farther out")
    b = joint_damping(own if damping is None else _for_each(damping, way, m), names, slides)
    bare = [i for i, of_joint in enumerate(as_matrix(b).diagonal()) if of_joint == 0]
    lacking = [i for i in bare if i in way and i not in held]
    if lacking and damping is None:
        raise InputError(f"{path.name} gives {_to_damp(model, way, lacking, held)}")
    locked = {i: held.get(i, 0.0) for i in bare if i not in lacking}
    left = [i for i in range(m) if i not in locked]
    words = [f"{names[i]} locked at {shown(at, every[i].unit)}" for i, at in locked.items() if i in held]
    source = [_source(model.locked(locked, ()))] if damping is None else []
    efforts = [one.effort for one in every if 0 < one.effort < np.inf]

    def each(given: Any, key: str, own: Sequence[float] = ()) -> tuple[float, ...]:
        numbers = joint_numbers(_for_each(own if given is None else given, way, m), key, names, slides)
        return tuple(numbers[i] for i in left) if numbers else ()

    given: dict[str, Any] = {
        "model": model.locked(locked, words),
        "frame": frame,
        "joint_range": _ranges([every[i] for i in left], [held.get(i) for i in left], whole),
        "damping": np.array(b)[np.ix_(left, left) if np.ndim(b) > 1 else left],
        "coulomb_friction": each(coulomb_friction, "coulomb_friction", [one.friction for one in every]),
        "resolution": each(resolution, "resolution"),
        "torque_limit": each(torque_limit, "torque_limit", efforts if len(efforts) == m else ()),
        "name": model.name,
        "transmission": (
            [transmission[i] for i in left]
            if isinstance(transmission, Sequence) and len(transmission) == m
            else transmission
        ),
        "damping_source": "; ".join([*source, *model.springs]),
    }
    if pose:
        given["rest"] = None if rest is None else _rest(given["joint_range"], every, left, rest)
        return PosedArm(**given)
    if rest is not None:
        raise InputError("rest is where the rotation of a wall in pose rests; a point does not turn")
    return DescribedArm(**given)


def _to_damp(model: Mechanism, way: Sequence[int], lacking: Sequence[int], held: Mapping[int, float]) -> str:
    """Which joints have no damping, and what to do about it."""
    names, several = model.names, len(lacking) > 1
    joints, it, are = " and ".join(names[i] for i in lacking), ("it", "them")[several], ("is", "are")[several]
    stay = {**held, **{i: _middle(model.coordinates[i]) for i in lacking}}
    hold = ",".join(f"{names[i]}={at:.4g}" for i, at in stay.items())
    before = way.index(lacking[0]) if lacking[0] in way else 0
    frames = [one.name for one in model.frames if one.is_body and model.moves(one) == way[:before]]
    leave = (
        f"leave {it} out, with the hand before: --frame {frames[-1]} (frame=…); or "
        if before and frames
        else ""
    )
    return (
        f"{joints} no damping, and no wall is passive at a hand that a joint without damping moves. "
        f"Hold {it}, and {('it', 'they')[several]} {are} taken as locked: --hold {hold} (in Python hold=…); "
        f"{leave}measure the damping and write {model.advice}, or give --joint-damping, in Python damping, "
        "one number for all joints or one for each"
    )


def _last_frame(model: Mechanism, name: str) -> str:
    """Of the only joint that bears no other; between several ends the last body before them is advised."""
    ends = sorted(set(range(len(model.joints))) - {joint.before for joint in model.joints})
    last = [[frame for frame in model.frames if frame.joint == end][-1] for end in ends]
    if len(last) == 1:
        return last[0].name
    ways = [[*map(id, model.path(frame))] for frame in last]  # two fingers may be alike
    shared = [one for one, *others in zip(*ways, strict=False) if {*others} == {one}]
    frames = [each.name for each in model.frames if each.is_body and [*map(id, model.path(each))] == shared]
    before = f", such as --frame {frames[-1]}, before the branches" if shared and frames else ""
    raise InputError(
        f"{name} branches, and ends at {', '.join(each.name for each in last)}: at which frame is the hand? "
        f"Say it with frame=…, on the command line --frame NAME{before}"
    )


def read_mechanism(path: Path) -> Mechanism:
    """What a .urdf, .xml or .mjcf file describes."""
    if path.suffix.lower() not in _ENDINGS:
        raise InputError(f"an arm is described in a .urdf, .xml or .mjcf file, got {path.name!r}")
    if not path.is_file():
        raise InputError(f"there is no file {path}{did_you_mean(path)}")
    try:
        root = parsed(path)
        read = {"robot": read_urdf, "mujoco": read_mjcf}.get(root.tag)
        if read is None:
            raise root.wrong("is neither <robot>, of a URDF, nor <mujoco>, of an MJCF")
        found = read(root, path.stem)
    except InputError as error:
        raise InputError(f"{path.name} cannot be read: {error}") from None
    if not found.coordinates:
        raise InputError(f"{path.name} has no joint that moves")
    return found


def _for_each(values: Any, way: Sequence[int], count: int) -> Any:
    """Of so many joints, from one number for each that moves the hand, or for all of those."""
    if np.ndim(values) != 1 or len(values) not in (1, len(way)):
        return values
    return [values[way.index(i) % len(values)] if i in way else 0.0 for i in range(count)]


def _source(model: Mechanism) -> str:
    """Of damping that is the description's: that it may be none of the arm's."""
    values = {each.damping for each in model.coordinates}
    words = "from the description, which does not say whether of motors or links; "
    if len(model.coordinates) > 1 and all(float(f"{b:.0e}") == b for b in values):
        told = "round numbers" if len(values) > 1 else "one number for every joint"
        words += f"{told}, most likely a simulator's placeholders: measure"
    else:
        words += "simulators' files often hold placeholders: measure"
    return "; ".join([words, *model.notes])


def _ranges(
    each: Sequence[Coordinate], held: Sequence[float | None], whole: bool
) -> tuple[tuple[float, float], ...]:
    """Of the joints that are held one value; of a map all but two of the others in the middle."""
    ranges, moving = list[tuple[float, float]](), 0
    for joint, at in zip(each, held, strict=True):
        low, high = _limits(joint) if at is None else (at, at)
        if not whole and moving == MOST_MAPPED:
            low = high = (low + high) / 2
        moving += low < high
        ranges.append((low, high))
    if not moving:
        raise InputError("no joint that is left moves the hand, and there is nothing to map: hold one less")
    return tuple(ranges)


def _rest(
    ranges: tuple[tuple[float, float], ...],
    every: Sequence[Coordinate],
    left: Sequence[int],
    rest: Mapping[str, float | str],
) -> tuple[float, ...]:
    given = _values(every, rest, "rest")
    return tuple(given.get(i, (low + high) / 2) for i, (low, high) in zip(left, ranges, strict=True))


def _values(each: Sequence[Coordinate], given: Mapping[str, float | str], what: str) -> dict[int, float]:
    """By the place of the joint, in SI; where it is held it can be."""
    names = [joint.name for joint in each]
    if unknown := sorted(set(given) - set(names)):
        raise InputError(f"{what}: there is no joint {unknown[0]!r}; there are {', '.join(names)}")
    found = {
        names.index(name): in_si(value, each[names.index(name)].unit, f"{what} of {name}")
        for name, value in given.items()
    }
    for i, value in found.items() if what == "hold" else ():
        low, high = each[i].limits
        if not (np.isfinite(value) and low <= value <= high):
            bounds = from_to(low, high, each[i].unit) if np.isfinite(each[i].limits).any() else "finite"
            raise InputError(f"hold: {each[i].name} can be {bounds}, got {shown(value, each[i].unit, 6)}")
    return found


def _middle(joint: Coordinate) -> float:
    low, high = joint.limits
    return (low + high) / 2 if np.isfinite(joint.limits).all() else 0.0


def _limits(joint: Coordinate) -> tuple[float, float]:
    """A joint that turns without limits goes round once."""
    if max(map(abs, joint.limits)) < _FAR:
        return joint.limits
    if joint.slides:
        raise InputError(
            f"joint {joint.name!r}, line {joint.line}, slides without limits; "
            + ("give some within 1000 m" if np.isfinite(joint.limits).all() else 'write range="…" in <joint>')
            + ", or hold it"
        )
    return (-float(np.pi), float(np.pi))


# Arms whose geometry is published; their joint friction is not, and must be given.
#
#     hapkit       one link: the handle 65.659 mm from the axis (Stanford Hapkit code)
#     two-link     two links of 0.1 m: an example, not a product
#     haply-2diy   five-bar pantograph, links 70 and 90 mm (Haply hAPI sketches); motors 38 mm
#                  apart, as the sketches of generation 3 have it; older ones have them on one axis
#     falcon       three legs at 105°, −15° and −135° (libnifalcon, geometry header): link 60 mm,
#                  rod 102.5 mm, hinges 11.25 mm each, r = 40, s = −23.09, c = 14.43, f = −25 mm
#
# Encoder steps: 2π/4880 of the Haply's joints (hAPI sketches); of the Falcon 1280 counts
# per turn of a motor that drives a disc of 110 mm by a shaft of 14.25 mm (libnifalcon).
# The regions of work are choices of this project, inside the reach of each.


def built_in(name: str, *, damping: float | str | Damping, **numbers: Any) -> Arm:
    """An arm with published geometry.

    Parameters
    ----------
    name
        "hapkit", "two-link", "haply-2diy" or "falcon".
    damping
        Viscous friction of each joint, one number for all, or a matrix as of `Arm` [N·m·s/rad]; no source
        gives it.
    numbers
        Other arguments of the arm: coulomb_friction [N·m], resolution [rad], torque_limit [N·m], or what
        belongs to its geometry, such as `lower` and `upper` [m], `joint_range` [rad] or `pose`, of a chain.
        One number stands for all joints.

    Raises
    ------
    InputError
        If the name is not known, or a number cannot be used.
    """
    if name not in BUILT_IN:
        raise InputError(f"there is no arm {str(name)[:40]!r}; built in are {', '.join(BUILT_IN)}")
    kind, given = BUILT_IN[name]()
    if "pose" in numbers and kind is not PlanarChain:
        raise InputError(
            f"{name} has no pose: the hand holds a point and its joints do not turn the handle; "
            "in pose there are hapkit, two-link and robot descriptions"
        )
    joints = len(given.get("links", given.get("legs", ())))
    merged = {"name": name, **given, "damping": damping, **numbers}
    for key in ("damping", "coulomb_friction", "resolution", "torque_limit"):
        value = merged.get(key, ())
        merged[key] = (value,) * joints if isinstance(value, (int, float, str)) else value
    return kind(**merged)


def _haply() -> tuple[type[Arm], dict[str, Any]]:
    plane: dict[str, Any] = {"out": (1.0, 0.0), "up": (0.0, 1.0), "link": 0.07, "rod": 0.09}
    legs = tuple(Leg(base=(-0.019 * side, 0.0), bend=side, **plane) for side in (1, -1))  # elbows outwards
    return LeggedArm, {
        "legs": legs,
        "lower": (-0.05, 0.05),
        "upper": (0.05, 0.12),
        "resolution": 2 * pi / 4880,
    }


def _falcon() -> tuple[type[Arm], dict[str, Any]]:
    return LeggedArm, {
        "legs": tuple(_falcon_leg(radians(angle)) for angle in (105, -15, -135)),
        "lower": (-0.03, -0.03, 0.1),
        "upper": (0.03, 0.03, 0.14),
        "resolution": 2 * pi / 1280 * 14.25 / 110,
    }


def _falcon_leg(turn: float) -> Leg:
    """p′_u = u − r + c and p′_v = v − s + f in the axes of the leg."""
    out, across = (cos(turn), sin(turn), 0.0), (-sin(turn), cos(turn), 0.0)
    u, v = 0.040 - 0.01443, -0.02309 + 0.025
    base = tuple(u * a + v * b for a, b in zip(out, across, strict=True))
    return Leg(base=base, out=out, up=(0.0, 0.0, 1.0), link=0.06, rod=0.1025, offset=0.0225)


BUILT_IN: Mapping[str, Callable[[], tuple[type[Arm], dict[str, Any]]]] = MappingProxyType(
    {
        "hapkit": lambda: (PlanarChain, {"links": (0.065659,), "joint_range": ((-pi / 4, pi / 4),)}),
        "two-link": lambda: (
            PlanarChain,
            {"links": (0.1,) * 2, "joint_range": ((0, pi), (pi / 6, 5 * pi / 6))},
        ),
        "haply-2diy": _haply,
        "falcon": _falcon,
    }
)
