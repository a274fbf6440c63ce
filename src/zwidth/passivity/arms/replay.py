"""A motion of an arm that takes energy out of a wall, replayed with its full geometry.

The joints go round a small closed path, straight from sample to sample:

    q(k) = q₀ + ε Re(w e^{jkθ}),   θ = 2π/N

Where the wall's force is held and its torque J(q)ᵀF follows the arm, its work over a period
is exactly F(k)·(p(q(k+1)) − p(q(k))); where the torque is held it is F(k)·J(q(k)) Δq.  The
joints lose Σ b_i Δq_i²/T + f_c,i |Δq_i|.  Nothing here is linearized.
A hand at the end can make this motion wherever it can hold every joint:
where J has as many independent columns as there are joints.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from zwidth.device.arm import Arm
from zwidth.environment.matrix_wall import MatrixWall
from zwidth.environment.wall import Wall
from zwidth.passivity.arms.joints import as_matrix
from zwidth.passivity.arms.need import damping_at, wall_matrices

Array = npt.NDArray[np.float64]

_LONGEST = 64
"""Samples of the longest cycle that is tried."""
_AMPLITUDES = (1e-3, 3e-3, 1e-2, 3e-2, 1e-1)
"""Of the joints [rad; m]; larger ones only where Coulomb friction eats the small ones."""
_HELD = 1e-3
"""Smallest ratio of the singular values of J at which a hand is taken to hold every joint."""
_NOTHING = 1e-6
"""Rows of J that are smaller [m/rad; 1] do not move the hand."""


@dataclass(frozen=True, kw_only=True)
class ArmMotion:
    """A closed motion, and its energy over one round.

    Parameters
    ----------
    joints
        q(k), N × m [rad; m].
    positions
        p(k), N × n [m]; in pose its rotation comes last [rad].
    work
        Of the hand against the wall's force, over one round [J].
    loss
        Of the joints' friction, over one round [J].
    """

    joints: Array
    positions: Array
    work: float
    loss: float

    @property
    def energy(self) -> float:
        """What the hand puts in, over one round [J]; negative: it takes energy out."""
        return self.work + self.loss


def replay_cycle(
    arm: Arm,
    wall: Wall | MatrixWall,
    sample_period: float,
    delay_samples: int,
    joints: Array,
    torque_held: bool = False,
) -> ArmMotion:
    """The energy of a closed path of the joints q(k), N × m, gone round for ever."""
    p = arm.forward(joints)
    k, b = wall_matrices(wall, p.shape[-1])
    depth = p - p.mean(axis=0)  # where the wall rests does not matter on a closed path
    read = np.roll(depth, delay_samples, axis=0)
    before = np.roll(depth, delay_samples + 1, axis=0)
    force = read @ k + (read - before) / sample_period @ b
    moved, turned = np.roll(p, -1, axis=0) - p, np.roll(joints, -1, axis=0) - joints
    if torque_held:
        moved = np.einsum("kij,kj->ki", arm.jacobian(joints), turned)
    friction = np.asarray(arm.coulomb_friction or (0.0,) * joints.shape[-1])
    viscous = np.einsum("ki,ij,kj->", turned, as_matrix(arm.damping), turned) / sample_period
    return ArmMotion(
        joints=joints,
        positions=p,
        work=float((force * moved).sum()),
        loss=float(viscous + (np.abs(turned) @ friction).sum()),
    )


def refuting_motion(
    arm: Arm,
    wall: Wall | MatrixWall,
    sample_period: float,
    delay_samples: int,
    at: Array,
    torque_held: bool = False,
) -> ArmMotion | None:
    """A motion near the joints `at` that takes energy out; None where none was found."""
    arm = arm.resting(at)
    jacobian = arm.jacobian(at)
    if not _held(jacobian, arm.turns):
        return None
    samples, shape = _worst(arm, wall, sample_period, delay_samples, jacobian)
    turn = np.cos(2 * np.pi / samples * np.arange(samples))
    for amplitude in _AMPLITUDES:
        path = at + amplitude * turn[:, None] * shape
        motion = replay_cycle(arm, wall, sample_period, delay_samples, path, torque_held)
        if not np.isfinite(motion.energy):
            return None
        if motion.energy < -1e-9 * (abs(motion.work) + motion.loss):
            return motion
    return None


def _held(jacobian: Array, turns: int) -> bool:
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
