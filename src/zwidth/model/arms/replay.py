"""A motion of an arm that takes energy out of a wall, replayed with its full geometry.

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

from dataclasses import replace

import numpy as np
import numpy.typing as npt

from zwidth.model.arms.encoders import moving_steps
from zwidth.model.arms.joints import as_matrix
from zwidth.model.arms.kinematics import Arm, DescribedArm, PlanarChain
from zwidth.model.arms.matrix_wall import MatrixWall
from zwidth.model.arms.motion import ArmMotion
from zwidth.model.arms.need import damping_at, wall_matrices
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
    """
    arm = arm.resting(at)
    jacobian = arm.jacobian(at)
    redundant = jacobian.shape[1] > jacobian.shape[0]
    if not redundant and not holds_every_joint(jacobian, arm.turns):
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
