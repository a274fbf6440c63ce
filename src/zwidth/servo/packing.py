"""A law as the loop runs it: its numbers, and what it remembers at rest at a position."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from zwidth.compiled import Array
from zwidth.device.device import Device
from zwidth.environment.environment import Environment
from zwidth.errors import InputError
from zwidth.loop.law import GATE, PENETRATION
from zwidth.loop.setup import prepare, resting_memory
from zwidth.loop.start import unloaded_range
from zwidth.operator import PrescribedMotion

_STRAIGHT = 1e-9
"""Of its size: so far from a straight line a memory may be and still be taken for one."""


class Packed(NamedTuple):
    """A law for `cycle.answer`."""

    law: Array
    rest: Array
    """What it remembers at rest at 0, and per metre or radian away from it; 2 × n."""
    begins: tuple[float, float]
    """Between which positions it holds little where it pushes little, see `loop.start.unloaded_range`."""


def pack(
    device: Device, environment: Environment, here: float, force: float, *, single: bool = False
) -> Packed:
    """Lay out a law.

    Parameters
    ----------
    device
        Whose encoder, converter and period the law is made for; its mass is not needed.
    environment
        With the laws in its chain.
    here
        The reading now [m; rad]: a law whose memory at rest is no straight function of the position
        begins with the memory that belongs to this one.
    force
        Up to which it may begin [N; N·m].
    single
        True where the machine keeps numbers in 24 bits.

    Raises
    ------
    InputError
        If the loop cannot be simulated, or the law is at rest nowhere.
    """
    begins = unloaded_range(environment, force, here)
    if begins[0] > begins[1]:
        raise InputError(
            "this law pulls away at one of its ends and is at rest nowhere: a hand would be given all it "
            "holds where it begins; let it push back at both ends"
        )
    still = PrescribedMotion([0.0, 0.0])
    setup = prepare(device, environment, still, device.exact("sample_period"), single=single)
    # one that sees max(x, 0) begins outside: what it remembers inside is another line
    places = (0.0, -1.0, -2.0) if setup.law[GATE] == PENETRATION else (0.0, 1.0, -1.0)
    rest, one, two = (resting_memory(setup, x) for x in places)
    slope = (one - rest) / places[1]
    bent = np.abs(rest + places[2] * slope - two)
    if not (bent <= _STRAIGHT * (np.abs(one) + np.abs(two))).all():
        rest, slope = resting_memory(setup, here), np.zeros_like(rest)
    return Packed(setup.law, np.stack([rest, slope]), begins)
