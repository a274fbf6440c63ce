"""What the cells of a workspace show: where the condition holds, and what is lacking where it does not.

At each middle of a cell: does δ_m ⪰ Jᵀ R J hold, with what margin?  Between the middles J changes by
no more than η, so the smallest eigenvalue falls by no more than

    ‖R‖ (2 ‖J‖ η + η²)

and a cell with more margin than that is proved as a whole.
"""

from __future__ import annotations

from math import ceil
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from zwidth.model.arms import Sites
from zwidth.model.arms.joints import surplus
from zwidth.model.arms.wall import loss_in_pose

Array = npt.NDArray[np.float64]
Truth = npt.NDArray[np.bool_]

_ROUNDING = 1e-12
"""Of the damping: how far rounding may move an eigenvalue."""
_FINE = 200
"""Cells along each side on which the proof is made, at least, in one or two coordinates."""


class Account(NamedTuple):
    """What the cells of a fine grid show."""

    reached: Truth
    margins: Array
    proved: Truth
    points: Array  # δ_m − JᵀRJ at the middle of the cell
    counted: Array  # the same, less what it may lose inside the cell


def account_of(damping: Array, need: Array, sites: Sites, turns: int) -> Account:
    """Decide every cell that the arm reaches; `need` is R, `turns` how many rows of J are rotations."""
    reached = reached_cells(sites)
    jacobians = sites.jacobians[reached]
    lacking = surplus(jacobians, damping, need)
    margins = np.asarray(np.linalg.eigvalsh(lacking)[:, 0], dtype=np.float64)
    if sites.parts is None:
        loss = _loss(need, jacobians, sites.change[reached])
    else:
        loss = loss_in_pose(need, jacobians, sites.parts[reached], turns)
    rounding = _ROUNDING * (float(np.abs(damping).max()) + float(np.abs(lacking).max()))
    taken = np.where(np.isfinite(loss), loss, 0.0)
    taken = taken + 10 * rounding  # damping that is added adds to the rounding too
    counted = np.asarray(lacking - taken[:, None, None] * np.eye(lacking.shape[-1]))
    return Account(reached, margins, margins > loss + rounding, lacking, counted)


def reached_cells(sites: Sites) -> Truth:
    """Where the arm reaches the middle of the cell."""
    return np.asarray(np.isfinite(sites.jacobians).all(axis=(-1, -2)))


def refinement(sites: Sites, points: int) -> int:
    """Into how many parts each side of a cell is cut for the proof."""
    return max(1, ceil(_FINE / points)) if len(sites.axes) < 3 else 1


def all_in_blocks(fine: Truth, shape: tuple[int, ...]) -> Truth:
    """True where every part of a cell is."""
    for axis, count in enumerate(shape):
        split = (*fine.shape[:axis], count, -1, *fine.shape[axis + 1 :])
        fine = np.asarray(fine.reshape(split).all(axis=axis + 1))
    return fine


def _loss(need: Array, jacobians: Array, change: Array) -> Array:
    """How far the smallest eigenvalue may fall inside a cell."""
    size = np.linalg.norm(jacobians, ord=2, axis=(-2, -1))
    with np.errstate(invalid="ignore"):
        return np.asarray(np.linalg.norm(need, 2) * (2 * size * change + change**2))
