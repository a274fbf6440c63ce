"""A periodic motion played in the simulator: the device in its tied hand, and nothing else moves it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from scipy.linalg import expm

from zwidth.model.device import Device
from zwidth.model.environment import Wall
from zwidth.model.operator.operator import LinearHand, Operator
from zwidth.passivity.stability.absolute.motion import PeriodicMotion

if TYPE_CHECKING:
    import xarray as xr


def replay_motion(
    device: Device, hand: LinearHand | Operator, motion: PeriodicMotion, rounds: int = 20
) -> xr.Dataset:
    """Simulate the motion for so many periods, from its first sample on.

    The wall begins at x = 0, the hand is anchored at −gap.  With a delay the forces under way at the first
    sample are missing: a motion that attracts is come back to.

    Parameters
    ----------
    device, hand
        As for `absolute_stability`.
    motion
        A `PeriodicMotion` of them.
    rounds
        Periods to simulate.
    """
    from zwidth.loop.simulate import simulate  # xarray takes its time
    from zwidth.model.operator.prescribed_motion import Tracking

    own = hand.hand if isinstance(hand, Operator) else hand
    period, count = float(device.exact("sample_period")), motion.period * rounds
    tied = Tracking(
        np.full(count + 1, -motion.gap), stiffness=own.stiffness, damping=own.damping, mass=own.mass
    )
    return simulate(
        device,
        Wall(stiffness=motion.slope),
        tied,
        count * period,
        initial_position=motion.positions[0] - motion.gap,
        initial_velocity=_velocity(device, own, motion),
    )


def _velocity(device: Device, hand: LinearHand, motion: PeriodicMotion) -> float:
    """ẋ at the first sample, from the first two positions and the forces between them."""
    mass = float(device.exact("mass")) + hand.mass
    flow = np.zeros((3, 3))
    flow[0, 1], flow[1, 2] = 1.0, -1 / mass
    flow[1, 0], flow[1, 1] = -hand.stiffness / mass, -(float(device.exact("damping")) + hand.damping) / mass
    period = float(device.exact("sample_period"))
    late, part = divmod(float(device.exact("delay")) / period, 1.0)
    whole, rest = expm(flow * period), expm(flow * period * (1 - part))
    new, old = (motion.slope * max(motion.positions[-int(late) - i] - motion.gap, 0.0) for i in (0, 1))
    pushed = rest[0, 2] * new + (whole[0, 2] - rest[0, 2]) * old
    first, second = motion.positions[:2]
    return float((second - whole[0, 0] * first - pushed) / whole[0, 1])
