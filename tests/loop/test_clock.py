"""What sample k means: when it is taken, when its force is applied, how long it is held."""

from __future__ import annotations

import numpy as np
import pytest

import zwidth as zw

PERIOD = 0.001
INSIDE = zw.Device(mass=0.05, damping=0.2, sample_period=PERIOD)


def _ramp(samples: int) -> np.ndarray:
    """Positions 1, 2, 3 … mm: every sample reads another position."""
    return 1e-3 * (1 + np.arange(samples + 1))


def _forces(device: zw.Device, samples: int = 6, points: int = 10, **options) -> zw.simulate:
    motion = zw.operators.PrescribedMotion(_ramp(samples))
    duration = samples * PERIOD
    return zw.simulate(device, zw.Wall(1000.0), motion, duration, points_per_sample=points, **options)


def _applied(trace) -> list[tuple[float, float]]:
    """(instant, force) at which the actuator force changes."""
    force = trace.actuator_force.values
    changes = np.flatnonzero(np.diff(force, prepend=0.0))
    return [(round(float(trace.time[i]) / PERIOD, 9), round(float(force[i]), 9)) for i in changes]


def test_without_delay_the_force_of_sample_0_acts_at_t_0():
    """Sample k is taken at k T, and its force acts from that instant until (k + 1) T."""
    assert _applied(_forces(INSIDE)) == [(k, k + 1.0) for k in range(7)]


@pytest.mark.parametrize(("delay", "shift"), [(0.001, 1.0), (0.0003, 0.3), (0.0024, 2.4)])
def test_a_delay_moves_every_force_by_as_much(delay, shift):
    trace = _forces(INSIDE.replace(delay=delay))
    expected = [(round(k + shift, 9), k + 1.0) for k in range(7) if k + shift <= 6]
    assert _applied(trace) == expected
    assert trace.actuator_force.values[0] == 0.0


def test_the_command_stands_at_its_sample_and_the_energy_before_its_jump():
    trace = _forces(INSIDE.replace(delay=0.0003))
    at_samples = trace.isel(time=trace.sampled.values)
    assert at_samples.measured_position.values == pytest.approx(_ramp(6))
    assert at_samples.commanded_force.values == pytest.approx(1000 * _ramp(6))
    assert float(at_samples.hand_work[0]) == 0.0


def test_a_late_sample_reads_later_and_acts_later():
    """Sample 2, late by 0.4 T, reads the position of then; the others stay where they are."""
    late = np.zeros(7)
    late[2] = 0.4 * PERIOD
    trace = _forces(INSIDE, timing=zw.simulation.Timing(lateness=late))
    assert [t for t, _ in _applied(trace)] == [0, 1, 2.4, 3, 4, 5, 6]
    assert trace.time.values[trace.sampled.values][2] == pytest.approx(2.4 * PERIOD)


def test_a_missed_sample_leaves_the_force_as_it_was():
    """The force of sample 2 is held through sample 3, which nobody took."""
    missed = [False, False, False, True, False, False, False]
    trace = _forces(INSIDE, timing=zw.simulation.Timing(missed=missed))
    assert [t for t, _ in _applied(trace)] == [0, 1, 2, 4, 5, 6]


@pytest.mark.parametrize("delay", [0.0, 0.0003, 0.0017])
def test_lateness_of_nearly_nothing_is_no_lateness(delay):
    device = zw.catalogue.device("haptic-paddle").replace(delay=delay)
    late = np.zeros(301)
    late[150] = 1e-17
    hand = zw.operators.Dowel()
    a = zw.simulate(device, zw.Wall(600.0), hand, 0.3)
    b = zw.simulate(device, zw.Wall(600.0), hand, 0.3, timing=zw.simulation.Timing(lateness=late))
    assert np.abs(a.position.values - b.position.values).max() < 1e-13


@pytest.mark.parametrize("phase", [0.0, 0.25, 0.999])
def test_the_encoder_counts_from_its_phase(phase):
    """x_m = Δ floor(x/Δ + φ): the first count comes (1 − φ) Δ deep."""
    device = INSIDE.replace(resolution=1e-4)
    positions = np.linspace(-1e-4, 3e-4, 401)
    motion = zw.operators.PrescribedMotion(positions)
    trace = zw.simulate(device, zw.Wall(1000.0), motion, 0.4, encoder_phase=phase)
    first = positions[np.flatnonzero(trace.measured_position.values > 0)[0]]
    assert first == pytest.approx((1 - phase) * 1e-4, abs=1.1e-6)
    counts = trace.measured_position.values / 1e-4
    assert np.abs(counts - np.round(counts)).max() < 1e-9


@pytest.mark.parametrize(
    ("given", "says"),
    [
        ({"lateness": 0.001}, "below the sample period"),
        ({"lateness": -1e-4}, "lateness must be"),
        ({"lateness": [0.0, 1e-4]}, r"\(7,\)"),
        ({"lateness": [1e-4] * 7}, "first lateness"),
        ({"missed": 1.5}, "probability"),
        ({"missed": [True]}, "missed has shape"),
    ],
)
def test_a_clock_that_cannot_be_is_refused(given, says):
    with pytest.raises(zw.InputError, match=says):
        _forces(INSIDE, timing=zw.simulation.Timing(**given))
