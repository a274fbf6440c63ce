"""Where in its workspace an arm renders a wall passively, and what to change where it does not.

The loop is passive for every motion that stays in cells in which δ_m ⪰ Jᵀ R J is proved.  Where it does
not hold: in which direction, what would help, and a motion that takes energy out.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from zwidth.device.arm import Arm
from zwidth.environment.matrix_wall import MatrixWall
from zwidth.environment.wall import Wall
from zwidth.errors import InputError
from zwidth.passivity.arms.account import account_of, all_in_blocks, reached_cells, refinement
from zwidth.passivity.arms.certificate import arm_certificate
from zwidth.passivity.arms.claim import claim, encoders
from zwidth.passivity.arms.encoders import covering_friction
from zwidth.passivity.arms.held import held_torque_damping
from zwidth.passivity.arms.joints import as_matrix, single_additions
from zwidth.passivity.arms.least import least_additions
from zwidth.passivity.arms.mapped import columns_of, dataset, scaled_stiffness, stiffness_factors
from zwidth.passivity.arms.need import wall_need
from zwidth.passivity.arms.pose import fits
from zwidth.passivity.arms.replay import ArmMotion, refuting_motion
from zwidth.passivity.arms.report import workspace_document
from zwidth.passivity.certificate import Certificate
from zwidth.passivity.document import save_json
from zwidth.quantity.exact import RealLike
from zwidth.quantity.units import parse_number

if TYPE_CHECKING:
    import xarray

Array = npt.NDArray[np.float64]

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
        stiffest = f"{self.stiffness_factor:.6g} times this one"
        if self.largest_stiffness is not None:
            stiffest = f"{self.largest_stiffness:.6g} N/m"
        return f"<Workspace {self.outcome}: {self.claim} Stiffest wall at every point: {stiffest}>"

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
    reached = reached_cells(sites)
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
    parts = refinement(sites, points)
    fine = sites if parts == 1 else arm.sites(points * parts)
    account = account_of(damping, need.stiffness_share + need.bound, fine, arm.turns)
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
        claim=claim(outcome, fine, account, arm, torque_held_up_to, words)
        + encoders(arm, friction, torque_held_up_to is not None),
        arm=arm,
        wall=wall,
        sample_period=period,
        delay_samples=samples,
        data=dataset(arm, sites, reached, all_in_blocks(whole, reached.shape), columns),
        additions=tuple(float(v) for v in single_additions(account.counted).max(axis=0)),
        addition_to_all=max(0.0, -float(np.linalg.eigvalsh(account.counted)[:, 0].min())),
        least_additions=tuple(least_additions(account.counted)[0].tolist()),
        stiffness_factor=float(factor),
        largest_stiffness=None if arm.turns else float(scaled_stiffness(wall, factor, n)),
        encoder_friction=tuple(friction.tolist()),
        motion=motion,
        certificate=certificate,
    )


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
