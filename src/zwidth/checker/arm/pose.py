"""A hand in pose: beside where it is, how far it has turned from the wall's orientation of rest.

    y = (p, e),    e = 2 v,    (w, v) = Q(q) ⊗ Q(q₀)⁻¹,    Q = Π c_i ⊗ (cos q_i/2, ẑ sin q_i/2)
    ∂e/∂q_i = E a_i,    EᵀE = 1 − v vᵀ ⪯ 1

c_i is the unit quaternion of the placement of joint i, a_i the axis of joint i in the base; a joint that
slides has 0 here. Where the rest q₀ is given the columns of J are those of e. For every orientation of rest
they are the axes alone: with no coupling of forces and turns in R and R_e ⪯ ρ·1,

    JᵀRJ ⪯ J_pᵀ R_p J_p + ρ J_ωᵀ J_ω

In the plane y = (x, y, Σ q_i): the derivative is constant, and the rest plays no part.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from fractions import Fraction
from typing import NamedTuple

from ..document.fields import Read
from ..document.number import about
from ..document.refusal import Invalid, only_if
from ..exact.enclosed import Enclosed, dot, inverse, mapped, root, sine_cosine
from .cells import Matrix, constant
from .kinematics import NOTHING, UNIT, Chain, about_z, from_end

Columns = Callable[[Sequence[Enclosed]], list[list[Enclosed]]]


class Pose(NamedTuple):
    turns: int  # coordinates of the wall, the last ones, that are rotations
    anywhere: bool

    @property
    def sizes(self) -> range:
        """How many coordinates the wall may have."""
        return {0: range(1, 4), 1: range(3, 4), 3: range(6, 7)}[self.turns]


def pose_of(wall: Read) -> Pose:
    """What of the wall of a document is rotation."""
    if not hasattr(wall, "turns"):
        return Pose(0, False)
    if wall.turns == 1 and wall.rest == "given":
        raise Invalid("a wall rests in every orientation; in space one may be given")
    return Pose(wall.turns, wall.rest == "every orientation")


def in_words(stiffness: Matrix, pose: Pose) -> str:
    """Of a matrix without negative eigenvalues no entry is above the largest of the diagonal."""
    if not pose.turns:
        return ""
    diagonal = [row[i] for i, row in enumerate(stiffness)]
    along, around = (about(max(part)) for part in (diagonal[: -pose.turns], diagonal[-pose.turns :]))
    where = "in every orientation of rest" if pose.anywhere else "from the orientation of rest that is given"
    return f"; the wall is in pose, with up to {along} N/m and {around} N·m/rad, {where}"


def for_every_rest(need: Matrix, pose: Pose) -> Matrix:
    """R with ρ·1 in the place of its rotations: ρ is the largest sum of a row, no eigenvalue is larger."""
    if pose.turns != 3 or not pose.anywhere:
        return need
    point = len(need) - 3
    if any(any(row[point:]) for row in need[:point]):
        raise Invalid("a wall that couples forces and turns has one orientation of rest")
    most = max(sum(map(abs, row), Fraction(0)) for row in need[point:])
    last = [[most if k == i else Fraction(0) for k in range(point + 3)] for i in range(point, point + 3)]
    return [*need[:point], *last]


def turning(machine: Read, chain: Chain, pose: Pose) -> Columns:
    """The rows of rotation of every column of J; `chain` is what `chain_of` found in `machine`."""
    if pose.turns == 1:
        if any(j.slides or j.rotation[2] != [0, 0, 1] for j in chain.joints):
            raise Invalid("in the plane every joint turns about the same axis")
        return lambda joints: [[UNIT] for _ in joints]
    placed = [_quaternion(j.rotation) for j in chain.joints]
    if pose.anywhere:
        return _axes(chain, placed)
    rest = [
        Fraction(0) if joint.slides else only_if(True, entry.rest, "rest_rad")
        for joint, entry in zip(chain.joints, machine.joints, strict=True)
    ]
    return _from_rest(chain, placed, rest)


def square(chain: Chain) -> Chain:
    """The chain with rotations that are rotations to the last digit."""
    joints = [joint._replace(rotation=_rotation(_quaternion(joint.rotation))) for joint in chain.joints]
    return chain._replace(joints=joints)


def axes_of(chain: Chain) -> Columns:
    """The axis of each joint in the base."""
    return _axes(chain, [_quaternion(joint.rotation) for joint in chain.joints])


def turning_bend(chain: Chain, pose: Pose) -> Fraction:
    """h_e with |Σ ∂²e/∂q_i∂q_j w_i w_j| ≤ h_e |w|²: each second derivative is at most ½ long."""
    return Fraction(sum(not j.slides for j in chain.joints), 2) if pose.turns == 3 else Fraction(0)


def _axes(chain: Chain, placed: Sequence[list[Fraction]]) -> Columns:
    """a_i, from the end to the base; 0 of a joint that slides."""
    rotations = [[[constant(x) for x in row] for row in _rotation(c)] for c in placed]

    def columns(joints: Sequence[Enclosed]) -> list[list[Enclosed]]:
        found: list[list[Enclosed]] = []
        for joint, q, rotation in from_end(chain.joints, joints, rotations):
            if joint.slides:
                own = NOTHING
            else:
                own, found = UNIT, about_z(q, found)
            found = [mapped(rotation, v) for v in ([NOTHING, NOTHING, own], *found)]
        return found

    return columns


def _from_rest(chain: Chain, placed: Sequence[list[Fraction]], rest: Sequence[Fraction]) -> Columns:
    """∂e/∂q_i = the vector of 2 ∂Q/∂q_i ⊗ Q(q₀)⁻¹, from the end to the base."""
    matrices = [_times_quaternion(c) for c in placed]

    def turned(joints: Sequence[Enclosed], end: list[Enclosed]) -> list[list[Enclosed]]:
        """Q ⊗ end, and twice its derivatives."""
        found = [end]
        for joint, q, matrix in from_end(chain.joints, joints, matrices):
            if joint.slides:
                own = [NOTHING] * 4
            else:
                s, c = sine_cosine(q.over(2))
                found = [_about_third(v, s, c) for v in found]
                w, x, y, z = found[0]
                own = [-z, -y, x, w]
            found = [mapped(matrix, v) for v in (found[0], own, *found[1:])]
        return found

    w, *v = turned([constant(q) for q in rest], [UNIT, NOTHING, NOTHING, NOTHING])[0]
    resting = [w, *(-x for x in v)]
    return lambda joints: [column[1:] for column in turned(joints, resting)[1:]]


def _about_third(v: Sequence[Enclosed], s: Enclosed, c: Enclosed) -> list[Enclosed]:
    """(c + ẑ s) ⊗ v."""
    back, on = (c, -s), (c, s)
    return [dot((v[0], v[3]), back), dot((v[1], v[2]), back), dot((v[2], v[1]), on), dot((v[3], v[0]), on)]


def _quaternion(r: Matrix) -> list[Fraction]:
    """Along the unit quaternion c of a rotation: the largest row of 4 c cᵀ, which is linear in it."""
    (a, b, c), (d, e, f), (g, h, i) = r
    if a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g) < 0:
        raise Invalid("a rotation must not mirror")
    rows = [
        [1 + a + e + i, h - f, c - g, d - b],
        [h - f, 1 + a - e - i, b + d, c + g],
        [c - g, b + d, 1 - a + e - i, f + h],
        [d - b, c + g, f + h, 1 - a - e + i],
    ]
    return rows[max(range(4), key=lambda k: rows[k][k])]


def _rotation(quaternion: list[Fraction]) -> Matrix:
    """The rotation of a quaternion of any length, without rounding."""
    w, x, y, z = quaternion
    size = w * w + x * x + y * y + z * z
    rows = [
        [w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), w * w - x * x + y * y - z * z, 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z],
    ]
    return [[entry / size for entry in row] for row in rows]


def _times_quaternion(quaternion: list[Fraction]) -> list[list[Enclosed]]:
    """c ⊗ as a matrix, with c made a unit."""
    shorter = inverse(root(constant(sum((x * x for x in quaternion), Fraction(0)))))
    w, x, y, z = (constant(part) * shorter for part in quaternion)
    return [[w, -x, -y, -z], [x, w, -z, y], [y, z, w, -x], [z, -y, x, w]]
