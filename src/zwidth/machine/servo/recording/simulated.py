"""The whole trace of a touch that was served on a simulated device: the same hand, by the recorded clock.

A simulated device is moved on by the lateness that the loop really had.  So `zwidth.simulate`, given that
lateness, computes the same touch, and with it what no column has: the forces of the hand, the energy that it
holds, and what `plots`, `energy` and `traces` make of a trace.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from zwidth.data.logs.contents import COLUMNS
from zwidth.errors import InputError
from zwidth.loop.simulate import simulate
from zwidth.machine.servo.recording.recording import Recording
from zwidth.machine.servo.recording.replayed import touch_of
from zwidth.model.device import Device
from zwidth.model.device.amplifier import Amplifier
from zwidth.model.operator.operator import Operator

if TYPE_CHECKING:
    import xarray as xr


def trace_of(
    recording: Recording,
    hand: Operator,
    device: Device | None = None,
    environment: object = None,
    *,
    encoder_phase: float = 0.0,
    amplifier: Amplifier | None = None,
) -> xr.Dataset:
    """The trace of the touch, equal to the recording in every sample, to the last bit.

    Parameters
    ----------
    recording
        Of a simulated device, whose first law was served from sample 0 on.
    hand
        That held it.
    device, environment
        As they were served; by default as the recording says.
    encoder_phase, amplifier
        Of the simulated device.

    Raises
    ------
    InputError
        If it is no such recording, or the simulation gives another position or force: then it was another
        hand, or the safety cut the force.
    """
    position, force = COLUMNS[recording.motion]
    if f"true_{position}" not in recording.columns:
        raise InputError(
            f"{recording.path} is of a real device: nobody knows where it was between two counts, and what "
            "its hand did; its columns are in dataset()"
        )
    touch = touch_of(recording, device, environment)
    numbers = recording.columns["sample"][touch.rows].astype(np.int64)
    if numbers[0] != 0:
        raise InputError(
            f"{recording.path}: the law was served from sample {numbers[0]} on, and the hand had moved the "
            "device before; a trace begins with law and hand together"
        )
    trace = simulate(
        recording.specification().device if device is None else device,
        touch.environment,
        hand,
        touch.duration,
        encoder_phase=encoder_phase,
        amplifier=amplifier,
        timing=touch.timing,
    )
    for name, column in (("position", f"true_{position}"), ("commanded_force", force)):
        other = trace[name].values[numbers] != recording.columns[column][touch.rows]
        if other.any():
            raise InputError(
                f"{recording.path}: with this hand the {name.replace('_', ' ')} is another one from sample "
                f"{numbers[int(np.argmax(other))]} on: give the hand, device and amplifier that were served; "
                "a force that the safety cut is not simulated"
            )
    return trace
