"""Between the knots: the drag of the generous rules, interpolated, is at most the drag of the true move."""

from __future__ import annotations

from fractions import Fraction
from itertools import product
from random import Random

import numpy as np
import pytest

import zwidth as zw
from zwidth.passivity.worst_hand.board import Board, Domain, Losses
from zwidth.passivity.worst_hand.law import FiniteLaw

HALF = Fraction(1, 2)


def lost(distance, spared=HALF):
    """L(D): nothing up to one step, D² − ½ beyond."""
    return Fraction(0) if distance <= 1 else distance**2 - spared


def on_rectangle(i, j, a, b, spared=HALF):
    """L interpolated at x = i + a, x' = j + b: linear in either."""
    corners = {
        (p, q): (a if p else 1 - a) * (b if q else 1 - b) * lost(abs(j + q - i - p), spared)
        for p, q in product((0, 1), repeat=2)
    }
    return sum(corners.values())


def on_triangle(a, b, spared=HALF):
    """L interpolated on the square of one step with itself, cut along its diagonal."""
    high, low = max(a, b), min(a, b)
    along, across = low, high - low  # from (0, 0) to (1, 1), and to the corner beside it
    return along * lost(0, spared) + across * lost(1, spared) + (1 - high) * lost(0, spared)


def places(random, number):
    """Corners, middles, and places at random, exact."""
    yield from product((Fraction(0), HALF, Fraction(1)), repeat=2)
    for _ in range(number):
        size = 10 ** random.randint(1, 9)
        yield Fraction(random.randint(0, size), size), Fraction(random.randint(0, size), size)


@pytest.mark.parametrize("apart", [*range(1, 9), 100])
@pytest.mark.parametrize("side", [-1, 1])
def test_never_more_than_the_true_drag_on_a_rectangle(apart, side):
    """Steps that differ: everywhere at most (x' − x)², equal half way from three steps on."""
    random = Random(apart * side)
    for a, b in places(random, 300):
        assert on_rectangle(0, side * apart, a, b) <= (side * apart + b - a) ** 2
    if apart >= 3:
        assert on_rectangle(0, side * apart, HALF, HALF) == apart**2


def test_never_more_than_the_true_drag_on_the_triangles():
    """The same step: nothing is counted there at all."""
    for a, b in places(Random(0), 300):
        assert on_triangle(a, b) <= (b - a) ** 2


def test_the_worst_place_is_searched_for():
    """Downhill from many places: the difference does not become negative, and comes to 0."""
    random, least = Random(1), []
    for apart in range(1, 7):
        best = min(_descended(random, apart, HALF) for _ in range(5))
        least.append(best)
    assert min(least) == 0


@pytest.mark.parametrize("apart", [3, 4, 50])
def test_a_quarter_would_be_too_little(apart):
    """With D² − ¼ it fails half way, so that the half is needed."""
    quarter = Fraction(1, 4)
    assert on_rectangle(0, apart, HALF, HALF, quarter) > apart**2
    assert _descended(Random(apart), apart, quarter) < 0


def _descended(random, apart, spared):
    """(x' − x)² less the interpolation, followed downhill from a place at random."""

    def left(a, b):
        return (apart + b - a) ** 2 - on_rectangle(0, apart, a, b, spared)

    grid = 64
    a, b = Fraction(random.randint(0, grid), grid), Fraction(random.randint(0, grid), grid)
    moves = [(Fraction(p, grid), Fraction(q, grid)) for p, q in product((-1, 0, 1), repeat=2)]
    while True:
        near = [(a + p, b + q) for p, q in moves if 0 <= a + p <= 1 and 0 <= b + q <= 1]
        best = min(near, key=lambda at: left(*at))
        if left(*best) >= left(a, b):
            return left(a, b)
        a, b = best


@pytest.mark.parametrize("seed", range(20))
def test_the_boards_costs_are_these(seed):
    """Generous: at most φ D + β L(D) of the true friction and drag; strict: at least φ D + β D²."""
    random = Random(seed)
    losses = Losses(
        *(Fraction(random.randint(1, 10**6), 10**6) for _ in range(2)),
        Fraction(1, 9973),
        Fraction(1, 3000),
        0,
    )
    law = FiniteLaw((Fraction(random.randint(1, 3000)),), "position")
    for rules in ("generous", "strict"):
        board = Board(law, losses, Domain(-4, 4, 3), 8, rules)
        drag = losses.damping / losses.period * (losses.resolution / 8) / board.force_unit
        friction = losses.coulomb_friction / board.force_unit
        for distance, cost in enumerate(board.costs.tolist()):
            if rules == "generous":
                assert cost <= friction * distance + drag * lost(distance)
                assert (
                    cost
                    >= (friction - board.rounding - 1) * distance + drag * lost(distance) - distance**2 - 1
                )
            else:
                assert cost >= friction * distance + drag * distance**2
                assert cost <= (friction + board.rounding + 1) * distance + (drag + 1) * distance**2
    assert np.all(np.diff(board.knots) > 0)


def test_the_losses_are_hardly_touched_by_rounding():
    """A force unit is so small that rounding takes less than a millionth off the friction."""
    paddle = zw.catalogue.device("haptic-paddle")
    law = FiniteLaw((Fraction(700), Fraction(-300)), "position")
    losses = Losses(
        paddle.exact("damping"), paddle.exact("coulomb_friction"), paddle.exact("resolution"),
        paddle.exact("sample_period"), 1,
    )  # fmt: skip
    board = Board(law, losses, Domain(-47, 64, 16), 64, "generous")
    assert board.friction * board.force_unit > losses.coulomb_friction * (1 - Fraction(1, 10**6))
