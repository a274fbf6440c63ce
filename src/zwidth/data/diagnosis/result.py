"""What `zwidth.diagnose` returns: the cause, how sure, the numbers it rests on, and what to change."""

from __future__ import annotations

import json
from abc import abstractmethod
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any, Generic, TypeVar

from zwidth.data.diagnosis.causes import CAUSES
from zwidth.data.diagnosis.change import Change, Lowered
from zwidth.data.diagnosis.evidence import Evidence
from zwidth.data.diagnosis.recording import Recording
from zwidth.data.diagnosis.vibration import nothing
from zwidth.errors import InputError
from zwidth.lazy import above
from zwidth.quantity.answered import answered, answers, data_of
from zwidth.quantity.text import in_a_table, shown
from zwidth.showing import Part, Shown, Table
from zwidth.writing import check_target, writing_whole

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Changed = TypeVar("Changed", bound=Lowered)
Seen = TypeVar("Seen")
Recorded = TypeVar("Recorded")

NO_NUMBER = "no one number of the loop is proved to end it, with the device as it was stated"
"""What is said of a cause without a change."""


@dataclass(frozen=True, kw_only=True, repr=False)
class Answer(Shown, Generic[Changed, Seen, Recorded]):
    """Why it shook."""

    cause: str | None = answered("what keeps it shaking; null where the data do not say")
    confidence: float = answered("how often such a finding is right, among simulated faults, from 0 to 1")
    likely: Mapping[str, float] = answered("of each cause how likely it is, the likeliest first")
    frequency: float | None = answered("of the vibration", unit="Hz")
    frequency_spread: float | None = answered("how far it wanders", unit="Hz")
    energy_per_cycle: float | None = answered(
        "what the forces put into the motion in each cycle, negative where they take", unit="J"
    )
    evidence: tuple[str, ...] = answered("sentences with the numbers that speak for the cause")
    change: Changed | None = answered(
        "the one number to change; null where there is none, or no device was given"
    )
    record: tuple[str, ...] = answered("what to record next, where the data do not say")
    seen: Seen | None = answered("what was measured; None where nothing vibrates", only_shown=True)
    findings: tuple[str, ...] = answered("what was odd in the file, and what was supposed")
    recording: Recorded = answered("what was read", only_shown=True)

    @property
    @abstractmethod
    @answers()
    def claim(self) -> str:
        """The answer in one sentence."""

    @abstractmethod
    def rows(self) -> Iterator[tuple[str, str]]:
        """Every number that was measured, with its name."""

    @abstractmethod
    def _measured(self, seen: Seen) -> dict[str, Any]:
        """What is seen as plain data, units in the keys."""

    @abstractmethod
    def _written(self, change: Changed) -> str:
        """TOML of what has the number changed."""

    @abstractmethod
    def _figure(self) -> Figure:
        """The picture."""

    @property
    def next_steps(self) -> tuple[str, ...]:
        """What to do, the change first."""
        if self.change is not None:
            return (self.change.text,)
        return (NO_NUMBER,) if self.cause is not None and not self.record else self.record

    def report(self) -> Iterable[Part]:
        """The claim, what speaks for it, what to do."""
        yield self.claim
        if self.cause is not None:
            yield f"{self.cause}, {shown(self.confidence, '%', 2)} sure"
        yield from self.evidence
        yield from self.next_steps
        yield Table(rows=[*self.rows()])

    def to_dict(self) -> dict[str, Any]:
        """As plain data, units in the keys."""
        rounded = {
            "confidence": round(self.confidence, 3),
            "likely": {name: round(p, 4) for name, p in self.likely.items()},
        }
        return data_of(self) | rounded | ({} if self.seen is None else self._measured(self.seen))

    def to_json(self) -> str:
        """`to_dict` as JSON."""
        return json.dumps(self.to_dict(), indent=2, ensure_ascii=False)

    def save(self, path: str | PathLike[str], *, force: bool = False) -> None:
        """Save what has the number changed, as TOML that `zwidth check`, or `zwidth pair`, reads.

        Raises
        ------
        InputError
            If there is no change to save, the file exists, or it cannot be written.
        """
        if self.change is None:
            raise InputError("there is no number to change in this diagnosis, and so nothing to save")
        target = Path(path)
        check_target(target, force)
        text = self._written(self.change)
        with writing_whole(target) as file:
            file.write(text.encode())

    def plot(self, path: str | PathLike[str] | None = None, *, force: bool = False) -> Figure:
        """The stretch that shakes, its spectrum, the energy of a cycle; saved where a path is given.

        Parameters
        ----------
        path
            Ends in .png, .svg or .pdf.
        force
            Replace a file that exists.
        """
        figure = self._figure()
        if path is not None:
            above("plots").save_figure(lambda: figure, Path(path), force)
        return figure


def rows_of_energy(
    energy: float, supplied: Mapping[str, float], lost: float | None
) -> Iterator[tuple[str, str]]:
    """What goes in and out in a cycle, term by term."""
    yield "energy in a cycle", shown(energy, "J", 3)
    for term, work in supplied.items():
        if work:
            yield f"by {term}", shown(work, "J", 3)
    if lost is not None:
        yield "friction takes", shown(lost, "J", 3)


def rows_of_likely(likely: Mapping[str, float]) -> Iterator[tuple[str, str]]:
    """The four likeliest causes."""
    for name, p in list(likely.items())[:4]:
        yield f"p({name})", f"{p:.2f}"


def key_with_unit(name: str, unit: str) -> str:
    """ "stiffness" and "N/m" as stiffness_N_per_m."""
    return f"{name}_{unit.replace('/', '_per_').replace('*', '_')}"


@dataclass(frozen=True, kw_only=True, repr=False)
class Diagnosis(Answer[Change, Evidence, Recording]):
    """Why it shook: `cause` is one of the keys of `zwidth.data.diagnosis.CAUSES`, or None where the data do
    not say, and `confidence` how often such a finding is right, among faults simulated as the weights were
    learnt from."""

    _BESIDES = (
        (
            "swing_m, swing_counts",
            "where something vibrates, from one side to the other; in encoder counts, null where the "
            "step is not known",
        ),
        (
            "supplied_J, friction_takes_J",
            "of the energy in a cycle the share of each cause; what the device's own friction takes",
        ),
        ("sample_period_s, delay_s", "of the loop; of the force, null where the file does not show it"),
        (
            "law",
            "as the file shows it: its stiffness and virtual damping, `window_samples` of the "
            "velocity, its compensation of friction, `unexplained`, the part of the force that is "
            "none of these",
        ),
        (
            "stated",
            "only with a law that was stated: `holds`, whether the force is taken as that law's; "
            "`gain`, how many times the law's it is; `lag_s`; `unexplained`; `text`, how it fits, and"
            " what `zwidth check` says to the loop as stated",
        ),
        ("command", "that checks the change, where one line holds it"),
        (
            "leader, follower",
            "of two arms, in the place of `swing`, `delay` and `law`: `amplitude_m`; `delay_s` from "
            "its reading to its force, null where the file does not show it; `law`, null where its "
            "force does not follow the arms: `stiffness_…`, `virtual_damping_…` against the other "
            "arm, `local_virtual_damping_…`, `compensation_…` of friction, `link_delay_s`, by how "
            "much the other's reading is older than its own, `unexplained`",
        ),
    )

    stated: tuple[str, ...] = answered(
        "how the law as stated fits the force, and what `check` says to that loop; empty without one",
        default=(),
        only_shown=True,
    )

    @property
    def claim(self) -> str:
        """The answer in one sentence."""
        if self.seen is None:
            return nothing(self.recording.time)
        at, time = shown(self.frequency, "Hz", 3), self.recording.time[self.seen.vibration.around]
        if time.size < self.recording.time.size // 2:
            at += f" from {shown(time[0], 's', 4)} to {shown(time[-1], 's', 4)}"
        if self.cause is None:
            first, second, *_ = self.likely
            return f"It shakes at {at}; the data do not say why: {first} or {second}, or something else."
        return f"It shakes at {at} because {CAUSES[self.cause].because}."

    def rows(self) -> Iterator[tuple[str, str]]:
        """Every number that was measured, with its name."""
        if self.seen is None:
            return
        v = self.seen.vibration
        length = "rad" if self.seen.rotary else "m"
        yield "frequency", f"{shown(v.frequency, 'Hz', 4)} ± {shown(v.frequency_spread, 'Hz', 2)}"
        counts = f", {in_a_table(self.seen.counts, 3)} counts" if self.seen.resolution else ""
        yield "end to end", f"{shown(v.swing, length, 3)}{counts}"
        yield from rows_of_energy(self.seen.energy, self.seen.supplied, self.seen.lost)
        if (law := self.seen.law) is not None:
            yield "stiffness", shown(law.stiffness, self.seen.unit("stiffness"), 4)
            if law.damping:
                damping = shown(law.damping, self.seen.unit("virtual_damping"), 3)
                yield "virtual damping", f"{damping}, window {law.window}"
            yield "force explained", shown(1 - law.unexplained, "%")
        yield from rows_of_likely(self.likely)

    def _measured(self, seen: Evidence) -> dict[str, Any]:
        document: dict[str, Any] = {
            f"swing_{'rad' if seen.rotary else 'm'}": seen.vibration.swing,
            "swing_counts": seen.counts if seen.resolution else None,
            "sample_period_s": seen.loop_period,
            "delay_s": seen.delay if seen.sees_delay else None,
            "supplied_J": dict(seen.supplied),
            "friction_takes_J": seen.lost,
        }
        if seen.law is not None:
            document["law"] = {
                key_with_unit("stiffness", seen.unit("stiffness")): seen.law.stiffness,
                key_with_unit("virtual_damping", seen.unit("virtual_damping")): seen.law.damping,
                "window_samples": seen.law.window,
                key_with_unit("compensation", "N*m" if seen.rotary else "N"): seen.law.compensation,
                "unexplained": seen.law.unexplained,
            }
        if (told := seen.stated) is not None:
            document["stated"] = {
                "holds": told.holds,
                "gain": told.gain,
                "lag_s": told.lag,
                "unexplained": told.unexplained,
                "text": list(self.stated),
            }
        return document

    def _written(self, change: Change) -> str:
        from zwidth.model.specification.write import written

        return written(change.device, change.environment)

    def _figure(self) -> Figure:
        figure: Figure = above("plots").diagnosis_figure(self.recording, self.seen, self.claim)
        return figure
