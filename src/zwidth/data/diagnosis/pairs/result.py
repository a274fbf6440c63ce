"""Why two arms shook: the cause, how sure, the numbers it rests on, and what to change."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from zwidth.data.diagnosis.answer import Answer, key_with_unit, rows_of_energy, rows_of_likely
from zwidth.data.diagnosis.pairs.causes import PAIR_CAUSES
from zwidth.data.diagnosis.pairs.change import PairChange
from zwidth.data.diagnosis.pairs.energy import PairEvidence
from zwidth.data.diagnosis.pairs.recording import ARMS, PairRecording
from zwidth.data.diagnosis.vibration import nothing
from zwidth.lazy import above
from zwidth.quantity.glossary import GLOSSARY
from zwidth.quantity.text import shown

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True, kw_only=True, repr=False)
class PairDiagnosis(Answer[PairChange, PairEvidence, PairRecording]):
    """Why two arms shook that follow each other: `cause` is one of `zwidth.data.diagnosis.PAIR_CAUSES`, or
    None where the data do not say, and `confidence` how often such a finding is right, among simulated
    pairs that shake for one reason.
    """

    @property
    def claim(self) -> str:
        """The answer in one sentence."""
        if self.seen is None:
            return nothing(self.recording.follower.time)
        at = f"{shown(self.frequency, 'Hz', 3)}"
        if self.cause is None:
            return f"Both arms shake at {at}; the data do not say why."
        return f"Both arms shake at {at} because {PAIR_CAUSES[self.cause]}."

    def rows(self) -> Iterator[tuple[str, str]]:
        """Every number that was measured, with its name."""
        if (seen := self.seen) is None:
            return
        v = seen.vibration
        length = "rad" if seen.rotary else "m"
        yield "frequency", f"{shown(v.frequency, 'Hz', 4)} ± {shown(v.frequency_spread, 'Hz', 2)}"
        for arm, size in zip(ARMS, seen.amplitudes, strict=True):
            yield f"{arm} swings", f"± {shown(size, length, 3)}"
        yield from rows_of_energy(seen.energy, seen.supplied, seen.lost)
        for arm, law in zip(ARMS, seen.laws, strict=True):
            if law is not None:
                yield f"{arm}: stiffness", shown(law.stiffness, _unit("stiffness", seen), 4)
                yield f"{arm}: link delay", shown(law.link_delay, "s", 3)
                yield f"{arm}: explained", f"{100 * (1 - law.unexplained):.4g} %"
        yield from rows_of_likely(self.likely)

    def _measured(self, seen: PairEvidence) -> dict[str, Any]:
        document: dict[str, Any] = {
            "sample_period_s": seen.loop_period,
            "supplied_J": dict(seen.supplied),
            "friction_takes_J": seen.lost,
        }
        stiffness, damping = (
            key_with_unit(name, _unit(name, seen)) for name in ("stiffness", "virtual_damping")
        )
        for k, (arm, law) in enumerate(zip(ARMS, seen.laws, strict=True)):
            document[arm] = {
                f"amplitude_{'rad' if seen.rotary else 'm'}": seen.amplitudes[k],
                "delay_s": seen.delays[k],
                "law": None
                if law is None
                else {
                    stiffness: law.stiffness,
                    damping: law.damping,
                    f"local_{damping}": law.local_damping,
                    key_with_unit("compensation", "N*m" if seen.rotary else "N"): law.compensation,
                    "link_delay_s": law.link_delay,
                    "unexplained": law.unexplained,
                },
            }
        return document

    def _written(self, change: PairChange) -> str:
        from zwidth.model.specification.write import written_pair

        return written_pair(change.pair)

    def _figure(self) -> Figure:
        figure: Figure = above("plots").pair_figure(self.recording, self.seen, self.claim)
        return figure


def _unit(name: str, seen: PairEvidence) -> str:
    return GLOSSARY[name].unit_for("rotary" if seen.rotary else "linear")
