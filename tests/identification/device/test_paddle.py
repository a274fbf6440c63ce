"""Mass, damping and friction from logs whose truth is known."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr
from hypothesis import given, settings
from hypothesis import strategies as st
from recordings import best_possible, hand_moves, paddle

import zwidth as zw
from zwidth.data.identification.device.identify import identify
from zwidth.data.logs import Log
from zwidth.errors import InputError
from zwidth.loop.traces.files import save_netcdf
from zwidth.quantity.exact import ends

TRUE = {"mass": 0.036, "damping": 0.15, "coulomb_friction": 0.12}
HAND = 3.0
"""[N·s/m] of a hand whose force jumps at the samples."""


def _log(recording, resolution=22.4e-6, **changes):
    arrays = {k: getattr(recording, k) for k in ("time", "position", "hand_force")}
    return Log.from_arrays(resolution=resolution, **{**arrays, **changes})


def holds(found):
    intervals = ((true, *found.estimates[name].interval(0.999)) for name, true in TRUE.items())
    return all(low < true < high for true, low, high in intervals)


@pytest.fixture(scope="module")
def recording():
    return hand_moves(paddle(), 60.0, seed=1)


@pytest.fixture(scope="module")
def found(recording):
    return identify(_log(recording))


def test_intervals_hold_and_are_short():
    """Of 40 recordings, three parameters each, 95 % intervals hold the truth nearly as often as they say.

    With 95 % of 120 expected, fewer than 104 would happen once in ten thousand times. The mean interval is
    not twice as wide as the Cramér–Rao bound allows.
    """
    held, widths = 0, []
    for seed in range(40):
        recording = hand_moves(paddle(), 20.0, seed=seed)
        estimates = identify(_log(recording)).estimates
        halves = []
        for name, true in TRUE.items():
            low, high = estimates[name].interval(0.95)
            held += low <= true <= high
            halves.append((high - low) / 2)
        widths.append(np.array(halves) / (1.96 * best_possible(recording, 0.1)))
    assert held >= 104
    assert (np.mean(widths, axis=0) < 2.0).all()


@pytest.mark.parametrize(
    ("period", "resolution"),
    [("1 ms", "224 um"), ("1 ms", "2.24 mm"), ("2 ms", "22.4 um"), ("0.2 ms", "22.4 um")],
)
def test_coarse_encoders_and_other_rates(period, resolution):
    device = paddle(sample_period=period, resolution=resolution)
    estimates = identify(
        _log(hand_moves(device, 60.0, seed=5), resolution=float(device.exact("resolution")))
    ).estimates
    for name in ("damping", "coulomb_friction"):
        low, high = estimates[name].interval(0.999)
        assert low < TRUE[name] < high
        assert high - low < (1.2 if resolution == "2.24 mm" else 0.6) * TRUE[name]


def test_the_wrong_model_is_never_silent(recording, found):
    """A mass–damper fit says a stiffness 2b/T that is not passive, makes no device, and both fits say so."""
    viscous = identify(_log(recording), model="viscous")
    assert viscous.estimates["damping"].interval(0.999)[0] > 2 * TRUE["damping"]
    assert viscous.shows("wrong model")
    for refused in (viscous.device, viscous.to_toml, lambda: viscous.confidence(zw.Wall(stiffness=1))):
        with pytest.raises(InputError, match=r"mass and a damper.*no device has them"):
            refused()
    text = next(f.text for f in found.findings if f.kind == "Coulomb friction")
    assert f"{2 * found.viscous_alone / 1e-3:.4g} N/m" in text
    assert found.viscous_alone == pytest.approx(viscous.estimates["damping"].value, rel=0.05)
    wall = zw.Wall(stiffness=2 * found.viscous_alone / 1e-3)
    assert zw.check(found.device(None), wall).outcome != "passive"


def test_the_right_model_is_not_called_wrong():
    log = _log(hand_moves(paddle(coulomb_friction=0, damping=0.5), 60.0, seed=2))
    found, viscous = identify(log), identify(log, model="viscous")
    assert not found.shows("Coulomb friction")
    assert found.shows("no coulomb friction")
    assert not viscous.shows("wrong model")
    low, high = viscous.estimates["damping"].interval(0.999)
    assert low < 0.5 < high


def test_a_force_recorded_late_is_read_in_time(recording):
    """A load cell 3.4 ms behind the encoder would make b half as large again; it is found and said."""
    late = np.interp(recording.time - 3.4e-3, recording.time, recording.hand_force)
    found = identify(_log(recording, hand_force=late))
    assert found.estimates["force_lag"].value == pytest.approx(3.4e-3, abs=4e-4)
    assert found.shows("force lag")
    assert holds(found)


def test_a_spring_is_seen_and_does_not_spoil_the_friction(recording):
    pulled = recording.hand_force + 5.0 * (recording.true_position + 1.0)
    found = identify(_log(recording, hand_force=pulled))
    assert found.estimates["spring"].value == pytest.approx(5.0, rel=0.1)
    low, high = found.estimates["damping"].interval(0.999)
    assert low < 0.15 < high


@pytest.mark.parametrize(
    ("shape", "more"),
    [("square", lambda s: 0.3 * s * s), ("saturating", lambda s: -0.06 * np.minimum(s, 1.0) ** 2)],
)
def test_what_is_proved_of_bent_friction_lies_below_it(recording, shape, more):
    v = recording.true_velocity
    speed = np.linspace(0, np.abs(v).max(), 200)
    bent = identify(_log(recording, hand_force=recording.hand_force + np.sign(v) * more(np.abs(v))))
    assert bent.shows("bent friction") or shape == "saturating"
    device = bent.device(0.99)
    f_c, b = (float(ends(getattr(device, name))[0]) for name in ("coulomb_friction", "damping"))
    assert (f_c + b * speed <= 0.12 + 0.15 * speed + more(speed)).all()
    assert min(f_c, b) > 0


def test_asymmetry_looks_like_the_zero_of_the_sensor(recording, found):
    """Friction larger by 0.04 N one way: half the difference goes into f_c, and no more can be known."""
    v = recording.true_velocity
    uneven = identify(_log(recording, hand_force=recording.hand_force + 0.04 * (v > 0)))
    more = uneven.estimates["coulomb_friction"].value - found.estimates["coulomb_friction"].value
    assert more == pytest.approx(0.02, abs=2e-3)
    assert uneven.offset - found.offset == pytest.approx(0.02, abs=4e-3)


def _motor(seed, delay=0):
    """The paddle driven by its motor alone, with a force commanded `delay` samples before it acts."""
    rng = np.random.default_rng(seed)
    time = np.arange(40_000) * 1e-3
    waves = zip(0.4 * rng.normal(size=8), rng.uniform(1, 6, 8), rng.uniform(0, 6.28, 8), strict=True)
    force = sum(a * np.sin(2 * np.pi * f * time + p) for a, f, p in waves)
    push = zw.operators.RecordedForce(force)
    trace = zw.simulate(paddle(), zw.Wall(stiffness=1), push, 40, initial_position=-9.0)
    commanded = -np.concatenate([force[delay:], np.zeros(delay)])
    position = trace["measured_position"].values[:-1]
    return Log.from_arrays(time=time, position=position, actuator_force=commanded, resolution=22.4e-6)


def test_a_motor_whose_force_is_known_needs_no_load_cell():
    """Without noise all three numbers are found to a thousandth with the delay known; unsaid, it is seen."""
    log = _motor(3, delay=2)
    found = identify(log, delay=2e-3)
    assert holds(found)
    assert {name: found.estimates[name].value for name in TRUE} == pytest.approx(TRUE, rel=2e-3)
    assert identify(log).estimates["force_lag"].value == pytest.approx(-2e-3, abs=5e-5)


def test_free_decay_with_a_known_mass():
    """The motion of sixty runs, pushed and let go, with the mass from a scale: b and f_c to a hundredth."""
    rng, runs, nobody = np.random.default_rng(7), [], zw.operators.RecordedForce(np.zeros(500))
    for _ in range(60):
        speed = rng.uniform(0.2, 1.0) * rng.choice([-1, 1])
        trace = zw.simulate(
            paddle(), zw.Wall(stiffness=1), nobody, 0.5, initial_position=-9.0, initial_velocity=speed
        )
        runs.append(trace["measured_position"].values[:-1])
    position = np.concatenate(runs)
    log = Log.from_arrays(time=np.arange(position.size) * 1e-3, position=position, resolution=22.4e-6)
    found = identify(log, mass=0.036)
    assert "mass" not in found.estimates
    for name in ("damping", "coulomb_friction"):
        low, high = found.estimates[name].interval(0.999)
        assert low < TRUE[name] < high
        assert found.estimates[name].value == pytest.approx(TRUE[name], rel=0.01)
    with pytest.raises(InputError, match="give the mass"):
        identify(log)
    apart = np.concatenate([0.7 * k + np.arange(500) * 1e-3 for k in range(60)])
    cut = Log.from_arrays(time=apart, position=position, resolution=22.4e-6)
    with pytest.raises(InputError, match="zero of the force is fitted too"):
        identify(cut, mass=0.036)
    again = identify(cut, mass=0.036, zero="exact").estimates["damping"]
    assert again.value == pytest.approx(TRUE["damping"], rel=0.01)


def test_a_hand_whose_force_is_not_logged_is_asked_for(recording):
    """Where a motor's spring pushes and nothing yields, the device would have a spring below 0."""
    log = Log.from_arrays(
        time=recording.time,
        position=recording.position,
        actuator_force=100 * recording.position,
        resolution=22.4e-6,
    )
    found = identify(log, mass=0.036)
    assert found.estimates["spring"].value < 0
    assert "a hand whose force is not in the log" in next(
        f.text for f in found.findings if f.kind == "spring"
    )


@settings(max_examples=8)
@given(st.floats(0.1, 10), st.floats(0.1, 10))
def test_units_do_not_matter(recording, found, length, force):
    scaled = {"position": recording.position * length, "hand_force": recording.hand_force * force}
    again = identify(_log(recording, resolution=22.4e-6 * length, **scaled)).estimates
    scales = {"mass": force / length, "damping": force / length, "coulomb_friction": force}
    for name, scale in scales.items():
        assert again[name].value == pytest.approx(found.estimates[name].value * scale, rel=1e-6)
        assert again[name].error == pytest.approx(found.estimates[name].error * scale, rel=1e-6)


@pytest.mark.parametrize(
    ("options", "samples", "words"),
    [
        ({"mass": -1.0}, 60_000, "mass must be > 0"),
        ({"mass": 36}, 60_000, 'write "36 g", or "36 kg"'),
        ({"delay": -1e-3}, 60_000, "delay must be ≥ 0"),
        ({"zero": "free"}, 60_000, "zero is"),
        ({"model": "stick"}, 60_000, 'model is "Coulomb and viscous" or "viscous"'),
        ({}, 600, "move to and fro"),
    ],
)
def test_what_cannot_be_identified(recording, options, samples, words):
    arrays = {k: getattr(recording, k)[:samples] for k in ("time", "position", "hand_force")}
    with pytest.raises(InputError, match=words):
        identify(Log.from_arrays(resolution=22.4e-6, **arrays), **options)


def path(seed: int) -> np.ndarray:
    """Strokes of some 5 cm within some 0.25 s, half a cosine each, 8 s at 1 kHz [m]."""
    rng = np.random.default_rng(seed)
    ends = 0.025 * (-1.0) ** np.arange(41) * np.exp(0.15 * rng.normal(size=41))
    parts = [
        a + (b - a) * (1 - np.cos(np.pi * np.arange(n) / n)) / 2
        for a, b, n in zip(ends[:-1], ends[1:], rng.integers(180, 320, 40), strict=True)
    ]
    return np.concatenate(parts)[:8001] - 1


@pytest.fixture(scope="module")
def traces() -> list[xr.Dataset]:
    """Three logs of one paddle in a hand with 300 N/m and 3 N·s/m."""
    device, found = paddle(resolution="20 um"), []
    for seed in range(3):
        hand = path(seed)
        operator = zw.operators.Tracking(hand, stiffness=300, damping=HAND)
        found.append(zw.simulate(device, zw.Wall(1), operator, 8, initial_position=hand[0]))
    return found


def test_the_force_of_a_log_is_the_mean_of_both_sides(traces, tmp_path):
    """From the path: c (ẋ_a after − ẋ_a before)/2 less than what the trace has; of a file too."""
    trace = traces[0]
    file = tmp_path / "hand.nc"
    save_netcdf(trace, file)
    speed = np.diff(path(0)) / 1e-3
    expected = trace["hand_force"].values[1:-1] - HAND * np.diff(speed) / 2
    for log in (zw.Log.from_arrays(trace), zw.read_log(file)):
        force = np.concatenate([block.hand_force for block in log.blocks()])
        assert force[1:-1] == pytest.approx(expected, abs=1e-7)
        assert any(finding.kind == "jumps" for finding in log.findings)


def test_a_damped_hand_adds_no_mass(traces):
    """The force just after each sample would make 4 % more of it, c T/2 = 1.5 g."""
    found = zw.identify(zw.Log.concatenate([zw.Log.from_arrays(trace) for trace in traces]))
    low, high = found.estimates["mass"].interval(0.999)
    assert low < TRUE["mass"] < high
    assert high - low < HAND * 1e-3 / 2
