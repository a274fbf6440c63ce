"""A law with contact made and broken, read from a document: readings of an encoder to a force.

u = q, or max(q, 0) if fed with the penetration
f = Σ c_j u_{k−j}  or  a spring through given points, times 1 + ρ (q_k − q_{k−1}) for a contact
f = max(0, f) if clamped;  f = 0 where q_k ≤ 0 if there is a surface
f = the nearest whole step of a converter, the upper of two;  then |f| ≤ the force limit
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Sequence
from fractions import Fraction
from itertools import pairwise
from typing import NamedTuple

from ..document.fields import Choice, Flag, Number, Read, Record, Words, numbers, pairs
from ..document.number import (
    DAMPING,
    FORCE,
    FORCE_AT,
    FORCE_AT_SPEED,
    FRICTION_MODEL,
    LENGTH,
    PER_LENGTH,
    SECONDS,
    STIFFNESS,
    increasing,
)
from ..document.refusal import Invalid, only_if, spend

MOST_TAPS = 50
MOST_POINTS = 10_000
LOSSES = Record(
    {
        "damping": Number(DAMPING, least=0, default=None),
        "coulomb_friction": Number(FORCE, least=0, default=None),
        "friction_curve": pairs(FORCE_AT_SPEED, least=2, most=MOST_POINTS, default=None),
        "friction_models": pairs(FRICTION_MODEL, least=1, most=MOST_POINTS + 1, default=None),
        "resolution": Number(LENGTH, above=0),
        "sample_period": Number(SECONDS, above=0),
        "delay": Number(SECONDS, least=0),
    }
)
"""A device with damping and Coulomb friction, or with a friction curve and models below it."""
LAW = Record(
    {
        "taps": numbers(STIFFNESS, most=MOST_TAPS),
        "points": pairs(FORCE_AT, least=1, most=MOST_POINTS, default=None),
        "rate_per": Number(PER_LENGTH, default=None),
        "surface": Choice("none", "position", "penetration"),
        "clamped": Flag(),
        "force_step": Number(FORCE, above=0, default=None),
        "force_limit": Number(FORCE, least=0, default=None),
        "relaxing": Record({"pole": Number(least=0, below=1), "stiffness": Number(STIFFNESS)}, default=None),
        "resets": Flag(default=None),
    }
)


class Losses(NamedTuple):
    """`part` of an interval has the force of the reading `delay` samples ago, the rest that of the next.

    `models` are (f_c, b) of which each holds at every speed; `curve` a measured friction
    above them all, (speed, force), or empty.
    """

    models: list[tuple[Fraction, Fraction]]
    curve: list[tuple[Fraction, Fraction]]
    resolution: Fraction
    period: Fraction
    delay: int
    part: Fraction

    def lost(self, move: Fraction, part: Fraction) -> Fraction:
        """What a move in a part of an interval costs a hand that moves evenly, or in slow steps."""
        far = abs(move)
        if not self.curve:
            ((friction, damping),) = self.models
            return friction * far + damping / (part * self.period) * far * far
        speed = far / (part * self.period)
        least, slow = min((force, v) for v, force in self.curve)
        return far * (least if speed <= slow else self._force(speed))

    def _force(self, speed: Fraction) -> Fraction:
        faster = [p for p in self.curve if p[0] >= speed]
        if len(faster) == len(self.curve):
            return self.curve[0][1]
        (v0, f0), (v1, f1) = self.curve[-2:] if not faster else self.curve[-len(faster) - 1 :][:2]
        slope = (f1 - f0) / (v1 - v0)
        return f1 + (slope if faster else max(slope, Fraction(0))) * (speed - v1)


class Law(NamedTuple):
    taps: list[Fraction]
    points: list[tuple[Fraction, Fraction]]
    surface: str
    clamped: bool
    limit: Fraction | None
    relaxing: tuple[Fraction, Fraction] | None
    resets: bool
    step: Fraction | None = None
    rate: Fraction = Fraction(0)

    @property
    def memory(self) -> int:
        """Readings before the last one that the force depends on."""
        return max(len(self.taps) - 1, 1 if self.rate else 0)

    def force(self, readings: Sequence[Fraction], average: Fraction = Fraction(0)) -> Fraction:
        """The force for q_k, q_{k−1}, …, one more than the memory, and the average a_k."""
        q = readings[0]
        if self.surface != "none" and q <= 0:
            return Fraction(0)
        if self.points:
            f = self._spring(q)
            if self.rate:
                f *= 1 + self.rate * (q - readings[1])
        else:
            u = [max(v, Fraction(0)) for v in readings] if self.surface == "penetration" else readings
            f = sum((c * v for c, v in zip(self.taps, u, strict=True)), Fraction(0))
            if self.relaxing is not None:
                f += self.relaxing[1] * (u[0] - average)
        if self.clamped and f < 0:
            f = Fraction(0)
        if self.step is not None:
            f = (2 * f + self.step) // (2 * self.step) * self.step
        if self.limit is not None:
            f = max(-self.limit, min(self.limit, f))
        return f

    def stored(self, x: Fraction) -> Fraction:
        """Φ(x) less its lowest value between the ends, Φ' the force of points, within the limit."""
        spend(len(self.points), each=300)
        most, places = self.limit, {x, *(place for place, _ in self.points)}
        for (x0, f0), (x1, f1) in pairwise(self.points):
            levels = (y for y in (0, most or 0, -(most or 0)) if (f0 < y) != (f1 < y))
            places |= {x0 + (y - f0) / (f1 - f0) * (x1 - x0) for y in levels}
        forces = {p: self._spring(p) for p in places}
        if most is not None:
            forces = {p: max(-most, min(most, f)) for p, f in forces.items()}
        potential = lowest = here = Fraction(0)
        for (x0, f0), (x1, f1) in pairwise(sorted(forces.items())):
            potential += (f0 + f1) / 2 * (x1 - x0)
            spend(3, potential.denominator.bit_length(), each=4)
            lowest = min(lowest, potential)
            here = potential if x1 == x else here
        return here - lowest

    def averaged(self, average: Fraction, reading: Fraction) -> Fraction:
        """a_{k+1} from a_k and q_k."""
        if self.relaxing is None or (self.resets and reading <= 0):
            return Fraction(0)
        pole = self.relaxing[0]
        u = max(reading, Fraction(0)) if self.surface == "penetration" else reading
        return pole * average + (1 - pole) * u

    def _spring(self, q: Fraction) -> Fraction:
        above = bisect_right(self.points, q, key=lambda point: point[0])
        if above == 0:
            return self.points[0][1]
        if above == len(self.points):
            return self.points[-1][1]
        (x0, f0), (x1, f1) = self.points[above - 1], self.points[above]
        return f0 + (q - x0) / (x1 - x0) * (f1 - f0)


def losses_of(loop: Read) -> Losses:
    """What the device of a document takes out."""
    curve = _curve(loop.friction_curve or [])
    for name in ("damping", "coulomb_friction"):
        only_if(not curve, getattr(loop, name), name)
    only_if(curve, loop.friction_models, "friction_models")
    models = _models_below(loop.friction_models, curve) if curve else [(loop.coulomb_friction, loop.damping)]
    whole = -(-loop.delay // loop.sample_period)
    if whole > MOST_TAPS:
        raise Invalid("the delay is longer than can be checked")
    if curve and loop.delay % loop.sample_period:
        raise Invalid("a friction curve is checked with delays of whole samples")
    part = loop.delay / loop.sample_period - whole + 1
    return Losses(models, curve, loop.resolution, loop.sample_period, int(whole), part)


def _curve(told: Sequence[Sequence[Fraction]]) -> list[tuple[Fraction, Fraction]]:
    curve = increasing(told, "the speeds of a friction curve")
    if any(v < 0 or f < 0 for v, f in curve):
        raise Invalid("speeds and forces of a friction curve are ≥ 0")
    return curve


def _models_below(
    told: Sequence[Sequence[Fraction]], curve: list[tuple[Fraction, Fraction]]
) -> list[tuple[Fraction, Fraction]]:
    """f_c + b v below all points, and not steeper than the last chord: below the curve everywhere."""
    models = [(f, b) for f, b in told]
    (v0, f0), (v1, f1) = curve[-2:]
    steepest = max((f1 - f0) / (v1 - v0), Fraction(0))
    for friction, b in models:
        if min(friction, b) < 0:
            raise Invalid("friction and damping of a model are ≥ 0")
        if b > steepest or any(friction + b * v > force for v, force in curve):
            raise Invalid("a friction model is not below the friction curve")
    return models


def law_of(told: Read) -> Law:
    """The law of a document."""
    points = increasing(told.points or [], "the positions of the points")
    if bool(told.taps) == bool(points):
        raise Invalid("a law has either taps or points")
    if told.rate_per and not points:
        raise Invalid("only a law given by points has rate_per")
    relaxing = told.relaxing and (told.relaxing.pole, told.relaxing.stiffness)
    if relaxing and (len(told.taps) != 1 or told.force_step is not None):
        raise Invalid("a law that relaxes has one tap, and no force_step")
    if told.resets is not None and not relaxing:
        raise Invalid("only a law that relaxes has resets")
    return Law(
        told.taps,
        points,
        told.surface,
        told.clamped,
        told.force_limit,
        relaxing,
        bool(told.resets),
        told.force_step,
        told.rate_per or Fraction(0),
    )


MOST_WORDS = 10_000
MOST_PARAMETERS = 100_000
TOLD_LAW = Record(
    {
        "description": Words(MOST_WORDS),
        "specification": Words(MOST_PARAMETERS, default="", shown=False),
        "counts_force_limit": Flag(shown=False),
        "counts_force_resolution": Flag(shown=False),
    }
)
"""What is said of laws in a chain, and their parameters for who has the law: the proof is of the table, or of
the forces, and not of these words."""
