"""The spring of the joints in the null space of the hand: what it does, replayed beside a wall.

    τ = −P(q) (k (q − q_d) + d_n q̇),   P = 1 − Jᵀ (J Jᵀ + λ² 1)⁻¹ J

P projects on motions of the joints that leave the hand where it is; λ = 0 is the pseudo-inverse, and
controllers take some λ > 0 near singular positions.  P is symmetric, k P(q)(q − q_d) is no gradient: its
curl is 0 at q_d and grows with the distance.  Once round a slow loop of the joints it gives the curl times
the area, at any speed, while viscous friction takes the less the slower the loop is: no damping pays for it,
and of Coulomb friction only as much as the length of the loop.
(Dietrich, Ott & Stramigioli 2016.  Proofs: docs/theory/arms.md)
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import pi

import numpy as np
import numpy.typing as npt

from zwidth.model.arms.joints import as_matrix
from zwidth.model.arms.kinematics import Arm, DescribedArm, PlanarChain, PosedArm
from zwidth.model.arms.matrix_wall import MatrixWall
from zwidth.model.arms.motion import ArmMotion
from zwidth.model.arms.need import damping_at
from zwidth.model.arms.replay import replay_cycle
from zwidth.model.environment.wall import Wall

Array = npt.NDArray[np.float64]

_FAST = 64
"""Samples of the longest cycle to and fro."""
_AMPLITUDES = (1e-3, 3e-3, 1e-2, 3e-2)
"""Of motions to and fro [rad; m]; larger ones only where Coulomb friction eats the small ones."""


@dataclass(frozen=True, kw_only=True)
class NullSpaceSpring:
    """A spring and a damper of the joints, projected on what does not move the hand.

    Parameters
    ----------
    stiffness
        k ≥ 0 of every joint [N·m/rad].
    damping
        d_n ≥ 0 of every joint [N·m·s/rad].
    rest
        q_d [rad; m].
    regularization
        λ ≥ 0 of the pseudo-inverse; metres and radians are mixed in it as in the controller's J.
    """

    stiffness: float
    damping: float
    rest: tuple[float, ...]
    regularization: float = 0.0


def task_jacobian(arm: Arm, joints: npt.ArrayLike) -> Array:
    """J of velocity, and in pose of angular velocity, whatever the wall's orientation of rest (…, n, m)."""
    if isinstance(arm, PosedArm) and arm.rest is not None:
        arm = arm.replace(rest=None)
    return arm.placed(joints)[1] if isinstance(arm, DescribedArm) else arm.jacobian(joints)


def moving(arm: Arm) -> npt.NDArray[np.intp]:
    """The joints that are not held: no motion that is asked about moves the others."""
    return np.array([i for i, (low, high) in enumerate(ranges(arm)) if high > low], dtype=np.intp)


def ranges(arm: Arm) -> Sequence[tuple[float, float]]:
    """Both ends of each joint [rad; m]."""
    return arm.joint_range if isinstance(arm, (DescribedArm, PlanarChain)) else [(0, 1)] * arm.joint_count


def projector(jacobian: Array, regularization: float = 0.0) -> Array:
    """P (…, m, m)."""
    turned = np.swapaxes(jacobian, -1, -2)
    size, count = jacobian.shape[-2:]
    if regularization:
        inner = jacobian @ turned + regularization**2 * np.eye(size)
        return np.asarray(np.eye(count) - turned @ np.linalg.solve(inner, jacobian))
    return np.asarray(np.eye(count) - np.linalg.pinv(jacobian) @ jacobian)


def resisting(arm: Arm, spring: NullSpaceSpring, joints: Array, speeds: Array | float = 0.0) -> Array:
    """P (k (q − q_d) + d_n q̇), against which the hands work (…, m) [N·m]."""
    pulled = spring.stiffness * (joints - np.asarray(spring.rest)) + spring.damping * speeds
    inside = projector(task_jacobian(arm, joints), spring.regularization)
    return np.asarray(np.einsum("...ij,...j->...i", inside, pulled))


def replay_both(
    arm: Arm,
    wall: Wall | MatrixWall,
    spring: NullSpaceSpring,
    period: float,
    delay_samples: int,
    joints: Array,
) -> ArmMotion:
    """The energy of a closed path of the joints against wall and null-space spring together.

    The wall is as of `replay_cycle`, at rest in the middle of the path; the spring's torque is computed
    once a sample from the difference of two readings, `delay_samples` late, and held.
    """
    motion = replay_cycle(arm, wall, period, delay_samples, joints)
    speeds = (joints - np.roll(joints, 1, axis=0)) / period
    torque = np.roll(resisting(arm, spring, joints, speeds), delay_samples, axis=0)
    moved = np.roll(joints, -1, axis=0) - joints
    size = task_jacobian(arm, joints[0]).shape[0]
    who = "links" if arm.joint_count > size else "end"
    return replace(motion, work=motion.work + float((torque * moved).sum()), imposed_by=who)


def null_space_need(
    arm: Arm, spring: NullSpaceSpring, period: float, delay_samples: int, theta: float
) -> Array:
    """What motions of one frequency near the rest ask of the joints, m × m [N·m·s/rad]."""
    inside = projector(task_jacobian(arm, spring.rest), spring.regularization)
    kernel = np.sin((delay_samples + 0.5) * theta) / np.sin(theta / 2)
    share = period / 2 * kernel * spring.stiffness - np.cos((delay_samples + 1) * theta) * spring.damping
    return np.asarray(share * inside)


def fast_motion(
    arm: Arm, wall: Wall | MatrixWall, spring: NullSpaceSpring, period: float, delay_samples: int
) -> ArmMotion | None:
    """A small motion to and fro at the rest that takes energy out of both, replayed; None: none was found."""
    at = np.asarray(spring.rest)
    jacobian, free = task_jacobian(arm, at), moving(arm)
    found: list[tuple[float, int, Array]] = []
    for samples in range(2, _FAST + 1):
        theta = 2 * pi / samples
        hand = damping_at(theta, wall, period, delay_samples, len(jacobian))
        need = jacobian.T @ hand @ jacobian + null_space_need(arm, spring, period, delay_samples, theta)
        values, vectors = np.linalg.eigh((as_matrix(arm.damping) - need)[np.ix_(free, free)])
        shape = np.zeros(len(at))
        shape[free] = vectors[:, 0]
        found.append((values[0] * (1 - np.cos(theta)), samples, shape))
    lowest, samples, shape = min(found, key=lambda item: item[0])
    if lowest >= 0:
        return None
    turn = np.cos(2 * pi / samples * np.arange(samples))[:, None]
    motions = (
        replay_both(arm.resting(at), wall, spring, period, delay_samples, at + size * turn * shape)
        for size in _AMPLITUDES
    )
    return next((motion for motion in motions if motion.takes_energy), None)
