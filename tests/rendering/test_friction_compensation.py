"""Compensation of friction in a chain: the force by its formula, on both sides of the surface."""

from __future__ import annotations

import numpy as np
import pytest
from prescribed import DEVICE, commands, wandering

import zwidth as zw


@pytest.mark.parametrize("speed", ["0", "0.03"])
def test_it_takes_from_the_force_what_the_formula_says(speed):
    """f − F tanh(Δx/(T v_s)) − C Δx/T; of no speed v_s the sign; nothing at rest."""
    wall, law = zw.Wall(800), zw.FrictionCompensation(coulomb="0.4", viscous="0.7", speed=speed)
    x, force = commands(wandering(), law, environment=wall)
    v = np.diff(x, prepend=x[0]) / float(DEVICE.sample_period)
    bent = np.tanh(v / float(speed)) if float(speed) else np.sign(v)
    expected = 800 * np.maximum(x, 0) - 0.4 * bent - 0.7 * v
    assert force == pytest.approx(expected, abs=1e-9)
    assert np.abs(bent[x < 0]).max() > 0.1


def test_energies_add_up():
    """It drives: what it gives is in the work of the actuator."""
    law = zw.render(zw.Wall(800), zw.FrictionCompensation(coulomb="0.1", speed="0.01"))
    trace = zw.simulate(DEVICE, law, zw.operators.Dowel(), 0.3, initial_velocity=0.1)
    assert trace.zwidth.energy.closes


def test_it_is_described():
    """With its numbers."""
    both = zw.FrictionCompensation(coulomb="0.4", viscous="0.7", speed="0.03")
    assert both.describe("rotary") == (
        "compensation of friction by 0.4 N·m tanh(v/(0.03 rad/s)) and 0.7 N·m·s/rad of its own speed"
    )
    sign = zw.FrictionCompensation(coulomb="0.4")
    assert sign.describe() == "compensation of friction by 0.4 N in the direction of motion"
    assert zw.FrictionCompensation().describe() == "compensation of friction by nothing"
    assert not zw.FrictionCompensation(speed=1)
