"""A witness: a hand motion that takes energy out of the loop, recomputed exactly.

Any motion found elsewhere becomes a witness only after the independent checker
has run it through the loop, encoder and Coulomb friction included, in rational
arithmetic, and found energy to come out.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from fractions import Fraction
from functools import partial
from math import ceil
from pathlib import Path
from typing import Any

from zwidth.passivity import checker
from zwidth.passivity.document import loop_document, to_json, unit_key
from zwidth.passivity.escape import PRESS_LENGTHS, buildups, slow_press
from zwidth.passivity.loop import LinearLoop
from zwidth.passivity.motion import Motion, Pattern, realize, round_up
from zwidth.passivity.schur import is_schur
from zwidth.passivity.sinusoid import sinusoids
from zwidth.passivity.straddle import best_waits, straddle

FORMAT = "zwidth witness 1"
_AMPLITUDE = Fraction(1, 1000)
"""Penetration of a witness that friction does not force to be larger [m; rad]."""

MOST_LISTED = 20_000
"""Samples up to which a witness is written down in full, repeated parts and all."""

_FEW_ROUNDS = 1000
_MOST_ROUNDED = 2500
"""Samples up to which a motion off the law's whole numbers is recomputed exactly."""


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

    def document(self, motion: Motion, energy: Fraction) -> dict[str, Any]:
        """The motion in this setting as a document for the checker."""
        loop = loop_document(self.loop, self.coulomb_friction, self.resolution, self.unilateral, self.motion)
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
        """Positions at the samples [m; rad]; in a very long motion each repeated part once."""
        return tuple(float(x) for x in self._told.positions)

    @property
    def _told(self) -> Motion:
        """The motion as it is written down: every round, unless there are very many."""
        return self.motion.listed() if self.motion.samples <= MOST_LISTED else self.motion

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

    @property
    def peak_force(self) -> float:
        """Largest actuator force that the motion asks for, to rounding [N; N·m]."""
        loop = self.setting.loop
        d = [c / loop.denominator[0] for c in loop.denominator[1:]]
        n = [c / loop.denominator[0] for c in loop.numerator]
        past = [0.0] * max(len(d), len(n) - 1)
        peak = 0.0
        for x in self.positions:
            w = x - sum(a * v for a, v in zip(d, past, strict=False))
            past = [w, *past]
            peak = max(peak, abs(sum(a * v for a, v in zip(n, past, strict=False))))
            past.pop()
        # a part that moves on with every round is listed once: its depth is what counts
        return max(peak, abs(float(loop.static_stiffness or 0)) * self.depth)

    def verify(self) -> bool:
        """True when the independent checker finds the same energy, > 0."""
        return checker.verify(self.to_dict()).valid

    def to_dict(self) -> dict[str, Any]:
        """The witness as plain data; positions are exact rationals."""
        return self.setting.document(self._told, self.exact_energy)

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
        witness = _shortest(setting, sinusoids(setting.loop, setting.unilateral))
        if witness is not None or is_schur(setting.loop.denominator[::-1]):
            return witness
    if reason == "negative static stiffness":
        press = slow_press(setting.loop)
        return _first(_sized(setting, press, times) for times in PRESS_LENGTHS)
    return _first(
        _scaled(setting, _unit(setting, one), partial(_multiplied, one))
        for one in buildups(setting.loop, setting.unilateral)
    )


def refute_friction(setting: Setting) -> Witness | None:
    """A witness that Coulomb friction does not cover one encoder count, or None."""
    loop = setting.loop
    memory = len(loop.numerator) + len(loop.denominator) > 2
    edge = (2 if memory else 1) if setting.unilateral else 0  # a law with memory is kept in contact
    motion = straddle(loop, setting.coulomb_friction, setting.resolution, best_waits(loop), edge)
    if motion is None:
        return None
    if len(loop.follower) == 1:
        return _repeated(setting, motion)
    return _in_full(setting, motion)


def _in_full(setting: Setting, motion: Motion) -> Witness | None:
    """The motion with every round listed: with a filter no round is quite like another."""
    part = motion.repeats[0]
    rounds = 1
    while len(motion.positions) + (rounds - 1) * (part.last - part.first) <= _MOST_ROUNDED:
        full = motion.repeated(rounds)
        witness = setting.witness(full.listed())
        if witness is not None:
            return witness
        rounds *= 4
    return None


def _first(candidates: Iterator[Witness | None]) -> Witness | None:
    return next((w for w in candidates if w is not None), None)


def _shortest(setting: Setting, patterns: Iterator[Pattern]) -> Witness | None:
    """The first pattern that needs few rounds, else the one that needs fewest."""
    best: tuple[int, Pattern] | None = None
    for pattern in patterns:
        times = _rounds(setting, pattern)
        if times is not None and (best is None or times < best[0]):
            best = times, pattern
        if best is not None and best[0] <= _FEW_ROUNDS:
            break
    return None if best is None else _sized(setting, best[1], best[0])


def _rounds(setting: Setting, pattern: Pattern) -> int | None:
    """Rounds with which the pattern gains in the ideal loop."""
    one = realize(setting.loop, pattern, Fraction(1), Fraction(0), 1)
    return _enough_rounds(lambda n: setting.ideal().energy(one.repeated(n)))


def _sized(setting: Setting, pattern: Pattern, times: int | None = None) -> Witness | None:
    """Enough rounds for the ideal loop, then large enough for friction and encoder."""
    times = times or _rounds(setting, pattern)
    if times is None:
        return None
    one = realize(setting.loop, pattern, Fraction(1), Fraction(0), times)
    unit = _unit(setting, one)
    if unit is None:
        return None
    if setting.resolution and _follower_is_long(setting.loop) and one.samples <= _MOST_ROUNDED:
        witness = _on_counts(setting, one, unit)
        if witness is not None:
            return witness
    return _scaled(setting, unit, lambda u, offset: realize(setting.loop, pattern, u, offset, times))


def _follower_is_long(loop: LinearLoop) -> bool:
    """True when x = D w on whole counts would make the motion absurdly large."""
    return sum(abs(c) for c in loop.follower) > 1000


def _on_counts(setting: Setting, one: Motion, unit: Fraction) -> Witness | None:
    """The motion rounded to whole counts, every round listed; the filter's exact numbers then grow."""
    count = setting.resolution
    unit = max(unit, 50 * count / one.depth)
    for _ in range(4):
        listed = one.scaled(unit).listed()
        last = listed.samples
        x = tuple(
            count * round(v / count) + (count / 8 if 0 < k < last else 0)
            for k, v in enumerate(listed.positions)
        )
        grid = count / 1024
        y = tuple(grid * round(v / grid) for v in listed.switch_positions)
        witness = setting.witness(Motion(x, y))
        if witness is not None:
            return witness
        unit *= 4
    return None


def _unit(setting: Setting, one: Motion) -> Fraction | None:
    """The size at which energy, growing as size², exceeds Coulomb friction, growing as size."""
    gain = setting.ideal().energy(one)
    if gain is None or gain <= 0:
        return None
    unit = _AMPLITUDE / max(abs(x) for x in (one.depth, *one.positions))
    if setting.coulomb_friction:
        unit = max(unit, 2 * setting.coulomb_friction * _path(setting, one, gain) / gain)
    return unit


def _scaled(
    setting: Setting, unit: Fraction | None, resize: Callable[[Fraction, Fraction], Motion]
) -> Witness | None:
    """The motion at that size or above, on whole counts, once the checker finds that it gains."""
    if unit is None:
        return None
    for _ in range(12):
        unit = round_up(unit)
        if setting.resolution:
            unit = setting.resolution * ceil(unit / setting.resolution)
        motion = resize(unit, setting.resolution / 8)
        witness = setting.witness(motion)
        if witness is not None:
            return witness
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
    def gain(rounds: int) -> Fraction | None:
        energy = setting.energy(motion.repeated(rounds))
        return None if energy is None else energy - setting.stored

    times = _enough_rounds(gain)
    return None if times is None else setting.witness(motion.repeated(times))


def _enough_rounds(energy: Callable[[int], Fraction | None]) -> int | None:
    """Rounds after which a repeated motion has gained: energy is affine in them from the second on."""
    one = energy(1)
    if one is None:
        return None
    if one > 0:
        return 1
    two, three = energy(2), energy(3)
    if two is None or three is None:
        return None
    per_round = three - two
    if per_round <= 0:
        return None
    return 2 if two > 0 else 3 + ceil(-2 * two / per_round)
