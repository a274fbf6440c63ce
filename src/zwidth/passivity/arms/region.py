"""Where in its workspace an arm renders a wall passively, and what to change where it does not.

At each middle of a cell: does δ_m ⪰ Jᵀ R J hold, with what margin, in which direction does it fail?
Between the middles J changes by no more than η, so the smallest eigenvalue falls by no more than

    ‖R‖ (2 ‖J‖ η + η²)

and a cell with more margin than that is proved as a whole.  The loop is passive for every motion
that stays in proved cells.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil
from typing import TYPE_CHECKING, Any, NamedTuple

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
from zwidth.passivity.arms.need import WallNeed, wall_matrices, wall_need
from zwidth.passivity.arms.replay import ArmMotion, refuting_motion

if TYPE_CHECKING:
    import xarray

Array = npt.NDArray[np.float64]

_ROUNDING = 1e-12
"""Of the damping: how far rounding may move an eigenvalue."""
_FINE = 200
"""Cells along each side on which the proof is made, at least, in one or two coordinates."""
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
    arm, wall
        What was asked about.
    sample_period
        T [s].
    delay_samples
        d, whole samples from reading to force.
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
    n, m = sites.jacobians.shape[-2:]
    reached = _reached(sites)
    if not reached.any():
        raise InputError(f"{arm.name} reaches no point of its region, {sites.region}; choose another one")
    if m > n and min(arm.damping) == 0:
        raise InputError("an arm with more joints than coordinates needs damping > 0 in each of them")
    need = wall_need(wall, period, samples, n)
    fine = arm.sites(points * _refinement(sites, points))
    account = _account(arm, need.stiffness_share + need.bound, fine)
    columns = _columns(arm, wall, need, sites.jacobians[reached])
    tightest = _columns(arm, wall, need, fine.jacobians[account.reached])["largest_stiffness"][0].min()
    motion = _motion(arm, wall, period, samples, fine.joints[account.reached], account.margins)
    whole = np.zeros(account.reached.shape, dtype=bool)
    whole[account.reached] = account.proved
    outcome = "active" if motion is not None else "passive" if whole.all() else "undecided"
    return Workspace(
        outcome=outcome,
        claim=_claim(outcome, fine, account, arm),
        arm=arm,
        wall=wall,
        sample_period=period,
        delay_samples=samples,
        data=_dataset(sites, reached, _all_in_blocks(whole, reached.shape), columns),
        additions=tuple(float(v) for v in single_additions(account.counted).max(axis=0)),
        addition_to_all=max(0.0, -float(np.linalg.eigvalsh(account.counted)[:, 0].min())),
        largest_stiffness=float(min(tightest, columns["largest_stiffness"][0].min())),
        motion=motion,
    )


class _Account(NamedTuple):
    """What the cells of a fine grid show."""

    reached: npt.NDArray[np.bool_]
    margins: Array
    proved: npt.NDArray[np.bool_]
    counted: Array  # δ_m − JᵀRJ, less what it may lose inside the cell


def _account(arm: Arm, need: Array, sites: Sites) -> _Account:
    reached = _reached(sites)
    jacobians = sites.jacobians[reached]
    lacking = surplus(jacobians, arm.damping, need)
    margins = np.linalg.eigvalsh(lacking)[:, 0]
    loss = _loss(need, jacobians, sites.change[reached])
    rounding = _ROUNDING * (max(arm.damping) + float(np.abs(lacking).max()))
    taken = np.where(np.isfinite(loss), loss, 0.0)
    taken = taken + 10 * rounding  # damping that is added adds to the rounding too
    counted = lacking - taken[:, None, None] * np.eye(lacking.shape[-1])
    return _Account(reached, margins, margins > loss + rounding, counted)


def _reached(sites: Sites) -> npt.NDArray[np.bool_]:
    return np.asarray(np.isfinite(sites.jacobians).all(axis=(-1, -2)))


def _refinement(sites: Sites, points: int) -> int:
    """Into how many parts each side of a cell is cut for the proof."""
    return max(1, ceil(_FINE / points)) if len(sites.axes) < 3 else 1


def _all_in_blocks(fine: npt.NDArray[np.bool_], shape: tuple[int, ...]) -> npt.NDArray[np.bool_]:
    """True where every part of a cell is."""
    for axis, count in enumerate(shape):
        split = (*fine.shape[:axis], count, -1, *fine.shape[axis + 1 :])
        fine = fine.reshape(split).all(axis=axis + 1)
    return fine


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


def _columns(arm: Arm, wall: Wall | MatrixWall, need: WallNeed, jacobians: Array) -> dict[str, Column]:
    """What is mapped; at the hand in the directions U in which the arm can move."""
    spring, damper = need.stiffness_share, need.bound
    lacking = surplus(jacobians, arm.damping, spring + damper)
    alone = single_additions(lacking)
    frame, at_hand = _at_hand(jacobians, as_matrix(arm.damping))
    turned = np.swapaxes(frame, -1, -2)
    values, vectors = np.linalg.eigh(at_hand - turned @ (spring + damper) @ frame)
    worst = (frame @ vectors[..., :, :1])[..., 0]
    stiffness = wall_matrices(wall, frame.shape[-2])[0]
    scale = largest_scale(at_hand - turned @ damper @ frame, turned @ spring @ frame)
    columns: dict[str, Column] = {
        "margin": (values[..., 0], "N*s/m", "damping at the hand beyond need, in the worst direction"),
        "largest_stiffness": (scale * float(np.linalg.norm(stiffness, 2)), "N/m", "stiffest passive wall here"),
        "margin_in_joints": (
            np.linalg.eigvalsh(lacking)[:, 0], "N*m*s/rad", "smallest eigenvalue of damping less need",
        ),
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


def _claim(outcome: str, sites: Sites, account: _Account, arm: Arm) -> str:
    """One sentence on what holds, others on what is not counted."""
    part = 100 * account.proved.mean()
    if outcome == "passive":
        text = f"Passive for every motion of the hand with {sites.region}."
    elif outcome == "active":
        text = "At one point of this map a motion of the hand takes energy out."
    elif (account.margins >= 0).all():
        text = f"The condition holds at every point; between the points {part:.4g} % of the region are proved."
    else:
        text = (
            f"{part:.4g} % of the region are proved; where the condition fails, no motion was found "
            "that takes energy out."
        )
    if not account.reached.all():
        text += " Parts of the region are out of reach; a smaller region may be proved."
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
    variables["proved"] = (dims, proved, {"long_name": "the condition is proved in the whole cell"})
    coordinates: dict[str, Any] = {a.name: (a.name, a.middles, {"units": a.unit}) for a in sites.axes}
    for name, values in zip("xyz", np.moveaxis(sites.positions, -1, 0), strict=False):
        if name not in coordinates:
            coordinates[f"hand_{name}"] = (dims, values, {"units": "m"})
    return xarray.Dataset(variables, coordinates, {"region": sites.region})
