"""Walls and solids that are passive while the hand stays inside, and are not when it touches and leaves.

A law fed with the position hears outside what it does not answer: a hand that comes in fast has loaded it
for nothing but the friction of the way.  What it then gives out at the surface, in and out in turn, is a
quadratic in the hand's moves once it is said at which samples the hand is inside.  So for each such pattern
the best moves follow by going backward from the last (`contact_pattern_search`).  Coulomb friction and counts
of the encoder grow with the first power of the size only: a large enough motion pays for them.  The checker
has the last word.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from itertools import chain, pairwise
from math import ceil
from typing import Any

from zwidth.model.environment.environment import Environment
from zwidth.passivity.linear.contact_pattern_search import Surface, rhythms
from zwidth.passivity.linear.exact_algebra import is_schur
from zwidth.passivity.scope import unit_key
from zwidth.passivity.witness.motion import Motion, round_up
from zwidth.passivity.witness.sinusoid import oscillations
from zwidth.passivity.witness.witness import FORMAT, Setting, Witness

_AMPLITUDE = Fraction(1, 1000)  # size of a motion that friction does not force to be larger [m; rad]
_FINENESS = (50, 200, 1000, 10_000)
"""Steps in which the largest position is counted; coarse ones make a smaller motion on counts."""

_LONGEST_RETURN = 20_000

_LONGEST_DEEP = 1000

_MOST_EFFORT = 60_000
"""Products times a thousand bits of exact numbers, about, that one check of a motion may take."""


@dataclass(frozen=True)
class TouchedSetting(Setting):
    """A law with memory that is touched and left, run as the controller runs it.

    `fed_with` is "position" or "penetration"; `never_pulls` says whether its force is clamped.
    """

    fed_with: str = "position"
    never_pulls: bool = False

    @property
    def stored(self) -> Fraction:
        """Nothing: the motion begins at rest outside."""
        return Fraction(0)

    def document(self, motion: Motion, energy: Fraction) -> dict[str, Any]:
        """The motion in this setting as a document for the checker."""
        length = unit_key("position", self.motion).removeprefix("position_")
        document: dict[str, Any] = {
            "format": FORMAT,
            "kind": "touching motion",
            "loop": self.loop_document(),
            "law": {"fed_with": self.fed_with, "never_pulls": self.never_pulls},
            unit_key("sample_period"): self.loop.period,
            "energy_J": energy,
            f"positions_{length}": list(motion.positions),
        }
        if self.loop.part_delay:
            document[f"switch_positions_{length}"] = list(motion.switch_positions)
        return document

    def forces(self, positions: tuple[Fraction, ...]) -> list[float]:
        """The force of each sample, to rounding [N; N·m]."""
        surface = Surface(self.loop, self.fed_with == "penetration", self.never_pulls)
        return surface.forces([float(self.read(x)) for x in positions])

    def read(self, position: Fraction) -> Fraction:
        """What the encoder says."""
        return self.resolution * (position // self.resolution) if self.resolution else position

    def peak_force(self, positions: tuple[Fraction, ...]) -> float:
        """Largest actuator force that the motion asks for, to rounding [N; N·m]."""
        return max(map(abs, self.forces(positions)))


def refute_touching(setting: Setting, environment: Environment) -> Witness | None:
    """A motion that touches and leaves a one-sided law with memory and takes energy out, or None."""
    loop = setting.loop
    if not (setting.unilateral and is_schur(loop.denominator[::-1]) and loop.damping > 0):
        return None
    touched = TouchedSetting(
        loop,
        setting.coulomb_friction,
        setting.resolution,
        True,
        setting.motion,
        environment.fed_with,
        environment.clamped,
    )
    surface = Surface(loop, environment.surface == "penetration", environment.clamped)
    motions = chain(rhythms(surface), _deep(surface))
    found = (_sized(touched, surface, positions) for positions in motions)
    return next((witness for witness in found if witness is not None), None)


def _deep(surface: Surface) -> Iterator[list[float]]:
    """To and fro so deep inside that a law that never pulls is not clamped, at a frequency that gains."""
    if not (surface.never_pulls and surface.static > 0):
        return
    free = Surface(surface.loop, surface.penetration, False)
    for one in oscillations(surface.loop, _LONGEST_DEEP):
        x = [float(v) for v in one.positions[1:-1]]
        gained = free.energy([x[0], *x])
        if gained <= 0:
            continue
        moved = free.forces([v - min(x) + 1 for v in x])
        depth = 2 * max(map(abs, moved)) / surface.static
        count = min(_LONGEST_RETURN, ceil(8 * surface.cost * depth * depth / gained))
        ramp = [depth * k / count for k in range(count)]
        yield [*ramp, *(depth + v - x[0] for v in x), *([depth + x[-1] - x[0]] if count else []), *ramp[::-1]]


def _sized(setting: TouchedSetting, surface: Surface, positions: list[float]) -> Witness | None:
    """The motion on a grid, with a slow way back, large enough for friction and on whole counts."""
    inside = max(k for k, x in enumerate(positions) if x > 0)
    bits = abs(setting.loop.follower[0]).bit_length()
    if inside * len(setting.loop.denominator) * (1 + inside * bits / 2000) > _MOST_EFFORT:
        return None
    for steps in _FINENESS:
        knots = _knots(positions, steps)
        gained = surface.energy([float(k) for k in knots])
        if gained <= 0:
            continue
        knots = _returned(knots, gained, surface.cost)
        unit = _unit(setting, knots, surface, steps)
        if unit is None:
            continue
        witness = setting.witness(_motion(setting, knots, unit))
        if witness is not None:
            return witness
    return None


def _knots(positions: list[float], steps: int) -> list[int]:
    """Whole numbers of the grid, each on its side of the surface: 1 at least inside, 0 at most outside."""
    size = max(map(abs, positions))
    return [max(1, round(steps * x / size)) if x > 0 else min(0, round(steps * x / size)) for x in positions]


def _returned(knots: list[int], gained: float, cost: float) -> list[int]:
    """With a way back so slow that it costs a fifth of what was gained, at most."""
    far = knots[0] - knots[-1]
    count = min(_LONGEST_RETURN, max(1, ceil(5 * cost * far * far / gained)), max(1, abs(far)))
    return knots + [knots[-1] + round(far * k / count) for k in range(1, count + 1)]


def _unit(setting: TouchedSetting, knots: list[int], surface: Surface, steps: int) -> Fraction | None:
    """The size of a step [m; rad] at which energy, growing as its square, exceeds friction."""
    gained = surface.energy([float(k) for k in knots])
    if gained <= 0:
        return None
    path = sum(abs(b - a) for a, b in pairwise(knots))
    unit = max(_AMPLITUDE / steps, 2 * setting.coulomb_friction * path / Fraction(gained))
    count = setting.resolution
    return count * ceil(unit / count) if count else round_up(unit)


def _motion(setting: Setting, knots: list[int], unit: Fraction) -> Motion:
    """The positions, an eighth of a count off the edges of the encoder."""
    x = tuple(unit * k + setting.resolution / 8 for k in knots)
    part = setting.loop.part_delay
    return Motion(x, tuple(a + part * (b - a) for a, b in pairwise(x)) if part else ())
