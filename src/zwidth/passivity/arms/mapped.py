"""What is mapped over a workspace, at the hand: margins, limits, directions, encoder steps, friction."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from zwidth.device.arm import Arm, Sites
from zwidth.environment.matrix_wall import MatrixWall
from zwidth.environment.wall import Wall
from zwidth.passivity.arms.joints import (
    end_effector_friction,
    end_effector_resolution,
    friction_surplus,
    largest_scale,
    single_additions,
    surplus,
)
from zwidth.passivity.arms.need import WallNeed, wall_matrices

Array = npt.NDArray[np.float64]
Truth = npt.NDArray[np.bool_]

_SINGULAR = 1e-4
"""Singular values of J below this part of the largest count as this, with the wall's share cut alike: damping
there is as good as infinite, yet leaves room for the digits of what is finite."""
_BLOCKED = 1e-12
"""Singular values of J below this part of the largest are rounding: the arm cannot move there."""

Column = tuple[Array, str, str]


def columns_of(
    arm: Arm, damping: Array, wall: Wall | MatrixWall, need: WallNeed, jacobians: Array
) -> dict[str, Column]:
    """What is mapped; at the hand in the directions U in which the arm can move."""
    spring, damper = need.stiffness_share, need.bound
    lacking = surplus(jacobians, damping, spring + damper)
    alone = single_additions(lacking)
    frame, seen, at_hand = _at_hand(jacobians, damping)
    turned = np.swapaxes(seen, -1, -2)
    values, vectors = np.linalg.eigh(at_hand - turned @ (spring + damper) @ seen)
    worst = (frame @ vectors[..., :, :1])[..., 0]
    stiffness = wall_matrices(wall, frame.shape[-2])[0]
    scale = largest_scale(at_hand - turned @ damper @ seen, turned @ spring @ seen)
    largest = float(np.linalg.norm(stiffness, 2))
    stiffest = np.where(np.isfinite(scale), scale, 0.0) * largest + np.where(np.isfinite(scale), 0.0, np.inf)
    in_joints = np.asarray(np.linalg.eigvalsh(lacking)[:, 0], dtype=np.float64)
    least = np.where(seen.any(axis=(-1, -2)), values[..., 0], np.inf)
    columns: dict[str, Column] = {
        "margin": (least, "N*s/m", "damping at the hand beyond need, in the worst direction"),
        "largest_stiffness": (stiffest, "N/m", "stiffest passive wall here"),
        "margin_in_joints": (in_joints, "N*m*s/rad", "smallest eigenvalue of damping less need"),
        "addition_to_one": (alone.min(axis=-1), "N*m*s/rad", "smallest damping added to one joint"),
        "joint_to_damp": (_joint(alone), "1", "joint that needs it, from 1; 0: none, -1: one is not enough"),
    }  # fmt: skip
    for name, component in zip("xyz", np.moveaxis(worst, -1, 0), strict=False):
        columns[f"direction_{name}"] = (component, "1", "unit vector of the worst direction")
    if arm.resolution:
        step = end_effector_resolution(jacobians, arm.resolution)
        columns["resolution"] = (step, "m", "largest step of the reading at the hand")
    if arm.coulomb_friction:
        held = end_effector_friction(jacobians, arm.coulomb_friction)
        columns["friction"] = (held, "N", "force that friction holds in every direction")
    if arm.coulomb_friction and arm.resolution:
        left = friction_surplus(
            jacobians, stiffness, np.array(arm.coulomb_friction), np.array(arm.resolution)
        )
        columns["friction_margin"] = (left, "N*m", "Coulomb friction beyond what the encoder steps ask for")
    if arm.torque_limit:
        columns["force_limit"] = (
            end_effector_friction(jacobians, arm.torque_limit), "N", "force that every direction gets",
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


def dataset(sites: Sites, reached: Truth, proved: Truth, columns: dict[str, Column]) -> Any:
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
    for name, values in zip("xyz", np.moveaxis(sites.positions, -1, 0), strict=False):
        if name not in coordinates:
            coordinates[f"hand_{name}"] = (dims, values, {"units": "m"})
    return xarray.Dataset(variables, coordinates, {"region": sites.region})
