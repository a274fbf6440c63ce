"""Where in its workspace an arm renders a wall passively, and what to change where it does not.

At each middle of a cell: does δ_m ⪰ Jᵀ R J hold, with what margin, in which direction does it fail?
Between the middles J changes by no more than η, so the smallest eigenvalue falls by no more than

    ‖R‖ (2 ‖J‖ η + η²)

and a cell with more margin than that is proved as a whole.  The loop is passive for every motion
that stays in proved cells.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import ceil
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import numpy.typing as npt

from zwidth.device.arm import Arm, Sites
from zwidth.environment.matrix_wall import MatrixWall
from zwidth.environment.wall import Wall
from zwidth.errors import InputError
from zwidth.passivity.arms.certificate import arm_certificate
from zwidth.passivity.arms.encoders import covering_friction
from zwidth.passivity.arms.held import held_torque_damping, in_words
from zwidth.passivity.arms.joints import (
    as_matrix,
    single_additions,
    surplus,
)
from zwidth.passivity.arms.least import least_additions
from zwidth.passivity.arms.mapped import columns_of, dataset, scaled_stiffness, stiffness_factors
from zwidth.passivity.arms.need import wall_need
from zwidth.passivity.arms.pose import fits, loss_in_pose
from zwidth.passivity.arms.replay import ArmMotion, refuting_motion
from zwidth.passivity.arms.report import workspace_document
from zwidth.passivity.certificate import Certificate
from zwidth.passivity.document import save_json
from zwidth.quantity.exact import RealLike
from zwidth.quantity.units import parse_number

if TYPE_CHECKING:
    import xarray

Array = npt.NDArray[np.float64]
Truth = npt.NDArray[np.bool_]

_ROUNDING = 1e-12
"""Of the damping: how far rounding may move an eigenvalue."""
_FINE = 200
"""Cells along each side on which the proof is made, at least, in one or two coordinates."""
_TRIES = 20
"""Points from which a motion that takes energy out is sought, the worst first."""


@dataclass(frozen=True, kw_only=True)
class Workspace:
    """The answer for an arm: a verdict, the map, and what to change.

    Parameters
    ----------
    outcome
        "passive": the independent checker has shown the condition in the whole region, `certificate`.
        "theorem": it holds in every cell, reckoned in doubles with room for rounding, without a certificate.
        "active": at one point a motion of the hand takes energy out, `motion`. "undecided": none of these.
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
    least_additions
        The damping of the joints with the smallest sum that proves the region [N·m·s/rad].
    stiffness_factor
        How many times as stiff the wall may be and hold at every point; ∞ if it has no stiffness.
    largest_stiffness
        The stiffest wall of this kind that holds at every point, in the largest stiffness of any
        direction [N/m]; None of a wall in pose, which has two units.
    encoder_friction
        Coulomb friction of each joint that covers the encoder steps in the whole region, the torque following
        the arm [N·m]; empty where no encoder is known.
    motion
        What takes energy out, near the worst point, if one was found.
    certificate
        The proof for `zwidth verify`, if "passive".
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
    least_additions: tuple[float, ...]
    stiffness_factor: float
    largest_stiffness: float | None
    encoder_friction: tuple[float, ...]
    motion: ArmMotion | None
    certificate: Certificate | None = None

    def __repr__(self) -> str:
        return (
            f"<Workspace {self.outcome}: {self.claim} "
            f"Stiffest wall at every point: {self.largest_stiffness:.6g} N/m>"
        )

    def to_dict(self) -> dict[str, Any]:
        """The verdict with its evidence as plain data; the map is in `data`."""
        return workspace_document(self)

    def save(self, path: str | Path) -> None:
        """Write the verdict with its certificate as JSON for `zwidth verify`; the map is in `data`."""
        save_json(path, self.to_dict())


def workspace(
    arm: Arm,
    wall: Wall | MatrixWall,
    *,
    rate: RealLike,
    delay: RealLike = 0,
    points: int = 100,
    torque_held_up_to: float | Sequence[float] | None = None,
) -> Workspace:
    """Map over the workspace whether an arm renders a wall passively.

    Parameters
    ----------
    arm
        `zwidth.arms.built_in`, `PlanarChain`, `LeggedArm`, or `read_arm` of a description.
    wall
        `Wall`, equally stiff in every direction (or a plane wall with any normal), or `MatrixWall`; of an
        arm in pose `MatrixWall.in_pose`.
    rate
        Samples per second, > 0 [Hz], or a text such as "1 kHz".
    delay
        From reading to force, a whole number of samples [s], or a text; round up what is not.
    points
        Cells along each side of the map, from 2 to 1000.
    torque_held_up_to
        None: the force is held, and the torque J(q)ᵀF follows the arm within each period, as Miller and
        others assume. A force ≥ 0 [N]: the torque J(q_k)ᵀF is held, and the wall renders no more than
        this; for chains and descriptions, whose curvature is bounded, and without delay. In pose a force
        and a moment [N], [N·m].

    Raises
    ------
    InputError
        If a number is outside its bound, or the arm reaches no point of its region.
    """
    hertz = float(parse_number(rate, "Hz", "rate"))
    period, samples = _timing(hertz, float(parse_number(delay, "s", "delay")))
    if not isinstance(arm, Arm):
        raise InputError(f"the first argument is an arm, got {type(arm).__name__}")
    if isinstance(points, bool) or not isinstance(points, int) or not 2 <= points <= 1000:
        raise InputError(f"points must be a whole number from 2 to 1000, got {points!r}")
    fits(arm, wall)
    sites = arm.sites(points)
    n, m = sites.jacobians.shape[-2:]
    reached = _reached(sites)
    if not reached.any():
        raise InputError(f"{arm.name} reaches no point of its region, {sites.region}; choose another one")
    need = wall_need(wall, period, samples, n)
    held = held_torque_damping(arm, period, samples, torque_held_up_to)
    damping = as_matrix(arm.damping) - held * np.eye(m)
    if m > n and np.linalg.eigvalsh(damping)[0] <= 0:
        raise InputError(
            "an arm with more joints than coordinates needs damping in each of them, "
            "beyond what held torques ask for"
        )
    parts = _refinement(sites, points)
    fine = sites if parts == 1 else arm.sites(points * parts)
    account = _account(damping, need.stiffness_share + need.bound, fine, arm.turns)
    columns = columns_of(arm, damping, wall, need, sites.jacobians[reached])
    factors = stiffness_factors(damping, need, fine.jacobians[account.reached])
    factor = min(columns["stiffness_factor"][0].min(), factors.min())
    at = fine.joints[account.reached]
    motion = _motion(arm, wall, period, samples, at, account.margins, torque_held_up_to is not None)
    whole = np.zeros(account.reached.shape, dtype=bool)
    whole[account.reached] = account.proved
    certificate, words = None, ""
    if account.reached.all() and (account.margins > 0).all():
        certificate, words = arm_certificate(arm, wall, hertz, samples, torque_held_up_to)
    if certificate is not None:
        whole[...] = True
        account = account._replace(counted=np.eye(m)[None])  # nothing is missing
    friction: Array = np.zeros(0)
    if any(arm.resolution):
        friction = covering_friction(arm, wall, period, fine)
    proof = "theorem" if certificate is None else "passive"
    outcome = "active" if motion is not None else proof if whole.all() else "undecided"
    return Workspace(
        outcome=outcome,
        claim=_claim(outcome, fine, account, arm, torque_held_up_to, words)
        + _encoders(arm, friction, torque_held_up_to is not None),
        arm=arm,
        wall=wall,
        sample_period=period,
        delay_samples=samples,
        data=dataset(arm, sites, reached, _all_in_blocks(whole, reached.shape), columns),
        additions=tuple(float(v) for v in single_additions(account.counted).max(axis=0)),
        addition_to_all=max(0.0, -float(np.linalg.eigvalsh(account.counted)[:, 0].min())),
        least_additions=tuple(least_additions(account.counted)[0].tolist()),
        stiffness_factor=float(factor),
        largest_stiffness=None if arm.turns else float(scaled_stiffness(wall, factor, n)),
        encoder_friction=tuple(friction.tolist()),
        motion=motion,
        certificate=certificate,
    )


class _Account(NamedTuple):
    """What the cells of a fine grid show."""

    reached: Truth
    margins: Array
    proved: Truth
    counted: Array  # δ_m − JᵀRJ, less what it may lose inside the cell


def _account(damping: Array, need: Array, sites: Sites, turns: int) -> _Account:
    reached = _reached(sites)
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
    return _Account(reached, margins, margins > loss + rounding, counted)


def _reached(sites: Sites) -> Truth:
    return np.asarray(np.isfinite(sites.jacobians).all(axis=(-1, -2)))


def _refinement(sites: Sites, points: int) -> int:
    """Into how many parts each side of a cell is cut for the proof."""
    return max(1, ceil(_FINE / points)) if len(sites.axes) < 3 else 1


def _all_in_blocks(fine: Truth, shape: tuple[int, ...]) -> Truth:
    """True where every part of a cell is."""
    for axis, count in enumerate(shape):
        split = (*fine.shape[:axis], count, -1, *fine.shape[axis + 1 :])
        fine = np.asarray(fine.reshape(split).all(axis=axis + 1))
    return fine


def _timing(rate: float, delay: float) -> tuple[float, int]:
    if rate <= 0:
        raise InputError(f"rate must be > 0 Hz, got {rate!r}")
    if delay < 0:
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


def _motion(
    arm: Arm,
    wall: Wall | MatrixWall,
    period: float,
    samples: int,
    joints: Array,
    margins: Array,
    torque_held: bool,
) -> ArmMotion | None:
    failing = np.argsort(margins)[: int((margins < 0).sum())]
    tried = failing[:: max(1, len(failing) // _TRIES)][:_TRIES]
    for k in tried:
        motion = refuting_motion(arm, wall, period, samples, joints[k], torque_held)
        if motion is not None:
            return motion
    return None


def _claim(
    outcome: str,
    sites: Sites,
    account: _Account,
    arm: Arm,
    held: float | Sequence[float] | None,
    without: str,
) -> str:
    """One sentence on what holds, others on what is not counted."""
    part = 100 * account.proved.mean()
    if outcome == "passive":
        text = f"No motion of the hand takes energy out with {sites.region}, proved."
    elif outcome == "theorem":
        text = f"No motion of the hand takes energy out with {sites.region}, by a proof on paper."
    elif outcome == "active":
        text = "At one point of this map a motion of the hand takes energy out."
    elif (account.margins >= 0).all():
        text = (
            f"The condition holds at every point; between the points {part:.4g} % of the region are proved."
        )
    else:
        text = (
            f"{part:.4g} % of the region are proved; where the condition fails, no motion was found "
            "that takes energy out."
        )
    if outcome in ("theorem", "undecided") and without:
        text += f" There is no certificate: {without}."
    if not account.reached.all():
        text += " Parts of the region are out of reach; a smaller region may be proved."
    return text + (
        " The torque is taken to follow the arm within a period."
        if held is None
        else f" The torque is held over a period, with wall forces up to {in_words(held)}."
    )


def _encoders(arm: Arm, friction: Array, held: bool) -> str:
    if not friction.size:
        return ""
    own = arm.coulomb_friction or (0.0,) * len(friction)
    if held or not (friction <= own).all():
        return " Encoder steps are not counted."
    return " Encoder steps are counted: Coulomb friction covers them, by a proof on paper."
