"""A witness: a hand motion that takes energy out of the loop, recomputed exactly.

Any motion found elsewhere becomes a witness only after the independent checker
has run it through the loop, encoder and Coulomb friction included, in rational
arithmetic, and found energy to come out.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from math import ceil
from pathlib import Path
from typing import Any

from zwidth.passivity import checker
from zwidth.passivity.document import loop_document, to_json, unit_key
from zwidth.passivity.escape import buildups, slow_presses
from zwidth.passivity.loop import LinearLoop
from zwidth.passivity.motion import Motion, Pattern, realize, round_up
from zwidth.passivity.sinusoid import sinusoids
from zwidth.passivity.straddle import best_waits, straddle

FORMAT = "zwidth witness 1"
_AMPLITUDE = Fraction(1, 1000)
"""Penetration of a witness that friction does not force to be larger [m; rad]."""


@dataclass(frozen=True)
class Setting:
    """What a motion is run through: the linear loop, friction, encoder and surface."""

    loop: LinearLoop
    coulomb_friction: Fraction
    resolution: Fraction
    unilateral: bool
    motion: str = "linear"

    def ideal(self) -> Setting:
        """Without Coulomb friction and with an ideal encoder: energy is then quadratic in size."""
        return Setting(self.loop, Fraction(0), Fraction(0), self.unilateral, self.motion)

    def energy(self, motion: Motion) -> Fraction | None:
        """Energy the hand takes out [J], by the checker; None if the motion is not admitted."""
        return checker.verify(self.document(motion, Fraction(0))).energy

    def document(self, motion: Motion, energy: Fraction) -> dict[str, Any]:
        """The motion in this setting as a document for the checker."""
        loop = loop_document(
            self.loop, self.coulomb_friction, self.resolution, self.unilateral, self.motion
        )
        document: dict[str, Any] = {"format": FORMAT, "kind": "motion", "loop": loop}
        document[unit_key("sample_period")] = self.loop.period
        document["energy_J"] = energy
        if motion.rounds > 1:
            document["repeats"] = [r._asdict() for r in motion.repeats if r.times > 1]
        suffix = unit_key("position", self.motion).removeprefix("position_")
        document[f"positions_{suffix}"] = list(motion.positions)
        if motion.switch_positions:
            document[f"switch_positions_{suffix}"] = list(motion.switch_positions)
        return document


@dataclass(frozen=True)
class Witness:
    """A motion from rest at the surface that takes energy out of the device.

    Energy out, in rational arithmetic: −Σ f Δx − f_c Σ|Δx| − (b/T) Σ Δx², the
    force held as the loop holds it, the mass taking part by impulses at the
    samples that cancel over the motion.
    """

    setting: Setting
    motion: Motion
    exact_energy: Fraction

    @property
    def energy(self) -> float:
        """Energy extracted by the whole motion [J], > 0."""
        return float(self.exact_energy)

    @property
    def positions(self) -> tuple[float, ...]:
        """Positions at the samples [m; rad]; the repeated part once."""
        return tuple(float(x) for x in self.motion.positions)

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
        """Largest mean speed over one sample [m/s; rad/s]."""
        x = self.motion.positions
        return float(max(abs(b - a) for a, b in zip(x, x[1:], strict=False)) / self.setting.loop.period)

    @property
    def depth(self) -> float:
        """Deepest penetration [m; rad]."""
        return float(self.motion.depth)

    def verify(self) -> bool:
        """True when the independent checker finds the same energy, > 0."""
        return checker.verify(self.to_dict()).valid

    def to_dict(self) -> dict[str, Any]:
        """The witness as plain data; positions are exact rationals."""
        return self.setting.document(self.motion, self.exact_energy)

    def save(self, path: str | Path) -> None:
        """Write the witness as JSON for `zwidth verify`."""
        Path(path).write_text(to_json(rounded_energy(self.to_dict())) + "\n", encoding="utf-8")

    def _repr_html_(self) -> str:
        return f"<p>{self.describe()}</p>"

    def describe(self) -> str:
        """The motion in a sentence."""
        unit = "rad" if self.setting.motion == "rotary" else "m"
        times = self.motion.rounds
        rounds = f", its cycle {times:.6g} times" if times > 1 and len(self.motion.repeats) == 1 else ""
        return (
            f"{self.motion.samples:.6g} samples{rounds}, to {self.depth:.4g} {unit} at up to "
            f"{self.peak_speed:.4g} {unit}/s, extracts {self.energy:.4g} J"
        )


def rounded_energy(document: dict[str, Any]) -> dict[str, Any]:
    """Energy to double precision: the checker recomputes it anyway."""
    return {**document, "energy_J": Fraction(repr(float(document["energy_J"])))}


def refute_linear(setting: Setting, reason: str) -> Witness | None:
    """A witness against the linear criterion or an unstable environment, or None if none is found."""
    if reason == "criterion":
        patterns = sinusoids(setting.loop, setting.unilateral)
        return _first(_sized(setting, pattern) for pattern in patterns)
    if reason == "negative static stiffness":
        return _first(_sized(setting, pattern) for pattern in slow_presses(setting.loop))
    return _first(_scaled(setting, motion) for motion in buildups(setting.loop))


def refute_friction(setting: Setting) -> Witness | None:
    """A witness that Coulomb friction does not cover one encoder count, or None."""
    waits = best_waits(setting.loop)
    memory = len(setting.loop.numerator) + len(setting.loop.denominator) > 2
    cell = 3 if memory else 0  # a law with memory is straddled inside the wall
    motion = straddle(setting.loop, setting.coulomb_friction, setting.resolution, waits, cell)
    return None if motion is None else _repeated(setting, motion)


def _first(candidates: Iterator[Witness | None]) -> Witness | None:
    return next((w for w in candidates if w is not None), None)


def _sized(setting: Setting, pattern: Pattern) -> Witness | None:
    """Enough rounds for the ideal loop, then large enough for friction and encoder."""
    ideal = setting.ideal()

    def motion(times: int, unit: Fraction, offset: Fraction = Fraction(0)) -> Motion:
        return realize(setting.loop, pattern, unit, offset, times)

    one = motion(1, Fraction(1))
    times = _enough_rounds(lambda n: ideal.energy(one.repeated(n)))
    if times is None:
        return None
    return _scaled(setting, one.repeated(times), lambda unit, offset: motion(times, unit, offset))


def _scaled(setting: Setting, one: Motion, resize: Any = None) -> Witness | None:
    """The motion at a size at which energy, growing as size², exceeds friction, growing as size."""
    gain = setting.ideal().energy(one)
    if gain is None or gain <= 0:
        return None
    resize = resize or (lambda unit, offset: _multiplied(one, unit, offset))
    unit = _AMPLITUDE / max(abs(x) for x in (one.depth, *one.positions))
    if setting.coulomb_friction:
        unit = max(unit, 2 * setting.coulomb_friction * _path(setting, one, gain) / gain)
    for _ in range(12):
        unit = round_up(unit)
        if setting.resolution:
            unit = setting.resolution * ceil(unit / setting.resolution)
        motion = resize(unit, setting.resolution / 8)
        energy = setting.energy(motion)
        if energy is not None and energy > 0:
            return Witness(setting, motion, energy)
        unit *= 4
    return None


def _multiplied(one: Motion, unit: Fraction, offset: Fraction) -> Motion:
    last = len(one.positions) - 1
    x = tuple(unit * v + (offset if 0 < k < last else 0) for k, v in enumerate(one.positions))
    y = tuple(unit * v for v in one.switch_positions)
    return Motion(x, y, one.repeats)


def _path(setting: Setting, one: Motion, gain: Fraction) -> Fraction:
    """Σ |Δx| of the motion: what one newton of Coulomb friction takes from it."""
    rubbed = Setting(setting.loop, Fraction(1), Fraction(0), setting.unilateral, setting.motion)
    return gain - (rubbed.energy(one) or Fraction(0))


def _repeated(setting: Setting, motion: Motion) -> Witness | None:
    times = _enough_rounds(lambda n: setting.energy(motion.repeated(n)))
    if times is None:
        return None
    energy = setting.energy(motion.repeated(times))
    return Witness(setting, motion.repeated(times), energy) if energy is not None and energy > 0 else None


def _enough_rounds(energy: Any) -> int | None:
    """Rounds after which a repeated motion has gained: energy is affine in them from the second on."""
    one = energy(1)
    if one is None:
        return None
    if one > 0:
        return 1
    two, three = energy(2), energy(3)
    per_round = three - two
    if per_round <= 0:
        return None
    return 2 if two > 0 else 3 + int(ceil(-2 * two / per_round))
