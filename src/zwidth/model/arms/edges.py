"""A motion across edges of the encoders that takes energy out of a wall: Coulomb friction is too small.

Where one or more readings step, the torque of joint i changes by

    Σ_j ± Δ_j (J_iᵀ K J_j + Fᵀ ∂J_i/∂q_j)

Four moves make a small rectangle: joint i goes by ℓ with the readings before the step and comes back with
those after it; between the two the other joints cross their edges by next to nothing.  It gains ℓ times this
change less 2 f_c,i ℓ and 2 b_i ℓ²/T.  The wall rests where its force F at the edge has the worst direction.
What is said is said by `replay_cycle`, with the full kinematics at the readings.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import product
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from zwidth.model.arms.encoders import Chain, moving_steps
from zwidth.model.arms.joints import as_matrix
from zwidth.model.arms.matrix_wall import MatrixWall
from zwidth.model.arms.motion import ArmMotion
from zwidth.model.arms.need import wall_matrices
from zwidth.model.arms.replay import holds_every_joint, replay_cycle
from zwidth.model.environment.wall import Wall

Array = npt.NDArray[np.float64]

_PLACES = 60
"""Of the map, about which edges are tried; the worst of them are replayed."""
_TRIES = 12
_MOST_JOINTS = 6
"""That step: each doubles the corners."""
_ACROSS = 1e-3
"""Of a step: how far the other joints go beyond their edges, at most."""
_SHARE = 0.02
"""Of the gain that these crossings may cost."""
_LONGEST = 0.4
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
    """A motion inside the region that takes energy out, with the smallest force for which one was found.

    Parameters
    ----------
    arm, wall, period, delay_samples
        The loop: chains with encoders, T [s], whole samples of delay.
    joints
        Places of the region, (…, m).
    torque_held
        The torque is computed once a sample.
    """
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
    longest = _LONGEST * steps[i]
    length = min(longest, gain * period / (4 * damping)) if damping else longest
    own = np.asarray(arm.coulomb_friction or (0.0,) * len(steps))
    across = np.where(np.arange(len(steps)) == i, 0.0, steps * corner.signs)
    cost = 4 * float(own @ np.abs(across))
    small = min(_ACROSS, _SHARE * length * gain / cost) if cost else _ACROSS
    along = np.where(np.arange(len(steps)) == i, 1.0, 0.0)
    near, far = small * length * along, -length * along
    points = (near + small * across, far + small * across, far - small * across, near - small * across)
    return np.asarray(corner.at + np.asarray(points))
