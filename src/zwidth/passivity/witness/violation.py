"""A violation of the linear criterion, by itself a proof that a loop is active, and the motion that shows it.

A frequency at which the criterion is negative, a negative static stiffness or an unstable law: each lets a
hand take out any amount of energy, whatever Coulomb friction and encoder are (docs/theory/criterion.md).  The
proof is a number and a sign; the motion that shows it is made when it is asked for.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property, partial
from itertools import chain, pairwise
from math import ceil, floor, isfinite
from typing import Any

from zwidth.passivity.linear.criterion import LinearRefutation, frequency, offset_of
from zwidth.passivity.linear.exact_algebra import is_schur
from zwidth.passivity.result import Evidence
from zwidth.passivity.scope import Contact
from zwidth.passivity.witness.motion import Motion, Pattern, best_waits, edge_crossing, realize, round_up
from zwidth.passivity.witness.sinusoid import (
    PRESS_LENGTHS,
    buildups,
    enough_rounds,
    holds,
    oscillations,
    sinusoids,
    slow_press,
)
from zwidth.passivity.witness.witness import Setting, Witness
from zwidth.quantity.text import exact_text, shown, told_quantity

FORMAT = "zwidth violation 1"


@dataclass(frozen=True, repr=False)
class Violation(Evidence):
    """A proof that a hand can take any amount of energy out of a loop.

    Parameters
    ----------
    setting
        The loop, with Coulomb friction, encoder and surface.
    refutation
        What is violated, and where.
    """

    setting: Setting
    refutation: LinearRefutation

    @property
    def frequency(self) -> float | None:
        """A frequency at which the criterion is violated [Hz]; None where something else is."""
        cosine = self.refutation.cosine
        return None if cosine is None else frequency(cosine, self.setting.loop.period)

    @cached_property
    def witness(self) -> Witness | None:
        """A motion that takes energy out; None where none that was found is short enough to be checked."""
        return refute_linear(self.setting, self.refutation.reason)

    @property
    def contact(self) -> Contact:
        """A hand that stays inside finds it; or there is no surface."""
        return "kept" if self.setting.unilateral else "both sides"

    def to_dict(self) -> dict[str, Any]:
        """The violation as plain data."""
        loop = self.setting.loop_document()
        return {"format": FORMAT, "kind": "violation", "loop": loop, "proof": self._proof()}

    def _proof(self) -> dict[str, Any]:
        reason, cosine = self.refutation.reason, self.refutation.cosine
        if cosine is not None:
            return {"kind": reason, "cosine": exact_text(cosine)}
        if reason == "unstable environment" and self.setting.loop.part_delay == 0:
            return {"kind": reason, "offset": exact_text(offset_of(self.setting.loop))}
        return {"kind": reason}

    def describe(self) -> str:
        """What is violated, in words."""
        if self.frequency is not None:
            return f"a motion at {shown(self.frequency, 'Hz')} gains"
        if self.refutation.reason == "negative static stiffness":
            return f"pressed slowly, the law pulls the hand in ({self._static()})"
        return "the law is unstable by itself"

    def _static(self) -> str:
        stiffness = float(self.setting.loop.static_stiffness or Fraction(0))
        return f"static stiffness {told_quantity(stiffness, 'stiffness', self.setting.motion)}"


# Which motion, how often, how large: the ideal loop says how many rounds a motion needs to pay for going in
# and out; then its size is raised until energy, which grows with the square of it, outweighs Coulomb
# friction, which grows with it.  The checker has the last word.


_AMPLITUDE = Fraction(1, 1000)  # penetration of a witness that friction does not force to be larger [m; rad]
_FEW_ROUNDS = 1000

_WAYS = (1, 2, 3, 4, 5, 6, 8, 10, 13, 16, 20, 26, 34, 44)
"""Moves of the way in, and of the way out, of a motion that is to stay below a force."""

_SHORT = 200  # samples up to which a motion is preferred that does not return the law to its state
_MOST_ROUNDED = 2500  # samples up to which a motion off the law's whole numbers is recomputed exactly


def refute_linear(setting: Setting, reason: str) -> Witness | None:
    """A witness against the linear criterion or an unstable environment, or None if none is found."""
    if reason == "criterion":
        witness = _refute_criterion(setting)
        if witness is not None or is_schur(setting.loop.denominator[::-1]):
            return witness
    if reason == "negative static stiffness":
        press = slow_press(setting.loop)
        return _first(_sized(setting, press, times) for times in PRESS_LENGTHS)
    return _first(
        _scaled(setting, _unit(setting, one), partial(_multiplied, one))
        for one in chain(holds(setting.loop), buildups(setting.loop, setting.unilateral))
    )


def _refute_criterion(setting: Setting) -> Witness | None:
    """A motion at a frequency where the criterion is negative: a short one, a periodic one, or a long one."""
    loop = setting.loop
    memory = len(loop.numerator) + len(loop.denominator) > 2
    return (
        (_oscillating(setting, _SHORT) if memory else None)
        or _shortest(setting, sinusoids(loop, setting.unilateral))
        or _oscillating(setting, _MOST_ROUNDED)
    )


def _oscillating(setting: Setting, longest: int) -> Witness | None:
    return _first(_from_positions(setting, one) for one in oscillations(setting.loop, longest))


def within_force(setting: Setting, limit: Fraction) -> Witness | None:
    """In, still, and out, so deep that the force just stays below a limit [N; N·m]; None if none gains.

    Of those tried the one that takes out most: behind a delay the way in meets the force of before, the way
    out the whole one.
    """
    late = setting.loop.whole_delay + (setting.loop.part_delay > 0)
    shapes = ((ways, still) for ways in _WAYS for still in sorted({1, late, late + 1, 2 * late + 1}))
    motions = (_pressed(setting, limit, *shape) for shape in shapes)
    tried = (setting.witness(one) for one in motions if one is not None)
    found = [witness for witness in tried if witness is not None and witness.peak_force <= limit]
    return max(found, key=lambda witness: witness.exact_energy, default=None)


def _pressed(setting: Setting, limit: Fraction, ways: int, still: int) -> Motion | None:
    """In and out in so many equal moves, and so many samples still between, on whole counts; None where the
    law's force goes beyond every number."""
    way = [Fraction(k, ways) for k in range(ways + 1)]
    shape = (*way, *[way[-1]] * still, *way[-2::-1])
    force, count = setting.peak_force(shape), setting.resolution
    if not isfinite(force):
        return None
    depth = limit * Fraction(999, 1000) / Fraction(force) if force else _AMPLITUDE
    unit = count or round_up(depth) / 10**6
    inside = [unit * floor(depth * v / unit) + count / 8 for v in shape[1:-1]]
    x = (Fraction(0), *inside, Fraction(0))
    part = setting.loop.part_delay
    return Motion(x, tuple(a + part * (b - a) for a, b in pairwise(x)) if part else ())


def refute_friction(setting: Setting) -> Witness | None:
    """A witness that Coulomb friction does not cover one encoder count, or None."""
    loop = setting.loop
    memory = len(loop.numerator) + len(loop.denominator) > 2
    edge = (2 if memory else 1) if setting.unilateral else 0  # a law with memory is kept in contact
    motion = edge_crossing(loop, setting.coulomb_friction, setting.resolution, best_waits(loop), edge)
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


def _from_positions(setting: Setting, one: Motion) -> Witness | None:
    """A motion given by whole positions, large enough for friction and encoder."""
    unit = _unit(setting, one)
    if unit is None:
        return None
    if setting.resolution:
        return _on_counts(setting, one, unit)
    return _scaled(setting, unit, partial(_multiplied, one))


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
    return enough_rounds(lambda n: setting.ideal().energy(one.repeated(n)))


def _sized(setting: Setting, pattern: Pattern, times: int | None = None) -> Witness | None:
    """Enough rounds for the ideal loop, then large enough for friction and encoder."""
    times = times or _rounds(setting, pattern)
    if times is None:
        return None
    one = realize(setting.loop, pattern, Fraction(1), Fraction(0), times)
    unit = _unit(setting, one)
    if unit is None:
        return None
    is_long = sum(abs(c) for c in setting.loop.follower) > 1000  # on whole counts x = D w would be absurd
    if setting.resolution and is_long and one.samples <= _MOST_ROUNDED:
        witness = _on_counts(setting, one, unit)
        if witness is not None:
            return witness
    return _scaled(setting, unit, lambda u, offset: realize(setting.loop, pattern, u, offset, times))


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

    times = enough_rounds(gain)
    return None if times is None else setting.witness(motion.repeated(times))
