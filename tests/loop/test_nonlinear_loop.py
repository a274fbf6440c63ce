"""The simulator with a spring through points: commands, ledger, batches."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import zwidth as zw

PADDLE = zw.catalogue.device("haptic-paddle")
IDEAL = zw.amplifiers.Ideal()
SPRING = zw.NonlinearSpring([-0.01, -0.002, 0, 0.001, 0.006, 0.02], [-3.0, -0.1, 0.5, 0.2, 0.2, 7.0])


def _trace(spring: zw.NonlinearSpring, positions: np.ndarray, resolution: float):
    loop = zw.Device(damping=0.1, sample_period=0.002, resolution=resolution)
    motion = zw.operators.PrescribedMotion(positions)
    return zw.simulate(loop, spring, motion, 0.002 * (len(positions) - 1), amplifier=IDEAL)


@pytest.mark.parametrize("resolution", [0.0, 1e-4, 2.24e-3])
def test_the_commands_are_read_off_the_points(resolution: float) -> None:
    """At what the encoder reads, on both sides of 0 and beyond either end."""
    x = 0.004 + 0.02 * np.sin(np.arange(500) * 0.37)
    trace = _trace(SPRING, x, resolution)
    read = trace.measured_position.values
    if resolution:
        assert read == pytest.approx(resolution * np.floor(x / resolution), abs=1e-15)
    expected = np.interp(read, SPRING.positions, SPRING.forces)
    assert trace.commanded_force.values == pytest.approx(expected, abs=1e-13)
    assert {-3.0, 7.0} < set(trace.commanded_force.values)


@settings(max_examples=40, deadline=None)
@given(st.data())
def test_any_table_at_its_points_and_between(data: st.DataObject) -> None:
    """Two points or many: the search finds the right pair."""
    counts = data.draw(st.lists(st.integers(-50, 50), min_size=2, max_size=17, unique=True).map(sorted))
    forces = data.draw(st.lists(st.integers(-40, 40), min_size=len(counts), max_size=len(counts)))
    spring = zw.NonlinearSpring([n / 1000 for n in counts], [f / 8 for f in forces])
    x = np.concatenate([np.array(counts) / 1000, np.linspace(-0.06, 0.06, 301)])
    got = _trace(spring, x, 0.0).commanded_force.values
    assert got == pytest.approx(np.interp(x, spring.positions, spring.forces), abs=1e-12)


def test_two_points_far_apart_are_a_spring() -> None:
    """The same motion as that of f = K x, to rounding."""
    line = zw.NonlinearSpring([-1, 1], [-300, 300])
    hand = zw.operators.Dowel()
    one = zw.simulate(PADDLE, line, hand, 0.05)
    other = zw.simulate(PADDLE, zw.PulseTransferFunction([300], [1]), hand, 0.05)
    assert one.position.values == pytest.approx(other.position.values, abs=1e-12)


LAWS = {
    "points": SPRING,
    "detents": zw.NonlinearSpring.detents(5, 0.004, 0.6),
    "bump stop": zw.NonlinearSpring.bump_stop(0.002, 200, 10**6, 0.02),
}


@pytest.mark.parametrize("name", LAWS)
@pytest.mark.parametrize("hand", [zw.operators.Finger(), zw.operators.ConstantForce(1.0)])
def test_the_ledger_closes(name: str, hand) -> None:
    """Every joule is accounted for, with a delay and in between samples."""
    device = PADDLE.replace(delay=4e-4)
    trace = zw.simulate(device, LAWS[name], hand, 0.4, initial_position=-2e-3, points_per_sample=3)
    assert trace.zwidth.energy.closes
    assert trace.attrs["environment"] == LAWS[name].describe()


def test_a_handle_let_go_comes_to_rest_in_a_detent() -> None:
    """A quarter of the way up its edge and no hand: it slides back into the detent."""
    detents = zw.NonlinearSpring.detents(5, 0.004, 0.6)
    device = zw.Device(mass=0.05, damping=2.0, sample_period=1e-4)
    free = zw.operators.ConstantForce(0.0)
    trace = zw.simulate(device, detents, free, 0.5, initial_position=0.009, amplifier=IDEAL)
    assert float(trace.position[-1]) == pytest.approx(0.008, abs=1e-6)


def test_a_batch_has_the_bits_of_single_loops() -> None:
    """Over a parameter of the device."""
    hand = zw.operators.Dowel()
    batch = zw.simulation.simulate_batch(
        PADDLE, SPRING, hand, 0.2, vary={"device.damping": [0.1, 0.4]}, workers=2
    )
    for damping in (0.1, 0.4):
        alone = zw.simulate(PADDLE.replace(damping=damping), SPRING, hand, 0.2)
        assert float(batch.position.sel(damping=damping)) == float(alone.position[-1])
