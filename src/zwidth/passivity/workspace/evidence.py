"""What speaks for or against an arm and a wall: a certificate of the whole region, or a motion in it."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from zwidth.model.arms import ArmMotion, EncoderSteps, Sites
from zwidth.model.arms.replay import refuting_motion
from zwidth.passivity.certificate import Certificate
from zwidth.passivity.workspace.account import Account
from zwidth.passivity.workspace.certificate import arm_certificate
from zwidth.passivity.workspace.counting import Counting, with_motion
from zwidth.passivity.workspace.question import Forces, Question

Array = npt.NDArray[np.float64]

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
    loop = (question.arm, question.wall, question.period, question.delay_samples)
    steps = with_motion(count, *loop, sites, question.torque_held)
    certificate, words, encoder = None, "", "counted" if question.asked else "ideal"
    if account.reached.all() and (account.margins > 0).all():
        certificate, words, encoder = _proof(question, count)
    joints, read = fine.joints[account.reached], _readings(question, count)
    motion = _motion_inside(question, joints, account.margins, read)
    if motion is None and steps is not None:
        motion = _across(steps.motion, question.forces, count.limits)
    if motion is not None:
        encoder = motion.encoder
    left = certificate if motion is None else None
    return Evidence(left, motion, steps, encoder, words, certificate is not None)


def _proof(question: Question, count: Counting) -> tuple[Certificate | None, str, str]:
    """A certificate or why there is none, and of which encoder: of the steps, if it can be or has to be."""
    loop = (question.arm, question.wall, question.rate, question.delay_samples, question.held_to)
    certificate, words = None, count.reason
    if count.limits and count.steps is not None:
        certificate, words = arm_certificate(*loop, count)
    if certificate is not None or question.asked:
        return certificate, words, "counted"
    return (*arm_certificate(*loop), "ideal")


def _readings(question: Question, count: Counting) -> tuple[bool, ...]:
    """Whether motions are looked for behind the encoders, in order."""
    return (True, False) if count.limits else (True,) if question.asked else (False,)


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
