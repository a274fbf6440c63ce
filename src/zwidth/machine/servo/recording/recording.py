"""A recording of a served loop, read back: columns of numbers, what it says of itself, and what happened."""

from __future__ import annotations

import json
from collections.abc import Iterable
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from zwidth.data.logs import Log, read_log
from zwidth.data.logs.contents import FORMAT, name_and_unit, rows_lost
from zwidth.data.logs.served import mcap_head, mcap_parts
from zwidth.errors import InputError
from zwidth.lazy import above
from zwidth.machine.servo.ring import ENDED, SERVING
from zwidth.missing import did_you_mean
from zwidth.model.specification.read import Specification
from zwidth.model.specification.write import parsed
from zwidth.native.compiled import Array
from zwidth.quantity.answered import answered, answers, data_of
from zwidth.quantity.text import shown
from zwidth.showing import Lines, Part, Shown, Table, printable

if TYPE_CHECKING:
    import xarray as xr

_NAMED = {
    "position": "measured_position",
    "force": "commanded_force",
    "true_position": "position",
    "true_velocity": "velocity",
}
"""What a trace calls them."""

_MEANINGS = {
    "position": "position, positive inside the wall",
    "velocity": "velocity",
    "measured_position": "position as it was read, positive inside the wall",
    "wished_force": "force that the law asks for, positive out of the wall",
    "commanded_force": "force that was given, positive out of the wall",
    "sample": "number of the sample",
    "late": "how late the sample was taken",
    "energy_out": "energy that the loop gave out since its start",
    "friction_loss": "energy that the device's friction took since its start",
    "status": "what became of the answer, 0 good",
    "phase": "what the loop was doing",
    "law": "which law, counted from 0",
    "limited": "what cut the force, 0 nothing",
    "exchange": "time that the exchange with the device took",
}


@dataclass(frozen=True, kw_only=True, repr=False, eq=False)
class Recording(Shown):
    """What was recorded, as far as the file is whole."""

    path: Path = answered("where it was read", only_shown=True)
    columns: dict[str, Array] = answered("each column as an array; the unit is in its name", only_shown=True)
    motion: str = answered('"linear" or "rotary"')
    period: float = answered("T", key="sample_period", unit="s")
    title: str = answered("what was served, in words")
    about: dict[str, Any] = answered(
        "what the loop said of itself, as in the file: device, environment, laws, safety, versions"
    )
    events: list[dict[str, Any]] = answered("what happened, in order, as in the file")
    whole: bool = answered("true where the recording was ended as it should be, false where it was cut off")

    @property
    @answers()
    def samples(self) -> int:
        """Rows that were read."""
        return int(next(iter(self.columns.values())).size)

    @property
    @answers(unit="s")
    def duration(self) -> float:
        """From the first row to the last."""
        time = self.columns["time_s"]
        return float(time[-1] - time[0]) if time.size else 0.0

    @property
    @answers(key="without_answer")
    def unanswered(self) -> int:
        """Samples to which the device gave no good answer before the force ended."""
        return int(((self.columns["status"] != 0) & (self.columns["phase"] != ENDED)).sum())

    @property
    @answers()
    def rows_lost(self) -> int:
        """Rows that never came into the file, as it says itself."""
        return rows_lost(self.events)

    @property
    @answers()
    def missed(self) -> int:
        """Samples that the loop left out: their numbers do not occur, and no row was lost there."""
        numbers = self.columns["sample"]
        passed = int(numbers[-1] - numbers[0]) + 1 if numbers.size else 0
        return max(0, passed - self.samples - self.rows_lost)

    @property
    def laws(self) -> tuple[int, ...]:
        """Numbers of the laws that were served, see `events` for what they were."""
        served = self.columns["phase"] == SERVING
        return tuple(int(number) for number in np.unique(self.columns["law"][served]))

    def dataset(self) -> xr.Dataset:
        """The columns along `time` with their units, named as in a trace where that has them.

        `position` and `velocity` are there where a simulated device told them: as it really moved, in the
        coordinates of the wall.
        """
        import xarray as xr

        variables = {}
        for column, values in self.columns.items():
            name, unit = name_and_unit(column)
            if name != "time":
                name = _NAMED.get(name, name)
                label = {"long_name": _MEANINGS[name]} if name in _MEANINGS else {}
                variables[name] = ("time", self._placed(name, values), {"units": unit, **label})
        time = ("time", self.columns["time_s"], {"units": "s", "long_name": "time since the loop began"})
        said = {
            "format": FORMAT,
            "title": self.title,
            "motion": self.motion,
            "sample_period_s": self.period,
            "whole": int(self.whole),
            "rows_lost": self.rows_lost,
            "about": printable(json.dumps(self.about, ensure_ascii=False)),
            "events": printable(json.dumps(self.events, ensure_ascii=False)),
        }
        return xr.Dataset(variables, coords={"time": time}, attrs=said)

    def _placed(self, name: str, values: Array) -> Array:
        """True position and velocity are told in the device's own zero and sense."""
        sense = float(self.about.get("sense", 1))
        if name == "position":
            origin = self.about.get(f"origin_{'rad' if self.motion == 'rotary' else 'm'}", 0.0)
            return sense * (values - float(origin))
        return sense * values if name == "velocity" else values

    def specification(self, law: int = 0) -> Specification:
        """Device and environment of a law, counted from 0, as they were served.

        Raises
        ------
        InputError
            If the recording does not say: the law is one of your own, or there were not so many.
        """
        told = [e["specification"] for e in self.events if isinstance(e.get("specification"), str)]
        if not 0 <= law < len(told) or not told[law]:
            raise InputError(
                f"{self.path} does not say what law {law} was: it names {len(told)} laws, and one of your "
                "own has no specification; give device and environment"
            )
        return parsed(told[law], str(self.path))

    def log(self, **reading: Any) -> Log:
        """The file as a log, for `zwidth.identify`; `reading` is for `zwidth.read_log`."""
        return read_log(self.path, **reading)

    def plot(self, path: str | PathLike[str], *, overwrite: bool = False) -> None:
        """Position, force and lateness as a picture: .png, .svg or .pdf.

        Raises
        ------
        InputError
            If there are fewer than two rows, or it cannot be written.
        """
        if self.samples < 2:
            raise InputError(f"{self.path} holds {self.samples} rows: a picture takes two")
        plots = above("plots")
        plots.save_figure(lambda: plots.recording_figure(self.dataset()), Path(path), overwrite)

    def to_dict(self) -> dict[str, Any]:
        """What is in it but for the rows, units in the keys."""
        return {"format": FORMAT, **data_of(self)}

    def report(self) -> Iterable[Part]:
        """What is in it, from the top down."""
        yield f"{self.path}: {self.title}"
        if not self.whole:
            yield "It has no end: the recording was cut off there. What is before is as it was written."
        rows = [
            ["samples", f"{self.samples:,}"],
            ["time", shown(self.duration, "s", 6)],
            ["sample period", shown(self.period, "s", 6)],
            ["samples missed by the loop", f"{self.missed:,}"],
            ["rows lost by the recorder", f"{self.rows_lost:,}"],
            ["without a good answer", f"{self.unanswered:,}"],
        ]
        if self.samples:
            rows.append(["latest sample", f"{shown(float(self.columns['late_s'].max()), 's', 4)} late"])
        yield Table(rows=rows, lefts=2)
        if self.events:
            yield Lines([_short(event) for event in self.events], "events")


def _short(event: dict[str, Any]) -> str:
    """An event in a line: the specification of a law is for programs, its words are for people."""
    return ", ".join(f"{key} {value}" for key, value in event.items() if key != "specification")


def read_recording(path: str | PathLike[str]) -> Recording:
    """Read what a recorder wrote, up to where it is whole.

    Parameters
    ----------
    path
        A .mcap file; it may have been cut off at any byte.

    Raises
    ------
    InputError
        If there is no such file, it is no recording, or what it says of itself is not there.
    """
    source = Path(path)
    if not source.exists():
        raise InputError(f"{source} cannot be read: there is no such file{did_you_mean(source)}")
    head = None if source.is_dir() else mcap_head(source)
    if head is None:
        raise InputError(
            f"{source} is no recording of a served loop, or it was cut off before it says what it holds; "
            "give the .mcap file that zwidth serve wrote"
        )
    pieces: list[Array] = [np.empty((0, len(head.columns)))]
    events: list[dict[str, Any]] = []
    whole = False
    for part in mcap_parts(source, head):
        pieces.append(part.rows)
        events += part.events
        whole = part.last
    columns = {name: np.concatenate([piece[:, k] for piece in pieces]) for k, name in enumerate(head.columns)}
    return Recording(
        path=source,
        columns=columns,
        motion=head.motion,
        period=head.period,
        title=head.title,
        about=head.about,
        events=events,
        whole=whole,
    )
