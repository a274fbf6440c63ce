"""What the checker counts, counted a second time: motions sample by sample, in fractions.

Each case draws some at random, and compares what the checker finds.
"""

from __future__ import annotations

import cmath
from collections.abc import Callable, Sequence
from fractions import Fraction
from importlib import import_module
from itertools import pairwise
from math import cos
from random import Random
from types import SimpleNamespace
from typing import Any

from . import Case, plain
from .entries import refusal

ROUNDS = 25


def found(name: str, kind: str, document: Any) -> Any:
    """What the checker finds: the energy, or with rounds the energy and that of one more."""
    motion = import_module(f"zwidth.checker.{name}")
    file = import_module("zwidth.checker.document.file")
    read, _ = file.read_document(getattr(motion, kind.upper()), plain(document))
    return getattr(motion, f"{kind}_energy")(read)


def some(random: Random, low: int, high: int, *parts: int) -> Fraction:
    """A number of few digits between two."""
    part = random.choice(parts or (1, 2, 3))
    return Fraction(random.randrange(low * part, high * part + 1), part)


def walk(random: Random, size: int, start: Fraction) -> list[Fraction]:
    """Positions on both sides of 0."""
    return [start, *(some(random, -1, 3) for _ in range(size))]


def read(position: Fraction, step: Fraction) -> Fraction:
    """Of an encoder with steps; 0: of none."""
    return step * (position // step) if step else position


def moved(
    x: Sequence[Fraction],
    switches: Sequence[Fraction],
    forces: Callable[[int], Fraction],
    late: int,
    part: Fraction,
    lost: Callable[[Fraction, Fraction], Fraction],
) -> list[Fraction]:
    """What each interval gives: until a part of it under the force of one sample more ago than after it."""
    gains = []
    for k, (here, there) in enumerate(pairwise(x)):
        at = switches[k] if part else here
        gain = -forces(k - late) * (there - at) - lost(there - at, 1 - part)
        if part:
            gain -= forces(k - late - 1) * (at - here) + lost(at - here, part)
        gains.append(gain)
    return gains


def _linear_loss(loop: Any) -> Callable[[Fraction, Fraction], Fraction]:
    damping, friction, period = (
        Fraction(loop[key]) for key in ("damping_N_s_per_m", "coulomb_friction_N", "sample_period_s")
    )
    return lambda move, part: friction * abs(move) + damping * move**2 / (part * period)


def _device(random: Random) -> dict[str, Any]:
    period = some(random, 1, 3)
    return {
        "damping_N_s_per_m": some(random, 0, 2),
        "coulomb_friction_N": some(random, 0, 1),
        "resolution_m": random.choice([0, 1, Fraction(1, 2), Fraction(2, 3)]),
        "sample_period_s": period,
        "delay_s": period * random.choice([0, 0, 1, 2, Fraction(1, 4), Fraction(4, 3)]),
    }


def touching_motions() -> str:
    """A law of up to three poles, fed with either, that pulls or does not."""
    random = Random(1)
    for _ in range(2 * ROUNDS):
        poles = [Fraction(random.randrange(-3, 4), 4) for _ in range(random.randrange(4))]
        bottom = [Fraction(random.choice([1, 2, -3]))]
        for pole in poles:
            bottom = [a - pole * b for a, b in zip([*bottom, 0], [0, *bottom], strict=True)]
        top = [some(random, -3, 3) for _ in range(random.choice([1, len(bottom), len(bottom)]))]
        device = _device(random)
        start = -abs(some(random, 0, 2))
        x = [*walk(random, random.randrange(1, 13), start), start]
        switches = [some(random, -2, 3) for _ in x[1:]]
        fed, never_pulls = random.choice(["penetration", "position"]), random.random() < 0.5
        part = Fraction(device["delay_s"]) / device["sample_period_s"] % 1
        document = {
            "loop": {"numerator": top, "denominator": bottom, "unilateral": True, **device},
            "law": {"fed_with": fed, "never_pulls": never_pulls},
            "sample_period_s": device["sample_period_s"],
            "positions_m": x,
            "energy_J": 0,
            **({"switch_positions_m": switches} if part else {}),
        }
        q = [read(place, Fraction(device["resolution_m"])) for place in x]
        forces = _filtered([Fraction(0)] * (len(bottom) - len(top)) + top, bottom, q, fed)
        held = [
            f if reading > 0 and (f > 0 or not never_pulls) else Fraction(0)
            for f, reading in zip(forces, q, strict=True)
        ]
        late = int(Fraction(device["delay_s"]) // device["sample_period_s"])
        gains = moved(x, switches, _of(held), late, part, _linear_loss(device))
        if found("contact.touching_motion", "touching_motion", document) != sum(gains):
            return f"{sum(gains)} of {document}"
    return ""


def _of(held: Sequence[Fraction]) -> Callable[[int], Fraction]:
    """The force of a sample; before the first there is none."""
    return lambda k: held[k] if k >= 0 else Fraction(0)


def _filtered(
    top: Sequence[Fraction], bottom: Sequence[Fraction], q: Sequence[Fraction], fed: str
) -> list[Fraction]:
    """H(z) on what it is fed with; it has rested at the first reading for ever."""
    u = [max(v, Fraction(0)) if fed == "penetration" else v for v in q]
    rest = u[0] * sum(top) / sum(bottom)
    out: list[Fraction] = []
    for k in range(len(u)):
        f = sum((c * (u[k - i] if k >= i else u[0]) for i, c in enumerate(top)), Fraction(0))
        f -= sum((c * (out[k - i] if k >= i else rest) for i, c in enumerate(bottom) if i), Fraction(0))
        out.append(f / bottom[0])
    return out


def _law(random: Random) -> dict[str, Any]:
    """Taps, a tap that relaxes, or a curve through points; clamped, in steps or limited now and then."""
    told: dict[str, Any] = {
        "clamped": random.random() < 0.3,
        "taps_N_per_m": [],
    }
    sort = random.randrange(4)
    told["surface"] = random.choice(["position", "penetration", *(["none"] if sort != 1 else [])])
    if sort == 0:
        told["taps_N_per_m"] = [some(random, -3, 3) for _ in range(random.randrange(1, 4))]
    elif sort == 1:
        places = sorted(random.sample(range(-2, 7), random.randrange(1, 5)))
        told["points_m_N"] = [[Fraction(place, 2), some(random, -3, 3)] for place in places]
        if random.random() < 0.5:
            told["rate_per_m"] = some(random, -1, 1)
    else:
        told["taps_N_per_m"] = [some(random, -3, 3)]
        told["relaxing"] = {
            "pole": Fraction(random.randrange(3), 4),
            "stiffness_N_per_m": some(random, -3, 3),
        }
        if random.random() < 0.5:
            told["resets"] = random.random() < 0.5
    if sort < 2 and random.random() < 0.3:
        told["force_step_N"] = Fraction(2, 3)
    if random.random() < 0.3:
        told["force_limit_N"] = Fraction(5, 2)
    return told


def _forces(law: Any, q: Sequence[Fraction]) -> list[Fraction]:
    """Of all readings, after it has rested at the first for ever."""
    limit, step, relaxing = law.get("force_limit_N"), law.get("force_step_N"), law.get("relaxing")
    out = []
    average = max(q[0], Fraction(0)) if law["surface"] == "penetration" else q[0]
    u = [max(v, Fraction(0)) if law["surface"] == "penetration" else v for v in q]
    for k, reading in enumerate(q):
        f = sum((c * u[max(k - i, 0)] for i, c in enumerate(law["taps_N_per_m"])), Fraction(0))
        if law.get("points_m_N"):
            f = _between(law["points_m_N"], reading)
            f *= 1 + law.get("rate_per_m", 0) * (reading - q[max(k - 1, 0)])
        if relaxing:
            f += relaxing["stiffness_N_per_m"] * (u[k] - average)
            average += (1 - relaxing["pole"]) * (u[k] - average)
            if law.get("resets") and reading <= 0:
                average = Fraction(0)
        if law["clamped"]:
            f = max(f, Fraction(0))
        if step:
            f = step * ((f / step + Fraction(1, 2)) // 1)
        if limit is not None:
            f = min(max(f, -limit), limit)
        out.append(f if reading > 0 or law["surface"] == "none" else Fraction(0))
    return out


def _between(points: Sequence[Sequence[Fraction]], x: Fraction) -> Fraction:
    """On the chords through them; as at the nearest beyond them."""
    if x <= points[0][0]:
        return points[0][1]
    for (a, f), (b, g) in pairwise(points):
        if x <= b:
            return f + (g - f) * (x - a) / (b - a)
    return points[-1][1]


def contact_motions() -> str:
    """With rounds; of a law that relaxes a rest of its rounded averages is taken off."""
    random = Random(2)
    for _ in range(2 * ROUNDS):
        law, device = _law(random), {**_device(random), "resolution_m": random.choice([1, Fraction(2, 3)])}
        start = -abs(some(random, 0, 2)) if law["surface"] != "none" else Fraction(0)
        cycle = [start, *walk(random, random.randrange(1, 5), some(random, -2, 3))]
        ends = walk(random, random.randrange(1, 4), some(random, -2, 3))
        x, times = [*cycle, *[start] * 4, *ends], 30 if "relaxing" in law else 5
        late = Fraction(device["delay_s"]) / device["sample_period_s"]
        part = late % 1
        switches = [some(random, -2, 3) for _ in x[1:]]
        document = {
            "loop": device,
            "law": law,
            "sample_period_s": device["sample_period_s"],
            "positions_m": x,
            "energy_J": 0,
            "repeats": {"first": 0, "last": len(cycle) + 3, "times": times},
            **({"switch_positions_m": switches} if part else {}),
        }
        last = len(cycle) + 3
        far = [*x[:last] * times, *x[last:]]
        between = [*switches[:last] * times, *switches[last:]]
        q = [read(place, Fraction(device["resolution_m"])) for place in far]
        gains = moved(far, between, _of(_forces(law, q)), int(late // 1), part, _linear_loss(device))
        wanted = sum(gains), sum(gains[(times - 1) * last : times * last])
        energies = found("contact.motion", "contact_motion", document)
        room = Fraction(1, 10**12) if "relaxing" in law else 0
        if not all(0 <= right - energy <= room for energy, right in zip(energies, wanted, strict=True)):
            return f"{wanted}, not {energies}, of {document}"
    return ""


def motions_with_rounds() -> str:
    """From rest through a law without a surface, or a spring with one; every round may end farther on."""
    random = Random(6)
    for _ in range(4 * ROUNDS):
        unilateral, device = random.random() < 0.3, _device(random)
        step = Fraction(device["resolution_m"])
        bottom = [Fraction(random.choice([1, 1, 2]))]
        for _ in range(0 if unilateral else random.randrange(3)):
            pole = random.choice([0, 0, Fraction(1, 2), Fraction(1, 3), Fraction(-1, 2)])
            bottom = [a - pole * b for a, b in zip([*bottom, 0], [0, *bottom], strict=True)]
        top = [some(random, -3, 3) for _ in bottom]
        advance = random.choice([Fraction(0), step, 2 * step, some(random, -1, 1)])
        before = [Fraction(0), *(some(random, 0, 2) for _ in range(random.randrange(4)))]
        cycle = walk(random, random.randrange(1, 4), some(random, 0, 2))
        cycle = [*cycle, *[cycle[0] + advance] * random.choice([1, 6])]
        if random.random() < 0.2:  # nothing is read of the first round
            before, cycle = [Fraction(0)], [Fraction(0), Fraction(0), advance]
        after = [some(random, -1, 2) for _ in range(random.randrange(3))]
        listed, times = [*before, *cycle, *after], random.randrange(1, 9)
        switches = [some(random, -1, 2) for _ in listed[1:]]
        first, last = len(before), len(before) + len(cycle) - 1
        part = Fraction(device["delay_s"]) / device["sample_period_s"] % 1
        document = {
            "loop": {"numerator": top, "denominator": bottom, "unilateral": unilateral, **device},
            "positions_m": listed,
            "energy_J": 0,
            "repeats": [{"first": first, "last": last, "times": times}],
            **({"switch_positions_m": switches} if part else {}),
        }
        x, between = (
            [*told[:first], *(v + k * advance for k in range(times) for v in told[first:last])]
            for told in (listed, switches)
        )
        x += [v + (times - 1) * advance for v in listed[last:]]
        between += [v + (times - 1) * advance for v in switches[last:]]
        q = [max(read(v, step), Fraction(0)) if unilateral else read(v, step) for v in x]
        late = int(Fraction(device["delay_s"]) // device["sample_period_s"])
        forces = _of(_filtered(top, bottom, q, "position"))
        energy = sum(moved(x, between, forces, late, part, _linear_loss(device)))
        if found("loop.motion", "motion", document) != energy:
            return f"{energy} of {document}"
    return ""


def stores_at_the_start() -> str:
    """H(1) Δ²/8, and nothing for a spring with a surface, for what pushes away, or with a pole at 1."""
    stored = import_module("zwidth.checker.loop.motion").stored_at_start
    laws = {
        ((3,), (2,), False): Fraction(3, 16) / 4,
        ((3,), (2,), True): 0,
        ((3, 0), (2, 0), True): 0,
        ((3, 1), (2, 0), True): Fraction(2, 8) / 4,
        ((3, 0), (2, 1), True): Fraction(1, 8) / 4,
        ((3, 0, 0), (2, 1, 0), True): Fraction(1, 8) / 4,
        ((3, 0, 1), (2, 0, 0), True): Fraction(2, 8) / 4,
        ((-3,), (2,), False): 0,
        ((3, 0), (2, -2), False): 0,
    }
    for (top, bottom, unilateral), wanted in laws.items():
        loop = SimpleNamespace(
            numerator=[Fraction(c) for c in top], denominator=[Fraction(c) for c in bottom],
            damping=Fraction(0), coulomb_friction=Fraction(0), resolution=Fraction(1, 2),
            sample_period=Fraction(1), delay=Fraction(0), unilateral=unilateral,
        )  # fmt: skip
        if stored(SimpleNamespace(loop=loop)) != wanted:
            return f"not {wanted} of {top}/{bottom}, {unilateral}"
    return ""


def denominators_of_positive_real_loops() -> str:
    """n + g d of b + T ζ^{d+1} N/((1 − ζ) D), and without 1 − ζ where N has it, too."""
    loop = import_module("zwidth.checker.loop.linear")
    random = Random(7)
    for _ in range(ROUNDS):
        bottom = [some(random, 1, 3) for _ in range(random.randrange(1, 4))]
        top = [some(random, -3, 3) for _ in bottom]
        if cancels := random.random() < 0.5:
            top[-1] -= sum(top)
        late, b, g, period = random.randrange(3), some(random, 0, 2), some(random, 1, 2), some(random, 1, 2)
        told = SimpleNamespace(numerator=top, denominator=bottom, damping=b, period=period, whole=late)
        found = loop.positive_real_denominator(told, g)
        for z in (0.3 + 0.4j, -1.2j):
            n, d, whole = (sum(complex(c) * z**i for i, c in enumerate(c)) for c in (top, bottom, found))
            wanted = float(b + g) * (1 - z) * d + float(period) * z ** (late + 1) * n
            if abs(whole * (1 - z if cancels else 1) - wanted) > 1e-9:
                return f"{found} of {told}, g = {g}"
    return ""


def moves_within_bounds() -> str:
    """Every position no deeper and no farther out, every move no quicker; of equals none is too much."""
    contact = import_module("zwidth.checker.contact.motion")
    random = Random(3)
    for _ in range(10 * ROUNDS):
        x = walk(random, 3, some(random, -2, 2))
        part, period = random.choice([Fraction(1), Fraction(1, 3)]), some(random, 1, 2)
        switches = x[1:] if part == 1 else [some(random, -2, 3) for _ in x[1:]]
        bounds = SimpleNamespace(
            speed=random.choice([None, some(random, 1, 6)]),
            depth=random.choice([None, some(random, 1, 3)]),
            outside=random.choice([None, some(random, 0, 2)]),
        )
        turns = list(zip(pairwise(x), switches, strict=True))
        moves = [(abs(m - a), part) for (a, _), m in turns]
        moves += [(abs(b - m), 1 - part) for (_, b), m in turns]
        quick = bounds.speed is not None and any(d > bounds.speed * period * of for d, of in moves)
        deep = bounds.depth is not None and max(*x, *switches) > bounds.depth
        far = bounds.outside is not None and min(*x, *switches) < -bounds.outside
        wrong = "speed" if quick else "depth" if deep else "outside" if far else ""
        said = f"Invalid: the motion does not keep to its {wrong}" if wrong else ""
        losses = SimpleNamespace(part=part, period=period)
        if refusal(contact.require_within, bounds, losses, x, switches) != said:
            return f"{said!r}: {bounds}, {x}, {switches}, {losses}"
    return ""


def friction_models_below_a_curve() -> str:
    """A line is below a curve if it is at every point and no steeper than its last chord, or level."""
    law = import_module("zwidth.checker.contact.law")
    random = Random(4)
    outcomes = set()
    for _ in range(4 * ROUNDS):
        speeds = sorted(random.sample(range(6), 3))
        curve = [(Fraction(v), some(random, 1, 5)) for v in speeds]
        friction, b = some(random, 0, 3), some(random, 0, 1)
        (v0, f0), (v1, f1) = curve[-2:]
        below = all(friction + b * v <= f for v, f in curve) and b <= max((f1 - f0) / (v1 - v0), 0)
        outcomes.add(below)
        said = "" if below else "Invalid: a friction model is not below the friction curve"
        if refusal(law._models_below, [[friction, b]], curve) != said:
            return f"{said!r}: {friction} + {b} v, {curve}"
    return "" if len(outcomes) == 2 else "all alike"


def criteria_of_multipliers() -> str:
    """4 λ κ |D|² − |D − λ ζ^{d+1} N_G|² at some angles, N_G = (N − K D)/(1 − ζ)."""
    contact = import_module("zwidth.checker.contact.multiplier")
    random = Random(5)
    for _ in range(ROUNDS):
        size = random.randrange(2, 5)
        bottom = [some(random, 5, 6), *(some(random, -1, 1) for _ in range(size - 1))]
        top = [some(random, -3, 3) for _ in bottom]
        stiffness = sum(top) / sum(bottom)
        rest = [n - stiffness * d for n, d in zip(top, bottom, strict=True)]
        late, factor, left = random.randrange(3), some(random, 1, 2), some(random, 1, 2)
        found = contact._circle(SimpleNamespace(whole=late, denominator=bottom), rest, factor, left)
        ratios = []
        for angle in (0.5, 1.1, 2.9):
            z = cmath.exp(-1j * angle)
            d, n = (sum(float(c) * z**i for i, c in enumerate(part)) for part in (bottom, rest))
            wanted = 4 * float(factor * left) * abs(d) ** 2
            wanted -= abs(d - float(factor) * z ** (late + 1) * n / (1 - z)) ** 2
            ratios.append(sum(float(c) * cos(angle) ** i for i, c in enumerate(found)) / wanted)
        if ratios[0] <= 0 or max(ratios) - min(ratios) > 1e-9 * ratios[0]:
            return f"{ratios}: {top} / {bottom}, {late} late, λ = {factor}, κ = {left}"
    return ""


CHECKS = [
    touching_motions, contact_motions, moves_within_bounds, friction_models_below_a_curve,
    criteria_of_multipliers, motions_with_rounds, stores_at_the_start, denominators_of_positive_real_loops,
]  # fmt: skip
CASES = [Case(check.__name__.replace("_", " "), check, "") for check in CHECKS]
