"""Where in its workspace an arm renders a wall passively, and what to change where it does not.

The loop is passive for every motion that stays in cells in which δ_m ⪰ Jᵀ R J is proved.  Where it does
not hold: in which direction, what would help, and a motion that takes energy out.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
import numpy.typing as npt

from zwidth.device.arm import Arm
from zwidth.environment.matrix_wall import MatrixWall
from zwidth.environment.wall import Wall
from zwidth.errors import InputError
from zwidth.passivity.arms.account import account_of, all_in_blocks, reached_cells, refinement
from zwidth.passivity.arms.certificate import arm_certificate
from zwidth.passivity.arms.claim import Covers, claim
from zwidth.passivity.arms.counting import Counting, counting, needs_encoders, with_motion
from zwidth.passivity.arms.encoders import EncoderSteps
from zwidth.passivity.arms.held import forces_of, held_torque_damping
from zwidth.passivity.arms.joints import as_matrix, single_additions
from zwidth.passivity.arms.least import least_additions
from zwidth.passivity.arms.mapped import columns_of, dataset, scaled_stiffness, stiffness_factors
from zwidth.passivity.arms.motion import ArmMotion
from zwidth.passivity.arms.need import wall_need
from zwidth.passivity.arms.pose import fits
from zwidth.passivity.arms.replay import refuting_motion, steps_of
from zwidth.passivity.arms.report import workspace_document
from zwidth.passivity.certificate import Certificate
from zwidth.passivity.document import save_json
from zwidth.passivity.outcome import Answer, Outcome
from zwidth.passivity.scope import Scope, Torque
from zwidth.quantity.exact import RealLike
from zwidth.quantity.units import parse_number

if TYPE_CHECKING:
    import xarray

Array = npt.NDArray[np.float64]

_OUTSIDE = "a reading may be outside the region, and one step around it nothing is proved"
_MOST_DELAY = 100
"""Samples."""
_TRIES = 20
"""Points from which a motion that takes energy out is sought, the worst first."""


@dataclass(frozen=True, kw_only=True)
class Workspace(Answer):
    """The answer for an arm: a verdict, the map, and what to change.

    Parameters
    ----------
    outcome
        "passive": the independent checker has shown the condition in the whole region, `certificate`.
        "passive without encoder steps": it has of an arm that is read without them, and this one has some.
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
    region
        In words: where the claim holds.
    torque
        "follows": the torque of each instant is that of the arm then, or of its readings. "held": it is
        computed once a sample.
    encoder
        "counted": the claim is of the wall's force and the Jacobian at the readings. "ideal": of an arm that
        is read without steps.
    largest_forces
        The force of the wall [N], in pose with its moment [N·m], up to which the claim goes; empty: any.
    encoder_steps
        What the steps ask of Coulomb friction, up to which force it covers them, and from which on a motion
        across them takes energy out; None where there are none, or no bound is known.
    can_be_refuted
        False of an arm with more joints than the hand has coordinates: no hand at its end makes them go round
        a path of their own, so that no motion is looked for.
    motion
        What takes energy out, if one was found.
    certificate
        The proof for `zwidth verify`, if "passive", with encoder steps or without.
    """

    outcome: Outcome
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
    region: str
    torque: str
    encoder: str
    largest_forces: tuple[float, ...]
    encoder_steps: EncoderSteps | None
    can_be_refuted: bool
    motion: ArmMotion | None
    certificate: Certificate | None = None

    @property
    def coordinates(self) -> int:
        """Of the hand: those of its point, and in pose those of its turn."""
        return int(self.data.attrs["coordinates"])

    @property
    def scope(self) -> Scope:
        """What the outcome is about: the wall pulls and pushes about its point of rest."""
        limits: tuple[float | None, ...] = (*self.largest_forces, None, None)
        follows: Torque = "follows the readings" if self.encoder == "counted" else "follows the arm"
        return Scope(
            contact="both sides",
            encoder="counted" if self.encoder == "counted" else self._encoder_left_out,
            largest_force=limits[0],
            largest_moment=limits[1],
            torque="held" if self.torque == "held" else follows,
            region=self.region,
            motion="linear",
        )

    @property
    def _encoder_left_out(self) -> Literal["ideal", "not counted"]:
        return "not counted" if any(self.arm.resolution) else "ideal"

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
    largest_force: float | Sequence[float] | None = None,
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
    largest_force
        Of the wall, ≥ 0 [N], in pose with a moment: up to it encoder steps are to be counted, and the answer
        is "undecided" where they cannot be. None: as far as Coulomb friction covers them; where it does at
        no force, and no motion across them is found, the answer is "passive without encoder steps" at best.

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
    held_to = forces_of(arm, torque_held_up_to, "torque_held_up_to")
    asked = forces_of(arm, largest_force, "largest_force")
    if held_to and asked:
        raise InputError("torque_held_up_to says the largest force already; leave largest_force out")
    needs_encoders(arm, asked)
    held = held_torque_damping(arm, period, samples, held_to)
    damping = as_matrix(arm.damping) - held * np.eye(m)
    if m > n and np.linalg.eigvalsh(damping)[0] <= 0:
        raise InputError(
            "an arm with more joints than coordinates needs damping in each of them, "
            "beyond what held torques ask for"
        )
    parts = refinement(sites, points)
    fine = sites if parts == 1 else arm.sites(points * parts)
    account = account_of(damping, need.stiffness_share + need.bound, fine, arm.turns)
    factors = stiffness_factors(damping, need, fine.jacobians[account.reached])
    count = counting(arm, wall, period, fine, held_to or asked)
    steps = count.steps
    if steps is not None:
        steps = with_motion(count, arm, wall, period, samples, sites, bool(held_to))
    certificate, words, encoder = None, "", "counted" if asked else "ideal"
    if account.reached.all() and (account.margins > 0).all():
        certificate, words, encoder = _proof(arm, wall, hertz, samples, held_to, count, bool(asked))
    at = fine.joints[account.reached]
    read = (True, False) if count.limits else (True,) if asked else (False,)
    motion = _motion(arm, wall, period, samples, at, account.margins, bool(held_to), asked, read)
    if motion is None and steps is not None:
        motion = _across(steps.motion, held_to or asked, count.limits)
    whole = np.zeros(account.reached.shape, dtype=bool)
    whole[account.reached] = account.proved
    if certificate is not None:
        whole[...] = True
        account = account._replace(counted=np.eye(m)[None])  # nothing is missing
    if motion is not None:
        certificate, encoder = None, motion.encoder
    stepped = encoder == "ideal" and bool(steps_of(arm).any())
    outcome = _outcome(motion, certificate, stepped, bool(whole.all()), bool(asked))
    limits = held_to or asked
    if encoder == "counted" and motion is None:
        limits = count.limits or limits
    columns = columns_of(arm, damping, wall, need, sites, reached, period, limits)
    factor = min(columns["stiffness_factor"][0].min(), factors.min())
    covers = Covers(
        region=fine.region,
        torque="held" if held_to else "follows",
        encoder=encoder,
        forces=limits,
        why_ideal=(count.reason or _OUTSIDE) if any(arm.resolution) else "",
        can_be_refuted=m <= n,
        has_friction=any(arm.coulomb_friction),
    )
    return Workspace(
        outcome=outcome,
        claim=claim(outcome, covers, account, words, steps),
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
        region=covers.region,
        torque=covers.torque,
        encoder=covers.encoder,
        largest_forces=covers.forces,
        encoder_steps=steps,
        can_be_refuted=covers.can_be_refuted,
        motion=motion,
        certificate=certificate,
    )


def _proof(
    arm: Arm,
    wall: Wall | MatrixWall,
    rate: float,
    samples: int,
    held_to: tuple[float, ...],
    count: Counting,
    required: bool,
) -> tuple[Certificate | None, str, str]:
    """A certificate or why there is none, and of which encoder: of the steps, if it can be or has to be."""
    certificate, words = None, count.reason
    if count.limits and count.steps is not None:
        certificate, words = arm_certificate(arm, wall, rate, samples, held_to, count)
    if certificate is not None or required:
        return certificate, words, "counted"
    return (*arm_certificate(arm, wall, rate, samples, held_to), "ideal")


def _outcome(
    motion: ArmMotion | None,
    certificate: Certificate | None,
    stepped: bool,
    everywhere: bool,
    required: bool,
) -> Outcome:
    """Of an arm whose steps are to be counted there is no theorem: without a certificate nothing is said."""
    if motion is not None:
        return "active"
    if certificate is not None:
        return "passive without encoder steps" if stepped else "passive"
    return "theorem" if everywhere and not required else "undecided"


def _across(
    motion: ArmMotion | None, asked: tuple[float, ...], covered: tuple[float, ...]
) -> ArmMotion | None:
    """A motion across the edges, if it says something of the forces asked for; where none is covered, any."""
    if asked:
        return motion if _within(motion, asked) else None
    return None if covered else motion


def _within(motion: ArmMotion | None, asked: tuple[float, ...]) -> bool:
    if motion is None or motion.encoder != "counted":
        return False
    return motion.largest_force <= asked[0] and motion.largest_moment <= (*asked, 0.0)[1]


def _timing(rate: float, delay: float) -> tuple[float, int]:
    if rate <= 0:
        raise InputError(f"rate must be > 0 Hz, got {rate!r}")
    if delay < 0:
        raise InputError(f"delay must be ≥ 0 s, got {delay!r}")
    samples = round(delay * rate)
    if samples > _MOST_DELAY:
        raise InputError(
            f"delay is {delay:g} s, {samples} samples at {rate:g} Hz, and no controller of a haptic device "
            f"waits for more than {_MOST_DELAY}; a number without a unit is in seconds: "
            'write "3 ms" for milliseconds'
        )
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
    asked: tuple[float, ...],
    read: tuple[bool, ...],
) -> ArmMotion | None:
    """Near the worst points, with the encoders counted or not, in the order of `read`."""
    failing = np.argsort(margins)[: int((margins < 0).sum())]
    tried = failing[:: max(1, len(failing) // _TRIES)][:_TRIES]
    for counted in read:
        for k in tried:
            motion = refuting_motion(arm, wall, period, samples, joints[k], torque_held, counted=counted)
            if motion is not None and (not asked or _within(motion, asked)):
                return motion
    return None
