"""Where in its workspace an arm renders a wall passively, and what to change where it does not.

At each middle of a cell: does δ_m ⪰ Jᵀ R J hold, with what margin, in which direction does it fail?
Between the middles J changes by no more than η, so the smallest eigenvalue falls by no more than

    ‖R‖ (2 ‖J‖ η + η²)

and a cell with more margin than that is proved as a whole.  The loop is passive for every motion
that stays in proved cells.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from zwidth.device.arm import Arm, Sites
from zwidth.environment.matrix_wall import MatrixWall
from zwidth.environment.wall import Wall
from zwidth.errors import InputError
from zwidth.passivity.arms.joints import (
    as_matrix,
    end_effector_friction,
    end_effector_resolution,
    friction_surplus,
    largest_scale,
    single_additions,
    surplus,
)
from zwidth.passivity.arms.need import wall_matrices, wall_need
from zwidth.passivity.arms.replay import ArmMotion, refuting_motion

if TYPE_CHECKING:
    import xarray

Array = npt.NDArray[np.float64]

_ROUNDING = 1e-12
"""Of the damping: how far rounding may move an eigenvalue."""
_TRIES = 20
"""Points from which a motion that takes energy out is sought, the worst first."""
_SINGULAR = 1e-9
"""Singular values of J below this part of the largest count as this: the damping there is as good as infinite."""


@dataclass(frozen=True, kw_only=True)
class Workspace:
    """The answer for an arm: a verdict, the map, and what to change.

    Parameters
    ----------
    outcome
        "passive": every cell of the region is proved. "active": at one point a motion of the hand takes
        energy out, `motion`. "undecided": neither.
    claim
        In words, with what was assumed.
    data
        The map, an xarray Dataset over the cells; each variable has its unit in `attrs`.
    additions
        The smallest damping that, given to one joint alone, proves the region; ∞ where none does
        [N·m·s/rad].
    addition_to_all
        The smallest damping that, given to every joint, proves the region [N·m·s/rad].
    largest_stiffness
        The stiffest wall of this kind that holds at every point, in the largest stiffness of any
        direction [N/m].
    motion
        What takes energy out, near the worst point, if one was found.
    """

    outcome: str
    claim: str
    arm: Arm
    wall: Wall | MatrixWall
    sample_period: float
    delay_samples: int
    data: xarray.Dataset
    additions: tuple[float, ...]
    addition_to_all: float
    largest_stiffness: float
    motion: ArmMotion | None


def workspace(
    arm: Arm,
    wall: Wall | MatrixWall,
    *,
    rate: float,
    delay: float = 0.0,
    points: int = 100,
) -> Workspace:
    """Map over the workspace whether an arm renders a wall passively.

    Parameters
    ----------
    arm
        `zwidth.arms.built_in`, `PlanarChain`, `LeggedArm`, or `read_arm` of a description.
    wall
        `Wall`, equally stiff in every direction (or a plane wall with any normal), or `MatrixWall`.
    rate
        Samples per second, > 0 [Hz].
    delay
        From reading to force, a whole number of samples [s]; round up what is not.
    points
        Cells along each side of the map, from 2 to 1000.

    Raises
    ------
    InputError
        If a number is outside its bound, or the arm reaches no point of its region.
    """
    period, samples = _timing(rate, delay)
    if not isinstance(arm, Arm):
        raise InputError(f"the first argument is an arm, got {type(arm).__name__}")
    if isinstance(points, bool) or not isinstance(points, int) or not 2 <= points <= 1000:
        raise InputError(f"points must be a whole number from 2 to 1000, got {points!r}")
    sites = arm.sites(points)
    reached = np.isfinite(sites.jacobians).all(axis=(-1, -2))
    if not reached.any():
        raise InputError(f"{arm.name} reaches no point of its region, {sites.region}; choose another one")
    n, m = sites.jacobians.shape[-2:]
    if m > n and min(arm.damping) == 0:
        raise InputError("an arm with more joints than coordinates needs damping > 0 in each of them")
    need = wall_need(wall, period, samples, n)
    jacobians = sites.jacobians[reached]
    total = need.stiffness_share + need.bound
    lacking = surplus(jacobians, arm.damping, total)
    margins = np.linalg.eigvalsh(lacking)[:, 0]
    loss = _loss(total, jacobians, sites.change[reached])
    rounding = _ROUNDING * (max(arm.damping) + float(np.abs(lacking).max()))
    proved = margins > loss + rounding
    columns = _columns(arm, wall, need.stiffness_share, need.bound, jacobians)
    counted = lacking - np.where(np.isfinite(loss), loss, 0.0)[:, None, None] * np.eye(m)
    counted -= 10 * rounding * np.eye(m)  # the damping that is added adds to the rounding too
    alone = single_additions(counted)
    columns["margin_in_joints"] = (margins, "N*m*s/rad", "smallest eigenvalue of damping less need")
    columns["addition_to_one"] = (alone.min(axis=-1), "N*m*s/rad", "smallest damping added to one joint")
    columns["joint_to_damp"] = (_joint(alone), "1", "joint that needs it, from 1; 0: none, -1: one is not enough")
    motion = _motion(arm, wall, period, samples, sites.joints[reached], margins)
    outcome = "active" if motion is not None else "passive" if proved.all() else "undecided"
    return Workspace(
        outcome=outcome,
        claim=_claim(outcome, sites, proved, margins, arm),
        arm=arm,
        wall=wall,
        sample_period=period,
        delay_samples=samples,
        data=_dataset(sites, reached, proved, columns),
        additions=tuple(float(v) for v in alone.max(axis=0)),
        addition_to_all=max(0.0, -float(np.linalg.eigvalsh(counted)[:, 0].min())),
        largest_stiffness=float(columns["largest_stiffness"][0].min()),
        motion=motion,
    )


def _timing(rate: float, delay: float) -> tuple[float, int]:
    if not (isinstance(rate, (int, float)) and 0 < rate < np.inf):
        raise InputError(f"rate must be > 0 Hz, got {rate!r}")
    if not (isinstance(delay, (int, float)) and 0 <= delay < np.inf):
        raise InputError(f"delay must be ≥ 0 s, got {delay!r}")
    samples = round(delay * rate)
    if abs(delay * rate - samples) > 1e-9 * max(1, samples):
        raise InputError(
            f"for arms the delay is a whole number of samples, got {delay * rate:g}; "
            "round it up: that is safe for springs"
        )
    return 1 / rate, samples


def _loss(need: Array, jacobians: Array, change: Array) -> Array:
    """How far the smallest eigenvalue may fall inside a cell."""
    size = np.linalg.norm(jacobians, ord=2, axis=(-2, -1))
    with np.errstate(invalid="ignore"):
        return np.asarray(np.linalg.norm(need, 2) * (2 * size * change + change**2))


Column = tuple[Array, str, str]


def _columns(arm: Arm, wall: Wall | MatrixWall, spring: Array, damper: Array, jacobians: Array) -> dict[str, Column]:
    """What is mapped at the hand; in the directions U in which the arm can move."""
    frame, at_hand = _at_hand(jacobians, as_matrix(arm.damping))
    turned = np.swapaxes(frame, -1, -2)
    values, vectors = np.linalg.eigh(at_hand - turned @ (spring + damper) @ frame)
    worst = (frame @ vectors[..., :, :1])[..., 0]
    stiffness = wall_matrices(wall, frame.shape[-2])[0]
    scale = largest_scale(at_hand - turned @ damper @ frame, turned @ spring @ frame)
    columns: dict[str, Column] = {
        "margin": (values[..., 0], "N*s/m", "damping at the hand beyond need, in the worst direction"),
        "largest_stiffness": (scale * float(np.linalg.norm(stiffness, 2)), "N/m", "stiffest passive wall here"),
    }
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


def _at_hand(jacobians: Array, damping: Array) -> tuple[Array, Array]:
    """U (…, n, r) and δ in its axes (…, r, r), from J = U S Vᵀ: (S Vᵀ δ_m⁻¹ V S)⁻¹."""
    u, s, vt = np.linalg.svd(jacobians, full_matrices=False)
    s = np.maximum(s, _SINGULAR * s[..., :1])
    v = np.swapaxes(vt, -1, -2)
    if jacobians.shape[-1] <= jacobians.shape[-2]:
        inner = vt @ damping @ v
    else:
        inner = np.linalg.inv(vt @ np.linalg.inv(damping) @ v)
    return u, inner / (s[..., :, None] * s[..., None, :])


def _joint(alone: Array) -> Array:
    best = alone.argmin(axis=-1) + 1.0
    least = alone.min(axis=-1)
    return np.where(least == 0, 0.0, np.where(np.isfinite(least), best, -1.0))


def _motion(
    arm: Arm, wall: Wall | MatrixWall, period: float, samples: int, joints: Array, margins: Array
) -> ArmMotion | None:
    failing = np.argsort(margins)[: int((margins < 0).sum())]
    tried = failing[:: max(1, len(failing) // _TRIES)][:_TRIES]
    for k in tried:
        motion = refuting_motion(arm, wall, period, samples, joints[k])
        if motion is not None:
            return motion
    return None


def _claim(outcome: str, sites: Sites, proved: Array, margins: Array, arm: Arm) -> str:
    """One sentence on what holds, one on what is not counted."""
    cells, good = len(proved), int(proved.sum())
    if outcome == "passive":
        text = f"Passive for every motion of the hand with {sites.region}."
    elif outcome == "active":
        text = "At one point of this map a motion of the hand takes energy out."
    elif (margins >= 0).all():
        text = f"The condition holds at all {cells} points; {good} of {cells} cells are proved between them."
    else:
        text = f"{good} of {cells} cells are proved; where the condition fails no motion was found to refute it."
    outside = proved.size < sites.change.size
    text += " Parts of the region are out of reach and are not meant." if outside else ""
    return text + (" Encoder steps are not counted." if any(arm.resolution) else "")


def _dataset(sites: Sites, reached: Array, proved: Array, columns: dict[str, Column]) -> Any:
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
    certain = np.zeros(reached.shape, dtype=bool)
    certain[reached] = proved
    variables["proved"] = (dims, certain, {"long_name": "the condition is proved in the whole cell"})
    coordinates: dict[str, Any] = {a.name: (a.name, a.middles, {"units": a.unit}) for a in sites.axes}
    for name, values in zip("xyz", np.moveaxis(sites.positions, -1, 0), strict=False):
        if name not in coordinates:
            coordinates[f"hand_{name}"] = (dims, values, {"units": "m"})
    return xarray.Dataset(variables, coordinates, {"region": sites.region})
