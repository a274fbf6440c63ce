"""Between the nodes: the drag of the outer approximation, interpolated, is at most that of the true move."""

from __future__ import annotations

from fractions import Fraction
from itertools import product
from random import Random

import numpy as np
import pytest
from strategies import seeds

import zwidth as zw
from zwidth.passivity.storage.domain import Domain, Losses
from zwidth.passivity.storage.grid import Grid
from zwidth.passivity.storage.law import FiniteLaw

HALF, QUARTER = Fraction(1, 2), Fraction(1, 4)


def lost(distance, spared=QUARTER):
    """L(D): nothing up to one step, D² − ¼ beyond."""
    return Fraction(0) if distance <= 1 else distance**2 - spared


def interpolated(i, j, a, b, spared=QUARTER):
    """L at x = i + a, x' = j + b, linear on both triangles of the square, cut where x' − x is constant.

    V(x) − V'(x') is linear on the whole square, so that any cut of it will do.
    """
    apart, high, low = j - i, max(a, b), min(a, b)
    beside = apart + (1 if b >= a else -1)
    weights = ((apart, 1 - high), (apart, low), (beside, high - low))
    return sum(w * lost(abs(d), spared) for d, w in weights)


def places(random, number):
    """Corners, middles, and places at random, exact."""
    yield from product((Fraction(0), HALF, Fraction(1)), repeat=2)
    for _ in range(number):
        size = 10 ** random.randint(1, 9)
        yield Fraction(random.randint(0, size), size), Fraction(random.randint(0, size), size)


@pytest.mark.parametrize("apart", [*range(9), 100])
@pytest.mark.parametrize("side", [-1, 1])
def test_never_more_than_the_true_drag(apart, side):
    """Everywhere at most (x' − x)², equal half way between two distances of two steps or more."""
    random = Random(apart * side)
    for a, b in places(random, 300):
        assert interpolated(0, side * apart, a, b) <= (side * apart + b - a) ** 2
    if apart >= 3:
        assert interpolated(0, apart, HALF, Fraction(1)) == (apart + HALF) ** 2


@seeds(15)
def test_every_move_between_nodes_is_covered(seed):
    """V and V' drawn at random, just large enough at the nodes: then nowhere between them too small."""
    random = Random(seed)
    steps, drag, force = 5, Fraction(random.randint(0, 9), 4), Fraction(random.randint(-9, 9), 2)
    friction = Fraction(random.randint(0, 4), 2)
    there = [Fraction(random.randint(-20, 20)) for _ in range(steps + 1)]

    def left(x, y, here, spent):
        return here + force * (y - x) + friction * abs(y - x) + spent - _linear(there, y)

    needed = [
        max(-left(Fraction(x), Fraction(y), 0, drag * lost(abs(y - x))) for y in range(steps + 1))
        for x in range(steps + 1)
    ]
    for _ in range(400):
        x, y = (Fraction(random.randint(0, 1000 * steps), 1000) for _ in range(2))
        assert left(x, y, _linear(needed, x), drag * (y - x) ** 2) >= 0


def _linear(values, x):
    at = min(int(x), len(values) - 2)
    return values[at] + (values[at + 1] - values[at]) * (x - at)


def test_the_worst_place_is_searched_for():
    """Downhill from many places: the difference does not become negative, and comes to 0."""
    random, least = Random(1), []
    for apart in range(1, 7):
        best = min(_descended(random, apart, QUARTER) for _ in range(5))
        least.append(best)
    assert min(least) == 0


@pytest.mark.parametrize("apart", [3, 4, 50])
def test_a_fifth_would_be_too_little(apart):
    """With D² − 1/5 it fails half way, so that the quarter is needed."""
    fifth = Fraction(1, 5)
    assert interpolated(0, apart, HALF, Fraction(1), fifth) > (apart + HALF) ** 2
    assert _descended(Random(apart), apart, fifth) < 0


def _descended(random, apart, spared):
    """(x' − x)² less the interpolation, followed downhill from a place at random."""

    def left(a, b):
        return (apart + b - a) ** 2 - interpolated(0, apart, a, b, spared)

    grid = 64
    a, b = Fraction(random.randint(0, grid), grid), Fraction(random.randint(0, grid), grid)
    moves = [(Fraction(p, grid), Fraction(q, grid)) for p, q in product((-1, 0, 1), repeat=2)]
    while True:
        near = [(a + p, b + q) for p, q in moves if 0 <= a + p <= 1 and 0 <= b + q <= 1]
        best = min(near, key=lambda at: left(*at))
        if left(*best) >= left(a, b):
            return left(a, b)
        a, b = best


@seeds(12)
def test_the_costs_of_a_grid_are_these(seed):
    """Outer: at most φ D + β L(D) of the true friction and drag; inner: at least φ D + β D²."""
    random = Random(seed)
    losses = Losses(
        *(Fraction(random.randint(1, 10**6), 10**6) for _ in range(2)),
        Fraction(1, 9973),
        Fraction(1, 3000),
        0,
    )
    law = FiniteLaw((Fraction(random.randint(1, 3000)),), "position")
    for approximation in ("outer", "inner"):
        grid = Grid(law, losses, Domain(-4, 4, 3), 8, approximation)
        drag = losses.damping / losses.period * (losses.resolution / 8) / grid.force_unit
        friction = losses.coulomb_friction / grid.force_unit
        for distance, cost in enumerate(grid.costs.tolist()):
            if approximation == "outer":
                assert cost <= friction * distance + drag * lost(distance)
                assert (
                    cost
                    >= (friction - grid.rounding - 1) * distance + drag * lost(distance) - distance**2 - 1
                )
            else:
                assert cost >= friction * distance + drag * distance**2
                assert cost <= (friction + grid.rounding + 1) * distance + (drag + 1) * distance**2
    assert np.all(np.diff(grid.nodes) > 0)


def test_the_losses_are_hardly_touched_by_rounding():
    """A force unit is so small that rounding takes less than a millionth off the friction."""
    paddle = zw.catalogue.device("haptic-paddle")
    law = FiniteLaw((Fraction(700), Fraction(-300)), "position")
    losses = Losses(
        paddle.exact("damping"), paddle.exact("coulomb_friction"), paddle.exact("resolution"),
        paddle.exact("sample_period"), 1,
    )  # fmt: skip
    grid = Grid(law, losses, Domain(-47, 64, 16), 64, "outer")
    friction = int(grid.costs[1]) * grid.force_unit
    assert friction > losses.coulomb_friction * (1 - Fraction(1, 10**6))
