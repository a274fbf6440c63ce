"""How an arm moves, and its damping less what the wall asks for: a chain of joints, or parallel legs."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from fractions import Fraction
from itertools import product
from math import isqrt
from typing import Any, NamedTuple

from ..document.fields import Choice, Field, List, Number, OneOf, Read, Record, numbers
from ..document.number import always
from ..document.refusal import Invalid
from ..exact.enclosed import Enclosed, dot, inverse, known, mapped, root, sine_cosine
from .cells import BITS, constant, damping_matrix, damping_of

# A chain of joints: p(q) from the numbers of the document, and δ_m − JᵀRJ with its slopes.
#
# From the end to the base, each joint turns or slides along the z axis of its own frame:
#
#     p_i = t_i + C_i (Rot_z(q_i) p_{i+1}    or    p_{i+1} + q_i ẑ)
#     ∂p_i/∂q_i = C_i (ẑ × Rot_z(q_i) p_{i+1}    or    ẑ)
#
# The proof takes p as it stands here, C_i need not be a rotation to the last digit. To bound its second
# derivatives by lengths, |∂²p/∂q_i∂q_j| ≤ what lies beyond both joints, it must nearly be one.

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
    chain: Chain, size: int, turning: Callable[[Sequence[Enclosed]], list[list[Enclosed]]] | None = None
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


# A parallel arm: each leg's elbow from where the hand is, and Σ δ_ij w_i w_jᵀ − R with its slopes.
#
# A leg sees the hand at P = (u, w) in its plane and v across it. Its link l ends at the elbow e, and the rod
# goes on from there:
#
#     |e| = l,    |P − e| = ℓ,    ℓ = D + √(b² − v²)
#     e = (A P + σ H P⊥)/|P|²,    A = (|P|² + l² − ℓ²)/2,    H = √(l²|P|² − A²) > 0,    P⊥ = (−w, u)
#
# σ = ±1 says which elbow; as long as H > 0 it stays the same one. The closure |P − e|² = ℓ² gives the angle
# of the link as a function of the hand, with the gradient
#
#     w = n/(n · e⊥),    n = (P − e) in the plane + ℓ v/√(b² − v²) across,    n · e⊥ = −σ H
#
# e⊥ = (A P⊥ − σ H P)/|P|² is e turned by a right angle, and e · e⊥ = 0. δ is diagonal, with b_i, unless
# motors damp each other; only then the sign plays a part.


def _place() -> List:
    return numbers(METRES, least=2, most=3)


_LEG = Record(
    {
        "base": _place(),
        "out": numbers(least=2, most=3),
        "up": numbers(least=2, most=3),
        "link": Number(METRES, above=0),
        "rod": Number(METRES, above=0),
        "offset": Number(METRES, least=0),
        "bend": Choice(-1, 1),
        "damping": Number(always("N_m_s_per_rad"), least=0, default=None),
    }
)
LEGS = Record(
    {
        "legs": List(_LEG, least=2, most=3),
        "low": _place(),
        "high": _place(),
        "damping": damping_matrix("N_m_s_per_rad", 3),
    }
)
"""Two legs in the plane or three in space; opposite corners of the region. Motors that damp each other have a
matrix in the place of their own damping."""


class Leg(NamedTuple):
    base: list[Fraction]
    axes: list[list[Fraction]]  # u, w, and across them v in space
    link: Fraction
    rod: Fraction
    offset: Fraction
    bend: int


class Legs(NamedTuple):
    legs: list[Leg]
    low: list[Fraction]
    high: list[Fraction]
    damping: list[list[Fraction]]


def legs_of(told: Read) -> Legs:
    """The arm of a document."""
    size = len(told.legs)
    places = [told.low, told.high, *(v for leg in told.legs for v in (leg.base, leg.out, leg.up))]
    if any(len(place) != size for place in places):
        raise Invalid("an arm has as many legs as its places have coordinates")
    if any(a > b for a, b in zip(told.low, told.high, strict=True)):
        raise Invalid("the region needs low ≤ high")
    legs = [_leg(leg, size) for leg in told.legs]
    return Legs(legs, told.low, told.high, damping_of(told, told.legs))


def _leg(told: Read, size: int) -> Leg:
    out, up = told.out, told.up
    across = [up[i - 2] * out[i - 1] - up[i - 1] * out[i - 2] for i in range(3)] if size == 3 else []
    axes = [out, up, across] if size == 3 else [out, up]
    require_square((out, up), "out and up must be of length 1, at right angles")
    return Leg(told.base, axes, told.link, told.rod, told.offset, told.bend)


def legs_surplus(
    arm: Legs, need: list[list[Enclosed]]
) -> Callable[[Sequence[Enclosed]], list[list[Enclosed]]]:
    """δ − R at the hand, the rows from the diagonal on."""
    enclosed = [_enclosed(leg) for leg in arm.legs]
    damping = [[constant(x) for x in row] for row in arm.damping]

    def surplus(position: Sequence[Enclosed]) -> list[list[Enclosed]]:
        found = [[-r for r in row[i:]] for i, row in enumerate(need)]
        normals, levers = zip(*(_normal(leg, position) for leg in enclosed), strict=True)
        for (i, normal), (j, other) in product(enumerate(normals), repeat=2):
            if not arm.damping[i][j]:
                continue
            weight = _over_levers(arm.legs, levers, i, j) * damping[i][j]
            for r, row in enumerate(found):
                for k, c in enumerate(range(r, len(found))):
                    row[k] = row[k] + normal[r] * other[c] * weight
        return found

    return surplus


def _over_levers(legs: Sequence[Leg], levers: Sequence[Enclosed], i: int, j: int) -> Enclosed:
    """1/((n_i · e_i⊥)(n_j · e_j⊥)), from H²."""
    if i == j:
        return inverse(levers[i])
    both = inverse(root(levers[i]) * root(levers[j]))
    return both if legs[i].bend == legs[j].bend else -both


class _Enclosed(NamedTuple):
    """The numbers of a leg, as they meet the hand."""

    base: list[Enclosed]
    axes: list[list[Enclosed]]
    length: Enclosed  # rod and offset
    offset: Enclosed
    link_squared: Enclosed
    rod_squared: Enclosed
    bend: int


def _enclosed(leg: Leg) -> _Enclosed:
    return _Enclosed(
        [constant(x) for x in leg.base],
        [[constant(x) for x in axis] for axis in leg.axes],
        constant(leg.rod + leg.offset),
        constant(leg.offset),
        constant(leg.link**2),
        constant(leg.rod**2),
        leg.bend,
    )


def _normal(leg: _Enclosed, position: Sequence[Enclosed]) -> tuple[list[Enclosed], Enclosed]:
    """n, and H²."""
    seen = [p - a for p, a in zip(position, leg.base, strict=True)]
    u, w, *aside = (dot(seen, axis) for axis in leg.axes)
    length, across = leg.length, NOTHING
    if aside:
        straight = root(leg.rod_squared - aside[0] * aside[0])
        length = straight + leg.offset
        across = length * aside[0] * inverse(straight)
    distance = u * u + w * w
    a = (distance + leg.link_squared - length * length).over(2)
    lever = distance * leg.link_squared - a * a
    closer = inverse(distance)
    near, turned = a * closer, root(lever) * closer
    side = turned if leg.bend > 0 else -turned
    in_plane = [u - near * u + side * w, w - near * w - side * u]
    parts = [*in_plane, across][: len(leg.axes)]
    return [dot(parts, [axis[k] for axis in leg.axes]) for k in range(len(position))], lever
