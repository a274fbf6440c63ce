"""Where in its workspace an arm renders a wall passively, and what to change where it does not.

The loop is passive for every motion that stays in cells in which δ_m ⪰ Jᵀ R J is proved.  Where it does
not hold: in which direction, what would help, and a motion that takes energy out.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from zwidth.arms import Arm
from zwidth.arms.held import forces_of, held_torque_damping
from zwidth.arms.joints import as_matrix, single_additions
from zwidth.arms.least import least_additions
from zwidth.arms.matrix_wall import MatrixWall
from zwidth.arms.motion import ArmMotion
from zwidth.arms.need import wall_need
from zwidth.arms.pose import fits
from zwidth.arms.replay import refuting_motion, steps_of
from zwidth.environment.wall import Wall
from zwidth.errors import InputError
from zwidth.passivity.certificate import Certificate
from zwidth.passivity.outcome import Outcome
from zwidth.passivity.workspace.account import account_of, all_in_blocks, reached_cells, refinement
from zwidth.passivity.workspace.certificate import arm_certificate
from zwidth.passivity.workspace.claim import Covers, claim
from zwidth.passivity.workspace.counting import Counting, counting, needs_encoders, with_motion
from zwidth.passivity.workspace.mapped import columns_of, dataset, scaled_stiffness, stiffness_factors
from zwidth.passivity.workspace.verdict import Workspace
from zwidth.quantity.exact import RealLike
from zwidth.quantity.units import parse_number

Array = npt.NDArray[np.float64]

_OUTSIDE = "a reading may be outside the region, and one step around it nothing is proved"
_MOST_DELAY = 100
"""Samples."""
_TRIES = 20
"""Points from which a motion that takes energy out is sought, the worst first."""


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
