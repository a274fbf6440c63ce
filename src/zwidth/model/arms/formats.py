"""The two formats of robot descriptions, MJCF and URDF.

MJCF as MuJoCo 4.0 reads it: defaults and their classes, the compiler's options, frames, equalities.

Every element that could move the hand is read or refused; what has no part in its motion is passed over.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import zip_longest
from math import inf, pi
from typing import NamedTuple

import numpy as np

from zwidth.model.arms.mechanism import (
    Array,
    Element,
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

_JOINT = (
    "name class type group pos axis springdamper limited actuatorfrclimited solreflimit solimplimit "
    "solreffriction solimpfriction stiffness range actuatorfrcrange actuatorgravcomp margin ref springref "
    "springyield armature damping frictionloss user"
)
_BODY = "name childclass pos quat axisangle xyaxes zaxis euler mocap gravcomp sleep simple fuse user"
_BESIDE = ("inertial", "geom", "camera", "light", "plugin")
_SECTIONS = (
    "compiler option size visual statistic default extension custom asset worldbody contact deformable "
    "equality tendon actuator sensor keyframe"
)
_TURNS = ("quat", "axisangle", "xyaxes", "zaxis", "euler")
_TRUTH = ("auto", "true", "false")
_LETTERS = "xyz"

_COULOMB = "is Coulomb friction, which covers encoder steps and no spring"
_NO_DAMPING_OF_MJCF = {"frictionloss": _COULOMB, "armature": "is inertia", "dampratio": "is a controller's"}
_NO_DAMPING_OF_URDF = {"friction": _COULOMB}
"""What a file may have in the place of damping, which a person would take for it."""

Defaults = dict[str, dict[str, str]]
"""Of each kind of element, its attributes."""


class _Settings(NamedTuple):
    angle: float  # one unit of the file's angles [rad]
    euler: str
    autolimits: bool
    classes: dict[str, Defaults]


def read_mjcf(root: Element, stem: str) -> Mechanism:
    """The joints as MuJoCo numbers them."""
    for section in root.parts:
        if section.tag not in _SECTIONS.split():
            raise section.wrong("is no section of an MJCF")
    reader = _Reader(_settings(root))
    for world in root.all("worldbody"):
        reader.go_on(world, _Inside(-1, Placement(), "main"))
    for section in root.all("equality"):
        for equality in section.parts:
            reader.couple(equality)
    advice = _advice('damping="…" in <joint>', root, _NO_DAMPING_OF_MJCF)
    motors = [motor.given for section in root.all("actuator") for motor in section.parts]
    turned_by = {given.get("joint", given.get("jointinparent")) for given in motors}
    known = bool(motors) and None not in turned_by  # a tendon may move any joint
    written = [joint._replace(driven=not known or joint.name in turned_by) for joint in reader.written]
    return mechanism(root.given.get("model") or stem, advice, written, reader.frames, reader.notes)


def _advice(damping_is: str, root: Element, others: dict[str, str]) -> str:
    """Where damping is written, and what of the file is none."""
    waiting, keys = [root], set[str]()
    while waiting:
        element = waiting.pop()
        keys |= element.given.keys()
        waiting += element.parts
    beside = [f"{key} {what}" for key, what in others.items() if key in keys]
    return "; ".join([f"{damping_is} in the description", *beside])


def _settings(root: Element) -> _Settings:
    given: dict[str, str] = {}
    compiler = root
    for compiler in root.all("compiler"):
        given |= compiler.given
    compiler.choice("coordinate", ("local",), given)
    sequence = given.get("eulerseq", "xyz")
    if len(sequence) != 3 or not set(sequence.lower()) <= set(_LETTERS):
        raise compiler.wrong(f"has eulerseq={sequence[:20]!r}; it is three of x, y, z, X, Y, Z")
    degrees = compiler.choice("angle", ("degree", "radian"), given) == "degree"
    limits = compiler.choice("autolimits", ("true", "false"), given) == "true"
    classes: dict[str, Defaults] = {"main": {}}
    for section in root.all("default"):
        if section.given.get("class", "main") != "main":
            raise section.wrong("is the outermost one, whose class is main")
        _default(section, "main", classes)
    return _Settings(pi / 180 if degrees else 1.0, sequence, limits, classes)


def _default(section: Element, name: str, classes: dict[str, Defaults]) -> None:
    """Its own attributes first; the classes inside begin with these."""
    for element in section.parts:
        if element.tag != "default":
            if element.tag == "joint":
                element.known(_JOINT)
            classes[name][element.tag] = _over(classes[name].get(element.tag, {}), element.given)
    for inner in section.all("default"):
        of = inner.given.get("class")
        if not of or of in classes:
            raise inner.wrong(f"has the class {of!r} of another" if of else "has no class")
        classes[of] = {tag: dict(given) for tag, given in classes[name].items()}
        _default(inner, of, classes)


def _over(default: dict[str, str], own: dict[str, str]) -> dict[str, str]:
    """What an element says goes before its default; of numbers that may be fewer, number by number."""
    both = default | own
    for key in ("damping", "polycoef"):
        if key in default and key in own:
            pairs = zip_longest(own[key].split(), default[key].split())
            both[key] = " ".join(new or old for new, old in pairs)
    if any(key in own for key in _TURNS):
        both = {key: text for key, text in both.items() if key in own or key not in _TURNS}
    return both


class _Inside(NamedTuple):
    """Where what is read is: in the frame of which joint, placed how, with which defaults."""

    joint: int
    at: Placement
    childclass: str


class _Reader:
    """Goes through the bodies, as they come."""

    def __init__(self, settings: _Settings) -> None:
        self._settings, self._names = settings, set[tuple[str, str]]()
        self.written, self.frames, self.notes = list[Written](), list[Frame](), list[str]()

    def go_on(self, element: Element, inside: _Inside) -> None:
        """The sites and bodies of a body, or of a frame in it, once its joints are read."""
        for part in element.parts:
            if part.tag == "site":
                given = self._given(part, inside.childclass)
                at = inside.at.then(self._placed(part, given))
                if name := part.given.get("name"):
                    self.frames.append(Frame(name, inside.joint, at))
        for part in element.parts:
            if part.tag == "body":
                self._body(part, inside)
            elif part.tag == "frame":
                self.go_on(part, self._inside(part, inside))
            elif part.tag not in ("site", "joint", "freejoint", *_BESIDE):
                raise part.wrong("is not read: write out the bodies that it stands for, or take it out")

    def couple(self, equality: Element) -> None:
        """Two joints that are coupled in proportion are one coordinate; other couplings are refused."""
        given = self._given(equality, "main", "equality")
        if equality.choice("active", ("true", "false"), given) == "false" or equality.tag.startswith("flex"):
            return
        names = [given.get(key) for key in ("joint1", "joint2")]
        if equality.tag != "joint" or None in names:
            raise equality.wrong("couples in a way that is not read; take it out where it is beyond the hand")
        places = {joint.name: i for i, joint in enumerate(self.written)}
        for name in names:
            if name not in places:
                raise equality.wrong(f"couples {name!r}, and there is no such joint")
        constant, factor, *more = _filled(equality.numbers("polycoef", 5, given, 1) or (), (0, 1, 0, 0, 0))
        one, other = (self.written[places[str(name)]] for name in names)
        if any(more) or one.follows is not None:
            raise equality.wrong("couples joints in another way than in proportion, which is not read")
        offset = one.zero + constant - factor * other.zero
        self.written[places[one.name]] = one._replace(
            follows=Follows(other.name, factor, offset, equality.line)
        )

    def _body(self, body: Element, outside: _Inside) -> None:
        body.known(_BODY)
        name = self._name(body, "body", f"body {len(self.frames) + 1}")
        inside = self._inside(body, outside)
        own = self._joints(body, inside, Placement(), name, len(self.written))
        self.frames.append(Frame(name, own.joint, own.at))
        self.go_on(body, own)

    def _joints(self, element: Element, body: _Inside, frame: Placement, name: str, first: int) -> _Inside:
        """The joints of a body as they come, those in its frames too; then it stands in the last one's."""
        for part in element.parts:
            if part.tag == "joint":
                body = self._joint(part, body, frame, f"{name}Joint_{len(self.written) - first}")
            elif part.tag == "freejoint":
                raise part.wrong("moves freely: every joint must turn or slide about one axis")
            elif part.tag == "frame":
                inner = self._inside(part, _Inside(-1, frame, body.childclass))
                moved = self._joints(part, body._replace(childclass=inner.childclass), inner.at, name, first)
                body = moved._replace(childclass=body.childclass)
        return body

    def _joint(self, joint: Element, body: _Inside, frame: Placement, unnamed: str) -> _Inside:
        joint.known(_JOINT)
        given = self._given(joint, body.childclass)
        kind = joint.choice("type", ("hinge", "slide", "ball", "free"), given)
        if kind in ("ball", "free"):
            raise joint.wrong(f"is of type {kind}: every joint must turn or slide about one axis")
        slides, name = kind == "slide", self._name(joint, "joint", unnamed)
        angle = 1.0 if slides else self._settings.angle
        placed = frame.then(Placement(translation=joint.numbers("pos", 3, given) or (0, 0, 0)))
        axis = unit(joint.numbers("axis", 3, given) or (0, 0, 1), f"line {joint.line}: the axis")
        if all(v > 0 for v in joint.numbers("springdamper", 2, given) or (0,)):
            raise joint.wrong("has springdamper, a damping by its inertia, which is not read: write damping")
        damping, *more = _filled(joint.numbers("damping", 3, given, 1) or (), (0, 0, 0))
        if min(more) < 0:
            raise joint.wrong(f"has damping={given['damping']!r}: less than in proportion is not read")
        if any(more):
            self.notes.append(
                f"joint {name} is damped by more at speed (damping={given['damping']!r}): {damping:g} counts"
            )
        low, high = self._limits(joint, given, "limited", "range")
        least, most = self._limits(joint, given, "actuatorfrclimited", "actuatorfrcrange")
        at = body.at.then(Placement(translation=placed.translation))
        self.written.append(
            Written(
                name=name,
                line=joint.line,
                slides=slides,
                before=body.joint,
                at=at,
                axis=tuple((np.array(frame.rotation) @ axis).tolist()),
                limits=(low * angle, high * angle),
                damping=damping,
                friction=joint.number("frictionloss", 0.0, given),
                effort=min(-least, most),
                zero=joint.number("ref", 0.0, given) * angle,
                spring=any(joint.numbers("stiffness", 3, given, 1) or ()),
            )
        )
        self.frames.append(Frame(name, len(self.written) - 1, Placement(), is_body=False))
        back = Placement(translation=tuple(-x for x in placed.translation))
        return body._replace(joint=len(self.written) - 1, at=back)

    def _limits(self, joint: Element, given: dict[str, str], key: str, of: str) -> Sequence[float]:
        """The range, if it is one: "auto" is true where it is written, which needs autolimits."""
        limited, ends = joint.choice(key, _TRUTH, given), joint.numbers(of, 2, given) or (0.0, 0.0)
        if limited == "auto" and any(ends) and not self._settings.autolimits:
            raise joint.wrong(f'has {of} and not {key}, which it needs with autolimits="false"')
        if limited == "false" or (limited == "auto" and not ends[0] < ends[1]):
            return (-inf, inf)
        if not ends[0] < ends[1]:
            raise joint.wrong(f"has limits, and no {of} that goes from less to more")
        return ends

    def _given(self, element: Element, childclass: str, kind: str | None = None) -> dict[str, str]:
        """Its attributes over those of its class."""
        named = element.given.get("class", childclass)
        return _over(self._class(element, named).get(kind or element.tag, {}), element.given)

    def _class(self, element: Element, name: str) -> Defaults:
        if name not in self._settings.classes:
            raise element.wrong(f"is of the class {name!r}, and there is none of this name")
        return self._settings.classes[name]

    def _inside(self, element: Element, outside: _Inside) -> _Inside:
        """In a body that has no joints, or a frame."""
        childclass = element.given.get("childclass", outside.childclass)
        self._class(element, childclass)
        return _Inside(outside.joint, outside.at.then(self._placed(element, element.given)), childclass)

    def _name(self, element: Element, kind: str, unnamed: str) -> str:
        name = element.given.get("name") or unnamed
        if (kind, name) in self._names:
            raise element.wrong(f"has the name of another {kind}, {name!r}")
        self._names.add((kind, name))
        return name

    def _placed(self, element: Element, given: dict[str, str]) -> Placement:
        ends = element.numbers("fromto", 6, given) if element.tag == "site" else None
        if ends is not None:
            if "pos" in given:
                raise element.wrong("has fromto and pos; leave out one")
            first, last = np.array(ends[:3]), np.array(ends[3:])
            way = unit((first - last).tolist(), f"line {element.line}: fromto")
            return placement(_z_turned_to(way), (first + last) / 2)
        return placement(self._rotation(element, given), element.numbers("pos", 3, given) or (0, 0, 0))

    def _rotation(self, element: Element, given: dict[str, str]) -> Array:
        told = [key for key in _TURNS if key in given]
        if len(told) > 1:
            raise element.wrong(f"has {told[0]} and {told[1]}; leave out one")
        where = f"line {element.line}: {told[0] if told else ''}"
        if (quaternion := element.numbers("quat", 4, given)) is not None:
            return of_quaternion(quaternion, where)
        if (about := element.numbers("axisangle", 4, given)) is not None:
            return turned(unit(about[:3], where), about[3] * self._settings.angle)
        if (axes := element.numbers("xyaxes", 6, given)) is not None:
            x = unit(axes[:3], where)
            y = np.array(axes[3:])
            y = unit((y - x * (x @ y)).tolist(), where)
            return np.stack([x, y, np.cross(x, y)], axis=-1)
        if (z := element.numbers("zaxis", 3, given)) is not None:
            return _z_turned_to(unit(z, where))
        rotation = np.eye(3)
        for letter, angle in zip(
            self._settings.euler, element.numbers("euler", 3, given) or (), strict=False
        ):
            step = turned(np.eye(3)[_LETTERS.index(letter.lower())], angle * self._settings.angle)
            rotation = rotation @ step if letter.islower() else step @ rotation
        return rotation


def _filled(given: Sequence[float], default: Sequence[float]) -> tuple[float, ...]:
    return (*given, *default[len(given) :])


def _z_turned_to(axis: Array) -> Array:
    """The least rotation that takes z there; of −z, about x."""
    across = np.array([-axis[1], axis[0], 0.0])
    size = float(np.linalg.norm(across))
    angle = float(np.arctan2(size, axis[2]))
    return turned(across / size if size > 1e-10 else np.eye(3)[0], angle)


_MOVES = {"revolute": False, "continuous": False, "prismatic": True}
"""Whether a joint of this type slides."""


def read_urdf(root: Element, stem: str) -> Mechanism:
    """The joints from the base on, those of one link by their names, as ROS numbers them."""
    links, joints = _by_name(root, "link"), _by_name(root, "joint")
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
                written.append(_urdf_joint(joint, kind, before, here))
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
    advice = _advice('<dynamics damping="…"/> in <joint>', root, _NO_DAMPING_OF_URDF)
    return mechanism(named, advice, written, frames)


def _by_name(root: Element, tag: str) -> dict[str, Element]:
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


def _urdf_joint(joint: Element, kind: str, before: int, at: Placement) -> Written:
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
        spring=dynamics is not None and any(dynamics.number(k, 0.0) for k in dynamics.given if "stiff" in k),
    )
