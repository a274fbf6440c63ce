"""What a robot description says, read from its XML into a table of joints and frames.

What a robot description says, as a table: joints, each in the frame of the one before it, and frames.

    x_before = t + R (Rot_a(v) x    or    x + v a),    v = factor · q_c + offset

q_c is the coordinate that moves the joint: its own, or that of the joint which it follows (a mimic joint).
A coordinate has the friction of all that it moves, b_c = Σ factor² b and f_c = Σ |factor| f, and goes as far
as every one of them may; where that is nowhere, as in files whose followers turn the other way than their
limits, as far as its own joint may.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from math import inf, isfinite
from pathlib import Path
from typing import NamedTuple
from xml.parsers.expat import ExpatError, ParserCreate

import numpy as np
import numpy.typing as npt

from zwidth.errors import InputError
from zwidth.missing import suggestion

Array = npt.NDArray[np.float64]
Vector = tuple[float, ...]


class Placement(NamedTuple):
    """A frame in another one: x_there = translation + rotation x_here."""

    rotation: tuple[Vector, ...] = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
    translation: Vector = (0.0, 0.0, 0.0)  # [m]

    def then(self, other: Placement) -> Placement:
        """`other` is placed in this one."""
        r, t = np.array(self.rotation), np.array(self.translation)
        return placement(r @ np.array(other.rotation), t + r @ np.array(other.translation))


def placement(rotation: npt.ArrayLike, translation: npt.ArrayLike = (0.0, 0.0, 0.0)) -> Placement:
    """Of arrays."""
    rows = np.asarray(rotation, dtype=np.float64).tolist()
    return Placement(tuple(map(tuple, rows)), tuple(np.asarray(translation, dtype=np.float64).tolist()))


class Follows(NamedTuple):
    """A joint whose value is factor · that of another + offset."""

    joint: str
    factor: float
    offset: float
    line: int


class Written(NamedTuple):
    """A joint as it is written; limits ±∞ where it has none, `zero`: its value where nothing is moved."""

    name: str
    line: int
    slides: bool
    before: int  # the place in the table of the joint that moves it; −1: the base
    at: Placement
    axis: Vector
    limits: tuple[float, float] = (-inf, inf)
    damping: float = 0.0
    friction: float = 0.0
    effort: float = inf
    zero: float = 0.0
    follows: Follows | None = None
    spring: bool = False  # to a rest of its own
    driven: bool = True


class Joint(NamedTuple):
    """A joint and what moves it."""

    slides: bool
    before: int
    at: Placement
    axis: Vector
    coordinate: int
    factor: float = 1.0
    offset: float = 0.0


class Coordinate(NamedTuple):
    """What moves freely: a joint with all those that follow it."""

    name: str
    line: int
    slides: bool
    limits: tuple[float, float]
    damping: float
    friction: float
    effort: float
    bare: bool  # a spring moves it, and no motor

    @property
    def unit(self) -> str:
        return "m" if self.slides else "rad"


class Frame(NamedTuple):
    """A frame that the hand may be at, in that of a joint; −1: the base."""

    name: str
    joint: int
    at: Placement
    is_body: bool = True


@dataclass(frozen=True, kw_only=True)
class Mechanism:
    """A tree of joints; made by `mechanism`."""

    name: str
    advice: str  # where the description's format has damping, and what of the file is none
    joints: tuple[Joint, ...]
    coordinates: tuple[Coordinate, ...]
    frames: tuple[Frame, ...]
    notes: tuple[str, ...] = ()
    springs: tuple[str, ...] = ()  # what is to be known of those to a rest of their own
    fixed: tuple[str, ...] = ()  # joints that are locked where they are held, in words

    @property
    def names(self) -> tuple[str, ...]:
        """Of the joints that move by themselves, in order."""
        return tuple(each.name for each in self.coordinates)

    def frame(self, name: str, file: str = "") -> Frame:
        """The frame of a name; where a link and a joint share it, that of the link."""
        named = [frame for frame in self.frames if frame.name == name]
        if not named:
            known = suggestion(name, dict.fromkeys(frame.name for frame in self.frames))
            raise InputError(f"{file} has no frame {name!r}; {known}")
        return max(named, key=lambda frame: frame.is_body)

    def moves(self, frame: Frame) -> list[int]:
        """The coordinates that move a frame, from the base on."""
        return [joint.coordinate for joint in self.path(frame)]

    def path(self, frame: Frame) -> list[Joint]:
        """The joints between the base and a frame, from the base on."""
        found, at = list[Joint](), frame.joint
        while at >= 0:
            found.insert(0, self.joints[at])
            at = self.joints[at].before
        return found

    def locked(self, values: Mapping[int, float], words: Sequence[str]) -> Mechanism:
        """The same without some coordinates, each fixed at a value [rad; m]; with the words for that."""
        kept = [i for i in range(len(self.coordinates)) if i not in values]
        joints, where = list[Joint](), {-1: (-1, Placement())}
        for i, joint in enumerate(self.joints):
            before, place = where[joint.before]
            at, axis = place.then(joint.at), np.array(joint.axis)
            if joint.coordinate in values:
                v = joint.factor * values[joint.coordinate] + joint.offset
                moved = placement(np.eye(3), v * axis) if joint.slides else placement(turned(axis, v))
                where[i] = before, at.then(moved)
            else:
                where[i] = len(joints), Placement()
                joints.append(joint._replace(before=before, at=at, coordinate=kept.index(joint.coordinate)))
        return replace(
            self,
            joints=tuple(joints),
            coordinates=tuple(self.coordinates[i] for i in kept),
            frames=tuple(
                frame._replace(joint=where[frame.joint][0], at=where[frame.joint][1].then(frame.at))
                for frame in self.frames
            ),
            fixed=tuple(words),
        )


_BESIDE = (
    "the spring of {} is one to a rest of its own, and gives back what it takes; of one between motor and "
    "link such a file says nothing"
)


def mechanism(
    name: str, advice: str, written: Sequence[Written], frames: Sequence[Frame], notes: Sequence[str] = ()
) -> Mechanism:
    """The table, with each joint that follows another moved by that one's coordinate."""
    for joint in written:
        if joint.damping < 0 or joint.friction < 0:
            raise InputError(f"line {joint.line}: joint {joint.name!r} has a friction < 0, and none drives")
    places = {joint.name: i for i, joint in enumerate(written)}
    free = [i for i, joint in enumerate(written) if joint.follows is None]
    moved = [_moved_by(written, places, i) for i in range(len(written))]
    joints = tuple(
        Joint(joint.slides, joint.before, joint.at, joint.axis, free.index(own), factor, offset - joint.zero)
        for joint, (own, factor, offset) in zip(written, moved, strict=True)
    )
    every = list(zip(written, moved, strict=True))
    coordinates = tuple(
        _coordinate(written[i], [(j, f, o) for j, (k, f, o) in every if k == i]) for i in free
    )
    sprung = [joint.name for joint in written if joint.spring and joint.driven]
    return Mechanism(
        name=name,
        advice=advice,
        joints=joints,
        coordinates=coordinates,
        frames=tuple(frames),
        notes=tuple(notes),
        springs=(_BESIDE.format(", ".join(sprung[:5])),) if sprung else (),
    )


def _moved_by(written: Sequence[Written], places: dict[str, int], place: int) -> tuple[int, float, float]:
    """The free joint, factor and offset: v = factor · q + offset."""
    factor, offset = 1.0, 0.0
    for _ in written:
        follows = written[place].follows
        if follows is None:
            return place, factor, offset
        if follows.joint not in places:
            raise InputError(
                f"line {follows.line}: joint {written[place].name!r} follows {follows.joint!r}, and there is "
                "no joint of this name that moves"
            )
        factor, offset = factor * follows.factor, factor * follows.offset + offset
        place = places[follows.joint]
    raise InputError(f"line {written[place].line}: joint {written[place].name!r} follows itself")


def _coordinate(own: Written, moves: Sequence[tuple[Written, float, float]]) -> Coordinate:
    low, high = -inf, inf
    for joint, factor, offset in moves:
        if factor:
            ends = sorted((end - offset) / factor for end in joint.limits)
            low, high = max(low, ends[0]), min(high, ends[1])
    return Coordinate(
        own.name,
        own.line,
        own.slides,
        (low, high) if low < high else own.limits,
        sum(factor**2 * joint.damping for joint, factor, _ in moves),
        sum(abs(factor) * joint.friction for joint, factor, _ in moves),
        own.effort,
        any(joint.spring for joint, _, _ in moves) and not any(joint.driven for joint, _, _ in moves),
    )


def turned(axis: npt.ArrayLike, angle: npt.ArrayLike) -> Array:
    """Rotations about a unit vector (…, 3) by angles (…), Rodrigues: 1 + sin φ [a]× + (1 − cos φ) [a]×²."""
    a, phi = np.asarray(axis, dtype=np.float64), np.asarray(angle, dtype=np.float64)[..., None, None]
    across = np.cross(np.eye(3), a[..., None, :])
    return np.asarray(np.eye(3) + np.sin(phi) * across + (1 - np.cos(phi)) * (across @ across))


def unit(vector: Sequence[float], what: str) -> Array:
    """Of length 1."""
    v = np.array(vector, dtype=np.float64)
    length = float(np.linalg.norm(v))
    if not (isfinite(length) and length > 1e-14):
        raise InputError(f"{what} has no direction: its length is {length:g}")
    return np.asarray(v / length)


def of_quaternion(quaternion: Sequence[float], what: str) -> Array:
    """The rotation of a quaternion w, x, y, z of any length."""
    a, b, c, d = unit(quaternion, what)
    v = np.array([b, c, d])
    across = np.cross(np.eye(3), v)
    return np.asarray(np.eye(3) + 2 * a * across + 2 * across @ across)


_LARGEST = 2**25
"""[bytes] Largest description that is read."""

_DEEPEST, _MOST_PARTS = 200, 2000
_PARTS = ("link", "body", "joint", "freejoint")
_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?")


class Element(NamedTuple):
    """An element of XML, and the line on which it begins."""

    tag: str
    given: dict[str, str]
    line: int
    parts: list[Element]

    def all(self, tag: str) -> list[Element]:
        """Its children of this kind."""
        return [part for part in self.parts if part.tag == tag]

    def one(self, tag: str) -> Element | None:
        """Its child of this kind."""
        found = self.all(tag)
        if len(found) > 1:
            raise found[1].wrong(f"is one <{tag}> too many in <{self.tag}>")
        return found[0] if found else None

    def wrong(self, what: str) -> InputError:
        """What is said of it, with its line."""
        name = f" {self.given['name']!r}" if self.given.get("name") else ""
        return InputError(f"line {self.line}: <{self.tag}>{name} {what}")

    def numbers(
        self, key: str, count: int, given: Mapping[str, str] | None = None, least: int | None = None
    ) -> tuple[float, ...] | None:
        """`count` numbers, or from `least` on so many; None where the attribute is not there."""
        text = (self.given if given is None else given).get(key)
        if text is None:
            return None
        words = text.split()
        if not (count if least is None else least) <= len(words) <= count:
            wanted = "a number" if count == 1 else f"{count} numbers"
            raise self.wrong(f"has {key}={text[:60]!r}, where {wanted} should be")
        values = tuple(float(word) if _NUMBER.fullmatch(word) else float("nan") for word in words)
        if not all(map(isfinite, values)):
            raise self.wrong(f"has {key}={text[:60]!r}, which is no finite number everywhere")
        return values

    def number(self, key: str, default: float, given: Mapping[str, str] | None = None) -> float:
        """One number."""
        found = self.numbers(key, 1, given)
        return default if found is None else found[0]

    def choice(self, key: str, allowed: tuple[str, ...], given: Mapping[str, str] | None = None) -> str:
        """One of some words; the first is that of an attribute that is not there."""
        text = (self.given if given is None else given).get(key, allowed[0])
        if text not in allowed:
            raise self.wrong(f"has {key}={text[:40]!r}; it can be {', '.join(allowed)}")
        return text

    def known(self, names: str) -> None:
        """Refuse an attribute that the format does not have."""
        for key in self.given:
            if key not in names.split():
                raise self.wrong(f"has an attribute {key[:40]!r}, which this format does not know")


def parsed(path: Path) -> Element:
    """The tree; what is no XML is refused, and what leads elsewhere or has no end."""
    parser = ParserCreate()
    tree = _Tree(parser)
    parser.StartDoctypeDeclHandler = tree.doctype
    parser.StartElementHandler, parser.EndElementHandler = tree.begin, tree.end
    try:
        if path.stat().st_size > _LARGEST:
            raise InputError(f"it is larger than {_LARGEST} bytes, and no description of an arm is")
        with open(path, "rb") as file:
            parser.ParseFile(file)
    except (ExpatError, OSError, ValueError) as error:
        if isinstance(error, InputError):
            raise
        raise InputError(f"it is no XML, {error}") from None
    return tree.top.parts[0]


class _Tree:
    """Builds the elements; refuses what would make a description grow, lead elsewhere, or end the process."""

    def __init__(self, parser: object) -> None:
        self._parser, self._parts = parser, 0
        self.top = Element("", {}, 0, [])
        self._open = [self.top]

    def doctype(self, *_: object) -> None:
        """Entities can name other files, and a few lines of them stand for gigabytes."""
        raise InputError("it has a DOCTYPE, which no robot description needs; take it out")

    def begin(self, name: str, given: dict[str, str]) -> None:
        """Readers go deeper with each level, and with each joint."""
        self._parts += name in _PARTS
        line = getattr(self._parser, "CurrentLineNumber")  # noqa: B009
        if name == "include":
            raise InputError(f"it includes another file in line {line}; put all into one")
        if name.startswith("xacro:"):
            raise InputError(f"it has <{name}> in line {line}: expand it first, xacro FILE.xacro > arm.urdf")
        if len(self._open) > _DEEPEST or self._parts > _MOST_PARTS:
            raise InputError(
                f"it has more than {_DEEPEST} levels, or {_MOST_PARTS} bodies and joints; no arm has so many"
            )
        element = Element(name, given, line, [])
        self._open[-1].parts.append(element)
        self._open.append(element)

    def end(self, _: str) -> None:
        self._open.pop()
