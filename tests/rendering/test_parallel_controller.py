"""The parallel passivity controller: what it keeps, what it does not see, and a hand that refutes it."""

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from strategies import zero_or

import zwidth as zw
from zwidth.model.rendering import ParallelController

T = 0.001

UNLIMITED = ParallelController(largest_mobility="unlimited")
BLIND = ParallelController(observer="published", largest_mobility="unlimited")

forces = st.lists(
    st.floats(0.01, 30).flatmap(lambda f: st.sampled_from([f, -f])), min_size=2, max_size=60
).map(np.array)
"""Held forces, none of them 0 [N]."""

bodies = st.builds(
    zw.simulation.VirtualBody,
    mass=st.floats(0.001, 3),
    damping=st.sampled_from([0, 0.3]),
    stiffness=st.sampled_from([0, 400]),
    integration=st.sampled_from(["implicit", "explicit"]),
)


def shown(mass, hand, duration, **options):
    """The display of a mass, or a body, in a hand."""
    body = mass if isinstance(mass, zw.simulation.VirtualBody) else zw.simulation.VirtualBody(mass)
    return zw.simulation.simulate_admittance(body, hand, duration, sample_period="0.001", **options)


def pushed(body, newtons, controller=None, **options):
    hand = zw.operators.RecordedForce(newtons)
    return shown(body, hand, len(newtons) * 0.001, controller=controller, **options)


def rounding(trace):
    """1e-12 of the largest energy so far, also of what the body would have given: it is cancelled."""
    fastest = np.maximum.accumulate(np.abs(trace.velocity.values) + np.abs(trace.body_velocity.values))
    strongest = np.maximum.accumulate(np.abs(trace.measured_force.values) + np.abs(trace.hand_force.values))
    return 1e-12 * (np.maximum.accumulate(np.abs(trace.hand_work.values)) + T * fastest * strongest)


@settings(max_examples=80, deadline=None)
@given(bodies, forces)
def test_it_owes_one_sample_at_most(body, newtons):
    """Unlimited, sensor and pairing exact: E_{k+1} ≥ T u_k (f̄_k − φ_k), debts do not add up; E is W_h."""
    trace = pushed(body, newtons, UNLIMITED)
    u, reading, work = (trace[key].values for key in ("velocity", "measured_force", "hand_work"))
    np.testing.assert_allclose(trace.observed_energy, work, rtol=1e-10, atol=1e-12 * np.abs(work).max())
    bound = T * u[:-1] * (newtons - reading[:-1])
    bound[0] = 0.0  # nothing was read before the first sample
    assert (work[1:] >= np.minimum(bound, 0) - rounding(trace)[1:]).all()


@settings(max_examples=80, deadline=None)
@given(
    st.lists(st.integers(-200, 200).map(lambda n: n / 1e4), min_size=3, max_size=50),
    st.floats(1, 3000),
    zero_or(0.001, 3),
    st.floats(0.001, 3),
)
def test_it_owes_one_sample_at_most_to_spring_hands(path, stiffness, damping, mass):
    hand = zw.operators.Tracking(path, stiffness=stiffness, damping=damping)
    trace = shown(mass, hand, 0.05, controller=UNLIMITED)
    u, reading, work = (trace[key].values for key in ("velocity", "measured_force", "hand_work"))
    assume((reading[1:] != 0).all())
    means = np.append(reading[1:], reading[-1])  # of the interval that follows
    bound = T * u * (means - reading)
    assert (work[2:] >= np.minimum(bound[1:-1], 0) - rounding(trace)[2:]).all()


def test_a_hand_that_turns_doubles_its_gain_in_every_sample():
    """f̄_k = −φ_k: E_{k+1} = E_k (1 − f̄_k/φ_k) = 2 E_k without end; without a controller, a straight line."""
    turns = np.tile([1.0, -1.0], 15)
    body = zw.simulation.VirtualBody("0.01")
    work = pushed(body, turns, UNLIMITED).hand_work.values
    np.testing.assert_allclose(work[2:], -1e-4 * 2.0 ** np.arange(29), rtol=1e-12)
    assert pushed(body, turns).hand_work.values[-1] == pytest.approx(-15e-4)
    slow = ParallelController(largest_mobility="unlimited", largest_velocity="0.1")
    capped = pushed(body, turns, slow).hand_work.values
    assert np.diff(capped).min() >= -T * 0.2 * (1 + 1e-12)


@settings(max_examples=60, deadline=None)
@given(forces, st.floats(0.001, 3), zero_or(0.001, 1), zero_or(0.01, 500), st.sampled_from(["mean", "point"]))
def test_the_published_pairing_never_sees_an_implicit_body(newtons, mass, damping, stiffness, sensor):
    """Σ T φ_k v_k is what the body stores and loses: the controller never acts, whatever the hand."""
    body = zw.simulation.VirtualBody(mass, damping, stiffness)
    watched = pushed(body, newtons, BLIND, sensor=sensor)
    scale = np.abs(watched.velocity).max() + 1e-12
    assert np.abs(watched.velocity - watched.body_velocity).max() <= 1e-9 * scale


def test_what_the_published_pairing_does_not_see_grows():
    """A light body diverges in a stiff hand; the observer, never below 0, sees only what it takes in."""
    hand = zw.operators.Tracking([0, 0.001], stiffness=2000, damping=0.2)
    trace = shown("0.01", hand, 1, controller=BLIND)
    assert trace.observed_energy.min() >= 0
    assert trace.hand_work[-1] < -1e6


@pytest.mark.parametrize("stiffness", [500, 2000])
def test_what_the_pairings_miss_in_a_still_hand(stiffness):
    """Point sensor: published ½ k T² u² + c T u_k (u_k − u_{k−1}) too much, sampled ½ k T² u² too little."""
    counted, hand = {}, zw.operators.Tracking([0.0, 0.001], stiffness=stiffness, damping=0.3)
    for observer in ("published", "sampled"):
        watching = ParallelController(observer=observer, weakest=1e30)
        trace = shown("0.05", hand, 0.4, sensor="point", controller=watching)
        counted[observer] = np.diff(trace.observed_energy - trace.hand_work)[2:]
    u = trace.velocity.values
    square = 0.5 * stiffness * T**2 * u[2:-1] ** 2
    damper = 0.3 * T * u[2:-1] * np.diff(u)[1:-1]
    np.testing.assert_allclose(counted["published"], square + damper, rtol=1e-6, atol=1e-9 * square.max())
    np.testing.assert_allclose(counted["sampled"], -square, rtol=1e-6, atol=1e-9 * square.max())


def touch(mass, **options):
    """A hand of 2000 N/m and 0.2 N·s/m that goes 20 mm in a second, then rests; 4 s."""
    path = np.minimum(np.arange(4000) * 2e-5, 0.02)
    hand = zw.operators.Tracking(path, stiffness=2000, damping=0.2)
    return shown(mass, hand, 4, **options)


def test_where_the_force_changes_slowly_it_works():
    """50 g behind a mean sensor: 24 orders of magnitude alone, a microjoule with it and no limit."""
    assert touch("0.05").hand_work.min() < -1e20
    kept = touch("0.05", controller=UNLIMITED)
    assert -1e-6 < kept.hand_work.min() < 0
    assert np.abs(kept.velocity[-200:]).max() < 1e-4


def test_where_it_changes_within_a_sample_it_does_harm():
    """10 g grow faster without a limit; 50 g behind a point sensor are stable alone, and diverge with it."""
    assert touch("0.01", controller=UNLIMITED).time[-1] < 0.8
    assert "diverged_at_s" not in touch("0.01").attrs
    assert np.abs(touch("0.05", sensor="point").velocity[-200:]).max() < 1e-3
    assert "diverged_at_s" in touch("0.05", sensor="point", controller=UNLIMITED).attrs


@pytest.mark.parametrize("mass", ["1", "0.05", "0.01"])
@pytest.mark.parametrize("sensor", ["mean", "point"])
def test_by_default_none_of_these_diverges(mass, sensor):
    """With T/(2M) at most, also where there is none of it and where there is no end to it."""
    trace = touch(mass, sensor=sensor, controller=ParallelController())
    assert float(trace.time[-1]) == pytest.approx(4.0)
    assert trace.hand_work.min() > -3e-4
    assert np.abs(trace.velocity[-200:]).max() < 0.02


zigzags = st.lists(st.tuples(st.floats(-3, 1), st.sampled_from([1, -1])), min_size=2, max_size=120).map(
    lambda parts: np.array([10.0**size * sign for size, sign in parts])
)
"""Held forces of all sizes between 1 mN and 10 N, in no order [N]."""


@settings(max_examples=100, deadline=None)
@given(zigzags, st.floats(0.002, 1), zero_or(0.001, 1), zero_or(0.01, 500), st.sampled_from([1, 2, 5]))
def test_no_zigzag_takes_out_more_than_stated(newtons, mass, damping, stiffness, times):
    """By default (T²/M) Σ f̄² at most, at every sample, for every hand: twice what the body alone may leak."""
    newtons = np.tile(newtons, times)
    body = zw.simulation.VirtualBody(mass, damping, stiffness)
    for observer in ("sampled", "published"):
        work = pushed(body, newtons, ParallelController(observer=observer)).hand_work.values
        bound = T**2 / mass * np.cumsum(newtons**2)
        assert (-work[1:] <= bound * (1 + 1e-9)).all()


def test_the_same_zigzag_without_a_limit_has_no_bound():
    """Small forces, then a large one: 1 mN asks for a velocity that 1 N is held against."""
    newtons, body = np.tile([0.001, -1.0], 20), zw.simulation.VirtualBody("0.01")
    bound = T**2 / 0.01 * np.sum(newtons**2)
    assert -pushed(body, newtons, ParallelController()).hand_work.min() < bound
    assert -pushed(body, newtons, UNLIMITED).hand_work.min() > 1e30 * bound


@settings(max_examples=60, deadline=None)
@given(forces, st.floats(0.002, 1), st.floats(0.0001, 0.5), zero_or(0.001, 1), zero_or(0.01, 500))
def test_capped_before_a_soft_damper_no_hand_gains(newtons, mass, mobility, damping, stiffness):
    """1/b_s = T/2M + β_max in series with the source: W_h + Σ T f²/b_s ≥ 0 at every sample."""
    body = zw.simulation.VirtualBody(mass, damping, stiffness)
    trace = pushed(body, newtons, ParallelController(largest_mobility=mobility))
    softness = T / (2 * mass) + mobility
    total = trace.hand_work.values[1:] + softness * T * np.cumsum(newtons**2)
    assert (total >= -1e-12 * np.abs(total).max()).all()


def test_the_cap_has_its_price():
    """With 1/b_s = T/2M alone, enough without a controller, a hand gains from the capped one."""
    turns = np.tile([1.0, -1.0], 200)
    softness, body = T / (2 * 0.01), zw.simulation.VirtualBody("0.01")
    spent = softness * T * np.cumsum(turns**2)
    capped = ParallelController(largest_mobility="0.03")
    assert (pushed(body, turns).hand_work.values[1:] + spent >= -1e-15).all()
    assert pushed(body, turns, capped).hand_work.values[-1] + spent[-1] < -0.001
