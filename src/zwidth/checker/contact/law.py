"""A law with contact made and broken, read from a document: readings of an encoder to a force.

u = q, or max(q, 0) if fed with the penetration
f = Σ c_j u_{k−j}  or  a spring through given points, times 1 + ρ (q_k − q_{k−1}) for a contact
f = max(0, f) if clamped;  f = 0 where q_k ≤ 0 if there is a surface
f = the nearest whole step of a converter, the upper of two;  then |f| ≤ the force limit
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import Any, NamedTuple

from ..document.reading import Invalid, get, number, numbers, quantity, the_one, with_no_more_than

MOST_TAPS = 50
MOST_POINTS = 10_000


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


def read_losses(document: Mapping[str, Any]) -> Losses:
    loop = get(document, "loop")
    resolution, period, delay = (quantity(loop, n) for n in ("resolution", "sample_period", "delay"))
    curve = _curve(loop)
    models = _models_below(loop, curve) if curve else [_friction(loop)]
    with_no_more_than(loop, 5)
    if period <= 0 or resolution <= 0 or delay < 0 or min(min(m) for m in models) < 0:
        raise Invalid("T and Δ must be > 0, and b, f_c and the delay ≥ 0")
    whole = -(-delay // period)
    if whole > MOST_TAPS:
        raise Invalid("the delay is longer than can be checked")
    if curve and delay % period:
        raise Invalid("a friction curve is checked with delays of whole samples")
    return Losses(models, curve, resolution, period, int(whole), delay / period - whole + 1)


def _friction(loop: Any) -> tuple[Fraction, Fraction]:
    return quantity(loop, "coulomb_friction"), quantity(loop, "damping")


def _curve(loop: Any) -> list[tuple[Fraction, Fraction]]:
    pairs = the_one(loop, "friction_curve", [])
    if not isinstance(pairs, list) or len(pairs) > MOST_POINTS:
        raise Invalid("the friction curve must be a short list")
    curve = [(number(v), number(f)) for v, f in pairs]
    if len(curve) == 1 or any(a[0] >= b[0] for a, b in zip(curve, curve[1:], strict=False)):
        raise Invalid("a friction curve has two points or more, of increasing speed")
    if any(v < 0 or f < 0 for v, f in curve):
        raise Invalid("speeds and forces of a friction curve are ≥ 0")
    return curve


def _models_below(loop: Any, curve: list[tuple[Fraction, Fraction]]) -> list[tuple[Fraction, Fraction]]:
    """f_c + b v below all points, and not steeper than the last chord: below the curve everywhere."""
    pairs = the_one(loop, "friction_models")
    if not isinstance(pairs, list) or not 0 < len(pairs) <= len(curve) + 1:
        raise Invalid("friction_models must be a short list")
    models = [(number(f), number(b)) for f, b in pairs]
    (v0, f0), (v1, f1) = curve[-2:]
    steepest = max((f1 - f0) / (v1 - v0), Fraction(0))
    for friction, b in models:
        if b > steepest or any(friction + b * v > force for v, force in curve):
            raise Invalid("a friction model is not below the friction curve")
    return models


def read_law(document: Mapping[str, Any]) -> Law:
    law = get(document, "law")
    known = {"surface", "clamped", "relaxing", "resets"}
    surface, clamped = get(law, "surface"), get(law, "clamped")
    if surface not in ("none", "position", "penetration") or not isinstance(clamped, bool):
        raise Invalid("surface must be none, position or penetration, and clamped true or false")
    for key in law:
        if key not in known and not key.startswith(
            ("taps_", "points_", "force_limit_", "force_step_", "rate_per_")
        ):
            raise Invalid(f"the law has a key that is not understood: {str(key)[:40]}")
    taps = numbers(the_one(law, "taps"), MOST_TAPS)
    pairs = the_one(law, "points", [])
    if not isinstance(pairs, list) or len(pairs) > MOST_POINTS:
        raise Invalid("points must be a short list")
    points = [(number(x), number(f)) for x, f in pairs]
    if any(a[0] >= b[0] for a, b in zip(points, points[1:], strict=False)):
        raise Invalid("the positions of the points must increase")
    if bool(taps) == bool(points):
        raise Invalid("a law has either taps or points")
    limit = the_one(law, "force_limit", None)
    limit = None if limit is None else number(limit)
    if limit is not None and limit < 0:
        raise Invalid("the force limit must be ≥ 0")
    step = the_one(law, "force_step", None)
    step = None if step is None else number(step)
    if step is not None and (step <= 0 or law.get("relaxing") is not None):
        raise Invalid("the converter's step must be > 0, and the law none that relaxes")
    rate = number(the_one(law, "rate_per", "0"))
    if rate and not points:
        raise Invalid("only the force of points may grow with the way since the last reading")
    resets = law.get("resets", False)
    if not isinstance(resets, bool):
        raise Invalid("resets must be true or false")
    return Law(taps, points, surface, clamped, limit, _relaxing(law, taps), resets, step, rate)


def _relaxing(law: Mapping[str, Any], taps: list[Fraction]) -> tuple[Fraction, Fraction] | None:
    part = law.get("relaxing")
    if part is None:
        return None
    pole, stiffness = number(get(part, "pole")), number(the_one(part, "stiffness"))
    if not 0 <= pole < 1 or len(taps) != 1 or "points" in " ".join(law):
        raise Invalid("a relaxing part has a pole from 0 to 1 and stands beside one spring")
    return pole, stiffness
