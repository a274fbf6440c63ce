"""Encoders of a chain whose steps Coulomb friction covers, for forces up to F and moments up to M.

    f_c,i ≥ ½ [Σ_a r_a,i Σ_b (‖K_ab‖ + 2 ‖B_ab‖/T) Σ_j Δ_j r_b,j + F Σ_j N_ij Δ_j + M Σ_j N′_ij Δ_j]

a and b stand for translation and rotation. r_i bounds |∂p/∂q_i| in the region and one step around it, and is
proved there as r_i² − |∂p/∂q_i|² > 0; where a joint slides it is 1, and of the turn it is 1 for joints that
turn. Every later column turns with an earlier joint: N_ij = r_max(i,j) for two that turn, 1 where one slides,
else 0. N′ = ½ for two joints that turn the hand in space. What only nearly rotates makes lengths longer by a
millionth. A joint whose range is one number stays at its reading, and has no steps.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from fractions import Fraction
from typing import NamedTuple

from ..document.fields import Read, only_if
from ..document.number import up
from ..document.refusal import Invalid
from ..exact.enclosed import Enclosed
from .chain import LONGER, NOTHING, UNIT, Chain, levers, root_above
from .damping import Matrix, constant
from .pose import Pose


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
