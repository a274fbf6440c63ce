"""Hands that turn, and step small, then large: what no controller gives out by default."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from prescribed import device as loop
from prescribed import follow

import zwidth as zw
from zwidth.model.rendering import PassivityController, WindowedController

B, T = 0.15, 1e-3

DEFAULTS = {
    "sampled": PassivityController(),
    "past": PassivityController(observer="past"),
    "published": PassivityController(observer="published"),
    "credited": PassivityController(credit=True, reference="spring"),
    "forgets": PassivityController(resets=True, ceiling=0, forgetting="0.01"),
    "windowed": WindowedController(),
    "short window": WindowedController(window=1, share=1, slowest="1e-9"),
}

steps = st.lists(st.tuples(st.floats(-4, 0), st.sampled_from([1, -1])), min_size=2, max_size=40)
"""Moves of all sizes over four decades, in no order."""


def zigzag(parts, start, times):
    """Positions [m] within some millimetres of the surface: the moves again and again, begun at `start`."""
    moves = np.tile([sign * 10.0 ** (exponent - 3) for exponent, sign in parts], times)
    path = np.concatenate([[0.0], np.cumsum(moves)])
    return path - path.mean() + start * np.ptp(path)


def given_out(device, law, positions):
    """The trace, the energy that the actuator has given at each sample, and Σ Δx² up to it."""
    trace = follow(device, law, positions)
    squares = np.concatenate([[0.0], np.cumsum(np.diff(trace.position.values) ** 2)])
    return trace, trace.actuator_work.values, squares


@pytest.mark.parametrize("name", DEFAULTS)
@settings(max_examples=25, deadline=None)
@given(
    steps,
    st.sampled_from([20.0, 300.0, 5000.0]),
    st.sampled_from([1, 4]),
    st.floats(-1, 1),
    st.sampled_from([None, "0.2"]),
)
def test_no_zigzag_takes_out_more_than_stated(name, parts, stiffness, times, start, most):
    """½ K x₀² and (K/2 + α/T) Σ Δx², α = b by default: beyond the device's damping (K/2) Σ Δx² at most."""
    positions = zigzag(parts, start, times)
    law = zw.render(zw.Wall(stiffness), DEFAULTS[name])
    trace, out, squares = given_out(loop(force_limit=most), law, positions)
    lost, held = trace.viscous_loss.values, stiffness / 2 * max(positions[0], 0.0) ** 2
    rounding = 1e-9 * (held + (stiffness + B / T) * squares)
    assert (out <= held + (stiffness / 2 + B / T) * squares + rounding).all()
    assert (out - lost <= held + stiffness / 2 * squares + rounding).all()


@pytest.mark.parametrize("name", DEFAULTS)
@settings(max_examples=10, deadline=None)
@given(steps, st.floats(-1, 1))
def test_counts_of_the_encoder_are_paid_by_friction(name, parts, start):
    """(K + 2α/T) Δ/2 of Coulomb friction covers them, on every motion."""
    stiffness, count = 800.0, 2e-5
    positions = zigzag(parts, start, 3)
    positions[0] = -abs(positions[0])
    law = zw.render(zw.Wall(stiffness), DEFAULTS[name])
    device = loop(friction=(stiffness + 2 * B / T) * count / 2, resolution=count)
    trace, out, squares = given_out(device, law, positions)
    lost = trace.viscous_loss.values + trace.coulomb_loss.values
    rounding = 1e-9 * (stiffness + B / T) * (squares + count**2)
    assert (out - lost <= stiffness / 2 * squares + rounding).all()


def gain_of_a_move(law):
    """What a move of 0.1 mm gives [J], to and fro outside after a leap out of the wall has left a debt."""
    x = np.concatenate([[-1e-3, 4e-3], -1e-3 - 1e-4 * (np.arange(400) % 2)])
    trace = follow(loop(), zw.render(zw.Wall(2000), law), x)
    net = (trace.actuator_work - trace.viscous_loss).values
    return (net[300] - net[100]) / 200


@pytest.mark.parametrize("observer", ["sampled", "past"])
def test_the_limit_is_the_largest_that_the_damping_pays_for(observer):
    """Outside the wall, with a debt: a hand gains |Δx|² (α − b)/T from each move, so nothing up to b."""
    for part in (0.98, 1, 1.02):
        law = PassivityController(observer=observer, largest_damping=part * B)
        assert gain_of_a_move(law) == pytest.approx((part - 1) * B / T * 1e-8, abs=1e-14)


@pytest.mark.parametrize("observer", ["sampled", "past"])
def test_without_a_limit_small_moves_before_large_ones_take_out_anything(observer):
    """1 mm in, 1 µm further, out: each round a thousand times more; by default what the bound says."""
    size, small = 1e-3, 1e-6
    x = np.tile([0.0, size, size + small], 39)
    for most, diverges in (("unlimited", True), (None, False)):
        law = PassivityController(observer=observer, largest_damping=most)
        _, out, squares = given_out(loop(), zw.render(zw.Wall(2000), law), x)
        bound = (1000 + B / T) * squares[-1]
        assert bool(out.max() > 1e100) is diverges
        assert bool(out.max() > bound) is diverges


def test_the_windowed_controller_beyond_b_is_no_longer_covered():
    """Its clamp is what counts: 0.9 of 1.2 b gives to a hand that goes to and fro, 0.9 of b does not."""
    assert gain_of_a_move(WindowedController()) < 0
    assert gain_of_a_move(WindowedController(largest_damping=1.2 * B)) > 0


@pytest.mark.parametrize("name", ["sampled", "past", "windowed"])
def test_a_wall_that_is_proved_stays_proved_with_the_default(name):
    """What the wall leaves of b is the limit; beyond the wall's own bound nothing is proved."""
    device = loop(friction=1, resolution="22.4e-6")
    most = 2 * device.exact("damping") / device.exact("sample_period")
    for share, outcome in ((0.5, "passive"), (1 - 1e-6, "passive"), (1 + 1e-6, "undecided")):
        wall = zw.Wall(float(most) * share)
        assert zw.check(device, zw.render(wall, DEFAULTS[name])).outcome == outcome, share
    left = DEFAULTS[name].most_damping(device, zw.Wall(float(most) / 2).stiffness)
    assert float(left) == pytest.approx(B / 2 * (0.9 if name == "windowed" else 1), rel=1e-9)
    late = DEFAULTS[name].most_damping(loop(delay="0.0005"), zw.Wall(float(most) / 4).stiffness)
    assert late == left


def test_of_an_interval_the_largest_limit_of_any_device():
    """b in 0.1 to 0.2 N·s/m: a spring that the least of them does not bear leaves all of b to some device."""
    law, device = DEFAULTS["sampled"], loop(damping=("0.1", "0.2"))
    assert float(law.most_damping(device, zw.Wall(199).stiffness)) == pytest.approx(0.1005, rel=1e-9)
    assert float(law.most_damping(device, zw.Wall(201).stiffness)) == 0.2
