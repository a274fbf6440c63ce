"""Motions run again, sample by sample: positions and readings in fractions, forces in fractions or balls.

A motion with rounds is run with fewer of them, four times, and what more rounds take out is extrapolated:
once the law has settled the energy is a quadratic in their number.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable, Iterator, Sequence
from fractions import Fraction
from itertools import pairwise
from typing import Any

import numpy as np
from flint import arb, ctx, fmpq
from scipy.signal import lfilter

from ..opinion import Opinion, agrees, cannot_say, false
from ..plain import entry, exact, exacts, law_of, poles_of, quantity

Document = dict[str, Any]
Rng = np.random.Generator
Part = tuple[int, int, int]

LONGEST = 6000
"""Samples that are run."""

MOST = 2_000_000
"""Samples that are run in long doubles."""

DIGITS = 120
SLACK = Fraction(1, 10**9)


def _ball(value: Fraction) -> arb:
    return arb(fmpq(value.numerator, value.denominator))


def unrolled(x: Sequence[Fraction], parts: Sequence[Part]) -> tuple[list[Fraction], list[int]]:
    """The whole motion, and of each interval the place in the list from which it comes."""
    motion, places, ahead, after = [x[0]], list[int](), Fraction(0), 0
    for first, last, times in [*parts, (len(x) - 1, len(x) - 1, 1)]:
        motion += [v + ahead for v in x[after + 1 : first + 1]]
        places += range(after, first)
        advance = x[last] - x[first]
        for n in range(times):
            motion += [v + ahead + n * advance for v in x[first + 1 : last + 1]]
            places += range(first, last)
        ahead += (times - 1) * advance
        after = last
    return motion, places


class Law:
    """A linear law as it is programmed: its own memory, nothing before the first reading."""

    def __init__(self, above: list[Fraction], below: list[Fraction]) -> None:
        recursive = any(below[1:])
        self.above, self.below = ([_ball(c) for c in side] if recursive else side for side in (above, below))
        self.recursive = recursive
        self.given: list[Any] = []
        self.out: list[Any] = []

    def force(self, reading: Fraction) -> Any:
        """Of the newest reading."""
        self.given.append(_ball(reading) if self.recursive else reading)
        f = sum(
            (c * self.given[-1 - i] for i, c in enumerate(self.above) if i < len(self.given)),
            0 * self.given[-1],
        )
        if self.recursive:
            f -= sum((c * self.out[-i] for i, c in enumerate(self.below) if 0 < i <= len(self.out)), arb(0))
        self.out.append(f)
        return f


def taken_out(
    loop: Document, x: Sequence[Fraction], y: Sequence[Fraction] | None, forces: Iterator[Any]
) -> Any:
    """−Σ f Δx − f_c Σ|Δx| − b Σ Δx²/t, the forces late by the delay, none before the first of them."""
    b, fc, period, delay = (
        quantity(loop, n) for n in ("damping", "coulomb_friction", "sample_period", "delay")
    )
    whole, part = int(delay // period), delay / period % 1
    line: list[Any] = [Fraction(0)] * (whole + 2)
    total = None
    for k in range(len(x) - 1):
        line = [next(forces), *line[:-1]]
        here = y[k] if part and y is not None else x[k]
        legs = [(line[whole], x[k + 1] - here, 1 - part)]
        if part:
            legs.append((line[whole + 1], here - x[k], part))
        for f, d, share in legs:
            lost = fc * abs(d) + b / (share * period) * d * d
            ball = isinstance(f, arb)
            step = f * (_ball(d) if ball else d) + (_ball(lost) if ball else lost)
            total = -step if total is None else _plus(total, -step)
    return total


def _plus(a: Any, b: Any) -> Any:
    if isinstance(a, arb) != isinstance(b, arb):
        a, b = (v if isinstance(v, arb) else _ball(Fraction(v)) for v in (a, b))
    return a + b


class _Left(Exception):
    """The motion leaves a wall whose law has a memory."""


def _readings(loop: Document, x: Sequence[Fraction]) -> Iterator[Fraction]:
    step = quantity(loop, "resolution")
    for v in x:
        yield step * (v // step) if step else v


def kept_forces(loop: Document, x: Sequence[Fraction]) -> Iterator[Any]:
    """The forces of a law in sustained contact, or without a surface."""
    law, one_sided = Law(*law_of(loop)), loop["unilateral"]
    remembers = len(law.above) > 1
    for q in _readings(loop, x):
        if one_sided and q <= 0:
            if remembers and any(v != 0 for v in law.given):
                raise _Left
            q = Fraction(0)
        yield law.force(q)


def touched_forces(loop: Document, fed: str, never_pulls: bool, x: Sequence[Fraction]) -> Iterator[Any]:
    """The forces of a law that is touched and left; it has rested at its first reading for ever."""
    above, below = law_of(loop)
    law, first = Law(above, below), None
    static = sum(above) / sum(below)
    for q in _readings(loop, x):
        u = max(q, Fraction(0)) if fed == "penetration" else q
        first = u if first is None else first
        f = law.force(u - first)
        f = _plus(f, static * first)
        pulls = never_pulls and (f < 0 if not isinstance(f, arb) else f.mid() < 0)
        yield 0 * f if q <= 0 or pulls else f


def parts_of(document: Document, size: int) -> list[Part] | None:
    """Repeated parts of a motion, in order and apart; None where they are not."""
    listed = document.get("repeats", [])
    listed = listed if isinstance(listed, list) else [listed]
    parts = [tuple(int(exact(e[k])) for k in ("first", "last", "times")) for e in listed]
    before = 0
    for first, last, times in parts:
        if not before <= first < last < size or times < 1:
            return None
        before = last
    return parts  # type: ignore[return-value]


def _fewer(parts: list[Part], times: int) -> list[Part]:
    return [(first, last, min(times, own)) for first, last, own in parts]


def energy(
    loop: Document, x: list[Fraction], y: list[Fraction] | None, parts: list[Part], run: Callable[..., Any]
) -> Any:
    """What the whole motion takes out, or None where it is too long; Arb's balls or a fraction."""
    size = sum((last - first) * (times - 1) for first, last, times in parts) + len(x)
    if size <= LONGEST:
        return _run(loop, x, y, parts, run)
    if len(parts) != 1:
        return _in_long_doubles(loop, x, y, parts, size)
    first, last, times = parts[0]
    most = (LONGEST - len(x)) // (last - first)
    counts = [most - 3 * k for k in range(4)]
    if counts[-1] < 4:
        return _in_long_doubles(loop, x, y, parts, size)
    found = [_run(loop, x, y, _fewer(parts, n), run) for n in counts]
    e0, e1, e2, e3 = (_ball(Fraction(v)) if not isinstance(v, arb) else v for v in found)
    second, other = e0 - 2 * e1 + e2, e1 - 2 * e2 + e3
    if not (abs(second - other) <= abs(e0 - e1) * _ball(Fraction(1, 10**40))):
        return _in_long_doubles(loop, x, y, parts, size)  # the law has not settled
    n = _ball(Fraction(times - counts[0], 3))
    return e0 + n * (e0 - e1) + n * (n + 1) / 2 * second


def _in_long_doubles(loop: Document, x: list[Fraction], y: Any, parts: list[Part], size: int) -> arb | None:
    """Of an ideal encoder and whole samples of delay, as a ball of what rounding may have done."""
    if y is not None or quantity(loop, "resolution") or size > MOST:
        return None
    long, positions = np.longdouble, np.array([float(v) for v in x], dtype=np.longdouble)
    motion, ahead, after = [positions[:1]], long(0), 0
    for first, last, times in [*parts, (len(x) - 1, len(x) - 1, 1)]:
        motion.append(positions[after + 1 : first + 1] + ahead)
        advance, one = positions[last] - positions[first], positions[first + 1 : last + 1]
        motion.append((one[None, :] + advance * np.arange(times, dtype=long)[:, None] + ahead).ravel())
        ahead, after = ahead + (times - 1) * advance, last
    path = np.concatenate(motion)
    if loop["unilateral"] and len(law_of(loop)[0]) > 1 and path[1:-1].min() <= 0:
        return None
    above, below = (np.array([float(c) for c in side], dtype=long) for side in law_of(loop))
    force = lfilter(above, below, np.maximum(path, 0) if loop["unilateral"] else path)
    whole = int(quantity(loop, "delay") / quantity(loop, "sample_period"))
    held = np.concatenate([np.zeros(whole, dtype=long), force])[: len(path) - 1]
    moves = np.diff(path)
    b, fc, period = (long(float(quantity(loop, n))) for n in ("damping", "coulomb_friction", "sample_period"))
    terms = -held * moves - fc * np.abs(moves) - b / period * moves**2
    if not np.isfinite(terms).all():
        return None
    total, off = float(terms.sum()), float(np.abs(held * moves).sum() + np.abs(terms).sum()) * 1e-14
    return arb(total, off)


def _run(loop: Document, x: list[Fraction], y: Any, parts: list[Part], run: Callable[..., Any]) -> Any:
    motion, places = unrolled(x, parts)
    if y is not None:
        y = [motion[k] + y[at] - x[at] for k, at in enumerate(places)]
    return taken_out(loop, motion, y, run(motion))


def compared(found: Any, told: Fraction, stored: Fraction = Fraction(0)) -> Opinion:
    """The energy against what is told and what was in."""
    if found is None:
        return cannot_say("the motion is too long to be run again")
    value = found if isinstance(found, arb) else _ball(Fraction(found))
    off = abs(value - _ball(told))
    if value.rad() > abs(value) * _ball(SLACK):
        return cannot_say("rounding hides the energy")
    if off > abs(value) * _ball(SLACK * (1 + SLACK)):
        return false(f"the motion takes out {float(value.mid()):.12g} J, not {float(told):.12g} J")
    if value > _ball(stored):
        return agrees()
    if value <= _ball(stored):
        return false(f"the motion takes out {float(value.mid()):.6g} J of {float(stored):.6g} J stored")
    return cannot_say("rounding hides the energy")


def _told(document: Document) -> str:
    """The sample period beside the motion is that of the loop."""
    own = entry(document, "sample_period")
    return (
        "" if own is None or exact(own) == quantity(document["loop"], "sample_period") else "another period"
    )


def _motion(document: Document, rng: Rng) -> Opinion:
    loop = document["loop"]
    x = exacts(entry(document, "positions"))
    late = quantity(loop, "delay") / quantity(loop, "sample_period") % 1
    y = exacts(entry(document, "switch_positions")) if late else None
    parts = parts_of(document, len(x))
    first = next(_readings(loop, x))
    if parts is None or _told(document) or (x[0] > 0 if loop["unilateral"] else first != 0):
        return false("parts that do not follow one another, another period, or a start that is loaded")
    above, below = law_of(loop)
    spring = not any(above[1:]) and not any(below[1:])
    static = sum(above) / sum(below) if sum(below) else Fraction(0)
    stored = (
        Fraction(0)
        if spring and loop["unilateral"]
        else max(static, Fraction(0)) * quantity(loop, "resolution") ** 2 / 8
    )
    with ctx.workdps(DIGITS):
        try:
            found = energy(loop, x, y, parts, lambda motion: kept_forces(loop, motion))
        except _Left:
            return false("the motion leaves the wall, where a law with memory is not defined")
        return compared(found, exact(document["energy_J"]), stored)


def _touching(document: Document, rng: Rng) -> Opinion:
    loop, law = document["loop"], document["law"]
    x = exacts(entry(document, "positions"))
    late = quantity(loop, "delay") / quantity(loop, "sample_period") % 1
    y = exacts(entry(document, "switch_positions")) if late else None
    if next(_readings(loop, x)) > 0 or x[0] != x[-1] or not loop["unilateral"]:
        return false("the motion does not begin at rest outside, or does not return")
    if any(abs(pole) >= 1 for pole, _ in poles_of(law_of(loop)[1])):
        return false("H(z) is unstable: it does not forget")
    if len(x) > LONGEST:
        return cannot_say("the motion is too long to be run again")
    with ctx.workdps(DIGITS):
        found = taken_out(loop, x, y, touched_forces(loop, law["fed_with"], law["never_pulls"], x))
        return compared(found, exact(document["energy_J"]))


def board_force(law: Document, readings: Sequence[Fraction], average: Fraction) -> Fraction:
    """The force of a law of readings, q_k first, as docs/json.md says."""
    q = readings[0]
    if law["surface"] != "none" and q <= 0:
        return Fraction(0)
    points = entry(law, "points", [])
    if points:
        f = _between([(exact(a), exact(b)) for a, b in points], q)
        rate = exact(entry(law, "rate_per", 0) or entry(law, "rate", 0))
        f *= 1 + rate * (q - readings[1]) if rate else 1
    else:
        u = [max(r, Fraction(0)) for r in readings] if law["surface"] == "penetration" else list(readings)
        f = sum((exact(c) * v for c, v in zip(entry(law, "taps"), u, strict=False)), Fraction(0))
        if law.get("relaxing"):
            f += quantity(law["relaxing"], "stiffness") * (u[0] - average)
    f = max(f, Fraction(0)) if law["clamped"] else f
    step, limit = entry(law, "force_step"), entry(law, "force_limit")
    if step is not None:
        f = (f / exact(step) + Fraction(1, 2)) // 1 * exact(step)
    return f if limit is None else max(-exact(limit), min(exact(limit), f))


def _between(points: list[tuple[Fraction, Fraction]], q: Fraction) -> Fraction:
    at = bisect_right([x for x, _ in points], q)
    if at in (0, len(points)):
        return points[min(at, len(points) - 1)][1]
    (x0, f0), (x1, f1) = points[at - 1 : at + 1]
    return f0 + (f1 - f0) * (q - x0) / (x1 - x0)


def memory_of(law: Document) -> int:
    """Readings before the last on which the force depends."""
    rate = "rate_per_m" in law or "rate_per_rad" in law
    return max(len(entry(law, "taps", [])) - 1, 1 if rate else 0)


def curve_loss(loop: Document, d: Fraction, share: Fraction) -> Fraction | None:
    """What friction takes at least over a way at even speed or in slow steps, None without a curve."""
    pairs = entry(loop, "friction_curve", [])
    if not pairs:
        return None
    curve = [(exact(v), exact(f)) for v, f in pairs]
    speed = abs(d) / (share * quantity(loop, "sample_period"))
    (v0, f0), (v1, f1) = curve[-2:]
    end = f1 + max((f1 - f0) / (v1 - v0), Fraction(0)) * (speed - v1)
    least, slow = min((f, v) for v, f in curve)
    if speed <= slow:
        return abs(d) * least
    return abs(d) * (end if speed > v1 else _between(curve, speed))


def _contact(document: Document, rng: Rng) -> Opinion:
    """In, round and round, and on: what all takes out, and what one round more does."""
    loop, law = document["loop"], document["law"]
    x = exacts(entry(document, "positions"))
    delay = quantity(loop, "delay") / quantity(loop, "sample_period")
    late, part = -(-delay // 1), delay - (-(-delay // 1)) + 1
    y = exacts(document.get("switch_positions_m") or document.get("switch_positions_rad") or []) or x[1:]
    first, last, times = (int(exact(document["repeats"][k])) for k in ("first", "last", "times"))
    if not 0 <= first < last < len(x) or x[first] != x[last] or _told(document):
        return false("the round does not return, or the period is another")
    wrong = _out_of_bounds(document, x, y if part < 1 else None, part)
    if wrong:
        return false(wrong)
    rounds = min(times, max(4, 1500 // (last - first)))
    if (rounds + 2) * (last - first) > LONGEST:
        return cannot_say("the rounds are too long")
    motion, places = unrolled(x, [(first, last, rounds)])
    taken = board_run(
        loop, law, motion, [y[k] + motion[i] - x[k] for i, k in enumerate(places)], int(late), part
    )
    if taken is None:
        return false("it does not begin where the law gives no force")
    span = last - first
    begin, end = first + (rounds - 1) * span, first + rounds * span
    gain, before = sum(taken[begin:end]), sum(taken[begin - span : begin])
    if abs(gain - before) > abs(gain) * Fraction(1, 10**12) and not law.get("relaxing"):
        return cannot_say("the law has not settled")
    total = sum(taken) + (times - rounds) * gain
    if gain <= 0:
        return false(f"a round more takes out {float(gain):.6g} J")
    return compared(total, exact(document["energy_J"]))


def _out_of_bounds(document: Document, x: list[Fraction], y: list[Fraction] | None, part: Fraction) -> str:
    bounds, period = document.get("bounds", {}), quantity(document["loop"], "sample_period")
    places = [*x, *(y or [])]
    for key, value in bounds.items():
        most, name = exact(value), key.partition("_")[0]
        ways = [(a, b, period) for a, b in pairwise(x)]
        if y is not None:
            ways = [(a, m, part * period) for a, m in zip(x, y, strict=False)]
            ways += [(m, b, (1 - part) * period) for m, b in zip(y, x[1:], strict=True)]
        if name == "speed" and any(abs(b - a) > most * t for a, b, t in ways):
            return "the motion is faster than it says"
        if (name == "depth" and max(places) > most) or (name == "outside" and -min(places) > most):
            return f"the motion does not keep to its {name}"
    return ""


def board_run(
    loop: Document, law: Document, x: list[Fraction], y: list[Fraction], late: int, part: Fraction
) -> list[Fraction] | None:
    """What each interval takes out, averages kept to 2⁻⁹⁰ of a count."""
    step, memory = quantity(loop, "resolution"), memory_of(law)
    start = step * (x[0] // step)
    relax = law.get("relaxing")
    pole = exact(relax["pole"]) if relax else Fraction(0)
    given = start if law["surface"] != "penetration" else max(start, Fraction(0))
    readings, averages = [start] * (memory + late + 2), [given] * (late + 1)
    if start > 0 or board_force(law, readings[: memory + 1], averages[0]):
        return None
    fine, out = step / 2**90, list[Fraction]()
    for k in range(len(x) - 1):
        readings = [step * (x[k] // step), *readings[:-1]]
        forces = [
            board_force(law, readings[a : a + memory + 1], averages[a]) for a in (late, max(late - 1, 0))
        ]
        legs = [(forces[0], y[k] - x[k], part), (forces[1], x[k + 1] - y[k], 1 - part)]
        out.append(-sum(f * d + _lost(loop, d, share) for f, d, share in legs if share))
        u = max(readings[0], Fraction(0)) if law["surface"] == "penetration" else readings[0]
        after = Fraction(0) if law.get("resets") and readings[0] <= 0 else pole * averages[0] + (1 - pole) * u
        averages = [round(after / fine) * fine, *averages[:-1]]
    return out


def _lost(loop: Document, d: Fraction, share: Fraction) -> Fraction:
    curved = curve_loss(loop, d, share)
    if curved is not None:
        return curved
    b, fc, period = (quantity(loop, n) for n in ("damping", "coulomb_friction", "sample_period"))
    return fc * abs(d) + b / (share * period) * d * d


def _row(document: Document, rng: Rng) -> Opinion:
    x, f = exacts(entry(document, "positions")), exacts(entry(document, "forces"))
    first, last, times = (int(exact(document["repeats"][k])) for k in ("first", "last", "times"))
    if not 0 <= first < last < len(x) or x[first] != x[last] or len(f) != len(x) - 1 or _told(document):
        return false("the round does not return, or a force is missing")
    wrong = _out_of_bounds(document, x, None, Fraction(1))
    if wrong:
        return false(wrong)
    taken = [
        -g * (b - a) - _lost(document["loop"], b - a, Fraction(1))
        for g, a, b in zip(f, x, x[1:], strict=False)
    ]
    gain = sum(taken[first:last], Fraction(0))
    if gain <= 0:
        return false(f"a round more takes out {float(gain):.6g} J")
    return compared(sum(taken, Fraction(0)) + (times - 1) * gain, exact(document["energy_J"]))


JUDGES: dict[str, Callable[[Document, Rng], Opinion]] = {
    "motion": _motion,
    "touching motion": _touching,
    "contact motion": _contact,
    "row motion": _row,
}
