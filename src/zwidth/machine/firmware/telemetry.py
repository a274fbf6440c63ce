"""Telemetry of a law on a machine of its own, as labelled data: time, position as read, force given.

`zwidth.read_log`, `zwidth.identify` and ``zwidth identify`` read such a file as they read any other; here it
is a Dataset with everything that the packets say.  Format: docs/firmware.md.
"""

from __future__ import annotations

from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr

from zwidth.data.logs.table import readable
from zwidth.data.logs.telemetry import FORMAT, About, Decoder, Samples, samples_of
from zwidth.errors import InputError
from zwidth.loop.trace import UNITS

if TYPE_CHECKING:
    from numpy.typing import NDArray

PHASES = ("waiting", "serving", "ended")
"""Force 0 and no law yet; the law's force; force 0 for good."""

REASONS = (
    "",
    "it was asked to end",
    "the reading jumped farther than a hand can move the device in that time",
    "readings failed to come",
    "the force of the law was no finite number",
    "a sample came, or took, too long",
    "the machine hung, and its watchdog started it anew",
    "the machine or the device failed",
)
"""Why the force ended, by the status of a sample."""

CUT = 0x40
"""Of the status: a force of the packet was cut at its limit."""


def read_telemetry(path: str | PathLike[str]) -> xr.Dataset:
    """The samples in a file of telemetry, as they came over the line.

    Along `time` [s], since the machine was started: `position` [m; rad], positive into the wall,
    `actuator_force` [N; N·m], positive out of it, `phase` (of `PHASES`), `reason` (of `REASONS`), `cut` (a
    force of the packet was cut at its limit) and `start`: how often the machine was started anew since the
    first sample; the time begins anew there.  Where packets are missing the time jumps.

    Parameters
    ----------
    path
        Bytes as the serial line gave them: begun and ended anywhere, with damaged and missing packets.
    """
    source = Path(path)
    decoder = Decoder()
    with readable(str(source)):
        pieces = list(samples_of(source, decoder))
    if decoder.about is None:
        raise InputError(
            f"{source} has no packet that says what its numbers are, among {decoder.packets} of samples: "
            "is it telemetry of zwidth, and of more than 64 packets?"
        )
    samples = Samples(*(np.concatenate(columns) for columns in zip(*pieces, strict=True)))
    return _labelled(samples, decoder, decoder.about)


def status_parts(status: NDArray[np.int64]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Phase and reason."""
    return status & 3, status >> 2 & 15


def _labelled(samples: Samples, decoder: Decoder, about: About) -> xr.Dataset:
    length, _, force = UNITS[about.motion]
    phase, reason = status_parts(samples.status)
    position = {"units": length, "long_name": "position as the encoder read it, positive into the wall"}
    given = {"units": force, "long_name": "force of the actuator, positive out of the wall"}
    variables: dict[str, Any] = {
        "position": ("time", samples.position(about), position),
        "actuator_force": ("time", samples.given(about), given),
        "phase": ("time", phase, {"long_name": ", ".join(f"{i} {name}" for i, name in enumerate(PHASES))}),
        "reason": ("time", reason, {"long_name": "why the force ended"}),
        "cut": ("time", samples.status & CUT > 0, {"long_name": "a force of the packet was cut"}),
        "start": ("time", samples.start, {"long_name": "starts of the machine since the first sample"}),
    }
    time = ("time", samples.time(about), {"units": "s", "long_name": "time since the machine was started"})
    resolution = "resolution_m" if about.motion == "linear" else "resolution_rad"
    attributes: dict[str, Any] = {
        "format": FORMAT,
        "motion": about.motion,
        "sample_period_s": about.period,
        resolution: about.resolution,
        "certificate_sha256": about.certificate,
        "packets": decoder.packets,
        "lost_packets": decoder.lost,
        "damaged_stretches": decoder.damaged,
        "dropped_samples": decoder.dropped,
    }
    return xr.Dataset(variables, coords={"time": time}, attrs=attributes)
