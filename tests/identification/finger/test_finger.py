"""Mass, damping and stiffness of a finger, from what a shaken device records; the truth is known."""

from __future__ import annotations

import numpy as np
import pytest
from recordings import paddle
from scipy import stats
from scipy.linalg import expm
from shaken import shaken

import zwidth as zw

NAMES = ("mass", "damping", "stiffness")
FINGER = (0.006, 1.7, 500.0)
"""That of `zwidth.operators.Finger`."""


def _log(arrays, *without, resolution=22.4e-6):
    kept = {name: values for name, values in arrays.items() if name not in without}
    return zw.Log.from_arrays(resolution=resolution, sample_period=1e-3, **kept)


def _near(found, true, part):
    return all(abs(found.estimates[n].value / t - 1) < part for n, t in zip(NAMES, true, strict=True))


@pytest.fixture(scope="module")
def arrays():
    """Twenty seconds."""
    return shaken(paddle(), FINGER, 20.0, seed=1)


def test_the_finger_is_found_by_the_force_of_the_hand(arrays):
    """Within 2 %, of which the 99.9 % intervals are a part."""
    found = zw.identification.identify_finger(_log(arrays))
    assert found.instrument == "perturbation"
    assert _near(found, FINGER, 0.02)
    for name, true in zip(NAMES, FINGER, strict=True):
        low, high = found.estimates[name].interval(0.999)
        assert low < true < high
        assert high - low < 0.1 * true


def test_the_finger_is_found_by_the_force_of_the_actuator(arrays):
    """With the device known, Coulomb friction and all, no load cell is needed."""
    found = zw.identification.identify_finger(_log(arrays, "hand_force"), paddle())
    assert _near(found, FINGER, 0.02)


def test_a_tenth_of_a_device_more_is_a_tenth_of_a_device_less_finger(arrays):
    """What the device is said to weigh and to brake is taken from what the actuator moves, to the digit."""
    log = _log(arrays, "hand_force")
    true, heavy = (
        zw.identification.identify_finger(log, paddle(**c)) for c in ({}, {"mass": 0.0365, "damping": 0.25})
    )
    difference = {n: true.estimates[n].value - heavy.estimates[n].value for n in NAMES}
    assert difference["mass"] == pytest.approx(0.0005, rel=1e-9)
    assert difference["damping"] == pytest.approx(0.1, rel=1e-9)
    assert difference["stiffness"] == 0


def test_a_device_known_in_intervals_widens_those_of_the_finger(arrays):
    """By the half-width of its own mass and damping, and by what its friction matters."""
    log = _log(arrays, "hand_force")
    exact = zw.identification.identify_finger(log, paddle())
    loose = zw.identification.identify_finger(
        log, paddle(mass=(0.035, 0.037), damping=(0.1, 0.2), coulomb_friction=(0.1, 0.14))
    )
    assert loose.estimates["mass"].shift > exact.estimates["mass"].shift + 0.001
    assert loose.estimates["damping"].shift > exact.estimates["damping"].shift + 0.05
    assert loose.estimates["mass"].value == pytest.approx(exact.estimates["mass"].value, rel=0.01)


@pytest.mark.parametrize("way", ["hand", "actuator"])
def test_intervals_hold_the_truth(way):
    """Of 15 fingers that tremble, three numbers each, 95 % intervals hold the truth as often as they say.

    With 43 of 45 expected, fewer than 38 would happen once in several hundred times.
    """
    rng = np.random.default_rng(7)
    held = 0
    for seed in range(15):
        true = rng.uniform(0.003, 0.015), rng.uniform(0.5, 4.0), rng.uniform(150, 1200)
        arrays = shaken(paddle(), true, 15.0, seed, tremor=0.05)
        log = _log(arrays, *(() if way == "hand" else ("hand_force",)))
        estimates = zw.identification.identify_finger(log, paddle()).estimates
        for name, value in zip(NAMES, true, strict=True):
            low, high = estimates[name].interval()
            held += low <= value <= high
    assert held >= 38


def test_tremor_biases_positions_as_instruments_and_not_the_perturbation():
    """A finger that trembles at 10 Hz looks softer to least squares; to the perturbation it does not."""
    arrays = shaken(paddle(), FINGER, 60.0, seed=3, tremor=0.2)
    log = _log(arrays)
    by_position, by_perturbation = (
        zw.identification.identify_finger(log, instrument=instrument).estimates["stiffness"]
        for instrument in ("position", "perturbation")
    )
    assert by_position.value < 0.95 * FINGER[2]
    low, high = by_perturbation.interval(0.999)
    assert low < FINGER[2] < high
    assert abs(by_perturbation.value - FINGER[2]) < 0.5 * abs(by_position.value - FINGER[2])


def test_a_coarse_encoder_does_not_bias():
    """Ten times coarser, and the motion only some nine counts: still within 3 %."""
    arrays = shaken(paddle(resolution="224 um"), FINGER, 30.0, seed=4)
    assert _near(zw.identification.identify_finger(_log(arrays, resolution=224e-6)), FINGER, 0.03)
    found = zw.identification.identify_finger(_log(arrays, "hand_force", resolution=224e-6), paddle())
    for name, true in zip(NAMES, FINGER, strict=True):
        low, high = found.estimates[name].interval(0.999)
        assert low < true < high


def test_without_the_force_of_the_actuator_half_a_sample_is_in_the_intervals(arrays):
    """When within a sample the force stepped is not known: k T/2 for damping, c T/2 for mass."""
    found = zw.identification.identify_finger(_log(arrays, "actuator_force"))
    assert found.instrument == "position"
    assert found.estimates["damping"].shift > 0.95 * FINGER[2] * 1e-3 / 2
    assert found.estimates["mass"].shift > 0.95 * FINGER[1] * 1e-3 / 2
    assert {"tremor", "beyond the load cell"} <= {finding.kind for finding in found.findings}
    for name, true in zip(NAMES, FINGER, strict=True):
        low, high = found.estimates[name].interval(0.999)
        assert low < true < high


def test_a_delayed_actuator_is_known_by_its_delay():
    """1.3 samples late and said so: the same finger; not said: another one."""
    log = _late(np.random.default_rng(5))
    device = paddle(coulomb_friction=0)
    assert _near(zw.identification.identify_finger(log, device, delay=0.0013), FINGER, 0.02)
    assert not _near(zw.identification.identify_finger(log, device), FINGER, 0.2)


def _late(rng):
    """Steps of the actuator, 1.3 samples after their own, and the exact motion without Coulomb friction."""
    m, c, k = FINGER
    total, period = 0.036 + m, 1e-3
    system = np.zeros((3, 3))
    system[:2] = [[0, 1, 0], [-k / total, -(c + 0.15) / total, -1 / total]]
    parts = [expm(system * part * period) for part in (0.3, 0.7)]
    force = np.repeat(rng.choice([-1.0, 1.0], 2000), 10)
    state, read = np.zeros(2), []
    for n in range(force.size):
        read.append(state[0])
        for step, late in zip(parts, (2, 1), strict=True):
            state = step[:2, :2] @ state + step[:2, 2] * (force[n - late] if n >= late else 0.0)
    arrays = {"time": np.arange(force.size) * period, "position": np.floor(np.array(read) / 1e-6) * 1e-6}
    return _log({**arrays, "actuator_force": force}, resolution=1e-6)


def test_what_it_gives_is_what_laws_and_hands_take(arrays):
    """A finger to simulate, and the model of a law that predicts, with the numbers that were found."""
    found = zw.identification.identify_finger(_log(arrays))
    finger = found.finger(force=1.0)
    assert (finger.mass, finger.damping, finger.stiffness) == tuple(found.estimates[n].value for n in NAMES)
    assert finger.force == 1.0
    for law in (
        zw.rendering.HalfSamplePrediction,
        zw.rendering.PoleMatched,
        zw.rendering.CrossingCorrection,
    ):
        made = law(**found.model)
        assert float(made.finger_stiffness) == pytest.approx(finger.stiffness)
        assert float(made.finger_mass) == pytest.approx(finger.mass)


def test_an_interval_is_of_student_t_with_the_pieces(arrays):
    """80 pieces of 0.25 s: 77 degrees of freedom."""
    found = zw.identification.identify_finger(_log(arrays))
    assert found.pieces == 80
    e = found.estimates["stiffness"]
    reach = stats.t.ppf(0.975, 77) * e.error + e.shift
    assert e.interval()[1] == pytest.approx(e.value + reach)


@pytest.mark.parametrize(
    ("without", "arguments", "message"),
    [
        (("hand_force", "actuator_force"), {}, "no force"),
        (("hand_force",), {}, "device"),
        (("hand_force",), {"device": zw.Device(damping=0.1, sample_period="1 ms")}, "mass"),
        ((), {"device": zw.Device(damping=1, mass=1, sample_period="1 ms", motion="rotary")}, "rotary"),
        (("actuator_force",), {"instrument": "perturbation"}, "no force of the actuator"),
        ((), {"instrument": "tremor"}, "instrument is"),
        ((), {"piece": 0.005}, "piece"),
        ((), {"piece": 60.0}, "run of"),
        ((), {"piece": 6.0}, "too little"),
        ((), {"delay": -1e-3}, "delay"),
    ],
)
def test_bad_input_is_refused(arrays, without, arguments, message):
    """One message says what cannot be identified."""
    with pytest.raises(zw.InputError, match=message):
        zw.identification.identify_finger(_log(arrays, *without), **arguments)


def test_a_finger_that_was_not_shaken_is_refused():
    """A finger that only wanders shows nothing, or that nothing was seen."""
    arrays = shaken(paddle(), FINGER, 20.0, seed=6, push=0.0)
    with pytest.raises(zw.InputError, match="too little"):
        zw.identification.identify_finger(_log(arrays, "hand_force"), paddle())
