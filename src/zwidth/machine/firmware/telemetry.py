"""Telemetry of a law on a machine of its own, as labelled data: time, position as read, force given.

`zwidth.read_log`, `zwidth.identify` and ``zwidth identify`` read such a file as they read any other; here it
is a Dataset with everything that the packets say, or rows while they come.  Format: docs/firmware.md.
"""

from __future__ import annotations

import logging
from os import PathLike
from pathlib import Path
from threading import Event, Lock, Thread
from typing import Any, Protocol

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from zwidth.data.logs.contents import COLUMNS
from zwidth.data.logs.table import readable
from zwidth.data.logs.telemetry import FORMAT, About, Decoder, Samples, samples_of
from zwidth.errors import InputError
from zwidth.loop.trace import UNITS

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


# Rows for the live graphs, with energies as in a served loop, see `servo.cycle`.  Where samples are missing
# between two, the energies stay as they are.  The first sample of a packet is as late as its stamp.


Array = NDArray[np.float64]

_PHASES = np.array([1.0, 2.0, 3.0, 3.0])
"""Waiting, serving, ended as a served loop counts them: before these it has a phase in which it measures."""

_MOST_SILENT = 50
"""So often in a row the line may give nothing before it is known what the numbers are."""

_AT_ONCE = 4096
"""Bytes that are asked for."""

_PAUSE = 0.01
"""Where a line gives nothing at once, as a file at its end does [s]."""


class Line(Protocol):
    """Gives bytes as they come, b"" where none came for a while."""

    def read(self, size: int, /) -> bytes | None:
        """At most so many bytes."""


class LiveTelemetry:
    """Rows of a law on a machine of its own, read from its line by a thread until `close`.

    Parameters
    ----------
    line
        A `serial.Serial` with a timeout of 0.1 s, for example.
    damping, coulomb_friction
        Of the device [N·s/m; N·m·s/rad], [N; N·m]: what its friction loss is counted with. Default 0.
    kept
        So many rows are kept, the newest ones.
    """

    def __init__(
        self, line: Line, *, damping: float = 0.0, coulomb_friction: float = 0.0, kept: int = 1 << 16
    ) -> None:
        self._line, self._decoder, self._kept = line, Decoder(), kept
        waiting = [*self._until_known()]
        about = self._decoder.about
        if about is None:
            raise InputError(
                f"the line gave {self._decoder.packets} packets and then nothing, and none said what its "
                "numbers are: check the port and its rate; the text comes once in 64 packets"
            )
        self._ledger = _Ledger(about, damping, coulomb_friction)
        position, force = COLUMNS[about.motion]
        self.COLUMNS = (
            "sample", "time_s", "late_s", position, f"wished_{force}", force,
            "energy_out_J", "friction_loss_J", "status", "phase", "law", "limited",
        )  # fmt: skip
        self.period, self.motion = about.period, about.motion
        self.title = f"a law on a machine of its own, certificate {about.certificate[:8]}"
        self._count, self._rows = 0, np.empty((0, len(self.COLUMNS)))
        self._lock, self._ended = Lock(), Event()
        for samples in waiting:
            self._write(samples)
        self._thread = Thread(target=self._run, name="zwidth telemetry", daemon=True)
        self._thread.start()

    def after(self, count: int) -> tuple[int, Array]:
        """How many rows were written so far, and those after the first `count` that are still kept."""
        with self._lock:
            first = max(count - self._count + len(self._rows), 0)
            return self._count, self._rows[first:].copy()

    def close(self) -> None:
        """Read no more; the rows stay."""
        self._ended.set()
        self._thread.join()

    def _until_known(self) -> list[Samples]:
        found, silent = [], 0
        while self._decoder.about is None and silent < _MOST_SILENT:
            data = self._line.read(_AT_ONCE) or b""
            silent = 0 if data else silent + 1
            found.append(self._decoder.take(data))
        return found

    def _run(self) -> None:
        try:
            while not self._ended.is_set():
                data = self._line.read(_AT_ONCE) or b""
                self._write(self._decoder.take(data))
                if not data:
                    self._ended.wait(_PAUSE)
        except Exception:
            logging.getLogger(__name__).exception("telemetry is read no more")

    def _write(self, samples: Samples) -> None:
        for start in np.unique(samples.start):
            part = Samples(*(column[samples.start == start] for column in samples))
            rows = self._ledger.rows(part, int(start), self._count)
            with self._lock:
                self._rows = np.concatenate([self._rows, rows])[-self._kept :]
                self._count += len(rows)


class _Ledger:
    """What is remembered from one stretch of samples to the next."""

    def __init__(self, about: About, damping: float, coulomb_friction: float) -> None:
        self._about, self._damping, self._coulomb = about, damping, coulomb_friction
        self._start: int | None = None
        self._time = self._offset = self._position = self._force = self._work = self._loss = 0.0

    def rows(self, samples: Samples, start: int, count: int) -> Array:
        """The rows of samples of one start of the machine; so many were written before."""
        about, period = self._about, self._about.period
        time, x, f = samples.time(about), samples.position(about), samples.given(about)
        if start != self._start:  # its clock began anew, and nobody knows what was in between
            self._offset = self._time + (0.0 if self._start is None else 2 * period) - time[0]
        self._start = start
        time = time + self._offset
        took = np.diff(time, prepend=self._time)
        moved = np.where(took < 1.5 * period, np.diff(x, prepend=self._position), 0.0)
        if count == 0:
            moved[0] = 0.0
        work = self._work - np.cumsum(np.concatenate([[self._force], f[:-1]]) * moved)
        loss = self._damping * moved**2 / np.maximum(took, 0.5 * period) + self._coulomb * np.abs(moved)
        loss = self._loss + np.cumsum(loss)
        late = np.where((samples.place == 0) & (took < 2 * period), np.maximum(took - period, 0.0), 0.0)
        phase, _ = status_parts(samples.status)
        self._time, self._position, self._force = float(time[-1]), float(x[-1]), float(f[-1])
        self._work, self._loss = float(work[-1]), float(loss[-1])
        zero = np.zeros(len(x))
        cut = (samples.status & CUT > 0).astype(np.float64)
        law = np.where(phase == 0, -1.0, 0.0)
        number = count + np.arange(len(x))
        return np.column_stack([number, time, late, x, f, f, work, loss, zero, _PHASES[phase], law, cut])
