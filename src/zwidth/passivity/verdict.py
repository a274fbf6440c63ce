"""The verdict: what is claimed of a loop, on what evidence, and what follows from it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from zwidth.model.device import Device
from zwidth.passivity.advice import Advice, easiest_first, in_lines
from zwidth.passivity.outcome_evidence import Found, active_at, assumptions, claim, decided_by
from zwidth.passivity.result import least, share_left
from zwidth.quantity.answered import answers
from zwidth.quantity.exact import Exact, Interval, ends
from zwidth.quantity.glossary import GLOSSARY
from zwidth.quantity.text import in_words, save_json, shown, shown_at_least, told_quantity
from zwidth.showing import Lines, Part

if TYPE_CHECKING:
    from zwidth.passivity.outcome_evidence import Moves


@dataclass(frozen=True, repr=False)
class Verdict(Found):
    """Whether a hand can take energy out of a sampled loop.

    "passive" stands on a ``certificate`` that the independent checker accepted, with contact made and broken,
    or as it was asked; "passive in contact" on one for hands that never leave the wall; "active" on a
    `violation` that it accepted or a motion, the `witness`, that it recomputed; "undecided" says what is
    known.
    For parameters given as intervals the verdict holds for every value; the
    numbers below then speak of the worst case (`device`, `environment`).
    """

    _FORMAT = "zwidth verdict 1"
    _PICTURE = "check_figure"

    @cached_property
    def claim(self) -> str:
        """The verdict in a sentence or two: what was found, how much, and what to do."""
        return claim(self, self._easiest_first())

    def _easiest_first(self) -> Iterable[Advice]:
        """The advice, each looked for when it is asked for where that takes long."""
        return easiest_first(self.advice)

    @property
    def assumptions(self) -> tuple[str, ...]:
        """What the claim covers and takes for granted, line by line."""
        return assumptions(self)

    @property
    @answers()
    def decided_by(self) -> str:
        """The road on which the outcome was found, in a few words."""
        return decided_by(self)

    @property
    @answers(
        "where energy comes out at values in intervals: which they are; `violation` and `witness` are of "
        "them. With `undecided` it may not come out at others",
        quantities=True,
        optional=True,
    )
    def active_at(self) -> Mapping[str, float] | None:
        """The values in its intervals at which energy was shown to come out; None where none was."""
        return active_at(self) or None

    @property
    def max_stiffness(self) -> float | None:
        """Largest passive K, all else as given [N/m; N·m/rad]; None where none is known."""
        return None

    @property
    def required_damping(self) -> float | None:
        """Smallest passive b, all else as given [N·s/m; N·m·s/rad]; None where none is known."""
        return None

    @property
    def critical_frequency(self) -> float | None:
        """Where most damping is asked for [Hz]; None where that is not what decides."""
        return None

    @property
    def admissible_speed(self) -> float | None:
        """Up to which hands are safe [m/s; rad/s]; None where it is not known."""
        return None

    def curve(self, points: int = 400) -> tuple[list[float], list[float]]:
        """(frequency [Hz], damping asked for there [N·s/m]), for plotting only; of a law with H(z) alone."""
        return [], []

    @property
    def limit(self) -> str:
        """What limits the loop, in a few words; "" where that is not known."""
        return ""

    @cached_property
    def demand(self) -> tuple[str, ...]:
        """What the motion asks of the actuator, where there is one and the actuator's limit is known."""
        if self.device.force_limit is None or self.witness is None:
            return ()
        return (actuator_demand(self.device, self.device.force_limit, self.witness),)

    @property
    def is_beyond_actuator(self) -> bool:
        """True where the motion asks for more than the actuator gives: the claim takes it as ideal."""
        limit = self.device.force_limit
        return limit is not None and self.witness is not None and is_beyond(limit, self.witness)

    def evidence(self) -> dict[str, Any]:
        """Proofs and motions as plain data; of bounded hands what is said, the proof only if saved."""
        hand = {} if self.available_storage is None else {"worst_hand": self.available_storage.stated()}
        return {**super().evidence(), **hand}

    def saved(self) -> dict[str, Any]:
        """What `save` writes: the proof of bounded hands too."""
        if self.available_storage is None or self.witness is not None:
            return self.to_dict()
        return {**self.to_dict(), "worst_hand": self.available_storage.to_dict()}

    def save(self, path: str | Path, reports: Mapping[str, Any] | None = None) -> None:
        """Write verdict and evidence as JSON for `zwidth verify`, and `reports` under their names."""
        save_json(path, {**self.saved(), **(reports or {})})

    def __repr__(self) -> str:
        return f"<Verdict {self.describe()}>"

    def small_print(self) -> tuple[str, ...]:
        """The assumptions, and what the motion asks of the actuator."""
        return (*self.assumptions, *self.demand)

    @cached_property
    @answers("list of objects, below", optional=True)
    def advice(self) -> tuple[Advice, ...]:
        """The smallest single changes that would do, or the slack of each parameter; () if none is known."""
        if not (self.environment.points and self.device.is_certain):
            return ()
        from zwidth.passivity.loop_advice import advise_on_spring

        return advise_on_spring(self.device, self.environment, self.is_proved)

    def advised(self) -> Iterator[Part]:
        """What to change, or how far each number may go."""
        told = in_lines(self.advice, self.is_proved)
        lines = [*told.useful, *([told.useless] if told.useless else [])]
        if lines:
            yield f"{told.title}:"
            yield Lines(lines)

    @property
    @answers(
        "object with `damping_N_s_per_m`, and with `coulomb_friction_N` over what the encoder needs: what is "
        "left over what is needed, negative if too little; null where the need is unbounded",
        quantities=True,
    )
    def margins(self) -> Mapping[str, float | None]:
        """What is left of damping and of Coulomb friction over what is needed; < 0 if too little.

        Keys "damping" [N·s/m; N·m·s/rad] and "coulomb_friction" [N; N·m]; None where the need is unbounded.
        """
        return {need.name: need.has - need.needed for need in self.needs}

    def _left(self) -> float | None:
        """Of the device's damping and of its Coulomb friction; of both the lesser."""
        there = {name: float(self.device.motor_side.exact(name)) for name in self.margins}
        needs = {name: None if left is None else there[name] - left for name, left in self.margins.items()}
        return least(share_left(needs[name], has) for name, has in there.items())

    def rows(self) -> list[tuple[str, str]]:
        """The main numbers as (name, text) for a report."""
        rows = [("decided by", self.decided_by)]
        if self.environment.points and len(self.needs) == 2:  # with a part-sample delay one is not known
            from zwidth.passivity.loop_advice import binding_of_spring

            rows.insert(0, ("limit", binding_of_spring(self.device, self.needs)))
        for need in self.needs:
            unit = GLOSSARY[need.name].unit_for(self.device.motion)
            name = in_words(need.name)
            rows.append((f"required {name}", shown_at_least(need.needed, unit, 6)))
            rows.append((f"margin of {name}", shown(need.has - need.needed, unit, 6)))
        if self.witness is not None:
            rows.append(("motion", self.witness.describe()))
        return rows


def actuator_demand(device: Device, limit: Exact | Interval, witness: Moves) -> str:
    """Whether the motion asks for more force than the limit of the device's actuator [N; N·m]."""
    most = told_quantity(float(ends(limit)[1]), "force", device.motion)
    needed = told_quantity(_peak_force(witness), "force", device.motion, 4)
    if not is_beyond(limit, witness):
        return f"the motion stays within the actuator's {most}: it asks for {needed}"
    return (
        f"the motion asks for {needed}, more than the actuator's {most}; with that "
        "limit respected no motion is shown, and none is excluded"
    )


def is_beyond(limit: Exact | Interval, witness: Moves) -> bool:
    """True where the motion asks for more than the limit [N; N·m]."""
    return _peak_force(witness) > float(ends(limit)[1])


def _peak_force(witness: Moves) -> float:
    own: float | None = getattr(witness, "peak_force", None)
    if own is not None:
        return own
    from zwidth.passivity.storage.gain import Gain, peak_force  # loaded by now

    assert isinstance(witness, Gain)
    return peak_force(witness)
