"""A thread beside the loop that writes its rows to a file, five times a second.

It never holds the loop up: it copies rows out of the ring, and what the ring has written over before it came
is lost, counted and said.  A disk that refuses ends the recording, not the loop.
"""

from __future__ import annotations

import threading
import time
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from zwidth.data.logs.contents import ROWS_LOST, Head, as_json, from_json
from zwidth.errors import InputError
from zwidth.machine.servo.recording.mcap import McapFile
from zwidth.machine.servo.recording.rows import LoopRows
from zwidth.writing import check_target, first_line

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

EVERY = 0.2
"""[s] between two looks at the ring, so that what was done a second ago is in the file."""

SUFFIX = ".mcap"


@dataclass(frozen=True, kw_only=True)
class Recorded:
    """What became of a recording.

    Parameters
    ----------
    path
        The file.
    rows
        In the file.
    rows_lost
        Written over in the ring before they could be.
    size
        [bytes].
    failure
        Why it ended before the loop did; None if it did not.
    """

    path: Path
    rows: int
    rows_lost: int
    size: int
    failure: str | None

    def describe(self) -> str:
        """In a line."""
        lost = f"{self.rows_lost:,} rows were lost" if self.rows_lost else "none lost"
        line = f"{self.path}: {self.rows:,} rows, {lost}, {self.size / 1e6:.1f} MB"
        return line if self.failure is None else f"{line}; the recording ended early: {self.failure}"

    def to_dict(self) -> dict[str, Any]:
        """The same with a unit in every key."""
        return {
            "path": str(self.path),
            "rows": self.rows,
            "rows_lost": self.rows_lost,
            "size_bytes": self.size,
            "failure": self.failure,
        }


class Recorder:
    """Write the rows of a loop to a file while it runs.

    Parameters
    ----------
    rows
        Of the loop; from its first row on.
    path
        Ends in .mcap.
    force
        Replace what is there.

    Raises
    ------
    InputError
        If the suffix is another, something is there already, or it cannot be written.
    """

    def __init__(self, rows: LoopRows, path: str | PathLike[str], *, force: bool = False) -> None:
        self._rows, self.path = rows, Path(path)
        check_recording(self.path, force)
        try:
            self._file = McapFile(self.path, _head(rows), force)
        except OSError as error:
            raise InputError(f"{path} cannot be written: {error.strerror or first_line(error)}") from None
        self._count = self._lost = self._told = 0
        self._sample: float | None = None
        self._origin: int | None = None
        self._failure: str | None = None
        self._over = threading.Event()
        self._thread = threading.Thread(target=self._run, name="zwidth-recorder", daemon=True)
        self._thread.start()

    def __enter__(self) -> Recorder:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> Recorded:
        """Write what is left, and the end; what became of it all.  May be called again."""
        if not self._over.is_set():
            self._over.set()
            self._thread.join()
            self._attempt(self._drain)
            self._attempt(self._file.close)
        return self.so_far()

    def so_far(self) -> Recorded:
        """What has been written up to now."""
        return Recorded(
            path=self.path,
            rows=self._file.rows,
            rows_lost=self._lost,
            size=self._file.size,
            failure=self._failure,
        )

    def _run(self) -> None:
        while not self._over.wait(EVERY) and self._failure is None:
            self._attempt(self._drain)

    def _attempt(self, step: Any) -> None:
        """A step of writing; whatever goes wrong ends the recording alone, never the loop."""
        if self._failure is not None:
            return
        try:
            step()
        except Exception as error:  # nobody else would hear of it: it is in the report
            self._failure = (error.strerror if isinstance(error, OSError) else None) or first_line(error)
            self._file.abandon()

    def _drain(self) -> None:
        """What the loop has written since the last time."""
        told = self._rows.events[self._told :]
        count, found = self._rows.after(self._count)
        now = time.time_ns()
        lost = count - self._count - len(found)
        events = ([self._loss(lost, found)] if lost else []) + told
        self._file.write(found, self._taken(found, now), events, now)
        self._count, self._told = count, self._told + len(told)
        self._lost += lost
        if len(found):
            self._sample = float(found[-1, self._rows.COLUMNS.index("sample")])

    def _loss(self, lost: int, found: Array) -> dict[str, Any]:
        sample = self._rows.COLUMNS.index("sample")
        before = float(found[0, sample]) if len(found) else None
        return {"event": ROWS_LOST, "rows": lost, "after_sample": self._sample, "before_sample": before}

    def _taken(self, found: Array, now: int) -> NDArray[np.int64]:
        """When the samples were taken [ns since 1970]: the newest row of the first look is of just now."""
        if not len(found):
            return np.empty(0, np.int64)
        since = np.rint(1e9 * found[:, self._rows.COLUMNS.index("time_s")]).astype(np.int64)
        if self._origin is None:
            self._origin = now - int(since[-1])
        return since + self._origin


def _head(rows: LoopRows) -> Head:
    return Head(
        columns=tuple(rows.COLUMNS),
        motion=rows.motion,
        period=rows.period,
        title=rows.title,
        about=from_json(as_json(rows.about)),  # as it is now: what is said of a file does not change in it
    )


def check_recording(path: Path, force: bool) -> None:
    """Refuse a place that is none for a recording, before anything is served."""
    if path.suffix.lower() != SUFFIX:
        raise InputError(
            f"a recording is a file that ends in {SUFFIX}, got {str(path)!r}; of one zwidth replay "
            "run.mcap -o run.nc makes a table, and in Python read_recording(path).dataset().to_dataframe()"
        )
    check_target(path, force)
