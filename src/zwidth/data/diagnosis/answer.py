"""What every diagnosis says: the cause, how sure, its numbers, what to do; as text, JSON, TOML, a picture."""

from __future__ import annotations

import json
from abc import abstractmethod
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any, Generic, TypeVar

from zwidth.data.diagnosis.lowered import Lowered
from zwidth.errors import InputError
from zwidth.lazy import above
from zwidth.quantity.text import shown
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
    """Why it shook.

    Parameters
    ----------
    cause
        Its name; None where the data do not say.
    confidence
        How often such a finding is right, among simulated faults; 0 for None.
    likely
        Each cause with its p, the likeliest first.
    frequency, frequency_spread
        [Hz] of the vibration, and how far it is known.
    energy_per_cycle
        [J] that the forces put into the motion in each cycle, negative where they take.
    evidence
        Sentences with the numbers that speak for the cause.
    change
        The one number to change; None where there is none, or no device was given.
    record
        What to record next, where the data do not say.
    seen
        Every number that was measured; None where nothing vibrates.
    findings
        What was odd in the file, and what was supposed.
    """

    cause: str | None
    confidence: float
    likely: Mapping[str, float]
    frequency: float | None
    frequency_spread: float | None
    energy_per_cycle: float | None
    evidence: tuple[str, ...]
    change: Changed | None
    record: tuple[str, ...]
    seen: Seen | None
    findings: tuple[str, ...]
    recording: Recorded

    @property
    @abstractmethod
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
            yield f"{self.cause}, {100 * self.confidence:.0f} % sure"
        yield from self.evidence
        yield from self.next_steps
        yield Table(rows=[*self.rows()])

    def to_dict(self) -> dict[str, Any]:
        """As plain data, units in the keys."""
        return {
            "cause": self.cause,
            "confidence": round(self.confidence, 3),
            "claim": self.claim,
            "likely": {name: round(p, 4) for name, p in self.likely.items()},
            "frequency_Hz": self.frequency,
            "frequency_spread_Hz": self.frequency_spread,
            "energy_per_cycle_J": self.energy_per_cycle,
            "evidence": list(self.evidence),
            "record": list(self.record),
            "change": None if self.change is None else self.change.to_dict(),
            "findings": list(self.findings),
        } | ({} if self.seen is None else self._measured(self.seen))

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
