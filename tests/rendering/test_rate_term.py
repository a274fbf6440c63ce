"""The term in the rate of the force: a damper in contact, what it pays for, and where a proof ends."""

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from prescribed import wandering
from tempting import device, follow

import zwidth as zw
from zwidth.model.rendering import PassivityController, RateTerm

K, T = 800.0, 1e-3
PADDLE = zw.catalogue.device("haptic-paddle")
paths = st.lists(st.floats(-1, 1), min_size=3, max_size=80).map(lambda v: 3e-3 * np.array(v))


@pytest.mark.parametrize("lead", [None, "0.0003", "0.004"])
def test_it_is_the_formula(lead):
    """f + τ (f − f_{k−1})/T, the first force without a rate."""
    positions = wandering()
    force = K * np.maximum(positions, 0)
    share = 0.5 if lead is None else float(lead) / T
    expected = force + share * np.diff(force, prepend=force[0])
    trace = follow(device(), zw.render(zw.Wall(K), RateTerm(lead)), positions)
    np.testing.assert_allclose(trace.commanded_force, expected, rtol=1e-12, atol=1e-14)


@pytest.mark.parametrize("lead", [None, "0.0002", "0.003"])
def test_it_is_proved_up_to_the_limit_and_no_further(lead):
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


def test_behind_another_law_nothing_is_proved_of_it():
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
