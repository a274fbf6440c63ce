"""Random loops near their limit in a target's numbers, and hands that try to gain from the emitted code.

Of a cycle of readings that is repeated, the forces of the last round are taken from the emitted law, in
whole units, and what the hand gains in that round is summed in fractions:

    E = −Σ f_k (x_{k+1} − x_k) − f_c Σ |x_{k+1} − x_k| − (b/T) Σ (x_{k+1} − x_k)²

The laws remember a few readings and no more, so from then on every round gains as much.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from math import floor
from pathlib import Path
from random import Random

import numpy as np
from firmware.emulated.host import HostLaw

import zwidth as zw
from zwidth.machine.firmware.header import header
from zwidth.machine.firmware.law import law_program
from zwidth.machine.firmware.machine import Machine, machine
from zwidth.machine.firmware.verdict import Judged, judged
from zwidth.model.environment.wall import Wall
from zwidth.passivity.check import check_by_closed_forms
from zwidth.quantity.exact import Exact

MOST = 400
"""Readings to each side."""
ROUNDS = 6


@dataclass(frozen=True)
class Loop:
    device: zw.Device
    wall: Wall
    found: Judged

    @property
    def name(self) -> str:
        w, m = self.wall, self.found.machine
        return f"{m.number} K {float(w.stiffness):g} B {float(w.damping):g} {self.device!r}"


def digits(value: float | Fraction) -> Fraction:
    return Fraction(f"{float(value):.5g}")


def text(m: Machine) -> str:
    unit = 1.0 if m.fixed is None else m.fixed.units.scale.size(m.fixed.result)
    ends = (f"({int(m.counts[0])})", str(int(m.counts[1])))
    numbers = [("COUNTS_MIN", ends[0], "n"), ("COUNTS_MAX", ends[1], "n")]
    numbers.append(("FORCE_PER_UNIT", repr(unit), "N"))
    return header(m, name="law", about=["a law"], numbers=numbers)


def random_loop(random: Random) -> Loop:
    """A wall whose device has hardly more, or hardly less, than the wall and ε need."""
    period = random.choice([Fraction(1, 500), Fraction(1, 1000), Fraction(1, 4000)])
    count, k = digits(10 ** random.uniform(-5, -3)), digits(10 ** random.uniform(1, 4))
    b = random.choice([Fraction(0), digits(k * period * Fraction(random.uniform(0.05, 2)))])
    wall = zw.Wall(k, b, clamped=random.random() < 0.3)
    share = random.choice([None, random.uniform(0.05, 3)])
    step = None if share is None else digits(k * count * Fraction(share))
    base = zw.Device(mass="0.1", damping=0, resolution=count, sample_period=period, force_resolution=step)
    number = random.choice(["double", "float", "fixed", "fixed"])
    unit = float(k * count) * 2.0 ** -random.randrange(0, 9) if step is None else None
    m = machine(law_program(base, wall), number, (-MOST, MOST), unit)
    near = [Fraction(1 + random.choice([-1, 1]) * 10 ** random.uniform(-4, -0.7)) for _ in range(3)]
    spent = Fraction(m.error) * random.choice([Fraction(1), near[2], digits(random.uniform(0, 1))])
    device = base.replace(
        damping=Exact(digits((k * period / 2 + b) * near[0])),
        coulomb_friction=Exact((k + 2 * b / period) * count / 2 * max(near[1], Fraction(1)) + spent),
    )
    return Loop(device, wall, judged(device, wall, m, check_by_closed_forms))


def cycles(random: Random, rounds: int) -> Iterator[list[Fraction]]:
    little = Fraction(1, 2**20)
    for _ in range(rounds):
        n = random.choice([1, 1, 2, random.randrange(1, MOST)])
        yield [n - little, n + little]
        yield [n - little, n - little, n + little, n + little]
        there, back = random.randrange(0, 30), random.randrange(1, MOST)
        yield [Fraction(there) - little, Fraction(back)]
        length = random.randrange(2, 40)
        size, middle = random.uniform(0.1, MOST / 2), random.uniform(-3, MOST / 2)
        phases = 2 * np.pi * random.randrange(1, length) / length * np.arange(length) + random.uniform(0, 7)
        yield [Fraction(float(x)) for x in np.clip(middle + size * np.sin(phases), -MOST, MOST)]
        size = random.choice([1, 2, 10, MOST // 2])
        some = [Fraction(random.randrange(0, 2 * size)) for _ in range(random.randrange(2, 7))]
        yield [x + random.choice([-little, little, 0]) for x in some]


def gained(loop: Loop, law: HostLaw, cycle: list[Fraction]) -> Fraction:
    """What the hand gains in a round [J]."""
    counts = [floor(x) for x in cycle]
    law.init(counts[0])
    units = law.run(counts * ROUNDS)[-len(counts) :]
    per = Fraction(law.force_per_unit)
    count, period = loop.device.exact("resolution"), loop.device.exact("sample_period")
    friction, damping = loop.device.exact("coulomb_friction"), loop.device.exact("damping")
    out = Fraction(0)
    for k, unit in enumerate(units):
        moved = (cycle[(k + 1) % len(cycle)] - cycle[k]) * count
        out -= Fraction(float(unit)) * per * moved + friction * abs(moved) + damping / period * moved**2
    return out


def attacked(loop: Loop, random: Random, rounds: int, folder: Path) -> tuple[Fraction, list[Fraction]]:
    """The most that a hand gains in a round, and how."""
    law = HostLaw(text(loop.found.machine), folder)
    return max(((gained(loop, law, c), c) for c in cycles(random, rounds)), key=lambda found: found[0])
