"""The spring of the joints in the null space of the hand, beside a wall: near its rest friction covers it.

    τ = −P(q_k) (k (q_k − q_d) + d_n (q_k − q_{k−1})/T),  held,    P = 1 − Jᵀ (J Jᵀ + λ²)⁻¹ J

    δ_m ≻ JᵀRJ + (2d + 1) T/2 k P₀ + d_n (P₀ + η 1)    and    f_c,i ≥ k |((P − P₀)(q − q_d))_i|

wherever the joints are in their ranges and |q − q_d| ≤ ρ, root of the sum of squares.  P₀ = P(q_d) and
η ≥ ‖P − P₀‖.  J is of velocity, and in pose of angular velocity; the rotations of the document are made
rotations to the last digit.  Joints turn: lengths and angles have no common root of a sum.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

from ..document.fields import Number, Read, Record, Whole, document, numbers, only_if
from ..document.number import about, up
from ..document.refusal import Invalid
from ..document.unit import SECONDS, always
from ..exact.enclosed import Enclosed
from .cells import BITS, Function, positive_in
from .chain import CHAIN, MOST_JOINTS, Chain, chain_of, chain_surplus
from .damping import Matrix, constant
from .pose import axes_of, for_every_rest, in_words, pose_of, square, turning
from .projector import Near, near
from .region import MOST_DELAY, WALL, matrices_of, need_of, outward, require_no_rest

NULL_SPACE = document(
    {
        "arm": CHAIN,
        "wall": WALL,
        "loop": Record(
            {
                "sample_period": Number(SECONDS, above=0),
                "delay_samples": Whole(least=0, most=MOST_DELAY),
            }
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
