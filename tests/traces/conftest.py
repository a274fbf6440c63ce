"""Traces that several tests read."""

from __future__ import annotations

import pytest

import zwidth as zw


@pytest.fixture(scope="session")
def dowel():
    """A dowel on a wall that the paddle cannot hold: it bounces and grows."""
    paddle = zw.catalogue.device("haptic-paddle")
    return zw.simulate(paddle, zw.Wall(770.0), zw.operators.Dowel(), 0.5)


@pytest.fixture(scope="session")
def finger():
    """A finger that comes to rest on a passive wall, recorded between the samples too."""
    paddle = zw.catalogue.device("haptic-paddle")
    return zw.simulate(paddle, zw.Wall(300.0), zw.operators.Finger(), 0.5, points_per_sample=3)


@pytest.fixture(scope="session")
def knob():
    """A rotary device: radians and newton metres."""
    device = zw.rotary(inertia=2e-5, damping=2e-4, coulomb_friction=2e-3, resolution=1e-4, rate=2000)
    hand = zw.operators.ConstantForce(0.01)
    return zw.simulate(device, zw.Wall(0.5), hand, 0.3, initial_position=-0.05)
