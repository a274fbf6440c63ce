"""Why two arms shook: the cause, how sure, the numbers it rests on, and what to change."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

from zwidth.diagnosis.pairs.causes import PAIR_CAUSES
from zwidth.diagnosis.pairs.change import PairChange
from zwidth.diagnosis.pairs.energy import PairEvidence
from zwidth.diagnosis.pairs.recording import ARMS, PairRecording
from zwidth.diagnosis.result import NO_NUMBER
from zwidth.diagnosis.vibration import nothing
from zwidth.quantity.glossary import GLOSSARY
from zwidth.quantity.text import shown
from zwidth.showing import Part, Shown, Table
from zwidth.writing import check_target, writing_whole

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True, kw_only=True, repr=False)
class PairDiagnosis(Shown):
    """Why two arms shook that follow each other.

    Parameters
    ----------
    cause
        One of `zwidth.diagnosis.PAIR_CAUSES`; None where the data do not say.
    confidence
        How often such a finding is right, among simulated pairs that shake for one reason; 0 for None.
    likely
        Each cause with its p, the likeliest first.
    frequency, frequency_spread
        [Hz] of the vibration, and how far it is known.
    energy_per_cycle
        [J] that the forces give both arms in a cycle.
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
    change: PairChange | None
    record: tuple[str, ...]
    seen: PairEvidence | None
    findings: tuple[str, ...]
    recording: PairRecording

    @property
    def claim(self) -> str:
        """The answer in one sentence."""
        if self.seen is None:
            return nothing(self.recording.follower.time)
        at = f"{shown(self.frequency, 'Hz', 3)}"
        if self.cause is None:
            return f"Both arms shake at {at}; the data do not say why."
        return f"Both arms shake at {at} because {PAIR_CAUSES[self.cause]}."

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

    def rows(self) -> Iterator[tuple[str, str]]:
        """Every number that was measured, with its name."""
        if (seen := self.seen) is None:
            return
        v = seen.vibration
        length = "rad" if seen.rotary else "m"
        yield "frequency", f"{shown(v.frequency, 'Hz', 4)} ± {shown(v.frequency_spread, 'Hz', 2)}"
        for arm, size in zip(ARMS, seen.amplitudes, strict=True):
            yield f"{arm} swings", f"± {shown(size, length, 3)}"
        yield "energy in a cycle", shown(seen.energy, "J", 3)
        for term, work in seen.supplied.items():
            if work:
                yield f"by {term}", shown(work, "J", 3)
        if seen.lost is not None:
            yield "friction takes", shown(seen.lost, "J", 3)
        for arm, law in zip(ARMS, seen.laws, strict=True):
            if law is not None:
                yield f"{arm}: stiffness", shown(law.stiffness, _unit("stiffness", seen), 4)
                yield f"{arm}: link delay", shown(law.link_delay, "s", 3)
                yield f"{arm}: explained", f"{100 * (1 - law.unexplained):.4g} %"
        for name, p in list(self.likely.items())[:4]:
            yield f"p({name})", f"{p:.2f}"

    def to_dict(self) -> dict[str, Any]:
        """As plain data, units in the keys."""
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
        if (seen := self.seen) is None:
            return document
        document |= {
            "sample_period_s": seen.loop_period,
            "supplied_J": dict(seen.supplied),
            "friction_takes_J": seen.lost,
        }
        for k, (arm, law) in enumerate(zip(ARMS, seen.laws, strict=True)):
            stiffness, damping = (
                f"{name}_{_unit(name, seen).replace('/', '_per_').replace('*', '_')}"
                for name in ("stiffness", "virtual_damping")
            )
            document[arm] = {
                f"amplitude_{'rad' if seen.rotary else 'm'}": seen.amplitudes[k],
                "delay_s": seen.delays[k],
                "law": None
                if law is None
                else {
                    stiffness: law.stiffness,
                    damping: law.damping,
                    f"local_{damping}": law.local_damping,
                    f"compensation_{'N_m' if seen.rotary else 'N'}": law.compensation,
                    "link_delay_s": law.link_delay,
                    "unexplained": law.unexplained,
                },
            }
        return document

    def to_json(self) -> str:
        """`to_dict` as JSON."""
        return json.dumps(self.to_dict(), indent=2, ensure_ascii=False)

    def save(self, path: str | PathLike[str], *, force: bool = False) -> None:
        """Save the pair with the number changed, as TOML that `zwidth pair` reads.

        Raises
        ------
        InputError
            If there is no change to save, the file exists, or it cannot be written.
        """
        from zwidth.errors import InputError
        from zwidth.specification.write_pair import written_pair

        if self.change is None:
            raise InputError("there is no number to change in this diagnosis, and so no pair to save")
        target = Path(path)
        check_target(target, force)
        text = written_pair(self.change.pair)
        with writing_whole(target) as file:
            file.write(text.encode())

    def plot(self, path: str | PathLike[str] | None = None, *, force: bool = False) -> Figure:
        """Both arms over some cycles, the spectrum, the energy of a cycle; saved where a path is given.

        Parameters
        ----------
        path
            Ends in .png, .svg or .pdf.
        force
            Replace a file that exists.
        """
        from zwidth.diagnosis.pairs.picture import pair_figure
        from zwidth.plots.files import save_figure

        if path is not None:
            save_figure(lambda: pair_figure(self.recording, self.seen, self.claim), Path(path), force)
        return pair_figure(self.recording, self.seen, self.claim)


def _unit(name: str, seen: PairEvidence) -> str:
    return GLOSSARY[name].unit_for("rotary" if seen.rotary else "linear")
