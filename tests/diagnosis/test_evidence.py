"""The numbers of a diagnosis, each against another road: integrals in small steps, closed forms."""

from __future__ import annotations

import numpy as np
import pytest

from zwidth.data.diagnosis import drive, law, vibration
from zwidth.data.diagnosis.evidence import Evidence, gather
from zwidth.data.diagnosis.reason import doubt
from zwidth.data.diagnosis.recording import Recording, Told, read_of_table
from zwidth.data.logs.table import Table, in_pieces
from zwidth.model.device import Device

PERIOD = 1 / 800
FREQUENCY = 23.7
RNG = np.random.default_rng(11)


def shaken(seconds: float = 1.5, amplitude: float = 0.004, drift: float = 0.002) -> np.ndarray:
    t = np.arange(round(seconds / PERIOD)) * PERIOD
    w = 2 * np.pi * FREQUENCY
    return amplitude * (np.sin(w * t + 0.4) + 0.07 * np.sin(3 * w * t + 1.1)) + drift * t


def held(values: np.ndarray, samples: int) -> np.ndarray:
    return np.concatenate([np.full(samples, values[0]), values[: values.size - samples]])


def recorded(position: np.ndarray, **forces: np.ndarray) -> Recording:
    return Recording(
        source="arrays", motion="linear", period=PERIOD, resolution=1e-6, findings=(), position=position,
        time=np.arange(position.size) * PERIOD, **{"commanded": None, "applied": None, **forces},
    )  # fmt: skip


def seen_in(position: np.ndarray, device: Device | None = None, **forces: np.ndarray) -> Evidence:
    found = vibration.find(position, PERIOD)
    return gather(recorded(position, **forces), found, device)


def test_frequency_and_swing_of_a_vibration_after_a_rest():
    slow = 0.003 * np.sin(2 * np.pi * 0.4 * np.arange(800) * PERIOD)
    position = np.concatenate([slow, slow[-1] + shaken()])
    found = vibration.find(position, PERIOD)
    assert found.rows.start >= 600
    assert abs(found.frequency - FREQUENCY) < max(3 * found.frequency_spread, 0.02)
    assert found.swing == pytest.approx(0.008, rel=0.15)
    assert found.regular > 0.95


def test_a_hand_that_moves_slowly_does_not_vibrate():
    """Half a hertz is no vibration, nor is a single stroke."""
    t = np.arange(2000) * PERIOD
    for position in (0.02 * np.sin(np.pi * t), np.where(t < 1, 0, 0.01) * np.minimum(t, 1.2), np.zeros(2000)):
        assert vibration.find(position, PERIOD) is None


@pytest.mark.parametrize(
    ("stiffness", "damping", "window", "compensation", "lag"),
    [(731.0, 0.0, 1, 0.0, 0), (412.0, 1.3, 5, 0.0, 0), (388.0, 0.0, 1, 0.21, 0), (950.0, 0.8, 2, 0.0, 4)],
)
def test_the_law_of_a_force_is_found(stiffness, damping, window, compensation, lag):
    """From quantized positions, through a limit: terms to a thousandth, the window and the lag exactly."""
    position = np.round(shaken() / 1e-6) * 1e-6
    move = np.concatenate([np.zeros(window), position[window:] - position[:-window]]) / (window * PERIOD)
    last = np.concatenate([[0.0], np.diff(position)])
    force = stiffness * position + damping * move - compensation * np.sign(last)
    force = np.clip(held(force, lag), -2.5, 2.5)
    found = law.fit(position, force, PERIOD, PERIOD, [k * PERIOD for k in range(8)])
    assert found.stiffness == pytest.approx(stiffness, rel=1e-3)
    assert found.damping == pytest.approx(damping, rel=1e-3, abs=1e-6)
    assert found.compensation == pytest.approx(compensation, rel=1e-3, abs=1e-6)
    assert found.lag == pytest.approx(lag * PERIOD)
    assert found.window == (window if damping else 1)
    assert found.unexplained < 1e-6


def test_a_force_that_has_nothing_to_do_with_the_motion_is_not_explained():
    found = law.fit(shaken(), RNG.normal(size=1200), PERIOD, PERIOD, [0.0, PERIOD])
    assert found is None or found.unexplained > 0.9


@pytest.mark.parametrize("kind", ["delay", "damper", "rate"])
def test_what_lies_between_two_forces(kind):
    position = shaken()
    command = 640 * position
    followed = command.copy()
    for k in range(1, command.size):
        followed[k] = followed[k - 1] + np.clip(command[k - 1] - followed[k - 1], -0.15, 0.15)
    inside = command + 2.7 * held(np.gradient(position, PERIOD), 6)
    applied = {"delay": held(command, 5), "damper": inside, "rate": followed}[kind]
    found = drive.account(command, applied, position, PERIOD, PERIOD, 1 / FREQUENCY)
    left = {"delay": found.by_delay, "damper": found.by_damper, "rate": found.by_rate}
    assert min(left, key=lambda key: left[key]) == kind
    assert left[kind] < 0.02
    if kind == "delay":
        assert found.delay == pytest.approx(5 * PERIOD)
    elif kind == "damper":
        assert found.damping == pytest.approx(2.7, rel=0.05)
        assert found.damping_lag == pytest.approx(6 * PERIOD)
    else:
        assert found.rate == pytest.approx(0.15 / PERIOD, rel=0.05)


def test_a_long_delay_of_a_slow_wobble_is_known_to_a_sample():
    """37 samples of a cycle of 1000, where lags are tried 19 apart."""
    position = 0.3 * np.sin(2 * np.pi * 0.8 * np.arange(6400) * PERIOD)
    command = 0.5 * position
    found = drive.account(command, held(command, 37), position, PERIOD, PERIOD, 1 / 0.8)
    assert found.delay_to_a_sample == pytest.approx(37 * PERIOD)
    assert abs(found.delay - 37 * PERIOD) < 10 * PERIOD


@pytest.mark.parametrize("late", [0, 3])
def test_the_energy_of_a_cycle_is_that_of_the_held_force_along_the_motion(late):
    """−∮ f dx by sums over the exact moves between samples; the terms add up to it."""
    position = shaken(2.5, drift=0.0)
    command = 640 * position + 0.4 * np.concatenate([[0.0], np.diff(position)]) / PERIOD
    applied = held(command, late)
    seen = seen_in(position, commanded=command, applied=applied)
    cycles = 49  # 1654.008 rows
    rows = slice(100, 100 + round(cycles / FREQUENCY / PERIOD))
    work = -float(np.sum(applied[rows] * np.diff(position)[rows])) / cycles
    assert seen.total == pytest.approx(work, rel=0.03)
    assert seen.energy == pytest.approx(work, rel=0.05)
    assert sum(seen.supplied.values()) == pytest.approx(seen.total, rel=0.03)
    assert (seen.supplied["delay"] > 0) == (late > 0)
    assert seen.delay == pytest.approx(late * PERIOD)


def test_the_energy_that_friction_takes():
    """π ω b X² + 4 f_c X of the device's numbers, and the mass that would move so: K/ω² without a hand."""
    position = shaken(drift=0.0)
    device = Device(mass=0.03, damping=0.3, coulomb_friction=0.05, sample_period=PERIOD)
    seen = seen_in(position, device, applied=640 * position)
    w = 2 * np.pi * FREQUENCY
    viscous = np.pi * w * 0.3 * 0.004**2 * (1 + (3 * 0.07) ** 2)  # the third harmonic is three times as fast
    assert seen.lost == pytest.approx(viscous + 4 * 0.05 * 0.004, rel=0.01)
    sinc = np.sinc(w * PERIOD / np.pi)  # the hold: cos(ωT/2) sin(ωT/2)/(ωT/2)
    assert seen.apparent_mass == pytest.approx(640 * sinc / w**2, rel=0.01)


def test_a_force_counted_the_other_way_is_turned_round():
    """A spring pushes back, whatever the file counts."""
    position = shaken()
    one, other = (seen_in(position, commanded=s * 640 * position) for s in (1, -1))
    assert other.law.stiffness == pytest.approx(one.law.stiffness)
    assert other.total == pytest.approx(one.total)


def test_a_wheel_that_wobbles_slowly_vibrates():
    """0.8 Hz, six cycles, quantized; a hand that goes to and fro as slowly is not so regular."""
    t = np.arange(round(8 / PERIOD)) * PERIOD
    wobble = 0.4 * np.sin(2 * np.pi * 0.8 * t) + 0.03 * np.sin(2 * np.pi * 2.4 * t + 1)
    wobble = np.round(wobble / 1e-3) * 1e-3
    found = vibration.find(wobble, PERIOD)
    assert found.frequency == pytest.approx(0.8, rel=0.02)
    hand = sum(0.1 * np.sin(2 * np.pi * f * t + p) for f, p in ((0.31, 0), (0.52, 1), (0.83, 2), (1.21, 3)))
    assert vibration.find(np.asarray(hand), PERIOD) is None


def test_a_frequency_that_drifts_is_looked_at_where_it_stays():
    """From 20 to 26 Hz in a second: the stretch is shortened until harmonics describe it."""
    t = np.arange(800) * PERIOD
    found = vibration.find(np.sin(2 * np.pi * (20 * t + 3 * t**2)), PERIOD)
    assert found.regular > 0.9
    assert found.rows.stop - found.rows.start < 500
    middle = 0.5 * (found.rows.start + found.rows.stop) * PERIOD
    assert found.frequency == pytest.approx(20 + 6 * middle, rel=0.03)
    assert found.around.stop - found.around.start >= found.rows.stop - found.rows.start


@pytest.mark.parametrize(("factor", "late"), [(1.0, 0), (1.0, 4), (1.6, 0)])
def test_the_motion_shows_the_force_behind_a_command(factor, late):
    """Of a device whose mass is known: how much larger than the command, and how far behind it."""
    position = shaken(drift=0.0)
    w = 2 * np.pi * FREQUENCY
    acts = 640 * np.sinc(w * PERIOD / 2 / np.pi)  # through the hold
    device = Device(mass=factor * acts / w**2, damping=0, coulomb_friction=0, sample_period=PERIOD)
    early = np.interp(np.arange(position.size) + late + 0.5, np.arange(position.size), position)
    seen = seen_in(position, device, commanded=640 * early)
    assert abs(seen.moves_as) == pytest.approx(factor, rel=0.02)
    assert np.angle(seen.moves_as) == pytest.approx(-w * late * PERIOD, abs=0.01)
    assert seen.recorded == "command"


def test_corners_of_a_force():
    """Third harmonic against the first: a triangle has a ninth, a square minus a third."""
    position = shaken(drift=0.0)
    phase = 2 * np.pi * FREQUENCY * np.arange(position.size) * PERIOD + 0.4
    held = np.sinc(3 * FREQUENCY * PERIOD) / np.sinc(FREQUENCY * PERIOD)
    for wave, bend in ((np.arcsin(np.sin(phase)), 1 / 9), (np.sign(np.sin(phase)), -1 / 3)):
        seen = seen_in(position, applied=wave)
        assert seen.force_bend.real == pytest.approx(bend * held, rel=0.1)


def test_what_speaks_against_any_cause():
    """Dying out, noise, a motor's force in another unit, millimetres read as metres, the hum of the mains."""
    device = Device(mass=0.08, damping=0.1, coulomb_friction=0, sample_period=PERIOD)
    t = np.arange(1600) * PERIOD
    x = 0.004 * np.sin(2 * np.pi * FREQUENCY * t)
    force = 0.08 * (2 * np.pi * FREQUENCY) ** 2 * x
    late, dying = held(force, 2), np.exp(-2 * t)
    noise, hum = RNG.normal(size=x.size) * 1e-3, 1e-4 * np.sin(2 * np.pi * 50 * t)
    assert doubt("delay", seen_in(x, device, commanded=force, applied=late)) is None
    for words, cause, position, forces in (
        ("dies out", "delay", dying * x, {"commanded": dying * force}),
        ("noise", "structural resonance", noise, {"commanded": 1000 * noise}),
        ("3 times", "delay", x, {"commanded": force, "applied": 3 * late}),
        ("units", "drive damping", 1000 * x, {"commanded": force}),
        ("mains", "structural resonance", hum, {"commanded": 300 * hum}),
    ):
        assert words in str(doubt(cause, seen_in(position, device, **forces)))


def test_a_motors_force_of_the_other_sign_is_turned_and_said():
    """The same rows, the motor's force counted the other way: read as the command counts."""
    t = np.arange(600) * PERIOD
    columns = {"time_s": t, "position_m": np.round(1e4 * np.sin(150 * t)) * 1e-7}
    columns["commanded_force_N"] = 200 * columns["position_m"]
    columns["motor_force_N"] = -columns["commanded_force_N"]
    table = Table(
        source="log.csv",
        units=dict.fromkeys(columns),
        read=lambda names: in_pieces("log.csv", columns, names),
    )
    taken = read_of_table(table, Told({}, {}, {}, {}))
    assert taken.applied == pytest.approx(columns["commanded_force_N"])
    assert any("other sign" in finding for finding in taken.findings)
