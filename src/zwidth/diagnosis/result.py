"""What `zwidth.diagnose` returns: the cause, how sure, the numbers it rests on, and what to change."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

from zwidth.diagnosis.causes import CAUSES
from zwidth.diagnosis.change import Change
from zwidth.diagnosis.evidence import Evidence
from zwidth.diagnosis.recording import Recording
from zwidth.diagnosis.vibration import nothing
from zwidth.quantity.text import shown
from zwidth.showing import Part, Shown, Table
from zwidth.writing import check_target, writing_whole

if TYPE_CHECKING:
    from matplotlib.figure import Figure


NO_NUMBER = "no one number of the loop is proved to end it, with the device as it was stated"
"""What is said of a cause without a change."""


@dataclass(frozen=True, kw_only=True, repr=False)
class Diagnosis(Shown):
    """Why it shook.

    Parameters
    ----------
    cause
        One of the keys of `zwidth.diagnosis.CAUSES`; None where the data do not say.
    confidence
        How often such a finding is right, among faults simulated as the weights were learnt from; 0 for None.
    likely
        Each cause with its p, the likeliest first.
    frequency, frequency_spread
        [Hz] of the vibration, and how far it is known.
    energy_per_cycle
        [J] that the actuator puts into the motion in each cycle, negative where it takes.
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
    change: Change | None
    record: tuple[str, ...]
    seen: Evidence | None
    findings: tuple[str, ...]
    recording: Recording

    @property
    def claim(self) -> str:
        """The answer in one sentence."""
        if self.seen is None:
            return nothing(self.recording.time)
        at = f"{shown(self.frequency, 'Hz', 3)}"
        if self.cause is None:
            first, second, *_ = self.likely
            return f"It shakes at {at}; the data do not say why: {first} or {second}, or something else."
        return f"It shakes at {at} because {CAUSES[self.cause].because}."

    @property
    def next_steps(self) -> tuple[str, ...]:
        """What to do, the change first."""
        if self.change is not None:
            return (self.change.text,)
        if self.cause is not None and not self.record:
            return (NO_NUMBER,)
        return self.record

    def report(self) -> Iterable[Part]:
        """The claim, what speaks for it, what to do."""
        yield self.claim
        if self.cause is not None:
            yield f"{self.cause}, {100 * self.confidence:.0f} % sure"
        yield from self.evidence
        yield from self.next_steps
        yield Table(rows=[*self.rows()])

    def rows(self) -> Iterator[tuple[str, str]]:
        """Every number that was measured, with its name."""
        if self.seen is None:
            return
        v = self.seen.vibration
        length = "rad" if self.seen.rotary else "m"
        yield "frequency", f"{shown(v.frequency, 'Hz', 4)} ± {shown(v.frequency_spread, 'Hz', 2)}"
        counts = f", {self.seen.counts:.3g} counts" if self.seen.resolution else ""
        yield "end to end", f"{shown(v.swing, length, 3)}{counts}"
        yield "energy in a cycle", shown(self.seen.energy, "J", 3)
        for term, work in self.seen.supplied.items():
            if work:
                yield f"by {term}", shown(work, "J", 3)
        if self.seen.lost is not None:
            yield "friction takes", shown(self.seen.lost, "J", 3)
        if (law := self.seen.law) is not None:
            yield "stiffness", shown(law.stiffness, self.seen.unit("stiffness"), 4)
            if law.damping:
                damping = shown(law.damping, self.seen.unit("virtual_damping"), 3)
                yield "virtual damping", f"{damping}, window {law.window}"
            yield "force explained", f"{100 * (1 - law.unexplained):.4g} %"
        for name, p in list(self.likely.items())[:4]:
            yield f"p({name})", f"{p:.2f}"

    def to_dict(self) -> dict[str, Any]:
        """As plain data, units in the keys."""
        seen = self.seen
        document: dict[str, Any] = {
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
        }
        if seen is not None:
            length = "rad" if seen.rotary else "m"
            document |= {
                f"swing_{length}": seen.vibration.swing,
                "swing_counts": seen.counts if seen.resolution else None,
                "sample_period_s": seen.loop_period,
                "delay_s": seen.delay if seen.sees_delay else None,
                "supplied_J": dict(seen.supplied),
                "friction_takes_J": seen.lost,
            }
            if seen.law is not None:
                document["law"] = {
                    _key("stiffness", seen.unit("stiffness")): seen.law.stiffness,
                    _key("virtual_damping", seen.unit("virtual_damping")): seen.law.damping,
                    "window_samples": seen.law.window,
                    _key("compensation", "N*m" if seen.rotary else "N"): seen.law.compensation,
                    "unexplained": seen.law.unexplained,
                }
        return document

    def to_json(self) -> str:
        """`to_dict` as JSON."""
        return json.dumps(self.to_dict(), indent=2, ensure_ascii=False)

    def save(self, path: str | PathLike[str], *, force: bool = False) -> None:
        """Save the loop with the number changed, as TOML that `zwidth check` reads.

        Raises
        ------
        InputError
            If there is no change to save, the file exists, or it cannot be written.
        """
        from zwidth.errors import InputError
        from zwidth.specification.write import written

        if self.change is None:
            raise InputError("there is no number to change in this diagnosis, and so no loop to save")
        target = Path(path)
        check_target(target, force)
        text = written(self.change.device, self.change.environment)
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
        from zwidth.diagnosis.picture import diagnosis_figure
        from zwidth.plots.files import save_figure

        figure = diagnosis_figure(self.recording, self.seen, self.claim)
        if path is not None:
            save_figure(lambda: figure, Path(path), overwrite=force)
        return figure


def _key(name: str, unit: str) -> str:
    return f"{name}_{unit.replace('/', '_per_').replace('*', '_')}"
