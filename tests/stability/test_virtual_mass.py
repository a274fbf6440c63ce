"""How light a virtual body may be: by eigenvalues, by simulation, and by the wall that is its dual."""

from __future__ import annotations

from itertools import product
from math import inf

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

import zwidth as zw

masses_of = zw.stability.stable_virtual_masses
COMBINATIONS = list(product(["implicit", "explicit"], ["mean", "point"]))


def growth(mass, k, c, period, body_damping, body_stiffness, integration, sensor):
    """The largest factor per sample: of the matrix that takes x, x⁻, u⁻, φ⁻ and the body on by a sample.

    The reading is written as what the sensor does, not with the γ of the formulas.
    """

    def step(state):
        x, x_old, u_old, last = state
        mean = -k * (x + x_old) / 2 - c * u_old
        reading = mean if sensor == "mean" else -k * x - c * u_old
        if integration == "explicit":
            u = u_old + period / mass * (last - body_damping * u_old - body_stiffness * x_old)
        else:
            effective = mass + body_damping * period + body_stiffness * period**2
            u = (mass * u_old + period * (reading - body_stiffness * x)) / effective
        return [x + period * u, x, u, reading]

    matrix = np.array([step(row) for row in np.eye(4)]).T
    return np.abs(np.linalg.eigvals(matrix)).max()


@settings(max_examples=100, deadline=None)
@given(
    st.sampled_from(COMBINATIONS),
    st.floats(-2, 4).map(lambda e: 10**e),
    st.sampled_from([0.0, 0.02, 0.3, 4.0]),
    st.sampled_from([0.0, 0.05, 1.0, 9.0]),
    st.sampled_from([0.0, 30.0, 2000.0]),
    st.floats(-6, 2).map(lambda e: 10**e),
)
def test_it_is_where_the_eigenvalues_say(how, k, c, body_damping, body_stiffness, mass):
    integration, sensor = how
    factor = growth(mass, k, c, 0.001, body_damping, body_stiffness, *how)
    assume(abs(factor - 1) > 1e-6)
    body = {"body_damping": body_damping, "body_stiffness": body_stiffness}
    masses = masses_of(k, c, "0.001", **body, integration=integration, sensor=sensor)
    assert (masses is not None and masses[0] < mass < masses[1]) is bool(factor < 1)


@pytest.mark.parametrize(
    ("k", "c", "options", "lightest"),
    [
        (20_000, 2, {"sensor": "point"}, "0.006"),
        (20_000, 2, {"sensor": "point", "body_damping": "0.4", "body_stiffness": 3000}, "0.00505"),
        (20_000, "9.999", {}, None),
        (20_000, 10, {}, "0.005"),
        (500, "0.5", {"sensor": "point", "integration": "explicit"}, None),
        (500, "0.6", {"sensor": "point", "integration": "explicit"}, "0.0036"),
    ],
)
def test_by_hand(k, c, options, lightest):
    """(k − K) T²/4 + (c − B) T/2 for a point sensor; a mean one takes off k T²/4 and asks for c ≥ k T/2."""
    assert masses_of(k, c, "0.001", **options) == (lightest and (zw.Exact(lightest), inf))


def test_a_heavier_body_may_be_worse():
    how = {"body_damping": 9, "integration": "explicit", "sensor": "mean"}
    low, high = masses_of(8000, "0.5", "0.001", **how)
    assert high < inf
    masses = (low * 0.999, low * 1.001, high * 0.999, high * 1.001)
    factors = [growth(mass, 8000, 0.5, 0.001, 9, 0, "explicit", "mean") for mass in masses]
    assert [factor < 1 for factor in factors] == [False, True, True, False]


@pytest.mark.parametrize(
    ("k", "c", "options"),
    [
        (20_000, 2, {"sensor": "point"}),
        (20_000, 12, {"sensor": "mean"}),
        (900, "0.2", {"sensor": "point", "body_damping": "0.3", "body_stiffness": 50}),
        (500, "0.6", {"sensor": "point", "integration": "explicit"}),
    ],
)
def test_both_sides_in_a_simulation(k, c, options):
    low, _ = masses_of(k, c, "0.001", **options)
    hand = zw.operators.Tracking([0, 0.001], stiffness=float(k), damping=float(c))
    body = {key[5:]: value for key, value in options.items() if key.startswith("body_")}
    body["integration"] = options.get("integration", "implicit")
    for factor, grows in ((1.01, False), (0.99, True)):
        light = zw.simulation.VirtualBody(float(low) * factor, **body)
        sampled = {"sample_period": "0.001", "sensor": options["sensor"]}
        trace = zw.simulation.simulate_admittance(light, hand, 3, **sampled)
        early, late = (np.abs(trace.velocity[a:b]).max() for a, b in ((20, 120), (-100, None)))
        assert bool(late > early) is grows


@pytest.mark.parametrize(("mass", "damper"), [("0.0005", 1), ("0.02", 40), ("0.0123", "24.6")])
def test_the_dual_of_a_wall(mass, damper):
    """A mass with a series damper b_s is the wall 1/M on a device of 1/b_s: passive exactly if b_s ≤ 2M/T."""

    def check(b_s):
        device = zw.Device(damping=1 / b_s.fraction, coulomb_friction=0, resolution=0, sample_period="0.001")
        return zw.check(device, zw.Wall(1 / zw.Exact(mass).fraction))

    limit = zw.Exact(damper)
    assert limit.fraction == 2 * zw.Exact(mass).fraction * 1000
    assert check(limit).outcome == "passive"
    harder = zw.Exact(limit.fraction * 101 / 100)
    witness = check(harder).witness
    momentum = np.array([0.0, *map(float, witness.motion.positions)])
    newtons = np.diff(momentum) / 0.001
    body, hand, duration = (
        zw.simulation.VirtualBody(mass),
        zw.operators.RecordedForce(newtons),
        len(newtons) * 0.001,
    )
    trace = zw.simulation.simulate_admittance(body, hand, duration, sample_period="0.001")
    total = float(trace.hand_work[-1]) + 0.001 * float(np.sum(newtons**2)) / float(harder)
    assert total == pytest.approx(-witness.energy, rel=1e-9)
    assert total < 0


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"stiffness": 0}, "stiffness must be > 0"),
        ({"damping": -1}, "damping must be ≥ 0"),
        ({"sample_period": 0}, "sample_period must be > 0"),
        ({"body_damping": -1}, "body_damping must be ≥ 0"),
        ({"body_stiffness": -1}, "body_stiffness must be ≥ 0"),
        ({"integration": "tustin"}, "integration is one of"),
        ({"sensor": "none"}, "sensor is one of"),
    ],
)
def test_what_it_refuses(given, said):
    with pytest.raises(zw.InputError, match=said):
        masses_of(**{"stiffness": 1, "damping": 1, "sample_period": 1, **given})
