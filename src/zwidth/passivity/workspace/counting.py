"""Whether a verdict on an arm counts its encoder steps, and up to which force of the wall; if not, why."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from zwidth.errors import InputError
from zwidth.model.arms import Arm, Sites
from zwidth.model.arms.encoders import EncoderSteps, encoder_steps, in_words, with_encoders
from zwidth.model.arms.replay import first_motion
from zwidth.model.arms.wall import MatrixWall
from zwidth.model.environment.wall import Wall

Array = npt.NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class Counting:
    """What is known of the encoder steps before a wall.

    Parameters
    ----------
    steps
        What they ask of friction; None where there are none, or where nothing is known.
    limits
        Force [N], in pose and moment [N·m], up to which friction covers them: those asked for, or all that it
        does; empty where it does not.
    reason
        Why not.
    """

    steps: EncoderSteps | None
    limits: tuple[float, ...]
    reason: str


def counting(
    arm: Arm, wall: Wall | MatrixWall, period: float, sites: Sites, asked: tuple[float, ...]
) -> Counting:
    """Up to the forces that are `asked` for, or empty: as far as it goes."""
    if not any(arm.resolution):
        return Counting(steps=None, limits=(), reason="none are known")
    steps = encoder_steps(arm, wall, period, sites)
    if steps is None:
        known = "how the Jacobian of such an arm changes over a step is not bounded"
        return Counting(steps=None, limits=(), reason=known)
    if not any(arm.coulomb_friction):
        return Counting(steps=steps, limits=(), reason="they need Coulomb friction, and none is given")
    if not asked:
        reason = "" if steps.covered else "Coulomb friction is too small for them at any force"
        return Counting(steps=steps, limits=steps.covered, reason=reason)
    needed = steps.friction_up_to(*asked)
    if all(own >= need for own, need in zip(arm.coulomb_friction, needed, strict=True)):
        return Counting(steps=steps, limits=asked, reason="")
    return Counting(steps=steps, limits=(), reason=_too_small(steps, asked))


def needs_encoders(arm: Arm, asked: tuple[float, ...]) -> None:
    """Refuse a largest force for steps that nobody knows."""
    if asked and with_encoders(arm) is None:
        raise InputError(
            "largest_force bounds what encoder steps cost, and needs a chain or a description with the "
            "resolution of its joints, as in --joint-resolution 0.001"
        )


def with_motion(
    found: Counting,
    arm: Arm,
    wall: Wall | MatrixWall,
    period: float,
    delay_samples: int,
    sites: Sites,
    torque_held: bool,
) -> EncoderSteps | None:
    """The steps with the smallest force at which a motion across their edges is known to take energy out."""
    chain, steps = with_encoders(arm), found.steps
    if chain is None or steps is None or wall.clamped:
        return steps  # a wall that never pulls has a normal, and the motion's forces may not be along it
    motion = first_motion(chain, wall, period, delay_samples, sites.joints, torque_held)
    return steps if motion is None else replace(steps, refuted=motion.largest_force, motion=motion)


def _too_small(steps: EncoderSteps, asked: tuple[float, ...]) -> str:
    if not steps.covered:
        return "Coulomb friction is too small for them at any force"
    up_to = f"Coulomb friction covers them up to {in_words(steps.covered)}"
    return f"{up_to}, and not up to {in_words(asked)}"
