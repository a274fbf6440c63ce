"""The environment as the loop runs it, sample by sample, and how it is packed for that.

    x_m = Δ floor(x/Δ + φ)              what the encoder reads, φ its phase
    x_m = law(x_m)                      one after the other, where laws look ahead for the environment
    f   = g x_m + Σ (sections)          H(z), each section a transposed direct form;
    f   = table(x_m)                    or points, linear between them
    f   = K uⁿ (1 + λ v)                or a contact, u = max(x_m, 0), v the backward difference of x_m
    f   = step of a scene               or a scene, moved to x_m
    f   = max(f, 0)                     where the law never pulls
    f   = law(x_m, f)                   one after the other, where laws render the environment
    f   = ΔF round(f/ΔF), |f| ≤ F_max   what the converter makes of it

A wall's velocity estimator runs on every measured position; a viscoelastic solid, which can be left, on the
penetration max(x_m, 0).  Neither pushes where x_m ≤ 0.
"""

from __future__ import annotations

from fractions import Fraction
from typing import Any, NamedTuple

import numpy as np

from zwidth.model.device.amplifier import Actuation
from zwidth.model.device.device import Device
from zwidth.model.environment.environment import Environment
from zwidth.model.rendering.chain import after, before
from zwidth.model.rendering.rendered import laws_of
from zwidth.model.rendering.rendering_law import LoopContext, RenderingLaw
from zwidth.model.scene.forces import scene_at_rest
from zwidth.model.scene.step import scene_force
from zwidth.native.compiled import Array, compiled
from zwidth.quantity.elementary import power

BILATERAL, PENETRATION, SURFACE = 0.0, 1.0, 2.0
"""At the surface: a law without one; one fed with max(x_m, 0); one fed with x_m.  Both push inside only."""

# The packed law: gate, encoder resolution, phase, force step, force limit (0: none), whether it never
# pulls, number of sections, number of points, whether it is a contact or a scene; then for each section its
# order n, b_0 … b_n, a_1 … a_n; or, where there are points and no section, their positions and their forces;
# or K, n and λ/T of a contact, which remembers the last reading; or a scene as `scene.layout` has it.
# Behind all that the laws in a chain, see `rendering.chain`: how many, where they begin, where their memory.
GATE, RESOLUTION, PHASE, STEP, LIMIT, CLAMPED, SECTIONS, POINTS, CONTACT, CHAIN, ROW, REMEMBERED = range(12)
HEADER = 12

POWER_LAW, SCENE = 1.0, 2.0
"""Which contact: K uⁿ (1 + λ v), or a scene."""


@compiled
def measured(x: float, resolution: float, phase: float) -> float:
    """What an encoder reads: Δ floor(x/Δ + φ); x itself if Δ = 0."""
    # a quotient, not a product with 1/Δ: they differ by a count at an edge
    return resolution * np.floor(x / resolution + phase) if resolution > 0.0 else x


@compiled
def rounded(f: float, step: float) -> float:
    """The converter's step nearest to a command; the command itself if ΔF = 0."""
    return step * np.floor(f / step + 0.5) if step > 0.0 else f


@compiled
def table_force(law: Array, points: int, x: float) -> float:
    """The force of the law's points at x: linear between them, constant beyond."""
    low, high = HEADER, HEADER + points - 1  # the force of the point at i is at i + points
    if x <= law[low]:
        return law[low + points]
    if x >= law[high]:
        return law[high + points]
    while high - low > 1:
        middle = (low + high) // 2
        if law[middle] <= x:
            low = middle
        else:
            high = middle
    part = (x - law[low]) / (law[high] - law[low])
    return law[low + points] + (law[high + points] - law[low + points]) * part


@compiled
def contact_force(law: Array, memory: Array, reading: float) -> float:
    """K uⁿ (1 + λ v); the last reading moves on."""
    moved = reading - memory[0]
    memory[0] = reading
    depth = max(reading, 0.0)
    return law[HEADER] * power(depth, law[HEADER + 1]) * (1.0 + law[HEADER + 2] * moved)


@compiled
def law_force(law: Array, memory: Array, reading: float) -> float:
    """The force that the law commands at a measured position; its memory moves on."""
    gate = law[GATE]
    x = max(reading, 0.0) if gate == PENETRATION else reading
    points = int(law[POINTS])
    f = table_force(law, points, x) if points > 0 else 0.0
    at, slot = HEADER, 0
    for _ in range(int(law[SECTIONS])):
        order = int(law[at])
        b, a = at + 1, at + 1 + order  # b_i at b + i, a_i at a + i
        y = law[b] * x
        if order > 0:
            y += memory[slot]
            for i in range(1, order):
                memory[slot + i - 1] = memory[slot + i] + law[b + i] * x - law[a + i] * y
            memory[slot + order - 1] = law[b + order] * x - law[a + order] * y
        f += y
        at += 2 * order + 2
        slot += order
    if law[CONTACT] == POWER_LAW:
        f = contact_force(law, memory, reading)
    if law[CLAMPED] > 0.0:
        f = max(f, 0.0)
    return 0.0 if gate != BILATERAL and reading <= 0.0 else f


@compiled
def rendered_force(law: Array, memory: Array, reading: float) -> float:
    """The same through the laws that render it, if there are any."""
    chained, seen = law[CHAIN] > 0.0, reading
    if chained:
        seen = before(law, int(law[ROW]), int(law[CHAIN]), memory, int(law[REMEMBERED]), reading)
    f = scene_force(law, HEADER, memory, 0, seen) if law[CONTACT] == SCENE else law_force(law, memory, seen)
    if chained:
        f = after(law, int(law[ROW]), int(law[CHAIN]), memory, int(law[REMEMBERED]), reading, f)
    return f


@compiled
def limited(law: Array, memory: Array, force: float) -> float:
    """The same within the force limit; the laws in the chain remember what is applied."""
    f = min(max(force, -law[LIMIT]), law[LIMIT]) if law[LIMIT] > 0.0 else force
    if law[CHAIN] > 0.0:
        memory[int(law[REMEMBERED])] = f
    return f


@compiled
def sampled_force(law: Array, memory: Array, counts: int) -> float:
    """One sample, from the encoder's counts to the force that the converter is told to give."""
    return limited(law, memory, rounded(rendered_force(law, memory, law[RESOLUTION] * counts), law[STEP]))


@compiled
def sampled_force_at(law: Array, memory: Array, reading: float) -> float:
    """The same from a position, where the encoder's resolution is not known."""
    return limited(law, memory, rounded(rendered_force(law, memory, reading), law[STEP]))


GATES = {"none": BILATERAL, "penetration": PENETRATION, "position": SURFACE}
"""By where a law acts and what it is computed from."""


class Packed(NamedTuple):
    """An environment and the laws that render it, as the kernel reads them, the encoder's phase left out."""

    numbers: Array
    row: tuple[RenderingLaw, ...]
    unit: Array
    remembers: int  # by law and row, the force between them aside


def packed(
    law: Environment,
    device: Device,
    period: Fraction,
    resolution: float,
    actuation: Actuation,
    single: bool,
    known: dict[Any, Any],
) -> Packed:
    """A law at T with this encoder and actuator; `known` and `single` as of `setup.laid_out`."""
    clock = period.as_integer_ratio()  # a tuple has its hash sooner
    key = ("law", id(law), id(device) if (row := laws_of(law)) else None, resolution, clock, actuation)
    if key in known:
        found: Packed = known[key]
        return found
    met = law.met
    clamped = float(met.clamped and not met.spring)  # a spring pushes wherever it acts
    header = [GATES[met.surface], resolution, 0.0, actuation.step, actuation.limit, clamped]
    kinds, body = _body(met, period)
    alone = np.array([*header, *kinds, 0.0, 0.0, 0.0, *body])
    unit = at_one(alone)
    links, context = list[float](), LoopContext(device, met, single)
    for link in row:
        own = link.numbers(context)
        links += [link.code, float(len(own)), float(link.state_size), *own]
    memory = len(_resting(alone, unit, 0.0))
    begins = [float(len(row)), float(len(alone)), float(memory)]
    numbers = np.array([*header, *kinds, *begins, *body, *links])
    known[key] = Packed(numbers, row, unit, memory + sum(link.state_size for link in row))
    return known[key]


def _body(law: Environment, period: Fraction) -> tuple[list[float], list[float]]:
    """The numbers of sections and of points and whether it is a contact; and what they are."""
    if law.points:
        places, forces = zip(*law.points, strict=True)
        return [0.0, float(len(places)), 0.0], [*map(float, places), *map(float, forces)]
    if law.power_law is not None:
        k, n, dissipation = law.power_law
        return [0.0, 0.0, POWER_LAW], [float(k), float(n), float(dissipation.fraction / period)]
    stepped = law.stepped(period)
    if stepped is not None:
        return [0.0, 0.0, SCENE], list(stepped.numbers)
    sections = [_section(part, period) for part in law.side_by_side()]
    return [float(len(sections)), 0.0, 0.0], [c for s in sections for c in s]


def _section(environment: Environment, period: Fraction) -> list[float]:
    numerator, denominator = environment.pulse_transfer_function(period)
    n, d = denominator[0].as_integer_ratio()
    # of whole numbers the quotient is rounded once, as that of fractions is, and needs no common divisor
    b, a = (
        [c.numerator * d / (c.denominator * n) or 0.0 for c in row] for row in (numerator, denominator[1:])
    )
    return [float(len(a)), *[0.0] * (len(a) + 1 - len(b)), *b, *a]


def remembered(law: Array, row: tuple[RenderingLaw, ...], unit: Array, reading: float) -> Array:
    """Environment, and behind it the force that was applied last and the laws that render it."""
    resting = _resting(law, unit, reading) + 0.0  # no line gives −0
    if not row:
        return resting
    return np.array([*resting, 0.0, *(n for link in row for n in link.initial_state(reading))]) + 0.0


def _resting(law: Array, unit: Array, reading: float) -> Array:
    """The law's memory after it has read this position for ever; 0 where it would not settle."""
    if law[CONTACT] == POWER_LAW:
        return np.array([reading])
    if law[CONTACT] == SCENE:
        return scene_at_rest(law, HEADER, reading)
    return unit * (max(reading, 0.0) if law[GATE] == PENETRATION else reading)


def at_one(law: Array) -> Array:
    """What sections remember at a reading of 1: times a reading, one line tells it for all of them."""
    at, states = HEADER, list[float]()
    for _ in range(int(law[SECTIONS])):
        order = int(law[at])
        b, a = law[at + 1 : at + 2 + order], np.concatenate(([1.0], law[at + 2 + order : at + 2 + 2 * order]))
        gain = float(np.add.reduce(a))
        y = float(np.add.reduce(b)) / gain if gain != 0.0 else 0.0
        later = 0.0
        own: list[float] = []
        for i in range(order, 0, -1):
            later += float(b[i]) - float(a[i]) * y
            own.append(later if gain != 0.0 else 0.0)
        states += reversed(own)
        at += 2 * order + 2
    return np.array(states or [0.0])
