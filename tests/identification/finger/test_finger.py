"""Mass, damping and stiffness of a finger, from what a shaken device records; the truth is known."""

from __future__ import annotations

import numpy as np
import pytest
from recordings import paddle
from scipy import stats
from scipy.linalg import expm
from scipy.signal import lfilter
from shaken import shaken

import zwidth as zw
from zwidth.data.identification.finger.means import weights

NAMES = ("mass", "damping", "stiffness")
FINGER = (0.006, 1.7, 500.0)
"""That of `zwidth.operators.Finger`."""


HAND = ("hand_force",)
OTHER = (0.011, 1.9, 640.0)
STEP = OTHER[0] / (OTHER[0] + 0.036)
"""Part of a step of the actuator that the hand's force makes at once."""


def identified(arrays, device=None, without=(), resolution=22.4e-6, **changed):
    options = {name: changed.pop(name) for name in set(changed) - set(arrays)}
    kept = {name: values for name, values in {**arrays, **changed}.items() if name not in without}
    log = zw.Log.from_arrays(resolution=resolution, sample_period=1e-3, **kept)
    return zw.identification.identify_finger(log, device, **options)


def holds(found, finger=FINGER, confidence=0.999):
    intervals = [found.estimates[name].interval(confidence) for name in NAMES]
    return all(low < true < high for (low, high), true in zip(intervals, finger, strict=True))


def near(found, part):
    return all(abs(found.estimates[n].value / t - 1) < part for n, t in zip(NAMES, FINGER, strict=True))


def kinds(found):
    return {finding.kind for finding in found.findings}


def later(force, samples):
    return np.concatenate([np.full(samples, force[0]), force[:-samples]])


@pytest.fixture(scope="module")
def arrays():
    return shaken(paddle(), FINGER, 20.0, seed=1)


@pytest.fixture(scope="module")
def found(arrays):
    """By the force of the hand."""
    return identified(arrays)


@pytest.fixture(scope="module")
def trembling():
    return shaken(paddle(), OTHER, 15.0, seed=11, tremor=0.05)


def test_the_finger_is_found(arrays, found):
    """Within 2 %, of which the 99.9 % intervals are a part; with the device known, without a load cell."""
    assert found.instrument == "perturbation"
    assert near(found, 0.02)
    assert holds(found)
    for name, true in zip(NAMES, FINGER, strict=True):
        low, high = found.estimates[name].interval(0.999)
        assert high - low < 0.1 * true
    assert near(identified(arrays, paddle(), HAND), 0.02)


def test_a_tenth_of_a_device_more_is_a_tenth_of_a_device_less_finger(arrays):
    """What the device is said to weigh and to brake is taken from what the actuator moves, to the digit."""
    true, heavy = (
        identified(arrays, paddle(**c), HAND).estimates for c in ({}, {"mass": 0.0365, "damping": 0.25})
    )
    difference = [true[name].value - heavy[name].value for name in NAMES]
    assert difference == [pytest.approx(0.0005, rel=1e-9), pytest.approx(0.1, rel=1e-9), 0]


def test_a_device_known_in_intervals_widens_those_of_the_finger(arrays):
    """By the half-width of its own mass and damping, and by what its friction matters."""
    wide = paddle(mass=(0.035, 0.037), damping=(0.1, 0.2), coulomb_friction=(0.1, 0.14))
    exact, loose = (identified(arrays, device, HAND).estimates for device in (paddle(), wide))
    assert loose["mass"].shift > exact["mass"].shift + 0.001
    assert loose["damping"].shift > exact["damping"].shift + 0.05
    assert loose["mass"].value == pytest.approx(exact["mass"].value, rel=0.01)


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
        estimates = identified(arrays, paddle(), () if way == "hand" else HAND).estimates
        for name, value in zip(NAMES, true, strict=True):
            low, high = estimates[name].interval()
            held += low <= value <= high
    assert held >= 38


def test_tremor_biases_positions_as_instruments_and_not_the_perturbation():
    """A finger that trembles at 10 Hz looks softer to least squares; to the perturbation it does not."""
    shaking = shaken(paddle(), FINGER, 60.0, seed=3, tremor=0.2)
    by_position, by_perturbation = (
        identified(shaking, instrument=name).estimates["stiffness"] for name in ("position", "perturbation")
    )
    assert by_position.value < 0.95 * FINGER[2]
    low, high = by_perturbation.interval(0.999)
    assert low < FINGER[2] < high
    assert abs(by_perturbation.value - FINGER[2]) < 0.5 * abs(by_position.value - FINGER[2])


def test_a_coarse_encoder_does_not_bias():
    """Ten times coarser, and the motion only some nine counts: still within 3 %."""
    coarse = shaken(paddle(resolution="224 um"), FINGER, 30.0, seed=4)
    assert near(identified(coarse, resolution=224e-6), 0.03)
    assert holds(identified(coarse, paddle(), HAND, resolution=224e-6))


def test_without_the_force_of_the_actuator_half_a_sample_is_in_the_intervals(arrays):
    """When within a sample the force stepped is not known: k T/2 for damping, c T/2 for mass."""
    found = identified(arrays, without=("actuator_force",))
    assert found.instrument == "position"
    assert found.estimates["damping"].shift > 0.95 * FINGER[2] * 1e-3 / 2
    assert found.estimates["mass"].shift > 0.95 * FINGER[1] * 1e-3 / 2
    assert kinds(found) >= {"tremor", "beyond the load cell"}
    assert holds(found)


def test_a_delayed_actuator_is_known_by_its_delay():
    """1.3 samples late and said so: the same finger, by its exact motion; not said: another one."""
    m, c, k = FINGER
    total, period = 0.036 + m, 1e-3
    system = np.zeros((3, 3))
    system[:2] = [[0, 1, 0], [-k / total, -(c + 0.15) / total, -1 / total]]
    parts = [expm(system * part * period) for part in (0.3, 0.7)]
    force = np.repeat(np.random.default_rng(5).choice([-1.0, 1.0], 2000), 10)
    state, read = np.zeros(2), []
    for n in range(force.size):
        read.append(state[0])
        for step, late in zip(parts, (2, 1), strict=True):
            state = step[:2, :2] @ state + step[:2, 2] * (force[n - late] if n >= late else 0.0)
    arrays = {"time": np.arange(force.size) * period, "position": np.floor(np.array(read) / 1e-6) * 1e-6}
    arrays["actuator_force"] = force
    device = paddle(coulomb_friction=0)
    assert near(identified(arrays, device, resolution=1e-6, delay=0.0013), 0.02)
    assert not near(identified(arrays, device, resolution=1e-6), 0.2)


def test_what_it_gives_is_what_laws_and_hands_take(found):
    finger = found.finger(force=1.0)
    assert (finger.mass, finger.damping, finger.stiffness) == tuple(found.estimates[n].value for n in NAMES)
    assert finger.force == 1.0
    for law in ("HalfSamplePrediction", "PoleMatched", "CrossingCorrection"):
        made = getattr(zw.rendering, law)(**found.model)
        assert float(made.finger_stiffness) == pytest.approx(finger.stiffness)
        assert float(made.finger_mass) == pytest.approx(finger.mass)


def test_an_interval_is_of_student_t_with_the_pieces(found):
    """80 pieces of 0.25 s: 77 degrees of freedom."""
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
    with pytest.raises(zw.InputError, match=message):
        identified(arrays, without=without, **arguments)


def test_a_finger_that_was_not_shaken_is_refused():
    with pytest.raises(zw.InputError, match="too little"):
        identified(shaken(paddle(), FINGER, 20.0, seed=6, push=0.0), paddle(), HAND)


def test_a_late_load_cell_is_refused_and_its_lateness_said(trembling):
    late, keep = later(trembling["hand_force"], 3), np.exp(-0.5)
    for without in ((), ("actuator_force",)):
        with pytest.raises(zw.InputError, match=r"recorded late, by .* ms"):
            identified(trembling, without=without, hand_force=late)
    with pytest.raises(zw.InputError, match="recorded late"):  # by its filter of the first order
        identified(trembling, hand_force=lfilter([1 - keep], [1, -keep], trembling["hand_force"]))


@pytest.mark.parametrize("without", [(), ("actuator_force",)])
def test_a_sample_late_or_read_before_the_step(trembling, without):
    """The two look alike, and the interval of the damping holds both; that of the stiffness stays as it
    was."""
    before = trembling["hand_force"] - STEP * np.diff(trembling["actuator_force"], prepend=0.0)
    plain = identified(trembling, without=without)
    for force in (later(trembling["hand_force"], 1), before):
        found = identified(trembling, without=without, hand_force=force)
        assert "late, or read before the step" in kinds(found)
        assert holds(found, OTHER, 0.99)
        assert found.estimates["damping"].shift > 0.9 * OTHER[2] * 1e-3
    assert "late, or read before the step" not in kinds(plain)
    assert holds(plain, OTHER, 0.99)


def test_the_delay_that_is_stated_tells_the_two_apart(trembling):
    """An actuator that steps just after the sample is read before its step: nothing is late then."""
    before = trembling["hand_force"] - STEP * np.diff(trembling["actuator_force"], prepend=0.0)
    found = identified(trembling, hand_force=before, delay=1e-6)
    assert "late, or read before the step" not in kinds(found)
    assert holds(found, OTHER, 0.99)


def test_with_the_device_known_a_late_load_cell_is_not_needed(trembling):
    found = identified(trembling, paddle(), hand_force=later(trembling["hand_force"], 4))
    alone = identified(trembling, paddle(), without=("hand_force",))
    assert found.estimates == alone.estimates
    assert "load cell not used" in kinds(found)


def test_a_load_cell_at_its_end_stop(trembling):
    force = trembling["hand_force"]
    middle = np.median(force)
    ends = [np.quantile(np.abs(force - middle), 1 - share) for share in (0.1, 0.002)]
    hard, little = (np.clip(force, middle - end, middle + end) for end in ends)
    with pytest.raises(zw.InputError, match="the sensor is at the end of its range"):
        identified(trembling, hand_force=hard)
    assert "load cell not used" in kinds(identified(trembling, paddle(), hand_force=hard))
    found = identified(trembling, hand_force=little)
    assert "saturated" in kinds(found)
    assert found.pieces < identified(trembling).pieces
    assert holds(found, OTHER, 0.99)


@pytest.mark.parametrize(
    ("turned", "named"),
    [
        ("hand_force", "hand force"),
        ("actuator_force", "actuator force"),
        ("position", "hand force and actuator force"),
    ],
)
def test_the_sign_that_is_turned_round_is_named(trembling, turned, named):
    """No finger pushes the harder the more it is moved away; what to type stands in the message."""
    with pytest.raises(zw.InputError, match=f"sign of the {named} looks") as error:
        identified(trembling, **{turned: -trembling[turned]})
    assert '": "-1"}' in str(error.value)


@pytest.mark.parametrize("factor", [1e3, 1e-3])
def test_units_that_are_off_by_a_thousand(trembling, factor):
    force = factor * trembling["hand_force"]
    with pytest.raises(zw.InputError, match="the two forces are not of one finger"):
        identified(trembling, hand_force=force)
    with pytest.raises(zw.InputError, match="most likely a unit is off by 1000"):
        identified(trembling, without=("actuator_force",), hand_force=force)


def test_holes_cost_pieces_and_nothing_else(trembling):
    kept = np.ones(trembling["time"].size, dtype=bool)
    kept[4000:4400] = kept[9100:9500] = False
    found = identified({name: values[kept] for name, values in trembling.items()})
    assert "gap" in kinds(found)
    assert holds(found, OTHER, 0.99)
    assert 50 < found.pieces < 60


def test_a_zero_that_drifts_changes_nothing(trembling):
    drift = np.linspace(0.0, 2.0, trembling["time"].size)
    plain, drifting = identified(trembling), identified(trembling, hand_force=trembling["hand_force"] + drift)
    for name in NAMES:
        assert drifting.estimates[name].value == pytest.approx(plain.estimates[name].value, rel=1e-6)


def _motion(rng, samples, fine):
    """A motion under a force held over each sample, as read, and as it is between."""
    acceleration = rng.normal(size=samples)
    v = np.concatenate([[0.3], 0.3 + np.cumsum(acceleration)])
    x = np.concatenate([[0.7], 0.7 + np.cumsum((v[:-1] + v[1:]) / 2)])
    u = (np.arange(fine) + 0.5) / fine
    inside_v = v[:-1, None] + acceleration[:, None] * u
    inside_x = x[:-1, None] + v[:-1, None] * u + acceleration[:, None] * u * u / 2
    return acceleration, x, inside_v, inside_x, u


@pytest.mark.parametrize("piece", [4, 10])
def test_sums_are_the_integrals_of_a_held_motion(piece):
    """∫φẍ and ∫φx to rounding of the integration by midpoints; ∫φẋ to the part that smoothness leaves."""
    rng = np.random.default_rng(piece)
    shape = weights(piece, 0.0)
    samples = 2 * shape.reach
    acceleration, x, inside_v, inside_x, u = _motion(rng, samples, 400)
    at = np.arange(samples)[:, None] + u
    place = np.arange(samples + 1)
    # the pulse is the force's weights with their correction undone: solve δ²/12 + 1
    matrix = np.eye(samples + 1) * (10 / 12) + (np.eye(samples + 1, k=1) + np.eye(samples + 1, k=-1)) / 12
    pulse = np.interp(at, place, np.linalg.solve(matrix, shape.force))
    integral = lambda values: (pulse * values).mean(axis=1).sum()  # noqa: E731
    assert shape.motion[0] @ x == pytest.approx(integral(acceleration[:, None] + 0 * u), abs=1e-5)
    assert shape.motion[2] @ x == pytest.approx(integral(inside_x), abs=1e-5)
    assert shape.motion[1] @ x == pytest.approx(integral(inside_v), abs=0.02)


@pytest.mark.parametrize("delay", [0.0, 0.4, 1.0, 2.7])
def test_held_forces_count_from_when_they_act(delay):
    """The weights of a held force are the pulse's parts of the time from its instant to the next one's."""
    shape = weights(6, delay)
    assert shape.held.sum() == pytest.approx(1.0, abs=1e-12)
    centre = np.arange(-shape.reach - shape.lag, shape.reach + 1) + delay + 0.5
    assert shape.held @ centre == pytest.approx(0.0, abs=1e-12)
    assert shape.steps.sum() == pytest.approx(0.0, abs=1e-12)
    assert shape.steps @ centre == pytest.approx(1.0, abs=1e-12)


def test_the_samples_of_either_parity_see_the_same_motion():
    """Cubics come out alike from the even and from the odd samples."""
    shape = weights(8, 0.0)
    k = np.arange(-shape.reach, shape.reach + 1)
    for power in range(4):
        for column in shape.motion:
            halves = [2 * (column * k.astype(float) ** power)[(k & 1) == parity].sum() for parity in (0, 1)]
            assert halves[0] == pytest.approx(halves[1], abs=1e-9)
