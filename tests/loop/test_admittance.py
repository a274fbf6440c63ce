"""The display of admittance in time: by arithmetic of many digits, by its ledger, in other units."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from mpmath import mp, mpf
from strategies import zero_or

import zwidth as zw
from zwidth.model.rendering import ParallelController

MASS = mpf("0.03")

CONTROLLERS = {
    "none": None,
    "sampled": {},
    "unlimited": {"largest_mobility": "unlimited"},
    "published": {"observer": "published"},
    "published, unlimited": {"observer": "published", "largest_mobility": "unlimited"},
    "capped": {"largest_mobility": "0.03", "largest_velocity": "0.002"},
    "forgets": {"resets": True, "weakest": "0.05", "ceiling": "0.00001"},
}


BODY, PUSH = zw.simulation.VirtualBody(1), zw.operators.ConstantForce(1.0)


def run(body=BODY, hand=PUSH, duration=1, **options):
    return zw.simulation.simulate_admittance(body, hand, duration, **{"sample_period": "0.001", **options})


def anchor_path(samples):
    """A reach and a wobble that never repeats, as decimals [m]."""
    k = np.arange(samples + 1)
    return [f"{v:.7f}" for v in 0.004 * (1 - np.exp(-k / 9.0)) + 0.0015 * np.sin(0.9 * k + 0.1 * k * k / 40)]


def plain(body, path, k, c, period, sensor, rules):
    """The loop once more in 60 digits; the port's energy by Simpson's rule, exact for a parabola."""
    mass, damping, stiffness = MASS, mpf("0.07"), mpf(11)
    path = [mpf(v) for v in path]
    x = y = path[0]
    own = held = work = energy = mpf(0)
    reading = before = pushed = mpf(0)
    for n, (here, there) in enumerate(pairwise([*path, 2 * path[-1] - path[-2]])):
        slope = (there - here) / period
        if body.integration == "explicit":
            own += period * pushed / mass if n else 0
            pushed = reading - damping * own - stiffness * y
        else:
            pull = period * (reading - stiffness * y)
            own = (mass * own + pull) / (mass + damping * period + stiffness * period**2)
        held, energy = controlled(rules, energy, reading, before, held, own, period)
        before = reading
        yield x, held, own, reading, work, energy

        def force(t, x=x, here=here, slope=slope, held=held):
            return k * (here + slope * t - x - held * t) + c * (slope - held)

        ends = force(mpf(0)) + force(period)
        work += period * held * (ends + 4 * force(period / 2)) / 6
        reading = ends / 2 if sensor == "mean" else force(period)
        x, y = x + period * held, y + period * own


def controlled(rules, energy, reading, before, held, own, period):
    """What the controller's docstring says, with its options by name."""
    if rules is None:
        return own, energy + period * reading * held
    published = rules.get("observer") == "published"
    energy += period * (before if published else reading) * held
    weakest = mpf(rules.get("weakest", 0))
    if rules.get("resets") and abs(reading) <= weakest:
        energy = mpf(0)
    if "ceiling" in rules:
        energy = min(energy, mpf(rules["ceiling"]))
    lack = -energy - period * reading * own
    if lack <= 0 or abs(reading) <= weakest:
        return own, energy
    mobility = lack / (period * reading**2)
    largest = rules.get("largest_mobility", period / (2 * MASS))
    if largest != "unlimited":
        mobility = min(mobility, mpf(largest))
    if "largest_velocity" in rules:
        mobility = min(mobility, mpf(rules["largest_velocity"]) / abs(reading))
    return own + mobility * reading, energy


@pytest.mark.parametrize("integration", ["implicit", "explicit"])
@pytest.mark.parametrize("sensor", ["mean", "point"])
@pytest.mark.parametrize("name", CONTROLLERS)
def test_it_does_what_a_plain_loop_does(name, sensor, integration):
    mp.dps = 60
    rules, period = CONTROLLERS[name], mpf("0.002")
    body = zw.simulation.VirtualBody("0.03", "0.07", "11", integration)
    path = anchor_path(60)
    trace = zw.simulation.simulate_admittance(
        body,
        zw.operators.Tracking([float(v) for v in path], stiffness=90, damping=0.4),
        "0.12",
        sample_period="0.002",
        sensor=sensor,
        controller=None if rules is None else ParallelController(**rules),
    )
    exact = np.array(list(plain(body, path, 90, mpf("0.4"), period, sensor, rules)), dtype=float).T
    names = ("position", "velocity", "body_velocity", "measured_force", "hand_work", "observed_energy")
    for key, row in zip(names, exact, strict=True):
        np.testing.assert_allclose(trace[key], row, rtol=1e-9, atol=1e-11 * np.abs(row).max())


@settings(max_examples=40, deadline=None)
@given(
    st.lists(st.integers(-100, 100).map(lambda n: n / 1e4), min_size=2, max_size=40),
    zero_or(0.1, 5000),
    zero_or(0.001, 5),
    st.floats(0.001, 2),
    st.sampled_from(["mean", "point"]),
    st.sampled_from(sorted(CONTROLLERS)),
)
def test_the_hands_ledger_closes(path, stiffness, damping, mass, sensor, name):
    rules = CONTROLLERS[name]
    hand = zw.operators.Tracking(path, stiffness=stiffness, damping=damping)
    controller = None if rules is None else ParallelController(**rules)
    trace = run(zw.simulation.VirtualBody(mass), hand, 0.04, sensor=sensor, controller=controller)
    spring = trace.hand_spring_energy - trace.hand_spring_energy[0]
    rest = trace.hand_source_work - trace.hand_work - spring - trace.hand_damper_loss
    moved = sum(np.abs(trace[key]).max() for key in ("hand_source_work", "hand_work")) + np.abs(spring).max()
    assert float(np.abs(rest).max()) <= 1e-12 * float(moved + trace.hand_damper_loss[-1])


def test_a_pushed_mass():
    """F on M alone: implicit, u_k = k F T/M with the reading of the interval before; W_h by hand."""
    trace = run(zw.simulation.VirtualBody("0.4"), zw.operators.ConstantForce(3.0), "0.005")
    steps = np.arange(6)
    np.testing.assert_allclose(trace.velocity, steps * 3.0 * 0.001 / 0.4, rtol=1e-14)
    np.testing.assert_allclose(trace.hand_work, 9.0 * 1e-6 / 0.4 * steps * (steps - 1) / 2, rtol=1e-13)
    assert trace.hand_work.attrs["units"] == "J"


@pytest.mark.parametrize("scale", [(1e-3, 1.0, 1.0), (1.0, 1e-3, 1.0), (10.0, 100.0, 0.1)])
def test_other_units_change_nothing(scale):
    def run(le, fo, ti):
        trace = zw.simulation.simulate_admittance(
            zw.simulation.VirtualBody(0.05 * fo * ti**2 / le, 0.02 * fo * ti / le, 3 * fo / le),
            zw.operators.Tracking(
                [0.0, 0.002 * le, 0.003 * le], stiffness=700 * fo / le, damping=0.1 * fo * ti / le
            ),
            0.1 * ti,
            sample_period=0.001 * ti,
            controller=ParallelController(largest_mobility=0.05 * le / ti / fo, weakest=0.001 * fo),
        )
        return trace.position / le, trace.hand_force / fo, trace.hand_work / (le * fo)

    for own, other in zip(run(1, 1, 1), run(*scale), strict=True):
        np.testing.assert_allclose(other.values, own.values, rtol=1e-6, atol=1e-9 * np.abs(own).max())


def test_a_motion_without_bound_ends_the_record():
    stiff = zw.operators.Tracking([0, 0.001], stiffness=20_000, damping=2)
    trace = run(zw.simulation.VirtualBody("0.001"), stiff, 2)
    assert trace.attrs["diverged_at_s"] == float(trace.time[-1]) < 2
    assert all(np.isfinite(trace[key]).all() for key in trace)


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (lambda: zw.simulation.VirtualBody(0), "mass must be > 0, got 0: a body without mass follows"),
        (lambda: zw.simulation.VirtualBody(1, damping=-1), "damping must be ≥ 0"),
        (lambda: zw.simulation.VirtualBody(1, stiffness="-2"), "stiffness must be ≥ 0"),
        (lambda: zw.simulation.VirtualBody(float("nan")), "mass is in kg: expected a finite number"),
        (lambda: zw.simulation.VirtualBody(1, integration="euler"), "integration is one of 'implicit', 'ex"),
        (lambda: run(body=zw.Wall(1)), "body is a zwidth.simulation.VirtualBody, got Wall"),
        (lambda: run(hand="finger"), "operator is a hand"),
        (lambda: run(hand=zw.operators.Finger()), "give mass=0"),
        (lambda: run(hand=zw.operators.PrescribedMotion([0, 1])), "prescribes the motion"),
        (lambda: run(hand=zw.operators.RecordedForce([1.0])), "recorded force has 1 values"),
        (lambda: run(duration=0), "duration must be > 0"),
        (lambda: run(duration="0.0001"), "one sample period"),
        (lambda: run(sample_period=0), "sample_period must be > 0"),
        (lambda: run(sensor="load cell"), "sensor is one of 'mean', 'point'"),
        (lambda: run(controller=zw.rendering.PassivityController()), "got PassivityController"),
    ],
)
def test_what_it_refuses(make, said):
    with pytest.raises(zw.InputError, match=said):
        make()
