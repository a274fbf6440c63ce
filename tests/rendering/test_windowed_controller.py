"""The windowed controller: by a plain loop, what it forgets and what it never does, in other units."""

from collections import deque

import numpy as np
import pytest
from prescribed import device, follow, wandering

import zwidth as zw
from zwidth.model.rendering import Hysteresis, PassivityController, WindowedController
from zwidth.model.rendering.rendering_law import LoopContext

DEVICE = device()
OPTIONS = {
    "default": {},
    "short": {"window": 3},
    "floor": {"slowest": "0.2"},
    "no floor": {"slowest": "1e-9", "share": 1},
    "limit": {"largest_damping": "0.4", "share": "0.5", "window": 200},
}


def plain(positions, stiffness, window=30, slowest=0.01, share=0.9, largest_damping=0.15):
    """The law of the docstring, its losses in a queue."""
    period, most = 1e-3, float(share) * float(largest_damping)
    before, held, total, losses = positions[0], 0.0, 0.0, deque([0.0] * window)
    for x in positions:
        moved = x - before
        stored, had = (stiffness / 2 * max(y, 0.0) ** 2 for y in (x, before))
        loss = held * moved - (stored - had)
        total += loss - min(max(losses.popleft(), 0.0), max(total, 0.0))
        losses.append(loss)
        lack, force = -(total + stored), stiffness * max(x, 0.0)
        if lack > 0:
            speed = max(abs(moved) / period, float(slowest))
            force += min(lack / (period * speed**2), most) * moved / period
        before, held = x, force
        yield force


@pytest.mark.parametrize("name", OPTIONS)
def test_it_does_what_a_plain_loop_does(name):
    options, positions = OPTIONS[name], wandering()
    trace = follow(DEVICE, zw.render(zw.Wall(1500), WindowedController(**options)), positions)
    expected = np.array(list(plain(positions, 1500.0, **options)))
    np.testing.assert_allclose(trace.commanded_force, expected, rtol=1e-9, atol=1e-12)
    assert np.abs(expected - 1500 * np.maximum(positions, 0)).max() > 1e-3


def after_friction(law):
    """What comes out of fast touches [J], after slow strokes through friction and 60 samples of rest."""
    way = np.linspace(-3e-3, 3e-3, 300)
    through = 4e-3 - 1e-3 * np.cos(np.arange(2513) / 40)
    out = 3e-3 - 4e-4 * np.arange(16)
    touches = np.concatenate([out[::-1], out] * 4)
    path = np.concatenate([way, through, way[::-1], np.full(60, -3e-3), touches])
    row = zw.render(zw.Wall(2000), Hysteresis("0.15"), law)
    work = follow(DEVICE, row, path).actuator_work.values
    return work[-1] - work[-len(touches)]


def test_what_was_lost_long_ago_does_not_hide_what_comes_out_now():
    """Of credit from slow friction 30 samples keep none, 1000 some; with all of it more comes out."""
    keeps = after_friction(PassivityController(observer="past", largest_damping="0.135"))
    short, long = (after_friction(WindowedController(slowest="1e-9", window=n)) for n in (30, 1000))
    assert short < 0.95 * long < 0.9 * keeps


def test_what_the_spring_stores_is_never_forgotten():
    inside = np.concatenate([np.linspace(-1e-3, 2e-3, 400), np.full(500, 2e-3), np.linspace(2e-3, 3e-4, 400)])
    trace = follow(DEVICE, zw.render(zw.Wall(100), WindowedController(window=5)), inside)
    added = trace.commanded_force.values - 100 * np.maximum(inside, 0)
    assert 100 / 2 * 3e-4**2 > 100 / 2 * float((np.diff(inside) ** 2).sum()) > 1e-6  # it does leak
    assert np.abs(added).max() <= 1e-12


@pytest.mark.parametrize(
    ("environment", "stored"),
    [
        (zw.Wall(300), 150),
        (zw.StandardLinearSolid(300, branch_stiffness=50, branch_damping=3), 150),
        (zw.GeneralizedMaxwell(300, branches=[(800, 3)]), 150),
        (zw.Maxwell(300, 1), 0),
        (zw.HuntCrossley(300), 0),
        (zw.VirtualCoupling(300, 0, zw.Wall(100)), 0),
    ],
)
def test_only_a_spring_from_the_surface_is_credited(environment, stored):
    """What relaxes, what is bent and what lies behind a coupling does not hold K x²/2 at x."""
    assert WindowedController().numbers(LoopContext(DEVICE, environment))[3] == stored


def test_a_clamped_amplifier_is_booked_as_it_was():
    """What the force limit cut was not absorbed: with a limit of 0.1 N the debt lasts longer."""
    path = np.concatenate([[-1e-3, 4e-3], -1e-3 - 1e-4 * np.arange(60)])
    weak = DEVICE.replace(force_limit="0.01")
    law = zw.render(zw.Wall(2000), WindowedController(slowest="1e-9"))
    free = follow(DEVICE, law, path).commanded_force.values
    cut = follow(weak, law, path).commanded_force.values
    assert np.abs(free[5:]).max() <= 0.0135 * (1 + 1e-9)
    assert (np.abs(cut[5:20]) > 0).all()
