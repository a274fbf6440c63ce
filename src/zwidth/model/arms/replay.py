"""Motions of an arm that take energy out of a wall: near one place, and across edges of the encoders.

A motion of an arm that takes energy out of a wall, replayed with its full geometry.

The joints go round a small closed path, straight from sample to sample:

    q(k) = q₀ + ε Re(w e^{jkθ}),   θ = 2π/N

Where the wall's force is held and its torque J(q)ᵀF follows the arm, its work over a period is exactly
F(k)·(p(q(k+1)) − p(q(k))); where the torque is held it is F(k)·J(q(k)) Δq.  Behind encoders F and J are those
of the readings ⌊q/Δ⌋Δ: then the work of a torque that follows is the sum of F(k)·J(q̂) δq over the pieces of
the way between two edges.  The joints lose Σ b_i Δq_i²/T + f_c,i |Δq_i|.  Nothing is linearized. A hand at
the end can make this motion wherever it can hold every joint: where J has as many independent columns as
there are joints.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import product
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from zwidth.model.arms.arm import Arm, ArmMotion
from zwidth.model.arms.chain import PlanarChain
from zwidth.model.arms.described import DescribedArm
from zwidth.model.arms.encoders import Chain, moving_steps
from zwidth.model.arms.joints import as_matrix
from zwidth.model.arms.wall import MatrixWall, damping_at, wall_matrices
from zwidth.model.environment.wall import Wall

Array = npt.NDArray[np.float64]

_LONGEST = 64
"""Samples of the longest cycle that is tried."""
_AMPLITUDES = (1e-3, 3e-3, 1e-2, 3e-2, 1e-1)
"""Of the joints [rad; m]; larger ones only where Coulomb friction eats the small ones."""
_HELD = 1e-3
"""Smallest ratio of the singular values of J at which a hand is taken to hold every joint."""
_NOTHING = 1e-6
"""Rows of J that are smaller [m/rad; 1] do not move the hand."""
_NODES = 6
"""Of Gauss's rule on a piece."""


def replay_cycle(
    arm: Arm,
    wall: Wall | MatrixWall,
    sample_period: float,
    delay_samples: int,
    joints: Array,
    torque_held: bool = False,
    *,
    counted: bool = False,
    rest: Array | None = None,
) -> ArmMotion:
    """The energy of a closed path of the joints q(k), N × m, gone round for ever.

    Parameters
    ----------
    arm, wall, sample_period, delay_samples
        The loop.
    joints
        q(k).
    torque_held
        The torque is computed once a sample. Default: it follows the arm, or its readings.
    counted
        Position and Jacobian are those of the readings, every joint rounded down to its step.
    rest
        Where the wall rests; None: in the middle of the path. It matters for held torques and for readings.
    """
    p, turned = arm.forward(joints), np.roll(joints, -1, axis=0) - joints
    seen = _readings(arm, joints) if counted else joints
    seen_at = arm.forward(seen) if counted else p
    k, b = wall_matrices(wall, p.shape[-1])
    rest = p.mean(axis=0) if rest is None else np.asarray(rest, dtype=np.float64)
    read = np.roll(seen_at - rest, delay_samples, axis=0)
    before = np.roll(seen_at - rest, delay_samples + 1, axis=0)
    force = read @ k + (read - before) / sample_period @ b
    if torque_held:
        moved = np.einsum("kij,kj->ki", arm.jacobian(seen), turned)
    else:
        moved = _followed(arm, joints, turned) if counted else np.roll(p, -1, axis=0) - p
    point = force.shape[1] - arm.turns
    friction = np.asarray(arm.coulomb_friction or (0.0,) * joints.shape[-1])
    viscous = np.einsum("ki,ij,kj->", turned, as_matrix(arm.damping), turned) / sample_period
    return ArmMotion(
        joints=joints,
        positions=p,
        work=float((force * moved).sum()),
        loss=float(viscous + (np.abs(turned) @ friction).sum()),
        rest=rest,
        largest_force=float(np.linalg.norm(force[:, :point], axis=1).max()),
        largest_moment=float(np.linalg.norm(force[:, point:], axis=1).max()),
        encoder="counted" if counted else "ideal",
    )


def steps_of(arm: Arm) -> Array:
    """Δ of each joint; of a chain 0 for one that is held, which stays at its reading."""
    if isinstance(arm, (PlanarChain, DescribedArm)):
        return moving_steps(arm)
    return np.asarray(arm.resolution or (0.0,) * arm.joint_count)


def _readings(arm: Arm, joints: Array) -> Array:
    """⌊q/Δ⌋Δ; q itself of a joint without steps."""
    steps = steps_of(arm)
    safe = np.where(steps > 0, steps, 1.0)
    return np.where(steps > 0, np.floor(joints / safe) * safe, joints)


def _followed(arm: Arm, joints: Array, turned: Array) -> Array:
    """∫ J(q̂) dq over each period, N × n: a sum over the pieces between the edges that are crossed."""
    owners, starts, shares = list[int](), list[Array](), list[Array]()
    for k, (start, way) in enumerate(zip(joints, turned, strict=True)):
        at = np.array([0.0, *_crossings(steps_of(arm), start, way), 1.0])
        owners += [k] * (len(at) - 1)
        starts.append(at[:-1])
        shares.append(np.diff(at))
    owner, start, share = np.array(owners), np.concatenate(starts), np.concatenate(shares)
    # Between edges J is constant, but for joints without steps: there it is as smooth as sine and cosine.
    nodes, weights = np.polynomial.legendre.leggauss(1 if (steps_of(arm) > 0).all() else _NODES)
    moved: Array = np.zeros((len(owner), 1))
    for node, weight in zip((nodes + 1) / 2, weights / 2, strict=True):
        places = joints[owner] + (start + node * share)[:, None] * turned[owner]
        pieces = weight * share[:, None] * turned[owner]
        moved = moved + np.einsum("kij,kj->ki", arm.jacobian(_readings(arm, places)), pieces)
    summed = np.zeros((len(joints), moved.shape[1]))
    np.add.at(summed, owner, moved)
    return summed


def _crossings(steps: Array, start: Array, way: Array) -> list[float]:
    """Where on the way an edge of an encoder is crossed, in order, as parts of it."""
    found = set[float]()
    for j in np.nonzero((steps > 0) & (way != 0))[0]:
        low, high = sorted((start[j], start[j] + way[j]))
        edges = np.arange(np.ceil(low / steps[j]), np.floor(high / steps[j]) + 1) * steps[j]
        found.update(c for c in ((edges - start[j]) / way[j]).tolist() if 0 < c < 1)
    return sorted(found)


def refuting_motion(
    arm: Arm,
    wall: Wall | MatrixWall,
    sample_period: float,
    delay_samples: int,
    at: Array,
    torque_held: bool = False,
    *,
    counted: bool = False,
) -> ArmMotion | None:
    """A motion near the joints `at` that takes energy out, `counted`: behind its encoders; or None.

    Of an arm with more joints than the hand has coordinates it is one of hands that hold the links, too.
    Of one whose joints give way there is none: no hand moves the motors as it likes.
    """
    arm = arm.resting(at)
    jacobian = arm.jacobian(at)
    redundant = jacobian.shape[1] > jacobian.shape[0]
    if arm.transmissions or not (redundant or holds_every_joint(jacobian, arm.turns)):
        return None
    samples, shape = _worst(arm, wall, sample_period, delay_samples, jacobian)
    turn = np.cos(2 * np.pi / samples * np.arange(samples))
    for amplitude in _AMPLITUDES:
        path = at + amplitude * turn[:, None] * shape
        motion = replay_cycle(arm, wall, sample_period, delay_samples, path, torque_held, counted=counted)
        if not np.isfinite(motion.energy):
            return None
        if motion.takes_energy:
            return replace(motion, imposed_by="links" if redundant else "end")
    return None


def holds_every_joint(jacobian: Array, turns: int) -> bool:
    """Whether a hand at the end holds every joint; rows of metres and rows of radians each by their size."""
    point = len(jacobian) - turns
    parts = [part for part in (jacobian[:point], jacobian[point:]) if len(part)]
    rows = np.concatenate([part / max(float(np.linalg.norm(part, 2)), _NOTHING) for part in parts])
    singular = np.linalg.svd(rows, compute_uv=False)
    return bool(jacobian.shape[1] <= jacobian.shape[0] and singular[-1] >= _HELD * singular[0])


def _worst(
    arm: Arm, wall: Wall | MatrixWall, sample_period: float, delay_samples: int, jacobian: Array
) -> tuple[int, Array]:
    """The number of samples of a round and the direction of the joints that give most, to first order."""
    found: list[tuple[float, int, Array]] = []
    for samples in range(2, _LONGEST + 1):
        theta = 2 * np.pi / samples
        need = damping_at(theta, wall, sample_period, delay_samples, jacobian.shape[0])
        values, vectors = np.linalg.eigh(as_matrix(arm.damping) - jacobian.T @ need @ jacobian)
        found.append((values[0] * (1 - np.cos(theta)), samples, vectors[:, 0]))
    return min(found, key=lambda item: item[0])[1:]


# A motion across edges of the encoders that takes energy out of a wall: Coulomb friction is too small.
#
# Where one or more readings step, the torque of joint i changes by
#
#     Σ_j ± Δ_j (J_iᵀ K J_j + Fᵀ ∂J_i/∂q_j)
#
# Four moves make a small rectangle: joint i goes by ℓ with the readings before the step and comes back with
# those after it; between the two the other joints cross their edges by next to nothing.  It gains ℓ times
# this change less 2 f_c,i ℓ and 2 b_i ℓ²/T.  The wall rests where its force F at the edge has the worst
# direction.  What is said is said by `replay_cycle`, with the full kinematics at the readings.

_PLACES = 60
"""Of the map, about which edges are tried; the worst of them are replayed."""
_TRIES = 12
_MOST_JOINTS = 6
"""That step: each doubles the corners."""
_ACROSS = 1e-3
"""Of a step: how far the other joints go beyond their edges, at most."""
_SHARE = 0.02
"""Of the gain that these crossings may cost."""
_LONGEST_WAY = 0.4
"""Of a step: how far the joint goes, at most."""
_MORE = 1.05
"""Of what the force of the wall is above the one allowed: so much less it pulls at the edge."""
_TIMES = (1.0001, 1.001, 1.003, 1.01, 1.03, 1.1, 1.3, 2.0, 4.0, 10.0)
"""Of the smallest force at which something is gained to first order."""
_RANK = 1e-9
"""Of the stiffness: eigenvalues below it give no force."""


class Corner(NamedTuple):
    """Edges that meet, and what crossing them changes in the torque of one joint."""

    at: Array  # q at the edges
    joint: int
    signs: Array  # on which side of its edge each joint is first
    direction: Array  # of the worst force of the wall, n
    change: float  # without a force, less 2 f_c
    per_force: float

    def change_at(self, force: float) -> float:
        """With the force; what is > 0 is gained, to first order, for each radian [N·m; N]."""
        return self.change + force * self.per_force


def first_motion(
    arm: Chain, wall: Wall | MatrixWall, period: float, delay_samples: int, joints: Array, torque_held: bool
) -> ArmMotion | None:
    """A motion near these places (…, m) that takes energy out, with the smallest force that was found."""
    corners = corners_of(arm, wall, joints, torque_held)
    forces = [-c.change / c.per_force for c in corners if c.per_force > 0]
    least = max(min(forces, default=0.0), _step_force(arm, wall, corners))
    for times in _TIMES:
        motion = motion_at(arm, wall, period, delay_samples, corners, times * least, torque_held)
        if motion is not None:
            return motion
    return None


def motion_at(
    arm: Chain,
    wall: Wall | MatrixWall,
    period: float,
    delay_samples: int,
    corners: Sequence[Corner],
    force: float,
    torque_held: bool,
) -> ArmMotion | None:
    """A motion that takes energy out with forces of the wall up to `force`; or None.

    In pose there is no moment but that of the steps.
    """
    gaining = [c for c in corners if c.change_at(force) > 0]
    for corner in sorted(gaining, key=lambda c: -c.change_at(force))[:_TRIES]:
        for waits in (1, delay_samples + 2):
            motion = _within(arm, wall, period, delay_samples, corner, waits, force, torque_held)
            if motion is not None:
                return motion
    return None


def corners_of(arm: Chain, wall: Wall | MatrixWall, joints: Array, torque_held: bool) -> list[Corner]:
    """The edges next to some places, with every joint and every way of crossing."""
    places = joints.reshape(-1, arm.joint_count)
    places = places[:: max(1, len(places) // _PLACES)]
    return [corner for place in places for corner in _corners(arm, wall, place, torque_held)]


def _corners(arm: Chain, wall: Wall | MatrixWall, place: Array, torque_held: bool) -> list[Corner]:
    steps = moving_steps(arm)
    stepping = np.nonzero(steps)[0]
    at = _nearest_edges(arm, place, steps)
    if at is None or len(stepping) > _MOST_JOINTS:
        return []
    here = arm.resting(at)
    jacobian, *others = here.jacobian(np.vstack([at, at - np.diag(steps)]))
    if not holds_every_joint(jacobian, arm.turns):
        return []
    k, _ = wall_matrices(wall, len(jacobian))
    stiff, given = jacobian.T @ k @ jacobian * steps, _range(k, arm.turns)
    own = np.asarray(arm.coulomb_friction or (0.0,) * len(at))
    bends = jacobian - np.array(others)  # Δ_j ∂J/∂q_j
    found = []
    for i in stepping:
        pulls = bends[:, :, i] @ given
        if not torque_held:
            pulls[i] = 0.0  # a torque that follows depends on this joint as on any position
        for sides in product((-1.0, 1.0), repeat=len(stepping) - 1):
            signs = np.zeros(len(at))
            signs[stepping] = 1.0
            signs[stepping[stepping != i]] = sides
            pull = signs @ pulls
            size = float(np.linalg.norm(pull))
            change = float(stiff[i] @ signs) - 2 * own[i]
            found.append(Corner(at, int(i), signs, pull / (size or 1.0), change, size))
    return found


def _step_force(arm: Chain, wall: Wall | MatrixWall, corners: Sequence[Corner]) -> float:
    """Twice what a step of the encoders changes the wall's force by: with less there is no edge [N]."""
    if not corners:
        return 0.0
    jacobian = arm.resting(corners[0].at).jacobian(corners[0].at)
    k, _ = wall_matrices(wall, len(jacobian))
    return 2 * float(np.abs(k @ jacobian @ np.diag(moving_steps(arm))).sum())


def _nearest_edges(arm: Chain, place: Array, steps: Array) -> Array | None:
    """The edges next to a place, a step inside the region; None if it has none."""
    low, high = np.array(arm.joint_range).T
    safe = np.where(steps > 0, steps, 1.0)
    first, last = np.ceil(low / safe) + 1, np.floor(high / safe) - 1
    if ((steps > 0) & (first > last)).any():
        return None
    edges = np.clip(np.round(place / safe), first, last) * safe
    return np.where(steps > 0, edges, place)


def _range(k: Array, turns: int) -> Array:
    """The projection on the forces that the wall's place of rest can give to the point, without a moment."""
    point = len(k) - turns
    values, vectors = np.linalg.eigh(k[:point, :point])
    given = vectors[:, values > _RANK * max(values[-1], 0.0)]
    full = np.zeros_like(k)
    full[:point, :point] = given @ given.T
    return full


def _within(
    arm: Chain,
    wall: Wall | MatrixWall,
    period: float,
    delay_samples: int,
    corner: Corner,
    waits: int,
    force: float,
    torque_held: bool,
) -> ArmMotion | None:
    """The rectangle at a corner, with the wall at rest so near that no force on the way is above `force`."""
    here = arm.resting(corner.at)
    path = np.repeat(_rectangle(arm, corner, period, force), waits, axis=0)
    k, _ = wall_matrices(wall, len(corner.direction))
    softness = np.linalg.pinv(k, hermitian=True)
    pull = force
    for _ in range(3):
        rest = here.forward(corner.at) - softness @ corner.direction * pull
        motion = replay_cycle(here, wall, period, delay_samples, path, torque_held, counted=True, rest=rest)
        if motion.largest_force <= force:
            return motion if motion.takes_energy else None
        pull -= _MORE * (motion.largest_force - force)
        if pull < 0:
            return None
    return None


def _rectangle(arm: Chain, corner: Corner, period: float, force: float) -> Array:
    """Its four points; as long as gains most, with viscous friction against it."""
    steps, i, gain = moving_steps(arm), corner.joint, corner.change_at(force)
    damping = float(as_matrix(arm.damping)[i, i])
    longest = _LONGEST_WAY * steps[i]
    length = min(longest, gain * period / (4 * damping)) if damping else longest
    own = np.asarray(arm.coulomb_friction or (0.0,) * len(steps))
    across = np.where(np.arange(len(steps)) == i, 0.0, steps * corner.signs)
    cost = 4 * float(own @ np.abs(across))
    small = min(_ACROSS, _SHARE * length * gain / cost) if cost else _ACROSS
    along = np.where(np.arange(len(steps)) == i, 1.0, 0.0)
    near, far = small * length * along, -length * along
    points = (near + small * across, far + small * across, far - small * across, near - small * across)
    return np.asarray(corner.at + np.asarray(points))
