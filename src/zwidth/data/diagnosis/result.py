"""What `zwidth.diagnose` returns: the cause, how sure, the numbers it rests on, and what to change."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from zwidth.data.diagnosis.answer import Answer, key_with_unit, rows_of_energy, rows_of_likely
from zwidth.data.diagnosis.causes import CAUSES
from zwidth.data.diagnosis.change import Change
from zwidth.data.diagnosis.evidence import Evidence
from zwidth.data.diagnosis.recording import Recording
from zwidth.data.diagnosis.vibration import nothing
from zwidth.lazy import above
from zwidth.quantity.text import shown

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True, kw_only=True, repr=False)
class Diagnosis(Answer[Change, Evidence, Recording]):
    """Why it shook: `cause` is one of the keys of `zwidth.data.diagnosis.CAUSES`, or None where the data do
    not say, and `confidence` how often such a finding is right, among faults simulated as the weights were
    learnt from.

    Parameters
    ----------
    stated
        How the law as it was stated fits the force, and what `check` says to that loop; nothing without one.
    """

    stated: tuple[str, ...] = ()

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

    def rows(self) -> Iterator[tuple[str, str]]:
        """Every number that was measured, with its name."""
        if self.seen is None:
            return
        v = self.seen.vibration
        length = "rad" if self.seen.rotary else "m"
        yield "frequency", f"{shown(v.frequency, 'Hz', 4)} ± {shown(v.frequency_spread, 'Hz', 2)}"
        counts = f", {self.seen.counts:.3g} counts" if self.seen.resolution else ""
        yield "end to end", f"{shown(v.swing, length, 3)}{counts}"
        yield from rows_of_energy(self.seen.energy, self.seen.supplied, self.seen.lost)
        if (law := self.seen.law) is not None:
            yield "stiffness", shown(law.stiffness, self.seen.unit("stiffness"), 4)
            if law.damping:
                damping = shown(law.damping, self.seen.unit("virtual_damping"), 3)
                yield "virtual damping", f"{damping}, window {law.window}"
            yield "force explained", f"{100 * (1 - law.unexplained):.4g} %"
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
