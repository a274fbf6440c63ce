"""A chain of joints: p(q) from the numbers of the document, and δ_m − JᵀRJ with its slopes.

From the end to the base, each joint turns or slides along the z axis of its own frame:

    p_i = t_i + C_i (Rot_z(q_i) p_{i+1}    or    p_{i+1} + q_i ẑ)
    ∂p_i/∂q_i = C_i (ẑ × Rot_z(q_i) p_{i+1}    or    ẑ)

The proof takes p as it stands here, C_i need not be a rotation to the last digit. To bound its second
derivatives by lengths, |∂²p/∂q_i∂q_j| ≤ what lies beyond both joints, it must nearly be one.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from fractions import Fraction
from math import isqrt
from typing import Any, NamedTuple

from ..document.fields import Field, List, Number, OneOf, Read, Record, numbers
from ..document.refusal import Invalid
from ..document.unit import always
from ..exact.enclosed import Enclosed, dot, known, mapped
from ..exact.functions import sine_cosine
from .cells import BITS
from .damping import constant, damping_matrix, damping_of

MOST_JOINTS = 16
METRES = always("m")


def vector(size: int, unit: str = "") -> List:
    """So many coordinates."""
    return numbers(always(unit), least=size, most=size)


def _joint(length: str, force: str, damping: str, **more: Field) -> Record:
    return Record(
        {
            "rotation": List(vector(3), least=3, most=3),
            "translation": vector(3, "m"),
            "low": Number(always(length)),
            "high": Number(always(length)),
            "damping": Number(always(damping), least=0, default=None),
            "resolution": Number(always(length), least=0, default=None),
            "coulomb_friction": Number(always(force), least=0, default=None),
            **more,
        }
    )


_JOINT = OneOf(
    "kind",
    {
        "revolute": _joint(
            "rad",
            "N_m",
            "N_m_s_per_rad",
            largest_column=Number(always("m_per_rad"), least=0, default=None),
            rest=Number(always("rad"), default=None),
        ),
        "prismatic": _joint("m", "N", "N_s_per_m"),
    },
)
CHAIN = Record(
    {
        "joints": List(_JOINT, least=1, most=MOST_JOINTS),
        "end": vector(3, "m"),
        "damping": damping_matrix("N_m_s_rad", MOST_JOINTS),
    }
)
"""From the base: the placement of each joint, its range and damping; the hand in the frame of the last.
Joints that damp each other have a matrix in the place of their own damping."""

NEARLY = Fraction(1, 10**9)
LONGER = 1 + Fraction(1, 10**6)
"""What 16 matrices that are nearly rotations can lengthen, and more."""


class Joint(NamedTuple):
    slides: bool
    rotation: list[list[Fraction]]
    translation: list[Fraction]
    low: Fraction
    high: Fraction


class Chain(NamedTuple):
    joints: list[Joint]
    end: list[Fraction]
    damping: list[list[Fraction]]


def chain_of(told: Read) -> Chain:
    """The chain of a document."""
    return Chain([_joint_of(joint) for joint in told.joints], told.end, damping_of(told, told.joints))


def _joint_of(told: Read) -> Joint:
    require_square(told.rotation, "the rows of a rotation must be of length 1, at right angles")
    if told.low > told.high:
        raise Invalid("a joint needs low ≤ high")
    return Joint(told.kind == "prismatic", told.rotation, told.translation, told.low, told.high)


def require_square(axes: Sequence[Sequence[Fraction]], message: str) -> None:
    """Refuse axes that are not of length 1 or not at right angles, or not nearly."""
    for i, a in enumerate(axes):
        for j, b in enumerate(axes):
            if abs(sum((x * y for x, y in zip(a, b, strict=True)), Fraction(-(i == j)))) > NEARLY:
                raise Invalid(message)


NOTHING = Enclosed(BITS, 0)
UNIT = known(Fraction(1), BITS)


def chain_surplus(
    chain: Chain,
    need: list[list[Enclosed]],
    price: Fraction,
    turning: Callable[[Sequence[Enclosed]], list[list[Enclosed]]] | None = None,
) -> Callable[[Sequence[Enclosed]], list[list[Enclosed]]]:
    """δ_m − c − JᵀRJ, its rows from the diagonal on; R of the hand's first coordinates, c of every joint.
    `turning` gives what comes after the point in each column of J."""
    own = [
        [constant(x - price if k == 0 else x) for k, x in enumerate(row[i:])]
        for i, row in enumerate(chain.damping)
    ]
    columns_at = jacobian(chain, len(need), turning)

    def surplus(joints: Sequence[Enclosed]) -> list[list[Enclosed]]:
        columns = columns_at(joints)
        loads = [mapped(need, v) for v in columns]
        return [
            [damping - dot(v, load) for damping, load in zip(own[i], loads[i:], strict=True)]
            for i, v in enumerate(columns)
        ]

    return surplus


def jacobian(
    chain: Chain,
    size: int,
    turning: Callable[[Sequence[Enclosed]], list[list[Enclosed]]] | None = None,
) -> Callable[[Sequence[Enclosed]], list[list[Enclosed]]]:
    """The columns of J of the hand's coordinates, `size` of them; the last ones are those of `turning`."""
    fixed = _placements(chain)
    end = [constant(x) for x in chain.end]

    def columns_at(joints: Sequence[Enclosed]) -> list[list[Enclosed]]:
        point, columns = end, list[list[Enclosed]]()
        for joint, q, (rotation, translation) in from_end(chain.joints, joints, fixed):
            vectors = _moved(joint.slides, q, point, columns)
            point, *columns = [mapped(rotation, v) for v in vectors]
            point = [x + t for x, t in zip(point, translation, strict=True)]
        turned = turning(joints) if turning else [[] for _ in joints]
        return [[*column[: size - len(more)], *more] for column, more in zip(columns, turned, strict=True)]

    return columns_at


def from_end(*listed: Sequence[Any]) -> list[tuple[Any, ...]]:
    """What belongs to each joint, from the end to the base."""
    found: list[tuple[Any, ...]] = list(zip(*listed, strict=True))
    return found[::-1]


def _placements(chain: Chain) -> list[tuple[list[list[Enclosed]], list[Enclosed]]]:
    return [
        ([[constant(x) for x in row] for row in j.rotation], [constant(x) for x in j.translation])
        for j in chain.joints
    ]


def _moved(
    slides: bool, q: Enclosed, point: list[Enclosed], columns: list[list[Enclosed]]
) -> list[list[Enclosed]]:
    """The point, the column of this joint and those beyond it, before the joint's own placement."""
    if slides:
        return [[point[0], point[1], point[2] + q], [NOTHING, NOTHING, UNIT], *columns]
    turned = about_z(q, (point, *columns))
    x, y, _ = turned[0]
    return [turned[0], [-y, x, NOTHING], *turned[1:]]


def about_z(q: Enclosed, vectors: Sequence[Sequence[Enclosed]]) -> list[list[Enclosed]]:
    """Vectors turned by an angle about the third axis."""
    s, c = sine_cosine(q)
    across, along = (c, -s), (s, c)
    return [[dot(v[:2], across), dot(v[:2], along), v[2]] for v in vectors]


def levers(chain: Chain) -> Callable[[Sequence[Enclosed]], list[Enclosed]]:
    """The square of the hand's distance from the axis of each joint, which only the joints beyond it change:
    |∂p/∂q_i|² of one that turns, but for the lengths of what only nearly rotates."""
    fixed = _placements(chain)
    end = [constant(x) for x in chain.end]

    def squares(joints: Sequence[Enclosed]) -> list[Enclosed]:
        point, found = end, list[Enclosed]()
        for joint, q, (rotation, translation) in from_end(chain.joints, joints, fixed):
            found.insert(0, dot(point[:2], point[:2]))
            moved = mapped(rotation, _moved(joint.slides, q, point, [])[0])
            point = [x + t for x, t in zip(moved, translation, strict=True)]
        return found

    return squares


def bends(chain: Chain) -> list[list[Fraction]]:
    """N_ij ≥ |∂²p/∂q_i∂q_j|: what lies beyond both joints where both turn, 1 where one slides, else 0."""
    beyond: list[Fraction] = []
    reach = _length(chain.end)
    for joint in reversed(chain.joints):
        reach += max(abs(joint.low), abs(joint.high)) if joint.slides else 0
        beyond.insert(0, reach)
        reach += _length(joint.translation)

    def bend(i: int, j: int) -> Fraction:
        sliding = chain.joints[i].slides + chain.joints[j].slides
        return LONGER * (min(beyond[i], beyond[j]) if sliding == 0 else int(sliding == 1))

    count = range(len(chain.joints))
    return [[bend(i, j) for j in count] for i in count]


def _length(v: Sequence[Fraction]) -> Fraction:
    return root_above(sum((x * x for x in v), Fraction(0)))


def root_above(x: Fraction) -> Fraction:
    """Not below √x; x itself where x is a square."""
    top, bottom = isqrt(x.numerator), isqrt(x.denominator)
    if (top * top, bottom * bottom) == (x.numerator, x.denominator):
        return Fraction(top, bottom)
    return Fraction(isqrt(int(x * 4**BITS)) + 1, 2**BITS)
