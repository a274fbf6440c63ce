"""What is asked about an arm and a wall: the loop, and up to which forces encoder steps are counted."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from zwidth.errors import InputError
from zwidth.model.arms import Arm, Sites
from zwidth.model.arms.encoders import (
    EncoderSteps,
    encoder_steps,
    forces_of,
    held_torque_damping,
    in_words,
    with_encoders,
)
from zwidth.model.arms.joints import as_matrix
from zwidth.model.arms.replay import first_motion
from zwidth.model.arms.wall import MatrixWall, WallNeed, fits, require_wall, wall_need
from zwidth.model.environment.wall import Wall
from zwidth.quantity.exact import RealLike
from zwidth.quantity.text import shown
from zwidth.quantity.units import parse_number

Forces = tuple[float, ...]
"""A force [N], in pose with a moment [N·m]; none."""

_MOST_DELAY = 100
"""Samples."""


@dataclass(frozen=True, kw_only=True)
class Question:
    """The loop, `rate` [Hz] and d from reading to force, and the forces that are asked about.

    Of joints that give way the `arm` is what the motors feel, and has their damping.
    `held_to`: up to which the torque is held; empty where it follows the arm.  `asked`: up to which encoder
    steps are to be counted; empty: as far as friction covers them.
    """

    arm: Arm
    wall: Wall | MatrixWall
    rate: float
    delay_samples: int
    held_to: Forces
    asked: Forces

    @property
    def period(self) -> float:
        """T [s]."""
        return 1 / self.rate

    @property
    def torque_held(self) -> bool:
        """Whether the torque is computed once a sample."""
        return bool(self.held_to)

    @property
    def forces(self) -> Forces:
        """Those that are asked about, for one reason or the other."""
        return self.held_to or self.asked

    def need(self, coordinates: int) -> WallNeed:
        """What the wall asks for at the hand."""
        return wall_need(self.wall, self.period, self.delay_samples, coordinates)

    def damping(self, coordinates: int) -> npt.NDArray[np.float64]:
        """What the joints have for the wall, m × m: less what held torques ask for."""
        arm = self.arm
        held = held_torque_damping(arm, self.period, self.delay_samples, self.held_to)
        damping: npt.NDArray[np.float64] = as_matrix(arm.damping) - held * np.eye(arm.joint_count)
        if arm.joint_count > coordinates and np.linalg.eigvalsh(damping)[0] <= 0:
            own = zip(arm.joint_names, np.diag(damping), strict=True)
            bare = ", ".join(name for name, b in own if b <= 0) or "some motion of the joints"
            held_torques = " beyond what held torques ask for" if held else ""
            raise InputError(
                f"no damping is left in {bare}{held_torques}, and an arm with more joints than the hand has "
                "coordinates needs some in each: give more, or, of a description, hold the joint by its name "
                "(--hold, hold=), and it is taken as locked"
            )
        return damping


def asked_of(
    arm: Arm,
    wall: Wall | MatrixWall,
    rate: RealLike,
    delay: RealLike,
    points: int,
    torque_held_up_to: RealLike | Sequence[RealLike] | None,
    largest_force: RealLike | Sequence[RealLike] | None,
) -> Question:
    """The question, once its numbers are within their bounds."""
    hertz = float(parse_number(rate, "Hz", "rate"))
    delay_samples = _delay_samples(hertz, float(parse_number(delay, "s", "delay")))
    if not isinstance(arm, Arm):
        raise InputError(f"the first argument is an arm, got {type(arm).__name__}")
    if isinstance(points, bool) or not isinstance(points, int) or not 2 <= points <= 1000:
        raise InputError(f"points must be a whole number from 2 to 1000, got {points!r}")
    require_wall(wall)
    fits(arm, wall)
    held_to = forces_of(arm, torque_held_up_to, "torque_held_up_to")
    asked = forces_of(arm, largest_force, "largest_force")
    if held_to and asked:
        raise InputError("torque_held_up_to says the largest force already; leave largest_force out")
    if asked and with_encoders(arm) is None:
        raise InputError(
            "largest_force bounds what encoder steps cost, and needs a chain or a description with the "
            "resolution of its joints, as in --joint-resolution 0.001"
        )
    arm = arm.at_motors
    return Question(arm=arm, wall=wall, rate=hertz, delay_samples=delay_samples, held_to=held_to, asked=asked)


def _delay_samples(rate: float, delay: float) -> int:
    if rate <= 0:
        raise InputError(f"rate must be > 0 Hz, got {rate!r}")
    if delay < 0:
        raise InputError(f"delay must be ≥ 0 s, got {delay!r}")
    samples = round(delay * rate)
    if samples > _MOST_DELAY:
        raise InputError(
            f"delay must be at most {_MOST_DELAY} samples, got {shown(delay, 's', 6)}, {samples} at "
            f'{shown(rate, "Hz", 6)}; a number without a unit is in seconds: write "3 ms" for milliseconds'
        )
    if abs(delay * rate - samples) > 1e-9 * max(1, samples):
        raise InputError(
            f"for arms the delay is a whole number of samples, got {delay * rate:g}; "
            "round it up: that is safe for springs"
        )
    return samples


@dataclass(frozen=True, kw_only=True)
class Counting:
    """What encoder steps before a wall ask of friction; None where there are none, or nothing is known.

    `limits`: force [N], in pose and moment [N·m], up to which friction covers them: those asked for, or all
    that it does; empty where it does not, `reason` says why.
    """

    steps: EncoderSteps | None
    limits: Forces
    reason: str


def counting(question: Question, sites: Sites) -> Counting:
    """Up to the forces that are asked about, or where there are none as far as it goes."""
    arm, asked = question.arm, question.forces
    if not any(arm.resolution):
        return Counting(steps=None, limits=(), reason="none are known")
    steps = encoder_steps(arm, question.wall, question.period, sites)
    limits: Forces = ()
    if steps is None:
        reason = "how the Jacobian of such an arm changes over a step is not bounded"
    elif not any(arm.coulomb_friction):
        reason = "they need Coulomb friction, and none is given"
    elif asked and _is_enough(arm, steps.friction_up_to(*asked)):
        limits, reason = asked, ""
    elif not steps.covered:
        reason = "Coulomb friction is too small for them at any force"
    elif asked:
        covered = f"Coulomb friction covers them up to {in_words(steps.covered)}"
        reason = f"{covered}, and not up to {in_words(asked)}"
    else:
        limits, reason = steps.covered, ""
    return Counting(steps=steps, limits=limits, reason=reason)


def _is_enough(arm: Arm, needed: Iterable[float]) -> bool:
    return all(float(own) >= need for own, need in zip(arm.coulomb_friction, needed, strict=True))


def with_motion(found: Counting, question: Question, sites: Sites) -> EncoderSteps | None:
    """The steps with the smallest force at which a motion across their edges is known to take energy out."""
    chain, steps = with_encoders(question.arm), found.steps
    if chain is None or steps is None or question.wall.clamped or question.arm.transmissions:
        return steps  # a wall that never pulls has a normal, and the motion's forces may not be along it
    loop = (question.wall, question.period, question.delay_samples)
    motion = first_motion(chain, *loop, sites.joints, question.torque_held)
    return steps if motion is None else replace(steps, refuted=motion.largest_force, motion=motion)
