"""What a controller asks of the joints that reads counts, and that holds torques instead of forces.

What Coulomb friction in the joints covers the steps of their encoders, and up to which force of the wall.

A controller has only readings q̂, each the count in which its joint is: q_j = q̂_j + o_j ± Δ_j/2, with the
same o_j in every count.  It renders the torque J(q̂)ᵀF(p(q̂)).  The arm with q′ = q − o moves as this one
does, and is the one that the wall thinks it has; from its torque the rendered one differs by

    J(q′)ᵀ(F(p(q̂)) − F(p(q′))) + (J(q̂) − J(q′))ᵀF(p(q̂)),

the first of which grows with the step alone, the second with the force, too.  Friction takes Σ f_c,i |q̇_i|.
So the loop with encoders is as passive as without them, for forces up to F and moments up to M, if in every
joint

    f_c,i ≥ ½ [Σ_a r_a,i Σ_b (‖K_ab‖ + 2 ‖B_ab‖/T) Σ_j Δ_j r_b,j + F Σ_j N_ij Δ_j + M Σ_j N′_ij Δ_j]

r_a,i ≥ |J_a,i| in the region and one step around it, a and b for translation and rotation, N_ij and N′_ij
bounds on the second derivatives of the point and of the turn.  Proof: docs/theory/arms.md.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import inf

import numpy as np
import numpy.typing as npt

from zwidth.errors import InputError
from zwidth.model.arms.arm import Arm, ArmMotion, Sites
from zwidth.model.arms.chain import PlanarChain
from zwidth.model.arms.described import SECOND_DERIVATIVE, DescribedArm
from zwidth.model.arms.joints import sampled_jacobian_damping
from zwidth.model.arms.wall import MatrixWall, wall_matrices
from zwidth.model.environment.wall import Wall
from zwidth.quantity.exact import RealLike
from zwidth.quantity.parameter import read_number
from zwidth.quantity.text import shown_at_most

Array = npt.NDArray[np.float64]
Chain = PlanarChain | DescribedArm
"""The arms whose second derivatives are bounded."""

_TIGHT, _TINY = 1e-5, 1e-9
"""Of a column, and in metres."""
_ROOM = 1 + 2e-6
"""The checker's lengths are longer by a millionth, and doubles round."""
_ROUNDING = 1e-12
MOST = 1e6
"""Newtons, and newton-metres: no wall renders more, and where these cost nothing this much is said."""


@dataclass(frozen=True, kw_only=True)
class EncoderSteps:
    """What the encoder steps of an arm ask of its Coulomb friction; joints that are held have none.

    Parameters
    ----------
    friction
        Of each joint, before a wall that renders next to no force [N·m; N of a sliding joint].
    friction_per_force
        What each newton of the wall's force adds to it [m; 1].
    friction_per_moment
        What each newton-metre of its moment adds, in pose [1; 1/m].
    columns
        r_i ≥ |∂p/∂q_i| in the region and one step around it [m/rad; 1].
    covered
        The largest force [N], in pose with a moment [N·m], up to which the arm's own Coulomb friction covers
        the steps; empty where it does not even at rest.
    refuted
        The smallest force at which a motion across their edges is known to take energy out [N]; None: none
        is. Between `covered` and this nothing is known.
    motion
        That motion.
    """

    friction: tuple[float, ...]
    friction_per_force: tuple[float, ...]
    friction_per_moment: tuple[float, ...]
    columns: tuple[float, ...]
    covered: tuple[float, ...] = ()
    refuted: float | None = None
    motion: ArmMotion | None = None

    def friction_up_to(self, force: float, moment: float = 0.0) -> tuple[float, ...]:
        """Coulomb friction of each joint that covers the steps up to a force [N] and a moment [N·m]."""
        each = zip(self.friction, self.friction_per_force, self.friction_per_moment, strict=True)
        return tuple(own + (force * f if f else 0.0) + (moment * m if m else 0.0) for own, f, m in each)


def encoder_steps(arm: Arm, wall: Wall | MatrixWall, period: float, sites: Sites) -> EncoderSteps | None:
    """None of an arm without encoders, or whose second derivatives are not bounded.

    Parameters
    ----------
    arm
        With encoders.
    wall
        Of its hand.
    period
        T [s].
    sites
        Cells that cover the region.
    """
    chain = with_encoders(arm)
    if chain is None:
        return None
    columns = columns_in_cells(chain, sites).reshape(-1, chain.joint_count).max(axis=0)
    columns = columns * (1 + _TIGHT) + _TINY * turning_joints(chain)  # above, for the checker to see it soon
    own, force, moment = friction_for(chain, wall, period, columns)
    found = EncoderSteps(
        friction=tuple(own.tolist()),
        friction_per_force=tuple(force.tolist()),
        friction_per_moment=tuple(moment.tolist()),
        columns=tuple(columns.tolist()),
    )
    return replace(found, covered=_covered(found, chain))


def covered_factors(arm: Arm, wall: Wall | MatrixWall, period: float, jacobians: Array) -> Array:
    """How many times as stiff the wall may be with friction covering the steps at each posture (…).

    To first order in the steps and before next to no force of the wall, J (…, n, m):

        f_c,i ≥ ½ Σ_j Δ_j (s |J_iᵀ K J_j| + (2/T) |J_iᵀ B J_j|)

    0 where friction does not even cover the steps of the virtual damping, ∞ where the steps cost nothing.
    Without virtual damping more stiffness than this gives energy out at a corner of the readings, where every
    joint crosses an edge; the force of the wall asks for more friction.
    """
    k, b = wall_matrices(wall, jacobians.shape[-2])
    steps, turned = np.asarray(arm.resolution, dtype=np.float64), np.swapaxes(jacobians, -1, -2)
    load = np.abs(turned @ k @ jacobians) @ steps / 2
    left = np.asarray(arm.coulomb_friction or 0.0) - np.abs(turned @ b @ jacobians) @ steps / period
    with np.errstate(divide="ignore", invalid="ignore"):
        each = np.where(left < 0, 0.0, np.where(load > 0, left / load, inf))
    return np.asarray(each.min(axis=-1))


def with_encoders(arm: Arm) -> Chain | None:
    """The arm, if it has encoders that step and its second derivatives are bounded, joint by joint."""
    if isinstance(arm, DescribedArm) and arm.follows:
        return None
    return arm if isinstance(arm, (PlanarChain, DescribedArm)) and moving_steps(arm).any() else None


def columns_in_cells(arm: Chain, sites: Sites) -> Array:
    """r_i ≥ |∂p/∂q_i| in each cell and one step around it (…, m): a reading may be in another cell."""
    point = sites.jacobians[..., : sites.jacobians.shape[-2] - arm.turns, :]
    ranges = np.array(arm.joint_range)
    moving = ranges[:, 0] < ranges[:, 1]
    halves = np.zeros(arm.joint_count)
    halves[moving] = np.diff(ranges[moving])[:, 0] / [2 * len(axis.middles) for axis in sites.axes]
    bends = arm.second_derivatives
    found = np.linalg.norm(point, axis=-2) + bends @ (halves + moving_steps(arm))
    return np.asarray(np.minimum(found, np.where(turning_joints(arm), np.diag(bends), 1.0)))


def friction_for(
    arm: Chain, wall: Wall | MatrixWall, period: float, columns: Array
) -> tuple[Array, Array, Array]:
    """What the steps ask of each joint (…, m): of any wall, for each newton, for each newton-metre.

    `columns` are r_i of the point (…, m).
    """
    steps, turning = moving_steps(arm), turning_joints(arm)
    blocks = [columns, np.broadcast_to(turning, columns.shape)] if arm.turns else [columns]
    sizes = _sizes(wall, arm, period)
    misread = np.stack([block @ steps for block in blocks], axis=-1)
    force = misread @ sizes.T  # of each block
    own = sum(block * force[..., a, None] for a, block in enumerate(blocks))
    bent = _bends(arm, columns) @ steps
    # In the plane the turn is the sum of the joints: its second derivative is 0.
    bend = SECOND_DERIVATIVE if arm.turns == 3 else 0.0
    turned = np.broadcast_to(bend * turning * (turning @ steps), columns.shape)
    return np.asarray(own) * _ROOM / 2, bent * _ROOM / 2, turned * _ROOM / 2


def moving_steps(arm: Chain) -> Array:
    """Δ of each joint; 0 of one that is held, which stays at its reading [rad; m]."""
    steps = np.asarray(arm.resolution or (0.0,) * arm.joint_count)
    return np.where([low < high for low, high in arm.joint_range], steps, 0.0)


def turning_joints(arm: Chain, slides: bool = False) -> Array:
    """1 for each joint between base and hand that turns, or slides, else 0."""
    found = np.zeros(arm.joint_count)
    for placed in arm.placements()[0]:
        found[placed.joint] = placed.slides == slides
    return found


def _bends(arm: Chain, columns: Array) -> Array:
    """N_ij (…, m, m): the later column, which turns with the earlier joint; 1 where one of them slides."""
    turning, sliding = turning_joints(arm), turning_joints(arm, slides=True)
    later = np.maximum.outer(np.arange(len(turning)), np.arange(len(turning)))
    mixed = np.outer(turning, sliding) + np.outer(sliding, turning)
    return np.asarray(np.outer(turning, turning) * columns[..., later] + mixed)


def size_bound(matrix: Array) -> float:
    """‖A‖ ≤ min(√(‖A‖₁ ‖A‖∞), ‖A‖_F): what is exact of k·1 and of k n nᵀ, and needs no eigenvalues."""
    sums = np.linalg.norm(matrix, 1) * np.linalg.norm(matrix, np.inf)
    return float(min(np.sqrt(sums), np.linalg.norm(matrix)))


def _sizes(wall: Wall | MatrixWall, arm: Chain, period: float) -> Array:
    """‖K_ab‖ + 2 ‖B_ab‖/T of every two blocks."""
    point = 2 if isinstance(arm, PlanarChain) else 3
    size = point + arm.turns
    k, b = wall_matrices(wall, size)
    blocks = [slice(0, point), slice(point, size)] if arm.turns else [slice(0, size)]
    return np.array(
        [[size_bound(k[r, c]) + 2 * size_bound(b[r, c]) / period for c in blocks] for r in blocks]
    )


def _covered(steps: EncoderSteps, arm: Chain) -> tuple[float, ...]:
    """The force; in pose with the moment that stands to it as what each could be alone."""
    left = np.asarray(arm.coulomb_friction or (0.0,) * arm.joint_count) - steps.friction
    if (left < 0).any():
        return ()
    kinds = [np.asarray(kind) for kind in (steps.friction_per_force, steps.friction_per_moment)]
    alone = np.array([min(_least(left, kind), MOST) for kind in kinds[: 2 if arm.turns else 1]])
    together = sum(limit * kind for limit, kind in zip(alone, kinds, strict=False))
    limits = alone * min(1.0, _least(left, together))
    return tuple(limits.tolist()) if limits.min() > 0 else ()


def _least(left: Array, each: Array | float) -> float:
    """The largest multiple of `each` that is left in every joint."""
    with np.errstate(divide="ignore", invalid="ignore"):
        return float(np.where(np.asarray(each) > 0, left / each, inf).min()) / (1 + _ROUNDING)


# What a controller asks of the joints that computes their torques once a sample and holds them.
#
#     c = ½ (h F + h_e M) T
#
# with the curvatures h of the point and h_e of the turn, and the largest force F and moment M of the
# wall; `sampled_jacobian_damping` is one of the two.

_DIGITS = 4


def held_torque_damping(arm: Arm, period: float, delay_samples: int, largest: tuple[float, ...]) -> float:
    """c, to be taken from every joint; 0 where the torque follows the arm [N·m·s/rad].

    `largest` is F [N], in pose F and M [N·m], from `forces_of`; it is empty where the torque follows the arm.
    """
    if not largest:
        return 0.0
    curvatures = (arm.curvature, arm.turning_curvature) if arm.turns else (arm.curvature,)
    if None in curvatures or delay_samples:
        raise InputError(
            "a bound for held torques is known for chains and descriptions without delay; "
            "compute the torque several times in each period, and leave torque_held_up_to out"
        )
    return sum(
        sampled_jacobian_damping(h or 0.0, force, period)
        for h, force in zip(curvatures, largest, strict=True)
    )


def forces_of(arm: Arm, given: RealLike | Sequence[RealLike] | None, name: str) -> tuple[float, ...]:
    """A force [N], in pose with a moment [N·m], as it was given for `name`; empty if it was not."""
    if given is None:
        return ()
    listed = [given] if isinstance(given, str) else given
    try:
        forces = np.atleast_1d(np.asarray(listed, dtype=object))
        units = zip(forces, ("linear", "rotary"), strict=False)
        forces = np.array([float(read_number(one, "force", name, motion=motion)) for one, motion in units])
    except (TypeError, ValueError):
        forces = np.empty(0)
    if forces.shape != (2 if arm.turns else 1,) or not ((forces >= 0) & (forces < np.inf)).all():
        also = " and the largest moment, ≥ 0 N·m" if arm.turns else ""
        raise InputError(f"{name} is the largest force of the wall, ≥ 0 N{also}; got {given!r}")
    return tuple(forces.tolist())


def in_words(largest: Sequence[float]) -> str:
    """The force, and the moment, rounded down: a claim goes no further than its proof."""
    units = zip(largest, ("N", "N*m"), strict=False)
    bounds = [shown_at_most(value, unit) for value, unit in units if value < MOST]
    return " and ".join(bounds) or "any"
