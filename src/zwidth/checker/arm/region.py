"""An arm of several joints renders a linear wall passively wherever it is in its region.

    δ_m − c ≻ Jᵀ R J    or, for a parallel arm, at the hand    Σ δ_ij w_i w_jᵀ ≻ R    in the whole region
    R = (2d + 1) KT/2 + A,    K ⪰ 0,    A ⪰ B,    A ⪰ −B

K and B of the wall, d whole samples of delay, T the period. A stands for |B|: all that the proof takes from
it is aᵀAa + bᵀAb ± 2aᵀBb ≥ 0. c = h F T/2 where the torque is held over a period, else 0: h bounds the second
derivatives of the hand's position, F the force of the wall. The hand's position is read without steps, or
Coulomb friction covers the steps, `Encoders`; then the region is one step larger on every side.
In pose the last coordinates are rotations, `pose`, and c = (h F + h_e M) T/2: M bounds what the wall
gives for them, no less than its moment.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from fractions import Fraction
from math import ceil, floor
from typing import NamedTuple

from ..document.fields import Choice, Either, Number, OneOf, Read, Record, Whole, document
from ..document.number import SECONDS, always, down, up
from ..document.refusal import Invalid, only_if
from ..exact.enclosed import Enclosed
from .cells import BITS, LARGEST, Function, Matrix, Range, constant, matrix_entry, positive_in
from .kinematics import (
    CHAIN,
    LEGS,
    LONGER,
    NOTHING,
    UNIT,
    Chain,
    bends,
    chain_of,
    chain_surplus,
    legs_of,
    legs_surplus,
    levers,
    root_above,
)
from .pose import Pose, for_every_rest, in_words, pose_of, turning, turning_bend

MOST_DELAY = 10**6


def _wall(stiffness: str, damping: str, most: int) -> Record:
    return Record(
        {
            "stiffness": matrix_entry(stiffness, most),
            "virtual_damping": matrix_entry(damping, most),
            "damping_bound": matrix_entry(damping, most),
        }
    )


_POINT = _wall("N_per_m", "N_s_per_m", 3)
_POSE = _wall("N_m_rad", "N_m_s_rad", 6).extended(
    turns=Choice(1, 3), rest=Choice("every orientation", "given")
)
WALL = Either(_POSE, _POINT, lambda value: "turns" in value)
ARM = document(
    {
        "arm": OneOf("geometry", {"chain": CHAIN, "legs": LEGS}),
        "wall": WALL,
        "loop": Record(
            {
                "sample_period": Number(SECONDS, above=0),
                "delay_samples": Whole(least=0, most=MOST_DELAY),
                "encoder": Choice("ideal", "counted"),
                "torque": Choice("follows the arm", "follows the readings", "held"),
                "curvature": Number(always("m_per_rad2"), default=None),
                "largest_force": Number(always("N"), least=0, default=None),
                "largest_moment": Number(always("N_m"), least=0, default=None),
            }
        ),
    }
)


class Claim(NamedTuple):
    """S(x) ≻ 0 in a box of coordinates x, the joints or the hand's position."""

    box: list[tuple[Fraction, Fraction]]
    matrix: Function
    words: str
    columns: Function | None = None  # that has to be ≻ 0 there, too


def arm(told: Read) -> tuple[str, tuple[tuple[float, ...], ...]]:
    """What was proved; and S at the middle of the region, to look at, its rows from the diagonal on."""
    claim = claim_of(told)
    box = tuple(outward(low, high) for low, high in claim.box)
    cells = positive_in(box, claim.matrix)
    if claim.columns is not None:
        cells += positive_in(box, claim.columns, "a column of the Jacobian is longer than it is said to be")
    middle = claim.matrix([Enclosed(BITS, (low + high) // 2) for low, high in box])
    surplus = tuple(tuple(x.middle / 2**BITS for x in row) for row in middle)
    return f"{claim.words}; {cells} cell{'s' * (cells != 1)}", surplus


def outward(low: Fraction, high: Fraction) -> Range:
    """Both ends in whole numbers."""
    if max(abs(low), abs(high)) > LARGEST:
        raise Invalid("a number is too large")
    return floor(low * 2**BITS), ceil(high * 2**BITS)


def claim_of(told: Read) -> Claim:
    """What is to be shown, and the words for it."""
    machine, wall, loop = told.arm, told.wall, told.loop
    pose, held, counted = pose_of(wall), _is_held(loop), loop.encoder == "counted"
    given = matrices_of(wall, pose)
    need = [[constant(x) for x in row] for row in for_every_rest(need_of(*given, loop), pose)]
    limits = _limits(loop, pose, held or counted)
    only_if(held, loop.curvature, "curvature_m_per_rad2")
    words = "no motion of the hand with {} takes energy out, " + _how(held, counted, limits, pose)
    if machine.geometry == "legs":
        return _of_legs(machine, need, words, pose, held or counted)
    chain, columns = chain_of(machine), None
    if counted:
        encoders = encoders_of(machine, chain)
        chain = with_steps(chain, encoders)
        require_friction(chain, encoders, given[:2], loop.sample_period, limits, pose)
        columns = columns_below(chain, encoders)
    else:
        require_no_encoders(machine)
    if pose.turns != 3 or pose.anywhere:
        require_no_rest(machine)
    price = _price(chain, loop, limits, pose) if held else Fraction(0)
    box = [(joint.low, joint.high) for joint in chain.joints]
    matrix = chain_surplus(chain, need, price, turning(machine, chain, pose) if pose.turns else None)
    words = words.format("every joint in its range") + in_words(given[0], pose)
    return Claim(box, matrix, words, columns)


def _of_legs(machine: Read, need: list[list[Enclosed]], words: str, pose: Pose, bounded: bool) -> Claim:
    if pose.turns:
        raise Invalid("a parallel arm is proved for walls of position, not of pose")
    legs = legs_of(machine)
    if len(need) != len(legs.legs):
        raise Invalid("the wall has as many coordinates as the arm has legs")
    if bounded:
        raise Invalid("the second derivatives of a parallel arm are not bounded here")
    box = list(zip(legs.low, legs.high, strict=True))
    return Claim(box, legs_surplus(legs, need), words.format("its position in the box"))


def require_no_rest(machine: Read) -> None:
    """Refuse an orientation of rest where none plays a part."""
    for joint in machine.joints:
        only_if(False, getattr(joint, "rest", None), "rest_rad")


def _how(held: bool, counted: bool, limits: tuple[Fraction, Fraction], pose: Pose) -> str:
    """How the arm is read, and what becomes of the torque within a period."""
    moment = f" and moments up to {down(limits[1])} N·m" if pose.turns else ""
    forces = f", for forces up to {down(limits[0])} N{moment}"
    if counted:
        torque = "is held over a period" if held else "follows the readings"
        steps = "its encoder steps counted: force and Jacobian are those of the readings, and the torque "
        return f"{steps}{torque}{forces}"
    return f"read without encoder steps; the torque {f'is held{forces}' if held else 'follows the arm'}"


def _is_held(loop: Read) -> bool:
    follows = "follows the arm" if loop.encoder == "ideal" else "follows the readings"
    if loop.torque not in ("held", follows):
        raise Invalid(f"the torque {follows}, or is held")
    held: bool = loop.torque == "held"
    return held


def _limits(loop: Read, pose: Pose, bounded: bool) -> tuple[Fraction, Fraction]:
    """F, and in pose M."""
    force = only_if(bounded, loop.largest_force, "largest_force_N")
    moment = only_if(bounded and pose.turns, loop.largest_moment, "largest_moment_N_m")
    return force or Fraction(0), moment or Fraction(0)


def need_of(stiffness: Matrix, _damping: Matrix, bound: Matrix, loop: Read) -> Matrix:
    """R [N·s/m; in pose N·s/rad and N·m·s/rad, too]."""
    return _sum(bound, stiffness, (2 * loop.delay_samples + 1) * loop.sample_period / 2)


def matrices_of(wall: Read, pose: Pose) -> tuple[Matrix, Matrix, Matrix]:
    """K ⪰ 0, B, and A with A ± B ⪰ 0."""
    told = (wall.stiffness, wall.virtual_damping, wall.damping_bound)
    stiffness, damping, bound = (_symmetric(rows, pose.sizes) for rows in told)
    if not len(stiffness) == len(damping) == len(bound):
        raise Invalid("the matrices of the wall differ in size")
    if not _semidefinite(stiffness):
        raise Invalid("the stiffness has a negative eigenvalue")
    if not (_semidefinite(_sum(bound, damping, 1)) and _semidefinite(_sum(bound, damping, -1))):
        raise Invalid(
            "the bound on the virtual damping is too small: added or taken off, a negative eigenvalue is left"
        )
    return stiffness, damping, bound


def _price(chain: Chain, loop: Read, limits: tuple[Fraction, Fraction], pose: Pose) -> Fraction:
    """(h F + h_e M) T/2, where h − N ⪰ 0 with N_ij ≥ |∂²p/∂q_i∂q_j|."""
    if loop.delay_samples:
        raise Invalid("a held torque is proved without a delay")
    curvature, most = loop.curvature, bends(chain)
    room = [[(curvature if i == k else 0) - x for k, x in enumerate(row)] for i, row in enumerate(most)]
    if not _semidefinite(room):
        raise Invalid("the hand's path can bend more than the curvature says")
    bent: Fraction = curvature * limits[0] + turning_bend(chain, pose) * limits[1]
    return bent * Fraction(loop.sample_period) / 2


def _symmetric(rows: Sequence[Sequence[Fraction]], sizes: range) -> Matrix:
    if len(rows) not in sizes or any(len(row) != len(rows) for row in rows):
        raise Invalid(f"a matrix of the wall has {' or '.join(map(str, sizes))} rows, and as many columns")
    if any(rows[i][k] != rows[k][i] for i in range(len(rows)) for k in range(i)):
        raise Invalid("a matrix of the wall is not symmetric")
    return [list(row) for row in rows]


def _sum(a: Matrix, b: Matrix, factor: Fraction | int) -> Matrix:
    return [[x + factor * y for x, y in zip(*rows, strict=True)] for rows in zip(a, b, strict=True)]


def _semidefinite(matrix: Matrix) -> bool:
    """No negative eigenvalue: symmetric elimination, where a pivot 0 has a row of zeros."""
    rest = [list(row) for row in matrix]
    while rest:
        pivot, *row = rest[0]
        if pivot < 0 or (pivot == 0 and any(row)):
            return False
        rest = [
            [x - (row[i] * y / pivot if pivot else 0) for x, y in zip(below[1:], row, strict=True)]
            for i, below in enumerate(rest[1:])
        ]
    return True


# Encoders of a chain whose steps Coulomb friction covers, for forces up to F and moments up to M.
#
#     f_c,i ≥ ½ [Σ_a r_a,i Σ_b (‖K_ab‖ + 2 ‖B_ab‖/T) Σ_j Δ_j r_b,j + F Σ_j N_ij Δ_j + M Σ_j N′_ij Δ_j]
#
# a and b stand for translation and rotation. r_i bounds |∂p/∂q_i| in the region and one step around it, and
# is proved there as r_i² − |∂p/∂q_i|² > 0; where a joint slides it is 1, and of the turn it is 1 for joints
# that turn. Every later column turns with an earlier joint: N_ij = r_max(i,j) for two that turn, 1 where one
# slides, else 0. N′ = ½ for two joints that turn the hand in space. What only nearly rotates makes lengths
# longer by a millionth. A joint whose range is one number stays at its reading, and has no steps.


class Encoders(NamedTuple):
    """Of each joint."""

    steps: list[Fraction]
    friction: list[Fraction]
    columns: list[Fraction]


def encoders_of(told: Read, chain: Chain) -> Encoders:
    """`chain` is what `chain_of` found in `told`."""
    steps, friction, columns = [], [], []
    for entry, joint in zip(told.joints, chain.joints, strict=True):
        step, own = (only_if(True, getattr(entry, name), name) for name in ("resolution", "coulomb_friction"))
        column = Fraction(1) if joint.slides else only_if(True, entry.largest_column, "largest_column")
        steps.append(step if joint.low < joint.high else Fraction(0))
        friction.append(own)
        columns.append(column * (LONGER if joint.slides else 1))
    return Encoders(steps, friction, columns)


def require_no_encoders(told: Read) -> None:
    """Refuse what only counts where steps are counted."""
    for joint in told.joints:
        for name in ("resolution", "coulomb_friction", "largest_column"):
            only_if(False, getattr(joint, name, None), name)


def with_steps(chain: Chain, encoders: Encoders) -> Chain:
    """The chain, each joint free to be one step further to either side."""
    joints = [
        joint._replace(low=joint.low - step, high=joint.high + step)
        for joint, step in zip(chain.joints, encoders.steps, strict=True)
    ]
    return chain._replace(joints=joints)


def columns_below(chain: Chain, encoders: Encoders) -> Callable[[Sequence[Enclosed]], list[list[Enclosed]]]:
    """diag(r_i² − |∂p/∂q_i|²), its rows from the diagonal on; 1 where the joint slides."""
    squares, longer = levers(chain), constant(LONGER * LONGER)
    most = [constant(r * r) for r in encoders.columns]

    def below(joints: Sequence[Enclosed]) -> list[list[Enclosed]]:
        found = zip(chain.joints, most, squares(joints), strict=True)
        left = [UNIT if joint.slides else r - lever * longer for joint, r, lever in found]
        return [[own] + [NOTHING] * (len(left) - i - 1) for i, own in enumerate(left)]

    return below


def require_friction(
    chain: Chain,
    encoders: Encoders,
    wall: tuple[Matrix, Matrix],
    period: Fraction,
    limits: tuple[Fraction, Fraction],
    pose: Pose,
) -> None:
    """Refuse joints whose friction is below the right side, F and M being the limits."""
    turning = [Fraction(not joint.slides) for joint in chain.joints]
    blocks = [encoders.columns, turning] if pose.turns else [encoders.columns]
    sizes = _sizes(*wall, period, pose)
    misread = [_dot(encoders.steps, block) for block in blocks]
    wrong = [_dot(row, misread) for row in sizes]
    bend = Fraction(1, 2) if pose.turns == 3 else Fraction(0)
    force, moment = limits
    for i, own in enumerate(encoders.friction):
        second = _dot(encoders.steps, [_bend(chain, encoders, i, j) for j in range(len(chain.joints))])
        turned = bend * turning[i] * _dot(encoders.steps, turning)
        least = _dot([block[i] for block in blocks], wrong) + force * second + moment * turned
        if 2 * own < least:
            raise Invalid(
                f"Coulomb friction of joint {i + 1} must be at least {up(least / 2)} for its encoders"
            )


def _bend(chain: Chain, encoders: Encoders, i: int, j: int) -> Fraction:
    sliding = chain.joints[i].slides + chain.joints[j].slides
    if sliding:
        return LONGER * int(sliding == 1)
    return LONGER * encoders.columns[max(i, j)]


def _sizes(stiffness: Matrix, damping: Matrix, period: Fraction, pose: Pose) -> Matrix:
    """Bounds on ‖K_ab‖ + 2 ‖B_ab‖/T."""
    blocks = [slice(-pose.turns), slice(-pose.turns, None)] if pose.turns else [slice(None)]
    return [
        [
            _size([row[c] for row in stiffness[r]]) + 2 * _size([row[c] for row in damping[r]]) / period
            for c in blocks
        ]
        for r in blocks
    ]


def _size(matrix: Matrix) -> Fraction:
    """No singular value is above √(‖A‖₁ ‖A‖∞), nor above ‖A‖_F."""
    rows = max(sum(map(abs, row), Fraction(0)) for row in matrix)
    columns = max(sum(map(abs, column), Fraction(0)) for column in zip(*matrix, strict=True))
    return root_above(min(rows * columns, sum((x * x for row in matrix for x in row), Fraction(0))))


def _dot(a: Sequence[Fraction], b: Sequence[Fraction]) -> Fraction:
    return sum((x * y for x, y in zip(a, b, strict=True)), Fraction(0))
