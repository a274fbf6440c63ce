"""What is different where the wall is in pose: metres and radians at one hand.

The condition δ_m ⪰ Jᵀ R J is one of the joints and holds in any units of the hand.  But a margin
at the hand would have no unit, and one bound for all rows of J would let the rotation be weighed
with the stiffness of the translation.  With G = √R J and R's blocks on the diagonal, R_p and R_e,

    ‖G(q) − G‖ ≤ η = √‖R_p‖ η_p + √‖R_e‖ η_e,   λ_min falls by no more than 2 ‖G‖ η + η².
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from zwidth.errors import InputError
from zwidth.model.arms.kinematics import Arm
from zwidth.model.arms.matrix_wall import MatrixWall
from zwidth.model.environment.wall import Wall

Array = npt.NDArray[np.float64]


def fits(arm: Arm, wall: Wall | MatrixWall) -> None:
    """Refuse a wall in pose before a point, and a wall of a point before a hand in pose."""
    turns = wall.turns
    if turns == arm.turns:
        if arm.rests_anywhere and not _alike(wall, turns):
            raise InputError(
                "a wall that is not as stiff about every axis asks for more in some orientations of rest "
                "than in others: say where it rests, read_arm(…, rest={}) or --rest middle for the middle "
                "of the ranges"
            )
        return
    if arm.turns:
        planar = ", planar=True" if arm.turns == 1 else ""
        raise InputError(
            f"{arm.name} is held in pose, and N/m and N·m/rad are not one stiffness: give the wall as "
            f"MatrixWall.in_pose(500, 20{planar}) or MatrixWall(…, turns={arm.turns})"
        )
    raise InputError(
        f"the wall has {turns} rotations and {arm.name} is held at a point; ask for the arm in pose, "
        "read_arm(…, pose=True) or PlanarChain(…, pose=True)"
    )


def _alike(wall: Wall | MatrixWall, turns: int) -> bool:
    """Whether a wall is as stiff about every axis, without coupling of forces and turns."""
    matrices = [np.array(m) for m in (wall.stiffness, wall.damping)]
    last = np.eye(turns, len(matrices[0]), len(matrices[0]) - turns)
    return all(np.array_equal(m[-turns:], m[-1, -1] * last) for m in matrices)


def loss_in_pose(need: Array, jacobians: Array, parts: Array, turns: int) -> Array:
    """How far the smallest eigenvalue of δ_m − JᵀRJ may fall inside a cell [N·m·s/rad].

    Parameters
    ----------
    need
        R ⪰ 0, n × n.
    jacobians
        J (…, n, m).
    parts
        η_p [m/rad] and η_e [1] (…, 2), `Sites.parts`.
    turns
        How many rows, the last ones, are rotations.
    """
    point = need.shape[0] - turns
    weights = [np.sqrt(np.linalg.norm(block, 2)) for block in (need[:point, :point], need[point:, point:])]
    change = parts @ np.array(weights)
    load = np.linalg.eigvalsh(np.swapaxes(jacobians, -1, -2) @ need @ jacobians)[..., -1]
    return np.asarray(2 * np.sqrt(np.maximum(load, 0.0)) * change + change**2)


def motion_at_hand(worst: Array, jacobians: Array, turns: int) -> tuple[Array, Array]:
    """|J_p w| [m/rad] and |J_e w| [1]: how the hand moves and turns in a direction w of the joints (…, m)."""
    rates = np.einsum("...nm,...m->...n", jacobians, worst)
    point = rates.shape[-1] - turns
    return np.linalg.norm(rates[..., :point], axis=-1), np.linalg.norm(rates[..., point:], axis=-1)
