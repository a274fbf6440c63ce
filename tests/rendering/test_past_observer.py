"""The controller that absorbs what has come out: a plain loop, what it owes, and what it does not promise."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from prescribed import wandering
from tempting import follow

import zwidth as zw
from zwidth.model.rendering import PassivityController

B, T, K = 0.2, 1e-3, 1700.0
DEVICE = zw.Device(mass="0.05", damping=B, coulomb_friction=0, resolution=0, sample_period="0.001")
UNLIMITED = PassivityController(observer="past", largest_damping="unlimited")


def debts(trace):
    """D_k, what has come out in all at each sample [J]; Δx_{k+1}; what the wall gives in that move [J]."""
    x = trace.position.values
    debt, moves = np.maximum(trace.actuator_work.values, 0.0), np.diff(x)
    return debt, moves, np.maximum(-K * np.maximum(x[:-1], 0.0) * moves, 0.0)


def test_at_a_steady_speed_it_absorbs_exactly_what_came_out():
    """Out of the wall: the debt is what the wall gave in the last sample, to rounding, and then none."""
    out = 2e-3 - 3e-4 * np.arange(20)
    trace = follow(DEVICE, zw.render(zw.Wall(K), UNLIMITED), np.concatenate([[-1e-3], out]))
    debt, _, given = debts(trace)
    assert debt[1] == 0  # the leap in was from outside: it cost nothing, and left no credit
    np.testing.assert_allclose(debt[2:], given[1:], rtol=1e-9, atol=1e-15)
    assert (given[1:7] > 1e-5).all()
    assert (debt[10:] <= 1e-15).all()


paths = st.lists(st.floats(-1, 1), min_size=3, max_size=60).map(lambda v: 4e-3 * np.array(v))
speeds = st.lists(st.floats(0.05, 1), min_size=3, max_size=60).map(lambda v: 3e-3 - np.cumsum(v) * 3e-4)


@settings(max_examples=100, deadline=None)
@given(speeds)
def test_while_a_hand_keeps_its_direction_it_owes_less_and_less(positions):
    """D_{k+1} ≤ max(0, 1 − r) D_k + what the wall gives in the move, r = Δx_{k+1}/Δx_k ≥ 0; no limit."""
    debt, moves, given = debts(follow(DEVICE, zw.render(zw.Wall(K), UNLIMITED), positions))
    # the first move is made before anything was measured, and what the spring held at the start is its own
    ratio = moves[1:] / moves[:-1]
    bound = np.maximum(1 - ratio, 0) * debt[1:-1] + given[1:]
    assert (debt[2:] <= bound + 1e-12 * (debt.max() + given.max())).all()


@settings(max_examples=100, deadline=None)
@given(paths)
def test_by_default_a_turn_costs_no_more_than_the_limit(positions):
    """For every hand D_{k+1} ≤ D_k + what the wall gives, and where it turns + b |Δx_k Δx_{k+1}|/T."""
    law = zw.render(zw.Wall(K), PassivityController(observer="past"))
    debt, moves, given = debts(follow(DEVICE, law, positions))
    turned = np.minimum(moves[1:] * moves[:-1], 0.0)
    bound = debt[1:-1] + given[1:] - B / T * turned
    assert (debt[2:] <= bound + 1e-12 * (debt.max() + given.max() + 1e-6)).all()


def test_nothing_wider_is_so_where_the_hand_turns():
    """Outside the wall the controller acts alone: D_{k+1} = (1 + |r|) D_k in each turn, without a limit."""
    path = np.concatenate([[-1e-3, 2e-3, -1e-3], -1e-3 - 4e-4 * (np.arange(20) % 2 == 0)])
    debt, moves, given = debts(follow(DEVICE, zw.render(zw.Wall(K), UNLIMITED), path))
    ratio = np.abs(moves[3:] / moves[2:-1])
    assert (given[3:] == 0).all()
    np.testing.assert_allclose(debt[4:], (1 + ratio) * debt[3:-1], rtol=1e-9)
    assert debt[-1] > 1e5 * debt[3]


def published(positions, damping):
    """Hannaford & Ryu (2002), series: force and velocity of the same sample; α is paid a sample later."""
    before, paid, energy = positions[0], 0.0, 0.0
    for x in positions:
        velocity = (x - before) / T
        force = K * x + damping * velocity if x > 0 else 0.0
        energy += T * (force * velocity + paid)
        alpha = -energy / (T * velocity**2) if energy < 0 and velocity != 0 else 0.0
        before, paid = x, alpha * velocity**2
        yield force + alpha * velocity


def test_the_published_law_is_as_it_was_published():
    """Unlimited, before a wall whose negative damping it does see: to 1e-13 of the largest force."""
    positions, wall = wandering(), zw.Wall(K, damping="-1.5")
    law = PassivityController(observer="published", largest_damping="unlimited")
    trace = follow(DEVICE, zw.render(wall, law), positions)
    expected = np.array(list(published(positions, -1.5)))
    np.testing.assert_allclose(trace.commanded_force, expected, rtol=0, atol=1e-13 * np.abs(expected).max())
    alone = follow(DEVICE, wall, positions).commanded_force
    assert np.abs(expected - alone).max() > 1e-2
