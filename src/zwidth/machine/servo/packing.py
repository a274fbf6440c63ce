"""A law as the loop runs it: its numbers, and what it remembers at rest at a position."""

from __future__ import annotations

from typing import NamedTuple

from zwidth.errors import InputError
from zwidth.loop.setup import prepare, resting_lines
from zwidth.loop.start import unloaded_range
from zwidth.model.device.device import Device
from zwidth.model.environment.environment import Environment
from zwidth.model.operator import PrescribedMotion
from zwidth.native.compiled import Array


class Packed(NamedTuple):
    """A law for `cycle.answer`."""

    law: Array
    rest: Array
    """What it remembers at rest, see `loop.setup.resting_lines`; 2 × 2 × n."""
    begins: tuple[float, float]
    """Between which positions it holds little where it pushes little, see `loop.start.unloaded_range`."""


def pack(
    device: Device, environment: Environment, here: float, force: float, *, single: bool = False
) -> Packed:
    """Lay out a law for the encoder, the converter and the period of a device; its mass is not needed.

    `here` is the reading now [m; rad], `force` up to which it may begin [N; N·m]; `single` where the machine
    keeps numbers in 24 bits.
    """
    begins = unloaded_range(environment, force, here)
    if begins[0] > begins[1]:
        raise InputError(
            "this law pulls away at one of its ends and is at rest nowhere: a hand would be given all it "
            "holds where it begins; let it push back at both ends"
        )
    still = PrescribedMotion([0.0, 0.0])
    setup = prepare(device, environment, still, device.exact("sample_period"), single=single)
    return Packed(setup.law, resting_lines(setup), begins)
