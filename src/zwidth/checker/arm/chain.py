"""A chain of joints: p(q) from the numbers of the document, and δ_m − JᵀRJ with its slopes.

From the end to the base, each joint turns or slides along the z axis of its own frame:

    p_i = t_i + C_i (Rot_z(q_i) p_{i+1}    or    p_{i+1} + q_i ẑ)
    ∂p_i/∂q_i = C_i (ẑ × Rot_z(q_i) p_{i+1}    or    ẑ)

The proof takes p as it stands here, C_i need not be a rotation to the last digit. To bound its second
derivatives by lengths, |∂²p/∂q_i∂q_j| ≤ what lies beyond both joints, it must nearly be one.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from math import isqrt
from typing import Any, NamedTuple

from ..document.reading import Invalid, get, number, numbers
from ..exact.enclosure import NOTHING, ONE, Jet, Range, enclosed, sine_cosine, total

MOST_JOINTS = 16
NEARLY = Fraction(1, 10**9)
LONGER = 1 + Fraction(1, 10**6)
"""What 16 matrices that are nearly rotations can lengthen, and more."""


class Joint(NamedTuple):
    slides: bool
    rotation: list[list[Fraction]]
    translation: list[Fraction]
    damping: Fraction
    low: Fraction
    high: Fraction


class Chain(NamedTuple):
    joints: list[Joint]
    end: list[Fraction]


def read_chain(arm: Mapping[str, Any]) -> Chain:
    listed = get(arm, "joints")
    if not isinstance(listed, list) or not 1 <= len(listed) <= MOST_JOINTS:
        raise Invalid(f"a chain has from 1 to {MOST_JOINTS} joints")
    return Chain([_joint(entry) for entry in listed], vector(get(arm, "end_m"), 3))


def _joint(entry: Mapping[str, Any]) -> Joint:
    kind = get(entry, "kind")
    if kind not in ("revolute", "prismatic"):
        raise Invalid("a joint is revolute or prismatic")
    slides = kind == "prismatic"
    rows = get(entry, "rotation")
    if not isinstance(rows, list) or len(rows) != 3:
        raise Invalid("a rotation has three rows")
    rotation = [vector(row, 3) for row in rows]
    for i, a in enumerate(rotation):
        for j, b in enumerate(rotation):
            if abs(sum((x * y for x, y in zip(a, b, strict=True)), Fraction(-(i == j)))) > NEARLY:
                raise Invalid("a rotation is not one")
    unit, per = ("m", "N_s_per_m") if slides else ("rad", "N_m_s_per_rad")
    low, high = number(get(entry, f"low_{unit}")), number(get(entry, f"high_{unit}"))
    damping = number(get(entry, f"damping_{per}"))
    if low > high or damping < 0:
        raise Invalid("a joint needs low ≤ high and damping ≥ 0")
    return Joint(slides, rotation, vector(get(entry, "translation_m"), 3), damping, low, high)


def vector(values: Any, size: int) -> list[Fraction]:
    found = numbers(values, size)
    if len(found) != size:
        raise Invalid(f"expected {size} coordinates")
    return found


def chain_surplus(
    chain: Chain,
    need: list[list[Range]],
    price: Fraction,
    turning: Callable[[Sequence[Jet]], list[list[Jet]]] | None = None,
) -> Callable[[Sequence[Jet]], list[list[Jet]]]:
    """δ_m − c − JᵀRJ, its rows from the diagonal on; R of the hand's first coordinates, c of every joint.
    `turning` gives what comes after the point in each column of J."""
    fixed = [
        ([[enclosed(x) for x in row] for row in j.rotation], [Jet(enclosed(x)) for x in j.translation])
        for j in chain.joints
    ]
    own = [Jet(enclosed(joint.damping - price)) for joint in chain.joints]
    end = [Jet(enclosed(x)) for x in chain.end]

    def surplus(joints: Sequence[Jet]) -> list[list[Jet]]:
        point, columns = end, list[list[Jet]]()
        for joint, q, (rotation, translation) in reversed(
            list(zip(chain.joints, joints, fixed, strict=True))
        ):
            vectors = _moved(joint.slides, q, point, columns)
            point, *columns = [
                [total([x.scaled(c) for x, c in zip(v, row, strict=True)]) for row in rotation]
                for v in vectors
            ]
            point = [x + t for x, t in zip(point, translation, strict=True)]
        turned = turning(joints) if turning else [[] for _ in joints]
        columns = [
            [*column[: len(need) - len(more)], *more] for column, more in zip(columns, turned, strict=True)
        ]
        loads = [[total([x.scaled(r) for x, r in zip(v, row, strict=True)]) for row in need] for v in columns]
        return [
            [
                (own[i] if k == 0 else NOTHING) - total([x * y for x, y in zip(v, load, strict=True)])
                for k, load in enumerate(loads[i:])
            ]
            for i, v in enumerate(columns)
        ]

    return surplus


def _moved(slides: bool, q: Jet, point: list[Jet], columns: list[list[Jet]]) -> list[list[Jet]]:
    """The point, the column of this joint and those beyond it, before the joint's own placement."""
    if slides:
        return [[point[0], point[1], point[2] + q], [NOTHING, NOTHING, Jet((ONE, ONE))], *columns]
    sine, cosine = sine_cosine(q.value)
    s = Jet(sine, dict.fromkeys(q.slopes, cosine))
    c = Jet(cosine, dict.fromkeys(q.slopes, (-sine[1], -sine[0])))
    turned = [[v[0] * c - v[1] * s, v[0] * s + v[1] * c, v[2]] for v in (point, *columns)]
    x, y, _ = turned[0]
    return [turned[0], [-y, x, NOTHING], *turned[1:]]


def levers(chain: Chain) -> Callable[[Sequence[Jet]], list[Jet]]:
    """The square of the hand's distance from the axis of each joint, which only the joints beyond it change:
    |∂p/∂q_i|² of one that turns, but for the lengths of what only nearly rotates."""
    fixed = [
        ([[enclosed(x) for x in row] for row in j.rotation], [Jet(enclosed(x)) for x in j.translation])
        for j in chain.joints
    ]
    end = [Jet(enclosed(x)) for x in chain.end]

    def squares(joints: Sequence[Jet]) -> list[Jet]:
        point, found = end, list[Jet]()
        for joint, q, (rotation, translation) in reversed(
            list(zip(chain.joints, joints, fixed, strict=True))
        ):
            found.insert(0, point[0].squared() + point[1].squared())
            moved = _moved(joint.slides, q, point, [])[0]
            placed = [total([x.scaled(c) for x, c in zip(moved, row, strict=True)]) for row in rotation]
            point = [x + t for x, t in zip(placed, translation, strict=True)]
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
    return Fraction(isqrt(int(sum(x * x for x in v) * ONE * ONE) + 1) + 1, ONE)
