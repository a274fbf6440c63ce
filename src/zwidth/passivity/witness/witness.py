"""A witness: a hand motion that takes energy out of the loop, recomputed exactly.

Any motion found elsewhere becomes a witness only after the independent checker has run it through the loop,
encoder and Coulomb friction included, in rational arithmetic, and found energy to come out.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any

from zwidth.checker import verify
from zwidth.passivity.linear.loop import LinearLoop
from zwidth.passivity.result import Evidence
from zwidth.passivity.scope import Contact, loop_document, unit_key
from zwidth.passivity.witness.motion import Motion, forces_of
from zwidth.passivity.wording import size
from zwidth.quantity.text import quantity_unit, shown

FORMAT = "zwidth witness 1"

MOST_LISTED = 20_000
"""Samples up to which a witness is written down in full, repeated parts and all."""


@dataclass(frozen=True)
class Setting:
    """What a motion is run through: the linear loop, friction, encoder and surface."""

    loop: LinearLoop
    coulomb_friction: Fraction
    resolution: Fraction
    unilateral: bool
    motion: str = "linear"

    def loop_document(self) -> dict[str, Any]:
        """Of all but the motion, exact."""
        return loop_document(self.loop, self.coulomb_friction, self.resolution, self.unilateral, self.motion)

    def ideal(self) -> Setting:
        """Without Coulomb friction and with an ideal encoder: energy is then quadratic in size."""
        return replace(self, coulomb_friction=Fraction(0), resolution=Fraction(0))

    def energy(self, motion: Motion) -> Fraction | None:
        """Energy the hand takes out [J], by the checker; None if the motion is not admitted."""
        return verify(self.document(motion, Fraction(0))).energy

    @property
    def stored(self) -> Fraction:
        """Energy that even a passive loop may give out once from rest: H(1) Δ²/8, 0 for a spring wall [J]."""
        memory = len(self.loop.numerator) + len(self.loop.denominator) > 2
        static = self.loop.static_stiffness
        if (self.unilateral and not memory) or static is None:
            return Fraction(0)
        return max(static, Fraction(0)) * self.resolution**2 / 8

    def witness(self, motion: Motion) -> Witness | None:
        """The motion as a witness if the checker finds that it takes out more than was stored."""
        energy = self.energy(motion)
        return None if energy is None or energy <= self.stored else Witness(self, motion, energy)

    def peak_force(self, positions: tuple[Fraction, ...]) -> float:
        """Largest force of the law at these positions, to rounding [N; N·m]."""
        return max(map(abs, forces_of(self.loop, [float(x) for x in positions])))

    def document(self, motion: Motion, energy: Fraction) -> dict[str, Any]:
        """The motion in this setting as a document for the checker."""
        document: dict[str, Any] = {"format": FORMAT, "kind": "motion", "loop": self.loop_document()}
        document[unit_key("sample_period")] = self.loop.period
        document["energy_J"] = energy
        if motion.rounds > 1:
            document["repeats"] = [r._asdict() for r in motion.repeats if r.times > 1]
        suffix = unit_key("position", self.motion).removeprefix("position_")
        document[f"positions_{suffix}"] = list(motion.positions)
        if motion.switch_positions:
            document[f"switch_positions_{suffix}"] = list(motion.switch_positions)
        return document


@dataclass(frozen=True, repr=False)
class Witness(Evidence):
    """A motion from rest at the surface that takes energy out of the device.

    Energy out, in rational arithmetic: −Σ f Δx − f_c Σ|Δx| − (b/T) Σ Δx², the force held as the loop holds
    it, the mass taking part by impulses at the samples that cancel over the motion.
    """

    setting: Setting
    motion: Motion
    exact_energy: Fraction

    @property
    def energy(self) -> float:
        """Energy extracted by the whole motion [J], > 0."""
        return float(self.exact_energy)

    @property
    def contact(self) -> Contact:
        """Whether the motion stays inside, touches and leaves, or meets no surface."""
        if not self.setting.unilateral:
            return "both sides"
        return "kept" if min(self.motion.positions[1:-1], default=1) > 0 else "made and broken"

    @property
    def positions(self) -> tuple[float, ...]:
        """Positions at the samples [m; rad]; in a very long motion each repeated part once."""
        return tuple(float(x) for x in self._told.positions)

    @property
    def _told(self) -> Motion:
        """The motion as it is written down: every round, unless there are very many."""
        return self.motion.listed() if self.motion.samples <= MOST_LISTED else self.motion

    @property
    def unit(self) -> str:
        """Of positions."""
        return quantity_unit("position", self.setting.motion)

    @property
    def sample_period(self) -> float:
        """T [s]."""
        return float(self.setting.loop.period)

    @property
    def energy_per_cycle(self) -> float:
        """Energy extracted by one more round of the repeated part [J]; all of it if none repeats."""
        if len(self.motion.repeats) != 1:
            return self.energy
        more = self.setting.energy(self.motion.repeated(self.motion.rounds + 1))
        return float(more - self.exact_energy) if more is not None else self.energy

    @property
    def duration(self) -> float:
        """Length of the whole motion [s]."""
        return self.motion.samples * self.sample_period

    @property
    def peak_speed(self) -> float:
        """Largest mean speed over each time in which one force is held [m/s; rad/s]."""
        loop = self.setting.loop
        return float(self.motion.peak_speed(loop.period, loop.part_delay))

    @property
    def depth(self) -> float:
        """Deepest penetration [m; rad]."""
        return float(self.motion.reach)

    @property
    def peak_force(self) -> float:
        """Largest actuator force that the motion asks for, to rounding [N; N·m]."""
        # a part that moves on with every round is listed once: its depth is what counts
        static = abs(float(self.setting.loop.static_stiffness or 0) * float(self.motion.depth))
        return max(self.setting.peak_force(self._told.positions), static)

    def to_dict(self) -> dict[str, Any]:
        """The witness as plain data; positions are exact rationals."""
        return self.setting.document(self._told, self.exact_energy)

    def saved(self) -> dict[str, Any]:
        """The energy rounded: the checker recomputes it anyway."""
        return rounded_energy(self.to_dict())

    def describe(self) -> str:
        """The motion in a sentence."""
        times = self.motion.rounds
        rounds = f", its cycle {times:.6g} times" if times > 1 and len(self.motion.repeats) == 1 else ""
        return (
            f"{self.motion.samples:.6g} samples{rounds}, {size(self.depth, self.peak_speed, self.unit)}, "
            f"extracts {shown(self.energy, 'J')}"
        )


def rounded_energy(document: dict[str, Any]) -> dict[str, Any]:
    """Energy to double precision: the checker recomputes it anyway."""
    return {**document, "energy_J": Fraction(repr(float(document["energy_J"])))}
