"""All laws in one row: simulated alone, side by side; every joule accounted for."""

import numpy as np
import pytest
from prescribed import DEVICE, commands, wandering

import zwidth as zw
from zwidth.model import rendering
from zwidth.model.rendering import Damper, Kalman, TickTime

ROW = (
    rendering.Damper(1.1),
    rendering.Damper(0.7, TickTime()),
    rendering.Damper(0.9, Kalman(0.3)),
    rendering.Hysteresis("0.1"),
    rendering.BrakingPulse(limit=1),
    rendering.EventTransient(frequency=200),
    rendering.Saturation(6),
    rendering.SlewLimit(2000),
    rendering.Dither(kind="random"),
    rendering.RateTerm("0.002"),
    rendering.WindowedController(window=4),
    rendering.FrictionCompensation(coulomb="0.2", viscous="0.3", speed="0.05"),
)
LAW = zw.render(zw.Wall(800), *ROW)
HAND = zw.operators.Dowel()


def test_each_law_changes_the_force_of_the_one_before():
    """None is left out of the row, and none takes the numbers or the memory of another."""
    x, wall = 2 * wandering(), zw.Wall(800)
    forces = [commands(x, *ROW[:n], environment=wall)[1] for n in range(1, len(ROW) + 1)]
    for before, after in zip(forces, forces[1:], strict=False):
        assert np.abs(after - before).max() > 1e-3
    # dampers and hysteresis only add, each whatever stands before it
    alone = [commands(x, stage, environment=wall)[1] for stage in ROW[:6]]
    spring = np.where(commands(x, ROW[0], environment=wall)[0] > 0, 1.0, 0.0)
    wall_force = 800 * commands(x, ROW[0])[0] * spring
    assert forces[5] - wall_force == pytest.approx(sum(f - wall_force for f in alone), abs=1e-9)


def test_every_law_has_its_own_code():
    codes = [stage.code for stage in (*ROW[2:], rendering.PassivityController())]
    assert len(set(codes)) == len(codes)
    kinds = [e.kind for e in (rendering.AdaptiveWindow(), TickTime(), Kalman())]
    assert len(set(kinds)) == 3


def test_the_ledger_closes():
    trace = zw.simulate(DEVICE.replace(delay=4e-4), LAW, HAND, 0.4, initial_velocity=0.1, points_per_sample=3)
    assert trace.zwidth.energy.closes
    assert trace.attrs["environment"] == LAW.describe()
    assert (trace.position > 0).any()


def test_a_missed_sample_leaves_the_laws_as_they_were():
    damper = Damper(2, rendering.AdaptiveWindow(longest=1))
    law = zw.render(zw.Wall(0), damper)
    motion = zw.operators.PrescribedMotion(np.array([0, 1e-3, 3e-3, 4e-3, 4e-3]))
    loop = zw.Device(damping=0.1, sample_period=0.001)
    trace = zw.simulate(loop, law, motion, 0.004, timing=zw.simulation.Timing(missed=[0, 0, 1, 0, 0]))
    assert trace.commanded_force.values == pytest.approx([0, 2, 2, 6, 0])


def test_a_batch_has_the_bits_of_single_loops():
    batch = zw.simulation.simulate_batch(
        DEVICE, LAW, HAND, 0.2, vary={"device.damping": [0.1, 0.4]}, workers=2
    )
    for damping in (0.1, 0.4):
        alone = zw.simulate(DEVICE.replace(damping=damping), LAW, HAND, 0.2)
        assert float(batch.position.sel(damping=damping)) == float(alone.position[-1])
    assert float(batch.samples_inside.min()) > 20


@pytest.mark.parametrize("speed", ["0", "0.03"])
def test_compensation_of_friction_is_its_formula(speed):
    """f − F tanh(Δx/(T v_s)) − C Δx/T; of no speed v_s the sign; nothing at rest."""
    wall, law = zw.Wall(800), zw.FrictionCompensation(coulomb="0.4", viscous="0.7", speed=speed)
    x, force = commands(wandering(), law, environment=wall)
    v = np.diff(x, prepend=x[0]) / float(DEVICE.sample_period)
    bent = np.tanh(v / float(speed)) if float(speed) else np.sign(v)
    expected = 800 * np.maximum(x, 0) - 0.4 * bent - 0.7 * v
    assert force == pytest.approx(expected, abs=1e-9)
    assert np.abs(bent[x < 0]).max() > 0.1
    assert not zw.FrictionCompensation(speed=1)
