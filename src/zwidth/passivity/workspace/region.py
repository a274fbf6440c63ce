"""Where in its workspace an arm renders a wall passively, and what to change where it does not.

The loop is passive for every motion that stays in cells in which δ_m ⪰ Jᵀ R J is proved.  Where it does
not hold: in which direction, what would help, and a motion that takes energy out.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from zwidth.errors import InputError
from zwidth.model.arms import Arm, ArmMotion, EncoderSteps, Sites
from zwidth.model.arms.encoders import in_words
from zwidth.model.arms.replay import refuting_motion, steps_of
from zwidth.model.arms.wall import MatrixWall
from zwidth.model.environment.wall import Wall
from zwidth.passivity.certificate import Certificate
from zwidth.passivity.scope import Outcome
from zwidth.passivity.workspace.certificate import arm_certificate
from zwidth.passivity.workspace.mapped import (
    Account,
    account_of,
    all_in_blocks,
    columns_of,
    dataset,
    reached_cells,
    refinement,
    scaled_stiffness,
    stiffness_factors,
)
from zwidth.passivity.workspace.question import Counting, Forces, Question, asked_of, counting, with_motion
from zwidth.passivity.workspace.verdict import OF_JOINTS_THAT_GIVE_WAY, Additions, Workspace, moved
from zwidth.quantity.exact import RealLike
from zwidth.quantity.text import shown

_OUTSIDE = "a reading may be outside the region, and one step around it nothing is proved"


def workspace(
    arm: Arm,
    wall: Wall | MatrixWall,
    *,
    rate: RealLike,
    delay: RealLike = 0,
    points: int = 100,
    torque_held_up_to: RealLike | Sequence[RealLike] | None = None,
    largest_force: RealLike | Sequence[RealLike] | None = None,
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
    question = asked_of(arm, wall, rate, delay, points, torque_held_up_to, largest_force)
    sites = arm.sites(points)
    n, period = sites.jacobians.shape[-2], question.period
    reached = reached_cells(sites)
    if not reached.any():
        raise InputError(f"{arm.name} reaches no point of its region, {sites.region}; choose another one")
    need, damping = question.need(n), question.damping(n)
    parts = refinement(sites, points)
    fine = sites if parts == 1 else arm.sites(points * parts)
    account = account_of(damping, need.stiffness_share + need.bound, fine, arm.turns)
    factors = stiffness_factors(damping, need, fine.jacobians[account.reached])
    count = counting(question, fine)
    found = evidence_for(question, count, sites, fine, account)
    whole = np.zeros(account.reached.shape, dtype=bool)
    whole[account.reached] = account.proved
    if found.nothing_missing:
        whole[...] = True
        account = account._replace(counted=np.eye(arm.joint_count)[None])
    outcome = _outcome(found, question, bool(whole.all()))
    limits = question.forces
    if found.encoder == "counted" and found.motion is None:
        limits = count.limits or limits
    columns = columns_of(arm, damping, wall, need, sites, reached, period, limits)
    factor = min(columns["stiffness_factor"][0].min(), factors.min())
    why_ideal = (count.reason or _OUTSIDE) if any(arm.resolution) else ""
    covers = Covers(question, fine.region, limits, why_ideal)
    return Workspace(
        outcome=outcome,
        found=what_was_found(outcome, covers, account, found),
        besides=besides(outcome, covers, account, found),
        arm=arm,
        wall=wall,
        sample_period=period,
        delay_samples=question.delay_samples,
        data=dataset(arm, sites, reached, all_in_blocks(whole, reached.shape), columns),
        added=Additions(question=question, points=account.points, cells=account.counted),
        stiffness_factor=float(factor),
        largest_stiffness=None if arm.turns else float(scaled_stiffness(wall, factor, n)),
        region=fine.region,
        torque="held" if question.torque_held else "follows",
        encoder=found.encoder,
        largest_forces=limits,
        encoder_steps=found.steps,
        can_be_refuted=arm.joint_count <= n and not arm.transmissions,
        motion=found.motion,
        certificate=found.certificate,
    )


def _outcome(found: Evidence, question: Question, everywhere: bool) -> Outcome:
    """Of an arm whose steps are to be counted there is no theorem: without a certificate nothing is said."""
    if found.motion is not None:
        return "active"
    if found.certificate is not None:
        stepped = found.encoder == "ideal" and bool(steps_of(question.arm).any())
        return "passive without encoder steps" if stepped else "passive"
    return "theorem" if everywhere and not question.asked else "undecided"


class Covers(NamedTuple):
    """What a verdict on an arm is about."""

    question: Question
    region: str
    forces: Forces
    why_ideal: str  # why the steps of an arm that has some are not counted


def what_was_found(outcome: str, covers: Covers, account: Account, found: Evidence) -> str:
    """What was found and how much, without its point."""
    part = shown(account.proved.mean(), "%")
    where = f"{covers.region}{_up_to(covers)}"
    if outcome == "passive":
        return f"No motion of the hand takes energy out with {where}, proved"
    if outcome == "passive without encoder steps":
        return f"Read without steps, no motion of the hand would take energy out with {where}, proved"
    if outcome == "theorem":
        return f"No motion of the hand takes energy out with {where}, by a proof on paper"
    if found.motion is not None:
        return f"At one point of this map {moved(found.motion, covers.question.period)}"
    if not (account.margins >= 0).all():
        return (
            f"{part} of the region are proved; at other points the condition fails, and no motion was "
            f"{'looked for' if covers.question.arm.transmissions else 'found that takes energy out'}"
        )
    if found.encoder == "counted" and found.words:
        return f"Whether a motion takes energy out behind these encoders is not known: {found.words}"
    return f"The condition holds at every point; between the points {part} of the region are proved"


def besides(outcome: str, covers: Covers, account: Account, found: Evidence) -> str:
    """What is not counted, and how the arm is read."""
    told, arm = list[str](), covers.question.arm
    if found.motion is not None and found.motion.imposed_by == "links":
        told.append(
            "These are hands that hold the links, such as one at the elbow and one at the end; a hand at the "
            "end alone cannot make every joint follow, and of it nothing is said."
        )
    if found.motion is not None and found.encoder == "counted" and not any(arm.coulomb_friction):
        told.append("Coulomb friction is not given and taken as 0.")
    said = found.encoder == "counted" and (account.margins >= 0).all()
    if outcome in ("theorem", "undecided") and found.words and not said:
        told.append(f"There is no certificate: {found.words}.")
    if not account.reached.all():
        told.append("Parts of the region are out of reach; a smaller region may be proved.")
    if arm.transmissions:
        told.append(OF_JOINTS_THAT_GIVE_WAY)
    return " ".join([*told, f"{_counted(covers, found.encoder, outcome)}{_beyond(found.steps, outcome)}"])


def _counted(covers: Covers, encoder: str, outcome: str) -> str:
    """How the arm is read, and what becomes of the torque within a period."""
    up_to = _up_to(covers) if outcome == "undecided" else ""  # what is proved says it first
    held = covers.question.torque_held
    if encoder == "counted":
        torque = "is held over a period" if held else "follows the readings within a period"
        read = "force and Jacobian are those of the readings"
        return f"Encoder steps are counted{up_to}: {read}, and the torque {torque}."
    torque = f"held over a period{up_to}" if held else "taken to follow the arm within a period"
    steps = f" Encoder steps are not counted: {covers.why_ideal}." if covers.why_ideal else ""
    return f"The arm is taken to be read without steps.{steps} The torque is {torque}."


def _up_to(covers: Covers) -> str:
    if not covers.forces or in_words(covers.forces) == "any":
        return ""
    return f", for wall forces up to {in_words(covers.forces)}"


def _beyond(steps: EncoderSteps | None, outcome: str) -> str:
    """From which force on a motion across the edges of the encoders is known."""
    if steps is None or steps.refuted is None or outcome == "active":
        return ""
    return f" From {shown(steps.refuted, 'N', 4)} on a motion across their edges takes energy out."


_TRIES = 20
"""Points from which a motion that takes energy out is sought, the worst first."""


class Evidence(NamedTuple):
    """What was found, and how far the encoders are in it."""

    certificate: Certificate | None  # None beside a motion
    motion: ArmMotion | None
    steps: EncoderSteps | None
    encoder: str  # "counted" or "ideal"
    words: str  # why there is no certificate
    nothing_missing: bool  # the condition was proved in all of the region


def evidence_for(
    question: Question, count: Counting, sites: Sites, fine: Sites, account: Account
) -> Evidence:
    """A certificate where every cell has a margin, and a motion where one is found; it counts for more.

    Motions are looked for in the `fine` cells of the account; across the edges of encoders in `sites`.
    """
    steps = with_motion(count, question, sites)
    certificate, words, encoder = None, "", "counted" if question.asked else "ideal"
    if account.reached.all() and (account.margins > 0).all():
        certificate, words, encoder = _proof(question, count)
    joints = fine.joints[account.reached]
    read = (True, False) if count.limits else (bool(question.asked),)  # behind the encoders or not, in order
    motion = _motion_inside(question, joints, account.margins, read)
    if motion is None and steps is not None:
        motion = _across(steps.motion, question.forces, count.limits)
    if motion is not None:
        encoder = motion.encoder
    left = certificate if motion is None else None
    return Evidence(left, motion, steps, encoder, words, certificate is not None)


def _proof(question: Question, count: Counting) -> tuple[Certificate | None, str, str]:
    """A certificate or why there is none, and of which encoder: of the steps, if it can be or has to be."""
    certificate, words = None, count.reason
    if count.limits and count.steps is not None:
        certificate, words = arm_certificate(question, count)
    if certificate is not None or question.asked:
        return certificate, words, "counted"
    return (*arm_certificate(question), "ideal")


def _across(motion: ArmMotion | None, asked: Forces, covered: Forces) -> ArmMotion | None:
    """A motion across the edges, if it says something of the forces asked for; where none is covered, any."""
    if asked:
        return motion if _within(motion, asked) else None
    return None if covered else motion


def _within(motion: ArmMotion | None, asked: Forces) -> bool:
    if motion is None or motion.encoder != "counted":
        return False
    return motion.largest_force <= asked[0] and motion.largest_moment <= (*asked, 0.0)[1]


def _motion_inside(
    question: Question,
    joints: npt.NDArray[np.float64],
    margins: npt.NDArray[np.float64],
    read: tuple[bool, ...],
) -> ArmMotion | None:
    """Near the worst points, with the encoders counted or not, in the order of `read`."""
    loop = (question.arm, question.wall, question.period, question.delay_samples)
    failing = np.argsort(margins)[: int((margins < 0).sum())]
    tried = failing[:: max(1, len(failing) // _TRIES)][:_TRIES]
    for counted in read:
        for k in tried:
            motion = refuting_motion(*loop, joints[k], question.torque_held, counted=counted)
            if motion is not None and (not question.asked or _within(motion, question.asked)):
                return motion
    return None
