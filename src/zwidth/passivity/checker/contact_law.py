"""A law with contact made and broken, read from a document: readings of an encoder to a force.

u = q, or max(q, 0) if fed with the penetration
f = Σ c_j u_{k−j}  or  a spring through given points
f = max(0, f) if clamped;  f = 0 where q_k ≤ 0 if there is a surface
f = the nearest whole step of a converter, the upper of two;  then |f| ≤ the force limit
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import Any, NamedTuple

from .reading import Invalid, get, number, numbers

MOST_TAPS = 50
MOST_POINTS = 10_000


class Losses(NamedTuple):
    """`part` of an interval has the force of the reading `delay` samples ago, the rest that of the next."""

    damping: Fraction
    friction: Fraction
    resolution: Fraction
    period: Fraction
    delay: int
    part: Fraction

    def lost(self, move: Fraction, part: Fraction) -> Fraction:
        """The least that the device takes out over a move in a part of an interval."""
        return self.friction * abs(move) + self.damping / (part * self.period) * move * move


class Law(NamedTuple):
    taps: list[Fraction]
    points: list[tuple[Fraction, Fraction]]
    surface: str
    clamped: bool
    limit: Fraction | None
    relaxing: tuple[Fraction, Fraction] | None
    resets: bool
    step: Fraction | None = None

    def force(self, readings: Sequence[Fraction], average: Fraction = Fraction(0)) -> Fraction:
        """The force for q_k, q_{k−1}, …, as many as there are taps, and the average a_k."""
        q = readings[0]
        if self.surface != "none" and q <= 0:
            return Fraction(0)
        if self.points:
            f = self._spring(q)
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
        before = [p for p in self.points if p[0] <= q]
        after = [p for p in self.points if p[0] > q]
        if not before:
            return self.points[0][1]
        if not after:
            return self.points[-1][1]
        (x0, f0), (x1, f1) = before[-1], after[0]
        return f0 + (q - x0) / (x1 - x0) * (f1 - f0)


def read_losses(document: Mapping[str, Any]) -> Losses:
    loop = get(document, "loop")

    def quantity(name: str) -> Fraction:
        return number(_one(loop, name))

    b, friction, resolution = (quantity(n) for n in ("damping", "coulomb_friction", "resolution"))
    period, delay = quantity("sample_period"), quantity("delay")
    if period <= 0 or resolution <= 0 or min(b, friction, delay) < 0:
        raise Invalid("T and Δ must be > 0, and b, f_c and the delay ≥ 0")
    whole = -(-delay // period)
    if whole > MOST_TAPS:
        raise Invalid("the delay is longer than can be checked")
    return Losses(b, friction, resolution, period, int(whole), delay / period - whole + 1)


def read_law(document: Mapping[str, Any]) -> Law:
    law = get(document, "law")
    known = {"surface", "clamped", "relaxing", "resets"}
    surface, clamped = get(law, "surface"), get(law, "clamped")
    if surface not in ("none", "position", "penetration") or not isinstance(clamped, bool):
        raise Invalid("surface must be none, position or penetration, and clamped true or false")
    for key in law:
        if key not in known and not key.startswith(("taps_", "points_", "force_limit_", "force_step_")):
            raise Invalid(f"the law has a key that is not understood: {str(key)[:40]}")
    taps = numbers(_one(law, "taps"), MOST_TAPS)
    pairs = _one(law, "points", [])
    if not isinstance(pairs, list) or len(pairs) > MOST_POINTS:
        raise Invalid("points must be a short list")
    points = [(number(x), number(f)) for x, f in pairs]
    if any(a[0] >= b[0] for a, b in zip(points, points[1:], strict=False)):
        raise Invalid("the positions of the points must increase")
    if bool(taps) == bool(points):
        raise Invalid("a law has either taps or points")
    limit = _one(law, "force_limit", None)
    limit = None if limit is None else number(limit)
    if limit is not None and limit < 0:
        raise Invalid("the force limit must be ≥ 0")
    step = _one(law, "force_step", None)
    step = None if step is None else number(step)
    if step is not None and (step <= 0 or law.get("relaxing") is not None):
        raise Invalid("the converter's step must be > 0, and the law none that relaxes")
    resets = law.get("resets", False)
    if not isinstance(resets, bool):
        raise Invalid("resets must be true or false")
    return Law(taps, points, surface, clamped, limit, _relaxing(law, taps), resets, step)


def _relaxing(law: Mapping[str, Any], taps: list[Fraction]) -> tuple[Fraction, Fraction] | None:
    part = law.get("relaxing")
    if part is None:
        return None
    pole, stiffness = number(get(part, "pole")), number(_one(part, "stiffness"))
    if not 0 <= pole < 1 or len(taps) != 1 or "points" in " ".join(law):
        raise Invalid("a relaxing part has a pole from 0 to 1 and stands beside one spring")
    return pole, stiffness


_REQUIRED = object()


def _one(table: Any, name: str, default: Any = _REQUIRED) -> Any:
    if not isinstance(table, Mapping):
        raise Invalid("expected an object")
    keys = [k for k in table if isinstance(k, str) and (k == name or k.startswith(name + "_"))]
    if len(keys) > 1 or (not keys and default is _REQUIRED):
        raise Invalid(f"{name} must be given once")
    return table[keys[0]] if keys else default
