"""Laws that never pull: the simulator runs max(0, law) and keeps its fast paths for springs."""

from __future__ import annotations

import numpy as np
import pytest

import zwidth as zw
from zwidth.loop.setup import prepare

PADDLE = zw.catalogue.device("haptic-paddle")
PERIOD = 0.002

LAWS = {
    "backward difference": zw.Wall(300.0, damping=2.0),
    "negative damping": zw.Wall(300.0, damping=-2.0),
    "window": zw.Wall(300.0, damping=2.0, velocity_filter=zw.rendering.Window(5)),
    "one-pole": zw.Wall(300.0, damping=2.0, velocity_filter=zw.rendering.OnePole(0.01)),
    "gain for an estimator": zw.Wall(
        10.0, damping=-2.0, velocity_filter=zw.rendering.VelocityFilter([50], [1])
    ),
    "standard linear solid": zw.StandardLinearSolid(20.0, 500.0, 2.0),
    "Maxwell": zw.Maxwell(500.0, 2.0),
    "Prony": zw.GeneralizedMaxwell(20.0, [(500.0, 2.0), (30.0, 900.0)]),
    "Prony, matched": zw.GeneralizedMaxwell(20.0, [(500.0, 2.0), (20.0, 5.0)], discretization="matched"),
}


def _commands(environment: zw.environment.Environment, positions: np.ndarray, **device) -> np.ndarray:
    """The force commanded at each sample of a prescribed motion."""
    loop = zw.Device(**{"damping": 0.1, "sample_period": PERIOD, **device})
    motion = zw.operators.PrescribedMotion(positions)
    duration = PERIOD * (len(positions) - 1)
    return zw.simulate(
        loop, environment, motion, duration, amplifier=zw.amplifiers.Ideal()
    ).commanded_force.values


@pytest.mark.parametrize("resolution", [0.0, 1e-4])
@pytest.mark.parametrize("name", LAWS)
def test_a_clamped_law_commands_the_positive_part_of_the_law(name: str, resolution: float) -> None:
    """Sample by sample, in and out of contact; the memory is that of the law without a clamp."""
    law = LAWS[name]
    steps = np.random.default_rng(7).normal(size=600)
    motion = 1e-3 + 4e-3 * np.sin(np.arange(600) / 20) + 2e-4 * np.cumsum(steps)
    whole = _commands(law, motion, resolution=resolution)
    assert whole.min() < 0
    clamped = _commands(law.replace(clamped=True), motion, resolution=resolution)
    assert (clamped == np.maximum(whole, 0.0)).all()


@pytest.mark.parametrize("name", LAWS)
def test_the_ledger_closes_and_no_sample_pulls(name: str) -> None:
    """A dowel on a clamped law: every joule is accounted for."""
    trace = zw.simulate(PADDLE, LAWS[name].replace(clamped=True), zw.operators.Dowel(), 0.4)
    assert trace.zwidth.energy.closes
    assert float(trace.actuator_force.min()) >= 0
    assert "never pulls" in trace.attrs["environment"]


@pytest.mark.parametrize("solid", [zw.Wall(500.0), zw.StandardLinearSolid(500.0, 0, 3.0)])
def test_a_clamped_spring_is_run_as_the_spring_that_it_is(solid) -> None:
    """It never pulls anyway: the quick path, and the same bits."""
    clamped = solid.replace(clamped=True)
    assert prepare(PADDLE, clamped, zw.operators.Dowel(), 0.1).plain
    one, other = (zw.simulate(PADDLE, law, zw.operators.Dowel(), 0.1) for law in (solid, clamped))
    assert (one.position.values == other.position.values).all()


def test_a_batch_varies_the_clamp_with_the_bits_of_single_loops() -> None:
    """With and without, springs and damped walls side by side."""
    wall, dowel = zw.Wall(500.0, 0.3), zw.operators.Dowel()
    vary = {"clamped": [False, True], "environment.damping": [0.0, 0.3]}
    batch = zw.simulation.simulate_batch(PADDLE, wall, dowel, 0.2, vary=vary, workers=2)
    for clamped in (False, True):
        for damping in (0.0, 0.3):
            alone = zw.simulate(PADDLE, wall.replace(clamped=clamped, damping=damping), dowel, 0.2)
            there = batch.sel(clamped=clamped, damping=damping)
            assert float(there.position) == float(alone.position[-1])
            assert float(there.energy_extracted) == float((-alone.hand_work).max())


def test_a_clamp_acts_before_the_converter() -> None:
    """The nearest step to no force is no force."""
    x = np.array([0.0, 5e-3, 4e-3, 1e-3, 0.5e-3])
    loop = zw.Device(damping=0.1, sample_period=PERIOD, force_resolution=0.05, force_limit=1.0)
    trace = zw.simulate(loop, zw.Wall(300.0, 0.7, clamped=True), zw.operators.PrescribedMotion(x), 4 * PERIOD)
    assert trace.commanded_force.values == pytest.approx([0.0, 1.0, 0.85, 0.0, 0.0])
