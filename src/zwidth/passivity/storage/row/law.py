"""Laws in a chain as the simulator packs them, for a hand that begins at rest outside."""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil

import numpy as np
from numpy.typing import NDArray

from zwidth.errors import InputError
from zwidth.loop.law import LIMIT, STEP
from zwidth.loop.setup import prepare
from zwidth.model.device.device import Device
from zwidth.model.environment.environment import Environment
from zwidth.model.operator import PrescribedMotion
from zwidth.model.specification.write import written

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class RowLaw:
    """Laws in a chain as the simulator runs them.

    Parameters
    ----------
    packed
        The numbers of environment and laws, see `loop.law`.
    resting
        What is remembered by a hand that has rested for ever, by count.
    waiting
        Forces that are kept, of which the oldest acts: one, and one more for each sample of delay.
    description
        Environment and laws, on one line.
    specification
        Device, environment and laws in TOML; empty where it has no words for them.
    clamped, unilateral
        As the environment.
    limited, stepped
        Whether force limit and converter steps of the actuator are counted in.
    """

    packed: Floats
    resting: dict[int, Floats]
    waiting: int
    description: str
    specification: str
    clamped: bool
    unilateral: bool
    limited: bool
    stepped: bool

    @property
    def starts(self) -> dict[int, Floats]:
        """Memory, and no force waiting, of a hand that has rested for ever, by count."""
        return {n: np.concatenate([row, np.zeros(self.waiting)]) for n, row in self.resting.items()}


def row_law(
    device: Device,
    environment: Environment,
    lowest: int,
    *,
    only: bool = False,
    force_limit: bool = False,
    force_resolution: bool = False,
) -> RowLaw:
    """The law of laws in a chain in a device's loop.

    Parameters
    ----------
    device, environment
        Without intervals.
    lowest
        The first count of the grid: the hand begins at rest at any count from there to 0, or at
        0 only where the environment has no surface.
    only
        True for a hand that begins at `lowest` and nowhere else.
    force_limit, force_resolution
        True to count in the actuator's force limit, the steps of its converter.
    """
    for counted, key in ((force_limit, "force_limit"), (force_resolution, "force_resolution")):
        if counted and getattr(device, key) is None:
            raise InputError(f"the actuator's {key} is to be counted in, but the device has none")
    delay = device.exact("delay") / device.exact("sample_period")
    if delay.denominator != 1:
        raise InputError(
            f"laws in a chain are looked at with delays of whole samples; this one is {float(delay):.6g}: "
            "the force would change within a sample"
        )
    first = min(lowest, 0) if environment.unilateral else 0
    resting = {}
    for count in (first,) if only else range(first, 1):
        middle = (count + 0.5) * float(device.exact("resolution"))
        hand = PrescribedMotion(np.full(2, middle))
        setup = prepare(device, environment, hand, device.exact("sample_period"))
        resting[count] = setup.memory.copy()
    packed = setup.law.copy()
    for counted, at in ((force_limit, LIMIT), (force_resolution, STEP)):
        packed[at] = packed[at] if counted else 0.0
    return RowLaw(
        packed=packed,
        resting=resting,
        waiting=ceil(delay) + 1,
        description=environment.describe(device.motion),
        specification=_specification(device, environment),
        clamped=environment.clamped,
        unilateral=environment.unilateral,
        limited=force_limit,
        stepped=force_resolution,
    )


def _specification(device: Device, environment: Environment) -> str:
    """Device, environment and laws in TOML, or nothing."""
    try:
        return written(device, environment)
    except InputError:  # a law of one's own is in no other program
        return ""
