"""URDF: links, and joints between them; angles in radians, roll, pitch and yaw about fixed axes."""

from __future__ import annotations

from math import inf

import numpy as np

from zwidth.model.arms.kinematics.description_file import Element
from zwidth.model.arms.kinematics.mechanism import (
    Follows,
    Frame,
    Mechanism,
    Placement,
    Written,
    mechanism,
    of_quaternion,
    placement,
    turned,
    unit,
)

_MOVES = {"revolute": False, "continuous": False, "prismatic": True}
"""Whether a joint of this type slides."""


def read_urdf(root: Element, stem: str) -> Mechanism:
    """The joints from the base on, those of one link by their names, as ROS numbers them."""
    links, joints = _named(root, "link"), _named(root, "joint")
    below: dict[str, list[Element]] = {name: [] for name in links}
    ends = {
        name: tuple(_end(joint, tag, links) for tag in ("parent", "child")) for name, joint in joints.items()
    }
    above: dict[str, str] = {}
    for name in sorted(joints):
        parent, child = ends[name]
        if child in above:
            raise joints[name].wrong(f"has the child {child!r}, which joint {above[child]!r} has already")
        above[child] = name
        below[parent].append(joints[name])
    bases = [name for name in links if name not in above]
    if len(bases) != 1:
        raise root.wrong(f"needs one link that is no child, and has {', '.join(bases[:5]) or 'none'}")
    written, frames = list[Written](), [Frame(bases[0], -1, Placement())]

    def go_on(link: str, before: int, at: Placement) -> None:
        for joint in below[link]:
            here, place, name = at.then(_origin(joint)), before, joint.given["name"]
            kind = joint.choice("type", ("", *_MOVES, "fixed", "floating", "planar"))
            if kind in _MOVES:
                written.append(_joint(joint, kind, before, here))
                place, here = len(written) - 1, Placement()
            elif kind != "fixed":
                raise joint.wrong(f"is {kind or 'of no type'}: every joint must turn or slide about one axis")
            child = ends[name][1]
            frames.extend((Frame(name, place, here, is_body=False), Frame(child, place, here)))
            go_on(child, place, here)

    go_on(bases[0], -1, Placement())
    if len(frames) != 1 + 2 * len(joints):
        lost = next(link for link in links if link not in {frame.name for frame in frames})
        raise links[lost].wrong("is in a ring of joints; a robot is a tree")
    named = root.given.get("name") or stem
    return mechanism(named, '<dynamics damping="…"/> in <joint>', written, frames)


def _named(root: Element, tag: str) -> dict[str, Element]:
    found: dict[str, Element] = {}
    for element in root.all(tag):
        name = element.given.get("name")
        if not name:
            raise element.wrong("has no name")
        if name in found:
            raise element.wrong(f"has a name that another <{tag}> has, in line {found[name].line}")
        found[name] = element
    return found


def _end(joint: Element, tag: str, links: dict[str, Element]) -> str:
    element = joint.one(tag)
    name = element.given.get("link") if element else None
    if name not in links:
        raise joint.wrong(f"has the {tag} {name!r}, which is no link" if name else f"has no {tag} link")
    return str(name)


def _origin(joint: Element) -> Placement:
    origin = joint.one("origin")
    if origin is None:
        return Placement()
    x, y, z, w = origin.numbers("quat_xyzw", 4) or (0.0, 0.0, 0.0, 1.0)
    rotation = of_quaternion((w, x, y, z), f"line {origin.line}: quat_xyzw")
    if (angles := origin.numbers("rpy", 3)) is not None:
        if "quat_xyzw" in origin.given:
            raise origin.wrong("has rpy and quat_xyzw; leave out one")
        roll, pitch, yaw = (turned(axis, angle) for axis, angle in zip(np.eye(3), angles, strict=True))
        rotation = yaw @ pitch @ roll
    return placement(rotation, origin.numbers("xyz", 3) or (0.0, 0.0, 0.0))


def _joint(joint: Element, kind: str, before: int, at: Placement) -> Written:
    axis, limit, dynamics, mimic = (joint.one(tag) for tag in ("axis", "limit", "dynamics", "mimic"))
    direction = (1.0, 0.0, 0.0) if axis is None else axis.numbers("xyz", 3) or (1.0, 0.0, 0.0)
    if limit is None and kind != "continuous":
        raise joint.wrong(f"is {kind} and has no <limit>; without limits it is continuous")
    low, high, effort = -inf, inf, 0.0
    if limit is not None:
        effort = limit.number("effort", 0.0)
        if kind != "continuous":
            low, high = limit.number("lower", 0.0), limit.number("upper", 0.0)
            if low > high:
                raise limit.wrong(f"of joint {joint.given['name']!r} has lower {low:g} > upper {high:g}")
    follows = None
    if mimic is not None:
        factor, offset = mimic.number("multiplier", 1.0), mimic.number("offset", 0.0)
        follows = Follows(mimic.given.get("joint", ""), factor, offset, mimic.line)
    return Written(
        name=joint.given["name"],
        line=joint.line,
        slides=_MOVES[kind],
        before=before,
        at=at,
        axis=tuple(unit(direction, f"line {joint.line}: the axis").tolist()),
        limits=(low, high),
        damping=0.0 if dynamics is None else dynamics.number("damping", 0.0),
        friction=0.0 if dynamics is None else dynamics.number("friction", 0.0),
        effort=effort,
        follows=follows,
    )
