"""`zw.simulate`: laws, amplifiers, recording, and what it refuses."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.signal
from hypothesis import given, settings
from hypothesis import strategies as st

import zwidth as zw

PADDLE = zw.catalogue.device("haptic-paddle")
IDEAL = zw.amplifiers.Ideal()


def test_the_converter_rounds_and_the_actuator_saturates():
    device = {"force_resolution": 0.05, "force_limit": 1.0, "mass": 0.1}
    x = np.array([0.0, 1.13e-3, 2.0e-3, 9e-3])
    motion = zw.operators.PrescribedMotion(x)
    loop = zw.Device(damping=0.1, sample_period=0.002, **device)
    trace = zw.simulate(loop, zw.Wall(300.0), motion, 0.006)
    assert trace.actuator_force.values == pytest.approx([0.0, 0.35, 0.6, 1.0])
    ideal = zw.simulate(loop, zw.Wall(300.0), motion, 0.006, amplifier=IDEAL)
    assert ideal.actuator_force.values[-1] == pytest.approx(2.7)


def test_a_limited_voltage_raises_the_force_at_u_over_l():
    """Abbott & Okamura's motor: 16.5 N in 0.15 ms, not at once."""
    x = np.array([0.0, 0.0, 20e-3, 20e-3, 20e-3])
    wall = zw.Wall(1000.0)
    motion = zw.operators.PrescribedMotion(x)
    drive = zw.amplifiers.VoltageLimited()
    trace = zw.simulate(PADDLE, wall, motion, 0.004, amplifier=drive, points_per_sample=1000)
    force = trace.actuator_force.values
    rise = float(trace.time[np.argmax(force >= 16.5 * (1 - 1e-9))]) - 0.002
    assert rise == pytest.approx(3.3 * 0.55e-3 / 12.0, abs=1.01e-6)
    assert np.diff(force).max() == pytest.approx(16.5 / 3.3 * 12.0 / 0.55e-3 * 1e-6, rel=1e-6)


def test_a_lagging_force_comes_nearer_by_the_same_part_each_time():
    """τ df/dt = f_command − f: after τ it has gone 1 − 1/e of the way."""
    x = np.array([0.0, 5e-3, 5e-3, 5e-3])
    motion = zw.operators.PrescribedMotion(x)
    lag = zw.amplifiers.FirstOrderLag(time_constant=0.5e-3)
    trace = zw.simulate(PADDLE, zw.Wall(1000.0), motion, 0.003, amplifier=lag, points_per_sample=2)
    force = trace.actuator_force.sel(time=0.0015, method="nearest")
    assert float(force) == pytest.approx(float(trace.commanded_force[2]) * (1 - np.exp(-1)), rel=1e-12)


@pytest.mark.parametrize("amplifier", ["Ideal", "VoltageLimited", "FirstOrderLag"])
@pytest.mark.parametrize("hand", [zw.operators.Dowel(), zw.operators.Finger()])
def test_the_motion_does_not_depend_on_how_many_points_are_recorded(amplifier, hand):
    """Nothing is integrated in steps: 1 point per sample or 7, the same loop."""
    drive = getattr(zw.amplifiers, amplifier)(*([2e-4] if amplifier == "FirstOrderLag" else []))
    device = PADDLE.replace(delay=4e-4, stiction=0.15)
    one = zw.simulate(device, zw.Wall(500.0), hand, 0.4, amplifier=drive)
    many = zw.simulate(device, zw.Wall(500.0), hand, 0.4, amplifier=drive, points_per_sample=7)
    picked = many.isel(time=many.sampled.values)
    assert np.abs(picked.position.values - one.position.values).max() < 1e-13
    assert np.abs(picked.hand_work.values - one.hand_work.values).max() < 1e-13


@settings(max_examples=60, deadline=None)
@given(
    stiffness=st.integers(0, 5000).map(float),
    delay=st.sampled_from([0.0, 3e-4, 1e-3, 2.7e-3]),
    resolution=st.sampled_from([0.0, 22.4e-6, 2.24e-3]),
    mass=st.integers(5, 1000).map(lambda n: n / 1000),
    limit=st.sampled_from([None, 2.0]),
    push=st.integers(-3000, 3000).map(lambda n: n / 1000),
    finger=st.booleans(),
)
def test_the_ledger_closes_in_every_loop(stiffness, delay, resolution, mass, limit, push, finger):
    device = PADDLE.replace(mass=mass, delay=delay, resolution=resolution, force_limit=limit)
    hand = zw.operators.Finger() if finger else zw.operators.ConstantForce(push)
    t = zw.simulate(device, zw.Wall(stiffness), hand, 0.3, initial_position=-2e-3, initial_velocity=0.1)
    stored = t.kinetic_energy - t.kinetic_energy[0]
    residual = stored - (t.hand_work + t.actuator_work - t.viscous_loss - t.coulomb_loss)
    moved = float(
        abs(t.hand_work).max() + abs(t.actuator_work).max() + t.viscous_loss[-1] + t.coulomb_loss[-1]
    )
    assert float(abs(residual).max()) <= 1e-12 * moved


def test_a_prescribed_motion_needs_the_work_that_the_proofs_count():
    """Energy out is −Σ f Δx − f_c Σ|Δx| − (b/T) Σ Δx²: the sum of the witness."""
    x = np.array([0.0, 2.0187e-3, 1e-3, 1.7e-3, 0.0, 0.0])
    trace = zw.simulate(PADDLE, zw.Wall(770.0), zw.operators.PrescribedMotion(x), 0.005, amplifier=IDEAL)
    f, dx = trace.actuator_force.values[:-1], np.diff(x)
    out = -(f * dx).sum() - 0.12 * np.abs(dx).sum() - 0.15 / 1e-3 * (dx**2).sum()
    assert -float(trace.hand_work[-1]) == pytest.approx(out, abs=1e-17)


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"duration": 0.0}, "duration must be > 0"),
        ({"duration": 1e-4}, "one sample period"),
        ({"duration": float("nan")}, "duration is in s: expected a finite number"),
        ({"duration": "long"}, "duration is in s"),
        ({"duration": 1e9}, "GiB"),
        ({"operator": "dowel"}, "operator is a hand"),
        ({"environment": 300.0}, "environment"),
        ({"device": "haptic-paddle"}, "the device is"),
        ({"device": PADDLE.replace(mass=None)}, "mass is needed"),
        ({"device": PADDLE.replace(damping=(0.1, 0.2))}, "damping has no single value"),
        ({"encoder_phase": 1.0}, "encoder_phase"),
        ({"initial_position": float("inf")}, "initial_position is in m: expected a finite"),
        ({"points_per_sample": 0}, "points_per_sample"),
        ({"points_per_sample": 1.5}, "points_per_sample"),
        ({"amplifier": "ideal"}, "amplifier"),
        ({"timing": 0.1}, "timing"),
        ({"operator": zw.operators.RecordedForce([1.0, 2.0])}, "2"),
        ({"operator": zw.operators.Finger(stiffness=1e12)}, "rigid"),
        ({"operator": zw.operators.PrescribedMotion(np.zeros(101)), "initial_velocity": 1.0}, "prescribed"),
    ],
)
def test_what_cannot_be_simulated_is_refused_in_one_message(change, says):
    call = {
        "device": PADDLE,
        "environment": zw.Wall(300.0),
        "operator": zw.operators.Dowel(),
        "duration": 0.1,
    }
    with pytest.raises(zw.InputError, match=says) as caught:
        zw.simulate(**{**call, **change})
    assert "\n" not in str(caught.value)


def test_ctrl_c_keeps_what_is_finished(monkeypatch):
    import zwidth.loop.simulate as module

    monkeypatch.setattr(module, "_STRIDE", 40)

    def stop(done: int, total: int) -> None:
        if done >= 80:
            raise KeyboardInterrupt

    whole = zw.simulate(PADDLE, zw.Wall(300.0), zw.operators.Dowel(), 0.2)
    part = zw.simulate(PADDLE, zw.Wall(300.0), zw.operators.Dowel(), 0.2, progress=stop)
    assert part.sizes["time"] == 80
    assert part.attrs["interrupted_at_s"] == pytest.approx(0.079)
    assert (part.position.values == whole.position.values[:80]).all()


def test_a_motion_that_grows_without_bound_is_cut_and_says_when():
    loop = zw.Device(mass=0.036, damping=0.1, sample_period=1e-3)
    spring = zw.PulseTransferFunction([1e9], [1.0])
    trace = zw.simulate(loop, spring, zw.operators.ConstantForce(1.0), 2.0, amplifier=IDEAL)
    assert trace.attrs["diverged_at_s"] == pytest.approx(float(trace.time[-1]))
    assert 1 < trace.sizes["time"] < 1000
    for values in trace.data_vars.values():
        assert np.isfinite(values.values.astype(float)).all()
    assert trace.zwidth.energy.closes


def test_a_delay_longer_than_the_simulation_leaves_the_hand_alone():
    far = zw.Device(mass=0.036, damping=0.1, sample_period=1e-3, delay="1e9 s")
    trace = zw.simulate(far, zw.Wall(1e3), zw.operators.ConstantForce(1.0), 0.1)
    assert float(trace.position[-1]) > 0
    assert not trace.actuator_force.values.any()


def test_switch_positions_need_a_delay_that_ends_within_a_sample():
    motion = zw.operators.PrescribedMotion([0, 1e-3, 2e-3], switch_positions=[0.5e-3, 1.5e-3])
    with pytest.raises(zw.InputError, match=r"switch positions.*delay of 0 s"):
        zw.simulate(PADDLE, zw.Wall(300.0), motion, 0.002)
    late = PADDLE.replace(delay="0.3 ms")
    trace = zw.simulate(late, zw.Wall(300.0), motion, 0.002, amplifier=IDEAL)
    assert float(trace.position[-1]) == 2e-3


def test_python_control_and_scipy_systems_are_environments():
    wall = zw.simulate(PADDLE, zw.PulseTransferFunction([300.0], [1.0]), zw.operators.Dowel(), 0.05)
    system = scipy.signal.dlti([300.0], [1.0], dt=0.001)
    same = zw.simulate(PADDLE, system, zw.operators.Dowel(), 0.05)
    assert (wall.position.values == same.position.values).all()
