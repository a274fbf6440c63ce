"""The spring of the joints in the null space of the hand, beside a wall: near its rest friction covers it.

    τ = −P(q_k) (k (q_k − q_d) + d_n (q_k − q_{k−1})/T),  held,    P = 1 − Jᵀ (J Jᵀ + λ²)⁻¹ J

    δ_m ≻ JᵀRJ + (2d + 1) T/2 k P₀ + d_n (P₀ + η 1)    and    f_c,i ≥ k |((P − P₀)(q − q_d))_i|

wherever the joints are in their ranges and |q − q_d| ≤ ρ, root of the sum of squares.  P₀ = P(q_d) and
η ≥ ‖P − P₀‖.  J is of velocity, and in pose of angular velocity; the rotations of the document are made
rotations to the last digit.  Joints turn: lengths and angles have no common root of a sum.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from fractions import Fraction
from itertools import product
from typing import NamedTuple

from ..document.fields import Number, Read, Record, Whole, document, numbers
from ..document.number import SECONDS, about, always, up
from ..document.refusal import Invalid, only_if
from ..exact.enclosed import Enclosed, NotPositive, dot, inverse, mapped
from .cells import BITS, Function, Matrix, constant, positive, positive_in
from .kinematics import (
    CHAIN,
    MOST_JOINTS,
    NOTHING,
    UNIT,
    Chain,
    bends,
    chain_of,
    chain_surplus,
    jacobian,
    root_above,
)
from .pose import axes_of, for_every_rest, in_words, pose_of, square, turning
from .region import MOST_DELAY, WALL, matrices_of, need_of, outward, require_no_rest

NULL_SPACE = document(
    {
        "arm": CHAIN,
        "wall": WALL,
        "loop": Record(
            {"sample_period": Number(SECONDS, above=0), "delay_samples": Whole(least=0, most=MOST_DELAY)}
        ),
        "spring": Record(
            {
                "stiffness": Number(always("N_m_per_rad"), least=0),
                "damping": Number(always("N_m_s_per_rad"), least=0),
                "rest": numbers(always("rad"), least=1, most=MOST_JOINTS),
                "regularization": Number(least=0),
                "distance": Number(always("rad"), above=0),
            },
            named=True,
        ),
    }
)


def null_space(told: Read) -> tuple[str, tuple[tuple[float, ...], ...]]:
    """What was proved; and what the joints have beyond what is asked of them in the middle of the region."""
    machine, wall, loop, spring = told.arm, told.wall, told.loop, told.spring
    friction = [_friction_of(joint) for joint in machine.joints]
    pose, chain = pose_of(wall), square(chain_of(machine))
    _require_rest(chain, spring.rest)
    given = matrices_of(wall, pose)
    size = len(given[0]) - pose.turns
    around = near(
        chain, axes_of(chain), (size, pose.turns), spring.rest, spring.regularization, spring.distance
    )
    _require_friction(chain, friction, around, spring)
    if pose.turns != 3 or pose.anywhere:
        require_no_rest(machine)
    need = [[constant(x) for x in row] for row in for_every_rest(need_of(*given, loop), pose)]
    left = chain._replace(damping=_left(chain.damping, around, loop, spring))
    turned = turning(machine, chain, pose) if pose.turns else None
    matrix = _of_moving(chain, chain_surplus(left, need, Fraction(0), turned))
    box = tuple(outward(low, high) for low, high in _box(chain, spring))
    cells = positive_in(box, matrix)
    middle = matrix([Enclosed(BITS, (low + high) // 2) for low, high in box])
    words = (
        "no hands, wherever they hold the arm, take energy out of the wall and the null-space spring while "
        f"the joints are in their ranges and within {about(spring.distance)} rad of its rest, root of the "
        "sum of squares; read without encoder steps; the wall's torque follows the arm, the spring's is "
        f"held{in_words(given[0], pose)}; {cells} cell{'s' * (cells != 1)}"
    )
    return words, tuple(tuple(x.middle / 2**BITS for x in row) for row in middle)


def _friction_of(joint: Read) -> Fraction:
    if joint.kind == "prismatic":
        raise Invalid("a null-space spring is proved of joints that turn")
    for name in ("resolution", "largest_column"):
        only_if(False, getattr(joint, name), name)
    friction: Fraction = only_if(True, joint.coulomb_friction, "coulomb_friction")
    return friction


def _require_rest(chain: Chain, rest: Sequence[Fraction]) -> None:
    if len(rest) != len(chain.joints):
        raise Invalid("the rest of the null-space spring has a number for each joint")
    for i, (joint, at) in enumerate(zip(chain.joints, rest, strict=True), start=1):
        if not joint.low <= at <= joint.high:
            raise Invalid(f"the null-space spring must rest in the range of joint {i}")


def _require_friction(chain: Chain, friction: Sequence[Fraction], around: Near, spring: Read) -> None:
    """Of the joints that move."""
    for i, (joint, own, lack) in enumerate(zip(chain.joints, friction, around.lacks, strict=True), start=1):
        if joint.low < joint.high and own < spring.stiffness * lack:
            least = up(spring.stiffness * lack)
            raise Invalid(f"Coulomb friction of joint {i} must be at least {least} for the null-space spring")


def _left(damping: Matrix, around: Near, loop: Read, spring: Read) -> Matrix:
    """δ_m − (2d + 1) T/2 k P₀ − d_n (P₀ + η 1), from below: what P₀ is known within goes to the diagonal."""
    share = (2 * loop.delay_samples + 1) * loop.sample_period / 2 * spring.stiffness + spring.damping
    unknown = sum(x.radius for row in around.inside for x in row)
    more = share * Fraction(unknown, 2**BITS) + spring.damping * around.change
    return [
        [
            own - share * Fraction(x.middle, 2**BITS) - (more if i == k else 0)
            for k, (own, x) in enumerate(zip(row, inside, strict=True))
        ]
        for i, (row, inside) in enumerate(zip(damping, around.inside, strict=True))
    ]


def _of_moving(chain: Chain, matrix: Function) -> Function:
    """The same of the joints that move: no motion has a speed of the others."""
    free = [i for i, joint in enumerate(chain.joints) if joint.low < joint.high]

    def found(joints: Sequence[Enclosed]) -> list[list[Enclosed]]:
        rows = matrix(joints)
        return [[rows[i][k - i] for k in free if k >= i] for i in free]

    return found


def _box(chain: Chain, spring: Read) -> list[tuple[Fraction, Fraction]]:
    """The ranges as far as they are within the distance."""
    return [
        (max(joint.low, at - spring.distance), min(joint.high, at + spring.distance))
        for joint, at in zip(chain.joints, spring.rest, strict=True)
    ]


# How far the projector on motions that leave the hand is from what it is at one place, in a ball around it.
#
#     P = 1 − Jᵀ (J Jᵀ + λ²)⁻¹ J,    W = J₀⁺,    F = W (J − J₀),    Q₀ = W J₀ = 1 − P₀
#     Z = (1 + F Q₀)⁻¹ F P₀,    ker J = {v − Z v : v of ker J₀}
#     (P − P₀) e = −Z u + (u − c),    u = (1 + ZᵀZ)⁻¹ (c − Zᵀa),    a = Q₀ e,  c = P₀ e
#
# With λ > 0 all this is of the matrix (J  λ1), whose projector has P for its first rows and columns.  To
# first order in e, Z is Y₁ = F₁[e] P₀, and the torque's lack (P − P₀) e is −Y₁ c − Y₁ᵀ a, one quadratic form
# of e for each joint; what is left is bounded by norms.  Joints turn, so that derivatives are vector
# products: ∂_j J_i = a_min × J_max of the hand's point, ∂_j a_i = a_j × a_i for j < i, and so on.


Vector = list[Enclosed]
Rows = list[Vector]
HALVINGS = 12
"""Of what a norm may be: a part in 4096."""


class Near(NamedTuple):
    """What the projector is within a distance of a place.

    Parameters
    ----------
    inside
        P₀, of the joints.
    change
        Not below ‖P − P₀‖.
    lacks
        Of each joint: not below |((P − P₀) e)_i| [rad].
    """

    inside: Rows
    change: Fraction
    lacks: list[Fraction]


class Place(NamedTuple):
    """The arm at the middle of the ball."""

    chain: Chain
    points: Rows  # ∂p/∂q_i
    axes: Rows
    point: int  # coordinates of the hand that are of its point
    turns: int  # and of its turn: 0, the third, or all three
    moving: list[int]

    def of_hand(self, point: Vector, turn: Vector) -> Vector:
        """The coordinates that the projector knows."""
        return [*point[: self.point], *turn[3 - self.turns :]]


def near(
    chain: Chain, axes: Callable[[Sequence[Enclosed]], Rows], size: tuple[int, int],
    at: list[Fraction], regularization: Fraction, distance: Fraction,
) -> Near:  # fmt: skip
    """Bounds within a distance of a place, in joints of which those without a range stay."""
    joints = [constant(x) for x in at]
    moving = [i for i, joint in enumerate(chain.joints) if joint.low < joint.high]
    place = Place(chain, jacobian(chain, 3)(joints), axes(joints), *size, moving)
    here = [place.of_hand(p, a) for p, a in zip(place.points, place.axes, strict=True)]  # its columns
    extra = constant(regularization)
    whole = [*here, *_times_unit(extra, len(here[0]))]
    back = _inverse(whole)
    row_space = [[dot(w, column) for column in whole] for w in back]
    inside = [[(UNIT - x if i == k else -x) for k, x in enumerate(row)] for i, row in enumerate(row_space)]
    return _bounded(place, back, inside, row_space, distance)


def _times_unit(x: Enclosed, size: int) -> Rows:
    return [[x if i == k else NOTHING for k in range(size)] for i in range(size)]


def _inverse(columns: Rows) -> Rows:
    """The rows of W = Jᵀ(J Jᵀ)⁻¹, of J by its columns."""
    rows = [list(row) for row in zip(*columns, strict=True)]
    gram = [[dot(a, b) for b in rows] for a in rows]
    whole = [[*g, *unit] for g, unit in zip(gram, _times_unit(UNIT, len(rows)), strict=True)]
    for k, row in enumerate(whole):  # Gauss and Jordan, without a change of rows: J Jᵀ ≻ 0
        try:
            shorter = inverse(row[k])
        except NotPositive:
            raise Invalid("at the rest of the null-space spring the arm is singular") from None
        whole[k] = pivot = [x * shorter for x in row]
        for i, other in enumerate(whole):
            if i != k:
                factor = other[k]
                whole[i] = [x - factor * y for x, y in zip(other, pivot, strict=True)]
    solved = [row[len(rows) :] for row in whole]
    return [mapped(solved, column) for column in columns]


def _bounded(place: Place, back: Rows, inside: Rows, row_space: Rows, far: Fraction) -> Near:
    free, joints = place.moving, range(len(place.chain.joints))
    here = [[inside[i][k] for k in joints] for i in joints]
    if not free:
        return Near(here, Fraction(0), [Fraction(0) for _ in joints])
    first = [_seen(back, _first(place, j)) for j in free]
    pairs = {(k, j): _seen(back, _second(place, k, j)) for k in free for j in free if k <= j}
    rest = _third(place, back) * far**3
    y_1 = [_after(f, inside) for f in first]
    y, x = (
        far * _norm([[_after(f, side)] for f in first])
        + far**2 / 2 * _norm(_of_pairs({pair: _after(f, side) for pair, f in pairs.items()}, free))
        + rest
        for side in (inside, row_space)
    )
    if x >= 1:
        raise Invalid("the region is too large: in it the arm may become singular")
    z = y / (1 - x)
    left = y - far * _norm([[t] for t in y_1]) + x * z  # ‖Z − Y₁‖
    outer, inner = left + z**3, z**2 + z**4
    along = far * root_above(outer**2 + z**4)
    across = far * root_above(outer**2 + inner**2)
    lacks = [
        _form(y_1, i, free) * far**2 + _root(row_space[i][i]) * along + _root(inside[i][i]) * across
        for i in joints
    ]
    return Near(here, z, lacks)


def _first(place: Place, j: int) -> Rows:
    """The columns of ∂J/∂q_j."""
    p, a = place.points, place.axes
    return [
        place.of_hand(_cross(a[min(i, j)], p[max(i, j)]), _cross(a[j], a[i]) if j < i else [NOTHING] * 3)
        for i in range(len(p))
    ]


def _second(place: Place, low: int, high: int) -> Rows:
    """The columns of ∂²J/∂q_low∂q_high, low ≤ high."""
    p, a = place.points, place.axes
    found = []
    for i in range(len(p)):
        one, two, three = sorted((low, high, i))
        turn = _cross(a[low], _cross(a[high], a[i])) if high < i else [NOTHING] * 3
        found.append(place.of_hand(_cross(a[one], _cross(a[two], p[three])), turn))
    return found


def _third(place: Place, back: Rows) -> Fraction:
    """‖W_p‖/6 (Σ r²)^½ + ‖W_e‖/6 (Σ 1)^½: of third derivatives of J along e, for |e| = 1.

    r bounds what lies beyond the last of the four joints; an axis turns with the joints before it.
    """
    reach = bends(place.chain)
    free, all_joints = place.moving, range(len(place.chain.joints))
    last = [(max(triple), i) for triple in product(free, repeat=3) for i in all_joints]
    moved = sum((reach[max(pair)][max(pair)] ** 2 for pair in last), Fraction(0))
    turned = sum(before < i for before, i in last)
    point, turn = ([row[part] for row in back] for part in (slice(place.point), slice(place.point, None)))
    total = _norm([[point]]) * root_above(moved)
    if place.turns == 3:
        total += _norm([[turn]]) * root_above(Fraction(turned))
    return total / 6


def _cross(a: Vector, b: Vector) -> Vector:
    return [
        dot((a[1], a[2]), (b[2], -b[1])), dot((a[2], a[0]), (b[0], -b[2])), dot((a[0], a[1]), (b[1], -b[0])),
    ]  # fmt: skip


def _seen(back: Rows, columns: Rows) -> Rows:
    """W times a matrix given by its columns, that of the joints: the rest of (J  λ1) does not change."""
    return [[dot(w, column) for column in columns] for w in back]


def _after(rows: Rows, side: Rows) -> Rows:
    """F times P₀ or Q₀, of which F meets the first rows."""
    columns = list(zip(*side[: len(rows[0])], strict=True))
    return [[dot(row, column) for column in columns] for row in rows]


def _of_pairs(pairs: dict[tuple[int, int], Rows], free: list[int]) -> list[list[Rows]]:
    return [[pairs[min(k, j), max(k, j)] for j in free] for k in free]


def _form(y_1: list[Rows], i: int, moving: list[int]) -> Fraction:
    """The largest |eᵀB e| of |e| = 1, B_jb = −(Y_j,ib + Y_j,bi)."""
    half = [[(y[i][b] + y[b][i]) for b in moving] for y in y_1]
    even = [[(half[j][b] + half[b][j]).over(2) for b in range(j, len(half))] for j in range(len(half))]
    return max(_largest(even), _largest([[-x for x in row] for row in even]))


def _norm(layers: list[list[Rows]]) -> Fraction:
    """Not below |Σ e_k e_j T_kj v| for |e| = |v| = 1: T laid out by its rows, or by k; or of one T alone."""
    rows = range(len(layers[0][0]))
    laid_out = [[[x for layer in layers for t in layer for x in t[i]] for i in rows]]
    laid_out.append([[x for t in layer for row in t for x in row] for layer in layers])
    grams = ([[dot(a, b) for b in lines[i:]] for i, a in enumerate(lines)] for lines in laid_out)
    return root_above(min(map(_largest, grams)))


def _largest(upper: Rows) -> Fraction:
    """Not below the largest eigenvalue of a symmetric matrix, from the diagonal on, nor below 0."""
    size = range(len(upper))
    full = [[upper[min(i, k)][abs(i - k)] for k in size] for i in size]
    high = max(sum(_most(x) for x in row) for row in full)
    low = 0
    for _ in range(HALVINGS):
        middle = (low + high) // 2
        shift = Enclosed(BITS, middle)
        if positive([[shift - row[0], *(-x for x in row[1:])] for row in upper]):
            high = middle
        else:
            low = middle
    return Fraction(high, 1 << BITS)


def _root(x: Enclosed) -> Fraction:
    return root_above(Fraction(_most(x), 1 << BITS))


def _most(x: Enclosed) -> int:
    return abs(x.middle) + x.reach
