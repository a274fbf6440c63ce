"""What is mapped over a workspace, at the hand, and what its cells show."""

from __future__ import annotations

from math import ceil
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from zwidth.model.arms import Arm, Sites
from zwidth.model.arms.encoders import columns_in_cells, friction_for, with_encoders
from zwidth.model.arms.joints import (
    end_effector_friction,
    end_effector_resolution,
    largest_scale,
    single_additions,
    surplus,
)
from zwidth.model.arms.wall import MatrixWall, WallNeed, loss_in_pose, motion_at_hand, wall_matrices
from zwidth.model.environment.wall import Wall
from zwidth.quantity.text import shown

Array = npt.NDArray[np.float64]
Truth = npt.NDArray[np.bool_]

_SINGULAR = 1e-4
"""Singular values of J below this part of the largest count as this, with the wall's share cut alike: damping
there is as good as infinite, yet leaves room for the digits of what is finite."""
_BLOCKED = 1e-12
"""Singular values of J below this part of the largest are rounding: the arm cannot move there."""

SPATIAL = 3
"""Rotations of a hand in space: there moments cost friction, too, and no force alone is covered."""

Column = tuple[Array, str, str]


def columns_of(
    arm: Arm,
    damping: Array,
    wall: Wall | MatrixWall,
    need: WallNeed,
    sites: Sites,
    reached: Truth,
    period: float,
    forces: tuple[float, ...],
) -> dict[str, Column]:
    """What is mapped; of a hand in pose the margin is one of the joints, as metres and radians do not mix."""
    jacobians = sites.jacobians[reached]
    lacking = surplus(jacobians, damping, need.stiffness_share + need.bound)
    alone = single_additions(lacking)
    factor = stiffness_factors(damping, need, jacobians)
    in_joints, vectors = np.linalg.eigh(lacking)
    if arm.turns:
        own = _in_pose(jacobians, vectors[..., :, 0], arm.turns)
    else:
        own = _at_point(jacobians, damping, need)
        stiffest = scaled_stiffness(wall, factor, jacobians.shape[-2])
        own["largest_stiffness"] = (stiffest, "N/m", "stiffest passive wall here")
    shared: dict[str, Column] = {
        "stiffness_factor": (factor, "1", "the wall may be this many times as stiff here"),
        "margin_in_joints": (in_joints[..., 0], "N*m*s/rad", "smallest eigenvalue of damping less need"),
        "addition_to_one": (alone.min(axis=-1), "N*m*s/rad", "smallest damping added to one joint"),
        "joint_to_damp": (_joint(alone), "1", "joint that needs it, from 1; 0: none, -1: one is not enough"),
    }  # fmt: skip
    return {**own, **shared, **_held(arm, jacobians), **_encoders(arm, wall, sites, reached, period, forces)}


def stiffness_factors(damping: Array, need: WallNeed, jacobians: Array) -> Array:
    """By how much K may be multiplied (…); 0 where virtual damping alone asks for too much, ∞ without K."""
    load = np.swapaxes(jacobians, -1, -2) @ need.stiffness_share @ jacobians
    return largest_scale(surplus(jacobians, damping, need.bound), load)


def scaled_stiffness(wall: Wall | MatrixWall, factor: Array, size: int) -> Array:
    """The largest stiffness of any direction of the wall with `factor` times its K [N/m]."""
    largest = float(np.linalg.norm(wall_matrices(wall, size)[0], 2))
    finite = np.isfinite(factor)
    return np.where(finite, np.where(finite, factor, 0.0) * largest, np.inf)


def _at_point(jacobians: Array, damping: Array, need: WallNeed) -> dict[str, Column]:
    """The margin at the hand, in the directions U in which the arm can move."""
    frame, seen, at_hand = _at_hand(jacobians, damping)
    turned = np.swapaxes(seen, -1, -2)
    values, vectors = np.linalg.eigh(at_hand - turned @ (need.stiffness_share + need.bound) @ seen)
    worst = (frame @ vectors[..., :, :1])[..., 0]
    least = np.where(seen.any(axis=(-1, -2)), values[..., 0], np.inf)
    columns: dict[str, Column] = {
        "margin": (least, "N*s/m", "damping at the hand beyond need, in the worst direction")
    }
    for name, component in zip("xyz", np.moveaxis(worst, -1, 0), strict=False):
        columns[f"direction_{name}"] = (component, "1", "unit vector of the worst direction")
    return columns


def _in_pose(jacobians: Array, worst: Array, turns: int) -> dict[str, Column]:
    """The direction of the joints in which the margin is smallest, and what the hand does in it."""
    moves, turned = motion_at_hand(worst, jacobians, turns)
    columns: dict[str, Column] = {
        "worst_translation": (moves, "m/rad", "how the hand moves in the worst direction of the joints"),
        "worst_rotation": (turned, "1", "how the hand turns in the worst direction of the joints"),
    }
    for i, component in enumerate(np.moveaxis(worst, -1, 0), start=1):
        columns[f"direction_{i}"] = (component, "1", "unit vector of the worst direction of the joints")
    return columns


def _held(arm: Arm, jacobians: Array) -> dict[str, Column]:
    """Encoder steps, friction and motors: of forces, and in pose of moments apart."""
    columns: dict[str, Column] = {}
    point = jacobians.shape[-2] - arm.turns
    parts = [("", jacobians[..., :point, :], "m", "N", "force")]
    if arm.turns:
        parts.append(("rotational_", jacobians[..., point:, :], "rad", "N*m", "moment"))
    for prefix, rows, step_unit, unit, kind in parts:
        if arm.resolution:
            step = end_effector_resolution(rows, arm.resolution)
            columns[f"{prefix}resolution"] = (step, step_unit, "largest step of the reading at the hand")
        if arm.coulomb_friction:
            held = end_effector_friction(rows, arm.coulomb_friction)
            columns[f"{prefix}friction"] = (held, unit, f"{kind} that friction holds in every direction")
        if arm.torque_limit:
            given = end_effector_friction(rows, arm.torque_limit)
            columns[f"{prefix}force_limit"] = (given, unit, f"{kind} that every direction gets")
    return columns


def _encoders(
    arm: Arm, wall: Wall | MatrixWall, sites: Sites, reached: Truth, period: float, forces: tuple[float, ...]
) -> dict[str, Column]:
    """What friction has beyond the encoder steps in each cell, whose readings may lie in the next one."""
    chain = with_encoders(arm)
    if chain is None or not arm.coulomb_friction:
        return {}
    steps, each, turned = friction_for(chain, wall, period, columns_in_cells(chain, sites)[reached])
    left = np.array(arm.coulomb_friction) - steps
    force, moment = (*forces, 0.0, 0.0)[:2]
    margin = (left - force * each - (moment * turned if moment < np.inf else 0.0)).min(axis=-1)
    words = f"Coulomb friction beyond what encoder steps ask for, for wall forces up to {shown(force, 'N')}"
    with np.errstate(divide="ignore", invalid="ignore"):
        most = np.where(each > 0, left / each, np.where(left < 0, 0.0, np.inf)).min(axis=-1)
    columns: dict[str, Column] = {"friction_margin": (margin, "N*m", words)}
    if arm.turns != SPATIAL:
        columns["covered_force"] = (
            np.maximum(most, 0.0), "N", "largest force of the wall up to which friction covers the steps here"
        )  # fmt: skip
    return columns


def _at_hand(jacobians: Array, damping: Array) -> tuple[Array, Array, Array]:
    """U (…, n, r), U P and P δ P in its axes (…, r, r), from J = U S Vᵀ and δ = (S Vᵀ δ_m⁻¹ V S)⁻¹.

    P = 1 but for directions in which the arm can hardly move, where S/P is raised to a floor: δ − UᵀRU ⪰ 0
    exactly if PδP − PUᵀRUP ⪰ 0, and no entry is so large that the others drown in its rounding.
    """
    u, s, vt = np.linalg.svd(jacobians, full_matrices=False)
    raised = np.maximum(s, _SINGULAR * s[..., :1])
    raised = np.where(raised > 0, raised, 1.0)  # the hand on the axis of the only joint: nothing moves it
    share = np.where(s > _BLOCKED * s[..., :1], s / raised, 0.0)
    v = np.swapaxes(vt, -1, -2)
    if jacobians.shape[-1] <= jacobians.shape[-2]:
        inner = vt @ damping @ v
    else:
        inner = np.linalg.inv(vt @ np.linalg.inv(damping) @ v)
    return u, u * share[..., None, :], inner / (raised[..., :, None] * raised[..., None, :])


def _joint(alone: Array) -> Array:
    best = alone.argmin(axis=-1) + 1.0
    least = alone.min(axis=-1)
    return np.where(least == 0, 0.0, np.where(np.isfinite(least), best, -1.0))


def dataset(arm: Arm, sites: Sites, reached: Truth, proved: Truth, columns: dict[str, Column]) -> Any:
    import xarray

    dims = tuple(axis.name for axis in sites.axes)

    def full(values: Array) -> Array:
        whole = np.full(reached.shape, np.nan)
        whole[reached] = values
        return whole

    variables: dict[str, Any] = {
        name: (dims, full(values), {"units": unit, "long_name": words})
        for name, (values, unit, words) in columns.items()
    }
    variables["proved"] = (dims, proved, {"long_name": "the condition is proved in the whole cell"})
    coordinates: dict[str, Any] = {a.name: (a.name, a.middles, {"units": a.unit}) for a in sites.axes}
    point = sites.positions[..., : sites.positions.shape[-1] - arm.turns]
    for name, values in zip("xyz", np.moveaxis(point, -1, 0), strict=False):
        if name not in coordinates:
            coordinates[f"hand_{name}"] = (dims, values, {"units": "m"})
    attributes = {"region": sites.region, "coordinates": sites.jacobians.shape[-2]}
    return xarray.Dataset(variables, coordinates, attributes)


# What the cells of a workspace show: where the condition holds, and what is lacking where it does not.
#
# At each middle of a cell: does δ_m ⪰ Jᵀ R J hold, with what margin?  Between the middles J changes by
# no more than η, so the smallest eigenvalue falls by no more than
#
#     ‖R‖ (2 ‖J‖ η + η²)
#
# and a cell with more margin than that is proved as a whole.


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
