"""What Coulomb friction in the joints covers the steps of their encoders.

A wall reads each joint wrong by less than one step, |q̂_j − q_j| ≤ Δ_j, and so renders a force that is
wrong by φ.  While the hand moves, φ does no more work than φᵀJ(q) q̇, wherever the arm is by then, and
friction takes Σ f_c,i |q̇_i|.  So the loop with encoders is as passive as without them if in every joint

    f_c,i ≥ Σ_a sup|J_a,i| Σ_b (‖K_ab‖ + 2 ‖B_ab‖/T) sup Σ_j Δ_j |J_b,j|

the suprema over the region; a and b stand for translation and rotation, and J_a,i for the columns
of these rows.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from zwidth.device.arm import Arm, Sites
from zwidth.environment.matrix_wall import MatrixWall
from zwidth.environment.wall import Wall
from zwidth.passivity.arms.need import wall_matrices

Array = npt.NDArray[np.float64]


def covering_friction(arm: Arm, wall: Wall | MatrixWall, period: float, sites: Sites) -> Array:
    """f_c of each joint that covers its encoder in the whole region [N·m; N of a sliding joint].

    Parameters
    ----------
    arm
        With encoders; the torque follows it.
    wall
        Of its hand.
    period
        T [s].
    sites
        Cells that cover the region; ∞ where one is not bounded.
    """
    reached = np.isfinite(sites.jacobians).all(axis=(-1, -2))
    jacobians = sites.jacobians[reached]
    n = jacobians.shape[-2]
    blocks = [slice(0, n - arm.turns), slice(n - arm.turns, n)] if arm.turns else [slice(0, n)]
    change = sites.change[reached][:, None] if sites.parts is None else sites.parts[reached]
    # |J_a,i| in any point of each cell: cell, block, joint
    columns = np.stack([np.linalg.norm(jacobians[:, rows], axis=-2) for rows in blocks], axis=1)
    columns = columns + change[:, :, None]
    misread = (columns @ np.asarray(arm.resolution)).max(axis=0)
    return np.asarray((_stiffness(wall, n, period, blocks) @ misread) @ columns.max(axis=0))


def _stiffness(wall: Wall | MatrixWall, n: int, period: float, blocks: list[slice]) -> Array:
    """‖K_ab‖ + 2 ‖B_ab‖/T of every two blocks."""
    k, b = wall_matrices(wall, n)
    return np.array(
        [
            [np.linalg.norm(k[r, c], 2) + 2 * np.linalg.norm(b[r, c], 2) / period for c in blocks]
            for r in blocks
        ]
    )
