"""A motor that shakes a handle on a cable: both sides are told apart, and walls rest on the motor's."""

from __future__ import annotations

from collections.abc import Callable
from math import pi, sin

import numpy as np
import pytest
from scipy.linalg import expm

import zwidth as zw

PERIOD, STEP, FINE = 1e-3, 22.4e-6, 20
MOTOR = {"mass": 0.03, "damping": 0.06, "coulomb_friction": 0.02}
BETWEEN = {
    "stiffness": (2 * pi * 60) ** 2 * 0.03,
    "damping": 0.05,
    "handle_mass": 0.03,
    "handle_damping": 0.09,
    "handle_coulomb_friction": 0.03,
}


def shaken(stiffness: float, more: Callable[[float], float] = lambda x: 0.0) -> zw.Log:
    """Twelve seconds; `more` is a force by place that nobody logs.

    Exact but for dry friction, which is steep around rest, so that nothing has to stick.
    """
    rng, samples = np.random.default_rng(4), 12_000
    m, b, f = MOTOR.values()
    _, c, o, h, g = BETWEEN.values()
    rates = np.zeros((6, 6))
    rates[0, 1] = rates[2, 3] = 1.0
    rates[1] = np.array([-stiffness, -b - c, stiffness, c, -1, 0]) / m
    rates[3] = np.array([stiffness, c, -stiffness, -c - h, 0, -1]) / o
    rows = [list(map(float, row)) for row in expm(rates * PERIOD / FINE)[:4]]
    noise = np.repeat(rng.normal(size=samples // 2), 2)
    state = [0.0] * 4
    read, force = np.empty(samples), np.empty(samples)
    for i in range(samples):
        read[i] = STEP * np.floor(state[0] / STEP)
        force[i] = noise[i] + 20 * (read[i] - 0.04 * sin(6.0 * i * PERIOD) - 0.03 * sin(11.0 * i * PERIOD))
        for _ in range(FINE):
            dry = [size * max(-1.0, min(1.0, state[at] / 1e-4)) for at, size in ((1, f), (3, g))]
            full = [*state, float(force[i]) + dry[0] + more(state[0]), dry[1]]
            state = [sum(a * z for a, z in zip(row, full, strict=True)) for row in rows]
    return zw.Log.from_arrays(
        time=np.arange(samples) * PERIOD, position=read, actuator_force=force, resolution=STEP
    )


@pytest.fixture(scope="module")
def found() -> zw.identification.Identified:
    return zw.identify(shaken(BETWEEN["stiffness"]))


def test_both_sides_and_the_cable_are_found(found):
    for name, true in MOTOR.items():
        low, high = found.estimates[name].interval(0.9999)
        assert low <= true <= high, name
    for name, true in BETWEEN.items():
        low, high = found.cable.between[name].interval(0.9999)
        assert low <= true <= high, name
    assert not found.as_one
    assert found.cable.resonance == pytest.approx(60 * 2**0.5, rel=1e-3)


def test_a_wall_rests_on_what_the_motor_feels_whatever_the_hand_does(found):
    b, c, h = MOTOR["damping"], BETWEEN["damping"], BETWEEN["handle_damping"]
    assert 0.8 * (b + c * h / (c + h)) < found.least_damping(0.99) < b + c * h / (c + h)
    device = found.device()
    assert (
        zw.check(device, zw.Wall(stiffness=2 * found.least_damping(0.99) / PERIOD * 0.99)).outcome
        == "passive"
    )
    assert found.confidence(zw.Wall(stiffness=2 * (b + h) / PERIOD * 0.9)) == 0


def test_the_file_has_the_cable(found, tmp_path):
    found.save(tmp_path / "device.toml")
    again = zw.load(tmp_path / "device.toml").device
    assert set(again.transmission.parameters()) == set(BETWEEN)
    assert [finding.kind for finding in found.findings].count("two masses") == 1
    assert {"stiffness_N_per_m", "handle_mass_kg"} < set(found.to_dict()["transmission"])


def test_one_mass_stays_one():
    one = zw.identify(shaken((2 * pi * 3000) ** 2 * 0.015))
    assert one.cable is None
    assert not one.as_one
    assert one.device().transmission is None


def test_what_two_masses_do_not_explain_either_is_said():
    odd = zw.identify(shaken(BETWEEN["stiffness"], lambda x: 0.5 * sin(2 * pi * x / 0.004)))
    assert odd.shows("not one mass")
    assert odd.cable is None
    assert odd.least_damping(0.99) == 0
