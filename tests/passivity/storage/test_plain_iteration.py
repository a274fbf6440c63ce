"""`value_iteration` against the same by its definition: the same outcome, and the same V to the last unit."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from itertools import product
from math import ceil
from random import Random

import numpy as np
import pytest
from plain_iteration import PlainIteration, exact_gain
from strategies import seeds

from zwidth.passivity.storage.domain import Domain, Losses
from zwidth.passivity.storage.grid import Grid
from zwidth.passivity.storage.law import FiniteLaw
from zwidth.passivity.storage.value_iteration import Effort, Until, value_iteration

LAWS = {
    "spring": ("position", 1, False, 0),
    "spring with a delay": ("position", 1, False, 1),
    "damped": ("position", 2, False, 0),
    "damped and clamped": ("position", 2, True, 0),
    "damped, fed with the penetration": ("penetration", 2, False, 0),
    "damped on both sides": ("none", 2, False, 0),
    "damped with a delay": ("position", 2, True, 1),
    "longer memory": ("position", 3, False, 0),
    "longer memory, clamped": ("penetration", 3, True, 0),
    "points": ("none", 0, False, 0),
    "points with a delay": ("none", 0, False, 1),
    "contact": ("position", 0, True, 0),
    "contact that pulls": ("position", 0, False, 0),
    "contact behind a converter, with a delay": ("position", 0, True, 1),
    "contact with half a sample of delay": ("position", 0, True, Fraction(1, 2)),
    "damped behind a converter, with a third of a sample": ("position", 2, False, Fraction(1, 3)),
    "spring behind a converter": ("position", 1, False, 0),
    "damped behind a converter": ("position", 2, False, 0),
    "damped on both sides behind a converter": ("none", 2, False, 0),
    "clamped behind a converter, with a delay": ("penetration", 2, True, 1),
    "points behind a converter": ("none", 0, False, 0),
    "spring with half a sample of delay": ("position", 1, False, Fraction(1, 2)),
    "spring with a delay just over nothing": ("position", 1, False, Fraction(1, 10)),
    "damped with part of a sample of delay": ("penetration", 2, True, Fraction(2, 3)),
    "points with a delay of one sample and a part": ("none", 0, False, Fraction(7, 5)),
}
"""A surface, how many taps (0: points), clamped, the delay in samples."""


def decimal(random, low, high):
    """Of five digits, even in the logarithm."""
    return Fraction(f"{low * (high / low) ** random.random():.5g}")


def drawn(random, name, easier):
    """A random law of a kind, and losses near what it needs; `easier` scales them."""
    surface, count, clamped, delay = LAWS[name]
    step, period = decimal(random, 1e-5, 1e-3), decimal(random, 1e-4, 1e-2)
    k = decimal(random, 1, 1000)
    rate = Fraction(random.randint(1, 20), 10) / step if "contact" in name else Fraction(0)
    if count == 0:
        heights = [random.randint(-9, 9) for _ in range(5)]
        points = tuple(
            ((n - 2) * step * random.choice([1, Fraction(11, 10)]) - step / 7, k * step * h / 9)
            for n, h in enumerate(heights)
        )
        taps, rough = (), k * max(abs(a - b) for a, b in zip(heights, heights[1:], strict=False)) / 9 + k / 9
        if rate:
            points = tuple((n * step, k * step * n**2 / 4) for n in range(3))
            rough = k * (1 + 2 * rate * step)
    else:
        points = ()
        rest = [k * Fraction(random.randint(-9, 9), 10) for _ in range(count - 1)]
        taps = (k - sum(rest, Fraction(0)), *rest)
        rough = sum(abs(c) for c in taps)
    limit = rough * step * random.choice([1, 2]) if random.random() < 0.25 else None
    share = [Fraction(random.randint(60, 160), 100) * easier for _ in range(2)]
    damping, friction = share[0] * rough * period / 2 * (2 * delay + 1), share[1] * rough * step / 2
    law = FiniteLaw(taps, surface, clamped, points, limit, rate=rate)
    if "converter" in name:  # of some steps a count, or some counts a step, and with ties
        coarse = rough * step * random.choice([2, 1, Fraction(1, 2), Fraction(3, 7)])
        law, friction = replace(law, force_step=coarse), friction + share[1] * coarse / 2
    return law, Losses(damping, friction, step, period, ceil(delay), delay - ceil(delay) + 1)


def domain_of(random, law, delay):
    """A few cells, reaching as far out as they must; the longest move may be no whole count."""
    memory = law.memory + delay
    reach = 1 if memory >= 2 else random.choice([1, 2])
    fastest = reach - Fraction(random.choice([0, 0, 1, 2]), 5)
    lowest = -2 if law.surface == "none" else 1 - (memory + 1) * reach
    return Domain(lowest, 2, reach, max_speed=fastest)


def column(grid, cell, before):
    """Of the history with these readings before."""
    readings, at = (cell, *before), 0
    for newer, older in zip(readings, before, strict=False):
        at = at * grid.width + older - newer + grid.domain.reach
    return at


def compared(grid, plain, zeros):
    """Play both from the same start: "passive" with equal V, or "active" with cycles that gain."""
    if zeros:
        grid.__dict__["first_guess"] = np.zeros_like(grid.first_guess)
    value, loop = plain.solved(_as_states(grid, plain, grid.first_guess))
    iteration = value_iteration(grid)
    if loop is not None:
        assert iteration.value is None
        assert iteration.cycle
        return "active", iteration
    assert iteration.cycle == ()
    assert _as_states(grid, plain, iteration.value) == value
    return "passive", iteration


def _as_states(grid, plain, value):
    low, nodes = grid.domain.lowest, grid.nodes.tolist()
    return {
        (cell, node, before): int(value[cell - low, column(grid, cell, before), nodes.index(node)])
        for cell, node, before in plain.states
    }


@pytest.mark.parametrize("approximation", ["outer", "inner"])
@pytest.mark.parametrize("name", LAWS)
def test_the_same_value_in_every_state(name, approximation):
    """From the first guess and from nothing, passive and active."""
    seen = []
    for seed, easier in product(range(5), (Fraction(1, 8), Fraction(1, 3), 1, 2)):
        random = Random(f"{name} {seed}")
        law, losses = drawn(random, name, easier)
        domain = domain_of(random, law, losses.delay)
        grid = Grid(law, losses, domain, random.choice([2, 3, 4]), approximation)
        nodes = grid.nodes.tolist() if approximation == "inner" else list(range(grid.steps + 1))
        plain = PlainIteration(law, losses, domain, grid.steps, nodes, approximation, grid.force_unit)
        outcome, iteration = compared(grid, plain, zeros=seed % 2 == 1)
        seen.append(outcome)
        if approximation == "inner" and outcome == "active":
            positions = [Fraction(node, grid.steps) for node, _ in iteration.cycle]
            cells = [cell for _, cell in iteration.cycle]
            assert all(0 <= x - n <= 1 for x, n in zip(positions, cells, strict=True))
            assert all(domain.lowest <= n <= domain.highest for n in cells)
            moves = [abs(a - b) for a, b in zip(positions, [*positions[1:], positions[0]], strict=True)]
            assert max(moves) <= domain.speed
            assert exact_gain(law, losses, positions, cells) > 0
    assert set(seen) == {"passive", "active"}


@seeds(15)
def test_what_gains_by_the_inner_costs_gains_by_the_outer_ones(seed):
    random = Random(seed)
    name = random.choice(list(LAWS))
    law, losses = drawn(random, name, Fraction(random.randint(50, 200), 100))
    domain = domain_of(random, law, losses.delay)
    inner, outer = (
        value_iteration(Grid(law, losses, domain, 4, approximation)) for approximation in ("inner", "outer")
    )
    assert not (inner.cycle and outer.value is not None)


def test_nothing_is_iterated_when_there_is_no_time():
    law, losses = drawn(Random(1), "damped", 1)
    iteration = value_iteration(Grid(law, losses, Domain(-3, 2, 2), 4, "outer"), Until(Effort(), 0.0))
    assert (iteration.value, iteration.cycle, iteration.rounds) == (None, (), 0)
