"""What is asked about an arm and a wall: the numbers of the loop, and up to which forces."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from zwidth.errors import InputError
from zwidth.model.arms import Arm
from zwidth.model.arms.encoders import forces_of, held_torque_damping
from zwidth.model.arms.joints import as_matrix
from zwidth.model.arms.wall import MatrixWall, fits, require_wall
from zwidth.model.environment.wall import Wall
from zwidth.passivity.workspace.counting import needs_encoders
from zwidth.quantity.exact import RealLike
from zwidth.quantity.units import parse_number

Forces = tuple[float, ...]
"""A force [N], in pose with a moment [N·m]; none."""

_MOST_DELAY = 100
"""Samples."""


@dataclass(frozen=True, kw_only=True)
class Question:
    """The loop, and the forces that are asked about.

    Parameters
    ----------
    arm, wall
        What meets.
    rate
        [Hz].
    delay_samples
        d, from reading to force.
    held_to
        Up to which the torque is held; empty where it follows the arm.
    asked
        Up to which encoder steps are to be counted; empty: as far as friction covers them.
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

    def damping(self, coordinates: int) -> npt.NDArray[np.float64]:
        """What the joints have for the wall, m × m: less what held torques ask for."""
        arm = self.arm
        held = held_torque_damping(arm, self.period, self.delay_samples, self.held_to)
        damping: npt.NDArray[np.float64] = as_matrix(arm.damping) - held * np.eye(arm.joint_count)
        if arm.joint_count > coordinates and np.linalg.eigvalsh(damping)[0] <= 0:
            raise InputError(
                "an arm with more joints than coordinates needs damping in each of them, "
                "beyond what held torques ask for"
            )
        return damping


def asked_of(
    arm: Arm,
    wall: Wall | MatrixWall,
    rate: RealLike,
    delay: RealLike,
    points: int,
    torque_held_up_to: float | Sequence[float] | None,
    largest_force: float | Sequence[float] | None,
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
    needs_encoders(arm, asked)
    return Question(arm=arm, wall=wall, rate=hertz, delay_samples=delay_samples, held_to=held_to, asked=asked)


def _delay_samples(rate: float, delay: float) -> int:
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
    return samples
