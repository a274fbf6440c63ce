"""Both sides of the closed limits, by value iteration alone: springs and damped walls with an encoder."""

from __future__ import annotations

from fractions import Fraction
from itertools import pairwise
from math import ceil, floor
from random import Random

import pytest

import zwidth as zw
from zwidth.passivity import formulas as forms
from zwidth.passivity.storage.domain import Domain, losses_of
from zwidth.passivity.storage.law import finite_law
from zwidth.passivity.storage.program import FINE, STEPS, DynamicProgram

BELOW, BEYOND = 1 - Fraction(1, 100), 1 + Fraction(1, 100)


def draw(random, low, high):
    """A decimal of four digits, spread over the decades."""
    return Fraction(f"{low * (high / low) ** random.random():.3e}")


def program_of(device, wall, inside, reach):
    law, losses = finite_law(device, wall), losses_of(device)
    outside = 1 - (law.memory + losses.delay + 1) * reach
    return DynamicProgram(law, losses, Domain(outside, inside, reach), device.motion)


def proved(program):
    """A storage function that the checker accepts."""
    found = (program.prove(steps) for steps in STEPS)
    storage = next((s for s in found if s is not None), None)
    return storage is not None and storage.certificate().verify()


def refuted(program):
    found = (program.refute(steps) for steps in FINE)
    motion = next((m for m in found if m is not None), None)
    assert motion is None or motion.verify()
    return motion


def moves(motion):
    part = motion.motion.repeats[0]
    return [b - a for a, b in pairwise(motion.motion.positions[part.first : part.last + 1])]


def device(damping, friction, step, period):
    return zw.Device(damping=damping, coulomb_friction=friction, resolution=step, sample_period=period)


@pytest.mark.parametrize("seed", range(20))
def test_a_spring_that_is_too_stiff_for_its_damping(seed):
    """1 % below 2b/T proved; 1 % above a press of many counts in one sample, with the hand's closed bound."""
    random = Random(seed)
    b, period, step = draw(random, 0.01, 1), draw(random, 1e-4, 1e-2), draw(random, 1e-6, 1e-3)
    limit = 2 * b / period
    friction = limit * step / 2 * Fraction(random.randint(103, 180), 100)
    assert forms.abbott_okamura_stiffness(b, friction, step, period).sampling.fraction == limit
    loop = device(b, friction, step, period)
    above = limit * BEYOND
    needed = (friction - above * step / 2) / (above / 2 - b / period)  # no gain below it, see contact.md
    assert needed < 200 * step
    counts = ceil(needed / step * Fraction(3, 2)) + 3
    motion = refuted(program_of(loop, zw.Wall(above), counts, counts))
    assert max(abs(d) for d in moves(motion)) > needed
    assert proved(program_of(loop, zw.Wall(limit * BELOW), counts, counts))
    slow = floor(needed / step * Fraction(9, 10))  # the same wall, and a hand a tenth too slow for it
    if slow:
        assert refuted(program_of(loop, zw.Wall(above), slow + 5, slow)) is None
        assert proved(program_of(loop, zw.Wall(above), slow + 5, slow))


@pytest.mark.parametrize("seed", range(20))
def test_a_spring_that_is_too_stiff_for_its_friction(seed):
    """1 % below 2f_c/Δ proved; 1 % above a step over one edge and back, by much less than a count."""
    random = Random(seed)
    friction, period, step = draw(random, 0.001, 1), draw(random, 1e-4, 1e-2), draw(random, 1e-6, 1e-3)
    limit = 2 * friction / step
    b = limit * period / 2 * Fraction(random.randint(103, 300), 100)
    assert forms.abbott_okamura_stiffness(b, friction, step, period).quantization.fraction == limit
    loop = device(b, friction, step, period)
    motion = refuted(program_of(loop, zw.Wall(limit * BEYOND), 10, 5))
    assert motion is not None
    part = motion.motion.repeats[0]
    cycle = motion.motion.positions[part.first : part.last + 1]
    assert max(cycle) - min(cycle) < step / 20
    assert floor(max(cycle) / step) == floor(min(cycle) / step) + 1
    assert proved(program_of(loop, zw.Wall(limit * BELOW), 10, 5))


@pytest.mark.parametrize("clamped", [False, True])
@pytest.mark.parametrize("seed", range(8))
def test_a_damped_wall_with_too_little_friction(seed, clamped):
    """σ = ½ + β_v from both sides to 1 %, masked and clamped, where there is enough damping."""
    random = Random(seed)
    k, period, step = draw(random, 10, 3000), draw(random, 2e-4, 5e-3), draw(random, 1e-5, 1e-3)
    b = draw(random, 0.03, 2) * k * period / 2
    damping = forms.damped_wall_damping(k, b, period).fraction * Fraction(random.randint(105, 300), 100)
    friction = forms.damped_wall_friction(k, b, step, period).fraction
    # clamped, the toggling needs a depth at which f = K x − B v ≥ 0 still
    inside = ceil(b / (k * period)) + 3 if clamped else 4
    inside, reach = min(max(inside, 4), 12), 4
    wall = zw.Wall(k, b, clamped=clamped)
    motion = refuted(program_of(device(damping, friction * BELOW, step, period), wall, inside, reach))
    assert motion is not None
    assert motion.law.clamped is clamped
    assert max(abs(d) for d in moves(motion)) < step
    assert refuted(program_of(device(damping, friction * BEYOND, step, period), wall, inside, reach)) is None
    assert proved(program_of(device(damping, friction * BEYOND, step, period), wall, inside, reach))


@pytest.mark.parametrize("clamped", [False, True])
@pytest.mark.parametrize("seed", range(8))
def test_a_damped_wall_with_hardly_enough_damping(seed, clamped):
    """At β = ½ + β_v it is proved; 1 % below, a hand that goes far enough gains, and a slow one does not."""
    random = Random(100 + seed)
    k, period, step = draw(random, 10, 3000), draw(random, 2e-4, 5e-3), draw(random, 1e-5, 1e-3)
    b = draw(random, 0.03, 2) * k * period / 2
    damping = forms.damped_wall_damping(k, b, period).fraction
    friction = forms.damped_wall_friction(k, b, step, period).fraction * Fraction(103, 100)
    wall = zw.Wall(k, b, clamped=clamped)
    for counts in (4, 8):
        loop = device(damping * Fraction(1001, 1000), friction, step, period)
        assert proved(program_of(loop, wall, counts, counts))
        assert refuted(program_of(loop, wall, counts, counts)) is None
    # in and out by n counts every sample gains [K T/2 + B − b] 2 n²Δ²/T less friction, f_c less its share
    short = device(damping * Fraction(8, 10), friction, step, period)
    spare = friction - (k / 2 + b / period) * step
    needed = spare / (damping / 5 / period) / step
    assert needed < 4
    motion = refuted(program_of(short, wall, 16 if clamped else 8, 8))
    assert motion is not None
    assert max(abs(d) for d in moves(motion)) > step / 2


def test_deeper_than_the_grid_a_clamped_wall_is_not_seen():
    """Where B v is larger than K x at every depth of the grid, the friction limit does not show."""
    k, period, step = Fraction(100), Fraction(1, 1000), Fraction(1, 10**4)
    b = Fraction(1)  # B/(K T) = 10 counts
    damping = forms.damped_wall_damping(k, b, period).fraction * 3
    friction = forms.damped_wall_friction(k, b, step, period).fraction * Fraction(9, 10)
    shallow, deep = (
        refuted(program_of(device(damping, friction, step, period), zw.Wall(k, b, clamped=True), n, 2))
        for n in (3, 14)
    )
    assert shallow is None
    assert deep is not None
    assert deep.depth > 5 * step
