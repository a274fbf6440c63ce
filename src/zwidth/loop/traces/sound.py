"""The actuator force as sound: a buzz is heard at once.

The staircase of the force is held at 44.1 kHz as the actuator holds it; the mean
over 50 ms around each instant is taken away, so that pressing is silent and
only what changes is heard.  Full scale is the largest of what is left.
"""

from __future__ import annotations

import wave
from io import BytesIO
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from zwidth.errors import InputError
from zwidth.writing import check_target, writing_whole

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from zwidth.loop.trace import AnyTrace

    Array = NDArray[np.float64]

RATE = 44_100
"""Sound samples per second."""

_MEAN = 0.05
_QUIETEST = 1e-9


def save_sound(trace: AnyTrace, path: str | PathLike[str], *, force: bool = False) -> None:
    """Write the actuator force as a WAV file, 16 bits, one channel.

    Parameters
    ----------
    trace
        As `zwidth.simulate` returns it.
    path
        Ends in .wav.
    force
        Replace a file that exists.

    Raises
    ------
    InputError
        If the suffix is another, the file exists, or it cannot be written.
    """
    target = Path(path)
    if target.suffix.lower() != ".wav":
        raise InputError(f"sound is a file that ends in .wav, got {str(target)!r}")
    check_target(target, force)
    samples = waveform(trace)
    with writing_whole(target) as file:
        file.write(_as_wav(samples))


def _as_wav(samples: NDArray[np.int16]) -> bytes:
    sound = BytesIO()
    with wave.open(sound, "wb") as file:
        file.setnchannels(1)
        file.setsampwidth(2)
        file.setframerate(RATE)
        file.writeframes(samples.astype("<i2").tobytes())
    return sound.getvalue()


def waveform(trace: AnyTrace) -> NDArray[np.int16]:
    """The sound, −32767 … 32767; all 0 for a force that never changes."""
    time, force = trace["time"].values, trace["actuator_force"].values
    count = int((time[-1] - time[0]) * RATE)
    instants = time[0] + np.arange(count) / RATE
    held = force[np.searchsorted(time, instants, side="right") - 1]
    left = held - _moving_mean(held, int(_MEAN * RATE))
    peak = np.abs(left).max(initial=0.0)
    if peak <= _QUIETEST * np.abs(force).max(initial=0.0) or peak == 0.0:
        return np.zeros(count, dtype=np.int16)
    loud: NDArray[np.int16] = np.round(left / peak * 32767).astype(np.int16)
    return loud


def _moving_mean(values: Array, width: int) -> Array:
    """The mean over `width` around each value, over what there is of it at the ends."""
    sums = np.concatenate(([0.0], np.cumsum(values)))
    place = np.arange(values.size)
    low, high = np.maximum(0, place - width // 2), np.minimum(values.size, place + width // 2 + 1)
    means: Array = (sums[high] - sums[low]) / (high - low)
    return means
