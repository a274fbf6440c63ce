"""All laws in one row; compensation of friction and the term in the rate of the force by their formulas."""

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from prescribed import DEVICE, commands, device, follow, wandering

import zwidth as zw
from zwidth.model import rendering
from zwidth.model.rendering import Damper, Kalman, PassivityController, RateTerm, TickTime

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


K, T = 800.0, 1e-3
PADDLE = zw.catalogue.device("haptic-paddle")
paths = st.lists(st.floats(-1, 1), min_size=3, max_size=80).map(lambda v: 3e-3 * np.array(v))


@pytest.mark.parametrize("lead", [None, "0.0003", "0.004"])
def test_the_rate_term_is_its_formula(lead):
    """f + τ (f − f_{k−1})/T, the first force without a rate."""
    positions = wandering()
    force = K * np.maximum(positions, 0)
    share = 0.5 if lead is None else float(lead) / T
    expected = force + share * np.diff(force, prepend=force[0])
    trace = follow(device(), zw.render(zw.Wall(K), RateTerm(lead)), positions)
    np.testing.assert_allclose(trace.commanded_force, expected, rtol=1e-12, atol=1e-14)


@pytest.mark.parametrize("lead", [None, "0.0002", "0.003"])
def test_the_rate_term_is_proved_up_to_the_limit_and_no_further(lead):
    """b = K T/2 + K τ is passive with a certificate; a millionth more stiffness is not."""
    tau = Fraction(1, 2000) if lead is None else Fraction(lead)
    limit = Fraction("0.15") / (Fraction(1, 2000) + tau)
    at = zw.check(PADDLE, zw.render(zw.Wall(limit), RateTerm(lead)))
    assert at.outcome == "passive"
    assert at.certificate.verify()
    beyond = zw.check(PADDLE, zw.render(zw.Wall(limit * (1 + Fraction(1, 10**6))), RateTerm(lead)))
    assert beyond.outcome != "passive"


def test_just_beyond_the_limit_a_hand_gains():
    """Inside, to and fro: |Δx|² (K/2 + K τ/T − b/T) a move, of either sign; no friction, no counts."""
    path = 5e-3 + 1e-3 * (np.arange(300) % 2)
    for part in (0.99, 1.01):
        stiffness = part * 0.15 / (T / 2 + 0.002)
        trace = follow(device(), zw.render(zw.Wall(stiffness), RateTerm("0.002")), path)
        net = (trace.actuator_work - trace.viscous_loss).values
        assert (net[250] - net[50]) / 200 == pytest.approx((part - 1) * 150e-6, rel=1e-6)


@settings(max_examples=100, deadline=None)
@given(paths, st.sampled_from(["0.0001", "0.0005", "0.01"]))
def test_no_hand_takes_out_more_than_stated(positions, lead):
    """Contact made and broken: ½ K x₀² + (K/2 + K τ/T) Σ Δx² at most."""
    positions[0] = -abs(positions[0])
    trace = follow(device(), zw.render(zw.Wall(K), RateTerm(lead)), positions)
    squares = np.concatenate([[0.0], np.cumsum(np.diff(positions) ** 2)])
    bound = K * (0.5 + float(lead) / T) * squares
    assert (trace.actuator_work.values <= bound * (1 + 1e-9)).all()


def test_behind_another_law_nothing_is_proved_of_the_rate_term():
    """The force that comes in then changes by more than K |Δx|; the other way round both are covered."""
    capped = PassivityController(largest_damping="0.05")
    first = zw.check(PADDLE, zw.render(zw.Wall(90), RateTerm(), capped))
    assert first.outcome == "passive"
    assert zw.check(PADDLE, zw.render(zw.Wall(90), capped, RateTerm())).outcome != "passive"


def test_an_uncertain_period_or_wall_is_not_guessed():
    """An interval has no one K τ, nor T/2."""
    law = RateTerm()
    assert law.most_damping(PADDLE.replace(sample_period=("0.001", "0.002")), zw.Wall(9).stiffness) is None
    assert zw.check(PADDLE, zw.render(zw.Wall((9, 10)), law)).outcome != "passive"
