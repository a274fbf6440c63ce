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

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from math import ceil, pi
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from zwidth.model.arms.arm import Arm, ArmMotion
from zwidth.model.arms.chain import PlanarChain
from zwidth.model.arms.described import DescribedArm, PosedArm
from zwidth.model.arms.joints import as_matrix
from zwidth.model.arms.replay import replay_cycle
from zwidth.model.arms.wall import MatrixWall, damping_at, wall_matrices
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


# The smallest slow loop of the joints on which a null-space spring gives more than Coulomb friction takes.
#
#     once round gains   ∮ k P(q)(q − q_d)·dq  −  Σ f_c,i ∮ |dq_i|
#
# Near the rest the torque's curl is linear in the distance from it, so that an ellipse c + u cos φ + v sin φ
# gains π C(c, u, v) − 4 Σ f_c,i (u_i² + v_i²)^½: the first grows with the cube of its size, the second with
# the size, and it begins to gain where the two are one.  Among all ellipses the one that begins soonest is
# looked for; whether it gains is then reckoned with the full kinematics.

_STEP = 1e-5
"""Of the joints, for the slope of the projector [rad]."""
_STARTS = 8
"""From which a shape is looked for."""
_TRIED = 3
"""Of the shapes, those that begin to gain soonest are reckoned with the full kinematics."""
_PLACES = 64
"""Of a loop, at which its gain is reckoned."""
_LONGEST = 30_000
"""Samples of the longest loop that is replayed."""
_SHORTEST = 64
_SIZES = 60
"""Between that at which a loop begins to gain and the largest: a larger one is quicker."""
_HALVINGS = 12
_SMALLEST, _LADDER = 1 / 64, 16
"""Of the room that there is, the first size that is tried, and how many up to all of it."""
_ROUND = 16
"""The power in which distances along a loop are averaged, so that their largest has a slope."""


class Loop(NamedTuple):
    """q(k) = centre + cosine cos(2πk/N) + sine sin(2πk/N) [rad; m]."""

    centre: Array
    cosine: Array
    sine: Array
    samples: int

    def joints(self) -> Array:
        """N × m."""
        angle = 2 * pi / self.samples * np.arange(self.samples)[:, None]
        return np.asarray(self.centre + np.cos(angle) * self.cosine + np.sin(angle) * self.sine)

    def reach(self, rest: Sequence[float]) -> float:
        """How far from the rest it goes, root of the sum of squares [rad]."""
        return float(np.linalg.norm(self.joints() - np.asarray(rest), axis=1).max())


class Shape(NamedTuple):
    """A loop whose farthest place is 1 rad from the rest: its centre from there, and its axes."""

    centre: Array
    cosine: Array
    sine: Array

    def at(self, rest: Sequence[float], size: float, samples: int) -> Loop:
        """So large."""
        return Loop(np.asarray(rest) + size * self.centre, size * self.cosine, size * self.sine, samples)


def slow_loop(
    arm: DescribedArm | PlanarChain,
    wall: Wall | MatrixWall,
    spring: NullSpaceSpring,
    period: float,
    delay_samples: int,
    within: float | None,
) -> tuple[Loop, ArmMotion] | None:
    """The smallest loop found that takes energy out, replayed; None: none was found within the distance."""
    if not spring.stiffness:
        return None
    found = [loop for shape in shapes(arm, spring) for loop in _of(arm, wall, spring, period, shape, within)]
    for loop in sorted(found, key=lambda one: one.reach(spring.rest)):
        motion = replay_both(arm.resting(loop.centre), wall, spring, period, delay_samples, loop.joints())
        if motion.takes_energy:
            return loop, motion
    return None


def shapes(arm: DescribedArm | PlanarChain, spring: NullSpaceSpring) -> list[Shape]:
    """Those that begin to gain soonest, as the curl near the rest tells it; the same every time."""
    from scipy.optimize import minimize

    free = moving(arm)
    curl = _curl(arm, spring, free)
    if not curl.any():
        return []
    friction = _friction(arm)[free]
    weights = friction + 1e-3 * (friction.max() or 1.0)  # a joint without friction is not moved for nothing
    starts = np.random.default_rng(0).normal(size=(_STARTS, 3 * len(free)))
    found = [minimize(_soonest, start, (curl, weights), jac=True, method="L-BFGS-B") for start in starts]
    best = sorted(found, key=lambda one: float(one.fun))[:_TRIED]
    return [_shape(one.x.reshape(3, -1), free, arm.joint_count) for one in best]


def gain(arm: Arm, spring: NullSpaceSpring, shape: Shape, size: float) -> tuple[float, float]:
    """What hands give the spring once round a slow loop, < 0 where it gives, and friction [J]."""
    joints = shape.at(spring.rest, size, _PLACES).joints()
    step = (np.roll(joints, -1, axis=0) - np.roll(joints, 1, axis=0)) / 2
    step *= 2 * pi / _PLACES / np.sin(2 * pi / _PLACES)  # the slope of an ellipse, exactly
    given = float((resisting(arm, spring, joints) * step).sum())
    return given, 4 * size * float(_friction(arm) @ np.hypot(shape.cosine, shape.sine))


def _friction(arm: Arm) -> Array:
    return np.asarray(arm.coulomb_friction or (0.0,) * arm.joint_count, dtype=np.float64)


def _curl(arm: Arm, spring: NullSpaceSpring, free: npt.NDArray[np.intp]) -> Array:
    """C_lij = k (∂_j P_il − ∂_i P_jl) at the rest [N·m/rad²]."""
    at, steps = np.asarray(spring.rest), _STEP * np.eye(len(spring.rest))[free]
    ahead, behind = (
        projector(task_jacobian(arm, at + sign * steps), spring.regularization) for sign in (1, -1)
    )
    slopes = spring.stiffness * ((ahead - behind) / (2 * _STEP))[:, free][:, :, free]  # j, i, l
    return np.asarray(np.einsum("jil->lij", slopes) - np.einsum("ijl->lij", slopes))


def _soonest(shape: Array, curl: Array, friction: Array) -> tuple[float, Array]:
    """The logarithm of friction × reach²/gain, the square of the size where a loop begins to gain."""
    centre, cosine, sine = shape.reshape(3, -1)
    by_centre = np.einsum("lij,i,j", curl, cosine, sine)
    given = float(by_centre @ centre)
    lengths = np.sqrt(cosine**2 + sine**2 + 1e-18)
    lost = float(friction @ lengths)
    angle = 2 * pi / _PLACES * np.arange(_PLACES)
    turning = np.stack([np.ones(_PLACES), np.cos(angle), np.sin(angle)])
    places = turning.T @ shape.reshape(3, -1)
    far = (places**2).sum(axis=1)
    mean = float((far**_ROUND).mean())
    rates = np.stack([
        by_centre, np.einsum("lij,l,j", curl, centre, sine), np.einsum("lij,l,i", curl, centre, cosine)
    ])  # fmt: skip
    slope = -rates / given
    slope[1:] += friction * np.stack([cosine, sine]) / lengths / lost
    slope += 2 * turning @ ((far ** (_ROUND - 1))[:, None] * places) / (_PLACES * mean)
    value = np.log(lost) + np.log(mean) / _ROUND - np.log(abs(given))
    return float(value), slope.ravel()


def _shape(parts: Array, free: npt.NDArray[np.intp], count: int) -> Shape:
    """Of all joints, its reach 1."""
    whole = np.zeros((3, count))
    whole[:, free] = parts
    reach = Loop(whole[0], whole[1], whole[2], _PLACES).reach([0.0] * count)
    return Shape(*(whole / reach))


def _of(
    arm: DescribedArm | PlanarChain,
    wall: Wall | MatrixWall,
    spring: NullSpaceSpring,
    period: float,
    shape: Shape,
    within: float | None,
) -> Iterator[Loop]:
    """The smallest loop of a shape, on either side of the rest, that gains, stays in the ranges and ends."""
    low, high = np.array(ranges(arm)).T
    for sign in (1, -1):
        one = Shape(*(sign * part for part in shape))
        most = _room(one, spring.rest, low, high, within)
        begins = _begins(arm, spring, one, most)
        if begins is None:
            continue
        size, turned = begins
        one = one if turned else one._replace(sine=-one.sine)
        for larger in np.geomspace(size, most, _SIZES):
            samples = _slow_enough(arm, wall, spring, period, one, float(larger))
            if samples is not None:
                yield one.at(spring.rest, float(larger), samples)
                break


def _room(shape: Shape, rest: Sequence[float], low: Array, high: Array, within: float | None) -> float:
    """The largest size inside the ranges, and within the distance."""
    swing, at = np.hypot(shape.cosine, shape.sine), np.asarray(rest)
    sides = ((swing + shape.centre, high - at), (swing - shape.centre, at - low))
    sizes = [space / way for ways, room in sides for way, space in zip(ways, room, strict=True) if way > 1e-9]
    return float(min([*sizes, pi if within is None else within]))


def _begins(arm: Arm, spring: NullSpaceSpring, shape: Shape, most: float) -> tuple[float, bool] | None:
    """From which size on it gains, by halving; and whether it does in the direction that it has."""
    low = 0.0
    for high in np.geomspace(_SMALLEST * most, most, _LADDER):
        given, lost = gain(arm, spring, shape, high)
        if abs(given) > lost:
            break
        low = high
    else:
        return None
    for _ in range(_HALVINGS):
        middle = (low + high) / 2
        there, lost = gain(arm, spring, shape, middle)
        low, high = (low, middle) if there * np.sign(given) > lost else (middle, high)
    return float(high), bool(given < 0)


def _slow_enough(
    arm: Arm, wall: Wall | MatrixWall, spring: NullSpaceSpring, period: float, shape: Shape, size: float
) -> int | None:
    """How many samples, so that viscous friction takes half of what is left; None: too many."""
    given, lost = gain(arm, spring, shape, size)
    left = -given - lost
    if left <= 0:
        return None
    brakes = _braking(arm, wall, spring, np.asarray(spring.rest) + size * shape.centre)
    axes = size * np.stack([shape.cosine, shape.sine])
    loss = 2 * pi**2 * float(np.einsum("ai,ij,aj", axes, brakes, axes))  # J·s
    samples = max(_SHORTEST, ceil(2 * loss / (left * period)))
    return samples if samples <= _LONGEST else None


def _braking(arm: Arm, wall: Wall | MatrixWall, spring: NullSpaceSpring, at: Array) -> Array:
    """All damping of the joints, virtual or not, in a slow motion [N·m·s/rad]."""
    jacobian = task_jacobian(arm, at)
    _, damper = wall_matrices(wall, len(jacobian))
    inside = projector(jacobian, spring.regularization)
    return np.asarray(as_matrix(arm.damping) + jacobian.T @ damper @ jacobian + spring.damping * inside)
