"""Between the nodes: the drag of the outer approximation, interpolated, is at most that of the true move."""

from __future__ import annotations

from fractions import Fraction
from random import Random

import numpy as np
from strategies import seeds

import zwidth as zw
from zwidth.passivity.storage.domain import Domain, Losses
from zwidth.passivity.storage.grid import Grid
from zwidth.passivity.storage.law import FiniteLaw


def lost(distance):
    """L(D): nothing up to one step, D² − ¼ beyond."""
    return Fraction(0) if distance <= 1 else distance**2 - Fraction(1, 4)


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
