"""Parts of the proof of an arm one by one, each against another way to the same numbers."""

from __future__ import annotations

import json
from fractions import Fraction
from itertools import combinations_with_replacement, product
from math import cos, pi, sin
from pathlib import Path
from typing import Any

from . import TINY, Case
from .parts import part, refuses

UNIT = [[Fraction(i == k) for k in range(3)] for i in range(3)]
SPACE = json.loads(Path(__file__).with_name("null_space.json").read_text(encoding="utf-8"))[
    "in pose in space"
]["document"]


def enclosed(middle: Any, slopes: tuple[int, ...] = (), radius: int = 0) -> Any:
    """A number in units of the last digit."""
    return part("exact.enclosed").Enclosed(part("arm.cells").BITS, middle, slopes, radius)


def what_cannot_be_computed_is_halved() -> str:
    """diag(1/x², 1/y²), where neither square is certainly above 0 in the whole box, but in parts of it."""
    cells, functions = part("arm.cells"), part("exact.enclosed")
    one = 1 << cells.BITS

    def matrix(at: Any) -> Any:
        x, y = (functions.inverse(v * v) for v in at)
        return [[x, enclosed(0)], [y]]

    found = cells.positive_in(((one, 3 * one), (one, 4 * one)), matrix)
    return "" if found > 4 else f"{found} cells"


def a_matrix_is_parted_to_the_last_digit() -> str:
    """Middles, radii and slopes, 0 where a number has none."""
    rows = [[enclosed(5), enclosed(3, (7, -1), 2)], [enclosed(4, (0, 9), 1)]]
    right = [[5, 3], [3, 4]], [[0, 2], [2, 1]], [[[0, 7], [7, 0]], [[0, -1], [-1, 9]]]
    found = part("arm.cells")._parted(rows, 2)
    return "" if found == right else f"{found}"


def what_is_nearly_a_rotation_is_let_through() -> str:
    """Up to 10⁻⁹ from right angles, and no farther."""
    chain = part("arm.kinematics")
    for off, right in ((TINY, False), (-TINY, False), (TINY * (1 + TINY), True), (-TINY * (1 + TINY), True)):
        if refuses(chain.require_square, [[1, 0, 0], [0, 1, 0], [off, 0, 1]], "") is not right:
            return f"{off} from a right angle"
    return ""


def roots_are_the_next_above() -> str:
    """In units of the last digit."""
    chain, unit = part("arm.kinematics"), Fraction(1, 1 << part("arm.cells").BITS)
    for x in (Fraction(2), Fraction(1, 3), Fraction(10**9 + 1, 7), Fraction(4, 7), Fraction(2, 9), unit / 3):
        root = chain.root_above(x)
        if not (root - unit) ** 2 <= x < root**2:
            return f"a root of {x}"
    return ""


def bends_are_what_lies_beyond_both_joints() -> str:
    """Of joints that turn and slide, with ranges to either side of 0: link by link, from the base."""
    chain = part("arm.kinematics")
    slides = [None, (-3, 2), None, (1, 4), None, (-5, -4)]
    lengths = [Fraction(x) for x in (9, 2, 4, 1, 6, 3)]
    joints = [
        chain.Joint(s is not None, UNIT, [x, 0, 0], *map(Fraction, s or (-7, 7)))
        for s, x in zip(slides, lengths, strict=True)
    ]
    found = chain.bends(chain.Chain(joints, [Fraction(8), 0, 0], []))
    for i, j in product(range(6), repeat=2):
        last = max(i, j)
        beyond = 8 + sum(lengths[last + 1 :]) + sum(max(map(abs, s)) for s in slides[last:] if s)
        right = (beyond, 1, 0)[(slides[i] is not None) + (slides[j] is not None)]
        if found[i][j] != right * chain.LONGER:
            return f"{found[i][j]} of {i} and {j}"
    return ""


def sizes_of_a_wall_are_those_of_its_blocks() -> str:
    """In the plane two coordinates and a turn: diag(1, 7) and 5, coupled by 2; damping diag(0, 3) and 1."""
    encoders, pose = part("arm.region"), part("arm.pose")
    stiffness, damping = (
        [[Fraction(x) for x in row] for row in rows]
        for rows in (([1, 0, 0], [0, 7, 2], [0, 2, 5]), ([0, 0, 0], [0, 3, 0], [0, 0, 1]))
    )
    found = encoders._sizes(stiffness, damping, Fraction(1, 2), pose.Pose(1, True))
    return "" if found == [[19, 2], [2, 9]] else f"{found}"


def a_range_is_rounded_outward() -> str:
    """Both ends by less than a unit of the last digit, and whole numbers not at all."""
    region, one = part("arm.region"), 1 << part("arm.cells").BITS
    for low, high in ((Fraction(1, 3), Fraction(2, 3)), (Fraction(-5, 7), Fraction(-1, 9)), (-2, 3)):
        found = region.outward(Fraction(low), Fraction(high))
        if not 0 <= low * one - found[0] < 1 or not 0 <= found[1] - high * one < 1:
            return f"{low} to {high}"
    return ""


def matrices_of_a_wall_are_of_one_size() -> str:
    """And symmetric, each with as many columns as rows."""
    region, none = part("arm.region"), part("arm.pose").Pose(0, False)
    for sizes in product((1, 2, 3), repeat=3):
        zeros = ([[Fraction(0)] * size for _ in range(size)] for size in sizes)
        wall = dict(zip(("stiffness", "virtual_damping", "damping_bound"), zeros, strict=True))
        if refuses(region.matrices_of, type("Wall", (), wall), none) is not (len(set(sizes)) > 1):
            return f"{sizes}"
    for rows in ([[1, 0, 0], [0, 1, 0]], [[1], [0]], [[1, 2], [1, 4]], [[1, 1], [2, 4]], [[0] * 4] * 4):
        if not refuses(region._symmetric, rows, none.sizes):
            return f"{rows}"
    return ""


def links(number: type = Fraction) -> Any:
    """Four joints that turn, in space, in exact numbers or in doubles."""
    chain, told = part("arm.kinematics"), SPACE["arm"]
    joints = [
        chain.Joint(
            False,
            [[number(Fraction(x)) for x in row] for row in joint["rotation"]],
            [number(Fraction(x)) for x in joint["translation_m"]],
            Fraction(-1),
            Fraction(1),
        )
        for joint in told["joints"]
    ]
    return chain.Chain(joints, [number(Fraction(x)) for x in told["end_m"]], [])


def derived(chain: Any, at: list[float], times: list[int], axis: int | None = None) -> list[float]:
    """The hand's point, or the axis of a joint, derived so many times after each joint: every derivative of
    a turn is another quarter of a turn, of what is at right angles to the axis."""
    if axis is not None and any(times[axis:]):
        return [0.0] * 3  # it turns with the joints before it
    v = chain.end if axis is None else [0.0, 0.0, 1.0]
    for i in reversed(range(len(at) if axis is None else axis + 1)):
        joint, angle = chain.joints[i], at[i] + times[i] * pi / 2
        if i != axis:
            s, c = sin(angle), cos(angle)
            v = [c * v[0] - s * v[1], s * v[0] + c * v[1], v[2] * (times[i] == 0)]
        v = [sum(r * x for r, x in zip(row, v, strict=True)) for row in joint.rotation]
        if axis is None and not any(times[i:]):
            v = [x + t for x, t in zip(v, joint.translation, strict=True)]
    return v


def vector_products_are_derivatives() -> str:
    """Of the columns of J, once and twice, against derivatives of the matrices of the joints."""
    projector, pose, chain, one = (
        part("arm.null_space"),
        part("arm.pose"),
        links(),
        1 << part("arm.cells").BITS,
    )
    numbers, at = links(float), [0.3, -0.7, 1.1, 0.4]
    joints = [enclosed(int(x * one)) for x in at]
    columns, axes = part("arm.kinematics").jacobian(chain, 3)(joints), pose.axes_of(chain)(joints)
    for size in ((2, 1), (3, 3)):
        place = projector.Place(chain, columns, axes, *size, [0, 1, 2, 3])
        for count in (1, 2):
            for after in combinations_with_replacement(range(4), count):
                found = (projector._first, projector._second)[count - 1](place, *after)
                for i, column in enumerate(found):
                    times = [after.count(k) for k in range(4)]
                    point = derived(numbers, at, [n + (k == i) for k, n in enumerate(times)])
                    right = [*point[: size[0]], *derived(numbers, at, times, i)[3 - size[1] :]]
                    off = [abs(x.middle / one - y) for x, y in zip(column, right, strict=True)]
                    if max(off) > 1e-9:
                        return f"column {i} after {after}"
    return ""


def third_derivatives_are_bounded() -> str:
    """Of a row W = (3, 4, 0 | 0, 5, 12): lengths 5 and 13, and every four joints counted by their last."""
    projector, chain = part("arm.null_space"), links()
    beyond = [row[i] for i, row in enumerate(part("arm.kinematics").bends(chain))]
    count = len(beyond)
    moved = sum(((k + 1) ** 4 - k**4) * r * r for k, r in enumerate(beyond))
    turned = sum(k**3 for k in range(count))
    rows = [[enclosed(x << part("arm.cells").BITS) for x in (3, 4, 0, 0, 5, 12)]]
    for turns, length in ((0, 0), (3, 13)):
        place = projector.Place(chain, [], [], 3, turns, list(range(count)))
        found = projector._third(place, [row[: 3 + turns] for row in rows])
        right = (5 * float(moved) ** 0.5 + length * turned**0.5) / 6
        if not right * (1 - 1e-12) <= found <= right * 1.001:
            return f"{float(found)}, not {right}, with {turns} turns"
    return ""


CHECKS = (
    what_cannot_be_computed_is_halved,
    a_matrix_is_parted_to_the_last_digit,
    what_is_nearly_a_rotation_is_let_through,
    roots_are_the_next_above,
    bends_are_what_lies_beyond_both_joints,
    sizes_of_a_wall_are_those_of_its_blocks,
    a_range_is_rounded_outward,
    matrices_of_a_wall_are_of_one_size,
    vector_products_are_derivatives,
    third_derivatives_are_bounded,
)

CASES = [Case(check.__name__.replace("_", " "), check, "") for check in CHECKS]
