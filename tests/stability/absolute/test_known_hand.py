"""The one-sided wall in a known hand: proved below, vibrating above, in the simulator too."""

from __future__ import annotations

import json

import numpy as np
import pytest

import zwidth as zw
from zwidth.model.operator.operator import LinearHand
from zwidth.passivity.certificate import read_document, verify_document
from zwidth.passivity.stability.absolute import (
    describing_guess,
    periodic_motion,
    replay_motion,
    smallest_motion,
    touched_plant,
)

absolute = zw.stability.absolute_stability
HAND = LinearHand(stiffness=400)


DEVICE = zw.Device(
    mass="0.04", damping="0.8", sample_period="0.001", coulomb_friction=0, resolution=0, delay=0
)


@pytest.fixture(scope="module")
def result():
    return absolute(DEVICE, HAND, motions=False)


def swing_at_the_end(stiffness, gap, start, samples=12000):
    """The swing of the last hundred samples in the simulator, for a hand tied at −gap."""
    hand = zw.operators.Tracking(np.full(samples + 1, -gap), stiffness=400, damping=0)
    wall = zw.Wall(stiffness=stiffness)
    trace = zw.simulate(DEVICE, wall, hand, samples * 0.001, initial_position=start)
    return float(np.ptp(trace.position.values[-100:]))


def test_criteria_of_the_wall(result):
    slopes = [float(row.slope) for row in result.proved]
    assert slopes == sorted(slopes)
    assert slopes[0] < 170
    assert result.linear_limit.slope / float(result.largest) - 1 < 1e-4
    assert all(row.certificate.verify() for row in result.proved)


def test_linear_limit_from_both_sides(result):
    plant = result.plant
    for factor, stable in ((1 - 1e-6, True), (1 + 1e-6, False)):
        closed = plant.denominator.copy()
        closed[-len(plant.numerator) :] += factor * result.linear_limit.slope * plant.numerator
        assert (np.abs(np.roots(closed)).max() < 1) == stable


@pytest.mark.parametrize("gap", [-0.01, 0.0, 0.01])
def test_below_what_is_proved_the_simulated_device_comes_to_rest(result, gap):
    assert swing_at_the_end(0.95 * float(result.largest), gap, 0.05) < 1e-3 * 0.05


def test_above_the_linear_limit_a_pressing_hand_vibrates(result):
    motion = periodic_motion(result.plant, 1800.0, -1.0)
    assert motion.slope > result.refuted
    assert motion.growth < 1
    trace = replay_motion(DEVICE, HAND, motion, rounds=30)
    x = trace.position.values
    expected = np.tile(motion.positions, 30) - motion.gap
    assert np.abs(x[: len(expected)] - expected).max() < 1e-9
    assert swing_at_the_end(1800.0, -0.01, 0.013) == pytest.approx(0.01 * motion.swing, rel=0.05)


def test_no_motion_is_found_where_stability_is_proved(result):
    for gap in (-1.0, 1.0):
        assert periodic_motion(result.plant, 0.99 * float(result.largest), gap) is None


def test_a_hand_off_the_wall_needs_a_far_stiffer_one(result):
    """Its first motion lies beyond five times the proved slope, repels, and the simulator plays it too."""
    motion = smallest_motion(result.plant, 9500.0, 1.0, longest=60)
    assert motion.slope > 5 * float(result.largest)
    assert motion.growth > 1
    trace = replay_motion(DEVICE, HAND, motion, rounds=2)
    expected = np.tile(motion.positions, 2) - motion.gap
    assert np.abs(trace.position.values[: len(expected)] - expected).max() < 1e-6 * motion.swing


def test_jury_lee_tends_to_the_passive_stiffness():
    """As its weight grows, Jury–Lee asks 2 Re{(z−1)G} ≥ K |(z−1)G|² of the bare device: K = 2b/T."""
    plant = touched_plant(DEVICE, LinearHand())
    angles = np.linspace(1e-3, np.pi, 20001)
    moved = (np.exp(1j * angles) - 1) * plant.response(angles)
    needs = 2 * moved.real / np.abs(moved) ** 2
    assert needs.min() == pytest.approx(2 * 0.8 / 0.001, rel=1e-4)
    assert needs.argmin() == 0


def test_jury_lee_with_a_soft_hand():
    found = absolute(DEVICE, LinearHand(stiffness=4), motions=False)
    assert float(found.slope("Jury–Lee")) == pytest.approx(1600, rel=0.01)
    assert float(found.slope("Tsypkin")) < 1000


@pytest.mark.parametrize("delay", ["0.0004", "0.001", "0.0023"])
def test_late_forces(delay):
    found = absolute(DEVICE.replace(delay=delay), HAND, motions=False)
    assert 0.98 * found.linear_limit.slope < float(found.largest) <= found.linear_limit.slope < 1606
    assert all(row.certificate.verify() for row in found.proved)


def test_describing_function_is_a_fair_guess_for_a_pressing_hand(result):
    guess = describing_guess(result.plant, 1800.0, -1.0)
    motion = periodic_motion(result.plant, 1800.0, -1.0)
    assert 2 * guess.amplitude == pytest.approx(motion.swing, rel=0.1)
    assert describing_guess(result.plant, 1500.0, -1.0) is None


def test_a_rotary_device_is_the_linear_one_in_other_units(result, tmp_path):
    """The same numbers in kg·m², N·m·s/rad and N·m/rad, and the hand as `HandImpedance`: the same slopes."""
    hand = zw.stability.HandImpedance(stiffness=400)
    turned = absolute(DEVICE.replace(motion="rotary"), hand, motions=False)
    assert [row.slope for row in turned.proved] == [row.slope for row in result.proved]
    path = tmp_path / "knob.json"
    turned.save(path)
    assert verify_document(read_document(path)).valid
    data = json.loads(path.read_text(encoding="utf-8"))
    data["certificate"]["corners"][0]["slope"] = "400"
    path.write_text(json.dumps(data))
    assert not verify_document(read_document(path)).valid


@pytest.mark.parametrize(("slope", "gap", "longest"), [(0.0, 1.0, 10), (9.0, 0.0, 10), (9.0, 1.0, 1)])
def test_motions_of_nothing_are_refused(result, slope, gap, longest):
    with pytest.raises(zw.InputError, match="must be > 0"):
        periodic_motion(result.plant, slope, gap, longest)


@pytest.mark.parametrize(
    ("plant", "hand", "words"),
    [
        (DEVICE, None, "which hand"),
        (DEVICE, LinearHand(), "spring"),
        (DEVICE, LinearHand(damping=-1, stiffness=4), "passive"),
        (DEVICE, zw.stability.HandImpedance(stiffness=(300, 400)), "interval"),
        (DEVICE, zw.stability.HandImpedance(damping=2), "needs a spring"),
        (DEVICE, "finger", "a known hand is"),
        (DEVICE.replace(mass=None), HAND, "mass"),
        (DEVICE.replace(resolution="1e-5"), HAND, "resolution"),
        (DEVICE.replace(coulomb_friction="0.1"), HAND, "coulomb_friction"),
        (DEVICE.replace(damping=0), HAND, "b \\+ c"),
        (DEVICE.replace(damping=("0.5", "0.9")), HAND, "certain"),
        (zw.PulseTransferFunction([1], [1, "-0.5"]), HAND, "leave hand out"),
        (zw.PulseTransferFunction([1], [1, -1]), None, "unit circle"),
        (zw.PulseTransferFunction([1, 1], [1, "-0.5"]), None, "fewer zeros"),
        (3, None, "expected a Device"),
    ],
)
def test_what_the_theorem_does_not_cover_is_refused(plant, hand, words):
    with pytest.raises(zw.InputError, match=words):
        absolute(plant, hand)
