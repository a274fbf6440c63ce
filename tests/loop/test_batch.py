"""Many loops: the same bits as alone, on any number of threads."""

from __future__ import annotations

import numpy as np
import pytest

import zwidth as zw
from zwidth.loop.batch import BLOCK

PADDLE = zw.catalogue.device("haptic-paddle")
PAIRS = {
    "position": "position", "velocity": "velocity", "hand_work": "hand_work",
    "actuator_work": "actuator_work", "viscous_loss": "viscous_loss", "coulomb_loss": "coulomb_loss",
    "hand_source_work": "hand_source_work", "hand_damper_loss": "hand_damper_loss",
}  # fmt: skip


def _same(batch, trace) -> None:
    """A loop of a batch against its trace, to the last bit."""
    for kept, variable in PAIRS.items():
        assert float(batch[kept]) == float(trace[variable][-1]), kept
    assert float(batch.deepest_position) == trace.position.values.max()
    assert float(batch.peak_actuator_force) == np.abs(trace.actuator_force.values).max()
    assert float(batch.energy_extracted) == (-trace.hand_work.values).max()
    assert int(batch.stops) == trace.attrs["stops"]
    last = trace.position.values[(trace.sizes["time"] - 1) - (trace.sizes["time"] - 1) // 4 :]
    assert float(batch.swing) == last.max() - last.min()


@pytest.mark.parametrize("delay", [0.0, 2e-3])
def test_free_loops_have_the_bits_of_each_alone(delay: float) -> None:
    """More loops than a block, every parameter varied."""
    count = BLOCK + 9
    rng = np.random.default_rng(5)
    vary = {
        "environment.stiffness": rng.uniform(0, 2000, count),
        "device.mass": rng.uniform(0.01, 0.5, count),
        "device.damping": rng.uniform(0, 0.5, count),
        "coulomb_friction": rng.uniform(0, 0.2, count),
        "device.resolution": rng.choice([0.0, 22.4e-6, 1e-3], count),
        "force_limit": rng.uniform(1, 20, count),
        "force": rng.uniform(0.5, 5, count),
        "encoder_phase": rng.uniform(0, 0.9, count),
        "initial_position": rng.uniform(-5e-3, 1e-3, count),
        "initial_velocity": rng.uniform(0, 0.4, count),
    }
    hand = zw.operators.ConstantForce(1.0)
    device = PADDLE.replace(delay=delay)
    batch = zw.simulation.simulate_batch(device, zw.Wall(1.0), hand, 0.4, vary=vary, together=True, workers=2)
    for i in range(count):
        own = {name.rpartition(".")[2]: float(values[i]) for name, values in vary.items()}
        options = {key: own.pop(key) for key in ("encoder_phase", "initial_position", "initial_velocity")}
        wall, push = zw.Wall(own.pop("stiffness")), zw.operators.ConstantForce(own.pop("force"))
        _same(batch.isel(case=i), zw.simulate(device.replace(**own), wall, push, 0.4, **options))


def test_loops_of_every_other_kind_have_the_bits_of_each_alone() -> None:
    """Memory, a tied hand, a part of a sample of delay: one by one, on two threads."""
    device = PADDLE.replace(delay=3e-4)
    wall, hand = zw.Wall(300.0, damping=0.2), zw.operators.Finger()
    vary = {"environment.stiffness": [200.0, 900.0], "operator.damping": [0.1, 1.0, 4.0]}
    batch = zw.simulation.simulate_batch(device, wall, hand, 0.5, vary=vary, workers=2)
    assert batch.sizes == {"stiffness": 2, "damping": 3}
    for i, k in enumerate(vary["environment.stiffness"]):
        for j, c in enumerate(vary["operator.damping"]):
            finger = zw.operators.Finger(damping=c)
            _same(batch.isel(stiffness=i, damping=j), zw.simulate(device, zw.Wall(k, 0.2), finger, 0.5))


def test_threads_do_not_change_a_bit() -> None:
    """One thread or three."""
    vary = {"stiffness": np.linspace(50.0, 1500.0, 3 * BLOCK + 1)}
    one, three = (
        zw.simulation.simulate_batch(PADDLE, zw.Wall(1.0), zw.operators.Dowel(), 0.3, vary=vary, workers=n)
        for n in (1, 3)
    )
    assert one.identical(three)


@pytest.mark.parametrize(
    ("vary", "says"),
    [
        ({}, "vary needs"),
        ({"stiffness": []}, "vary needs"),
        ({"stifness": [1.0]}, "no parameter 'stifness'"),
        ({"damping": [0.1]}, "ambiguous"),
        ({"device.stiffness": [1.0]}, "no parameter 'device.stiffness'"),
        ({"environment.stiffness": [-1.0]}, "stiffness must be"),
        ({"device.mass": [0.0]}, "mass must be > 0"),
        ({"stiffness": [[100.0, 200.0], [300.0, 400.0]]}, "'stiffness' is varied over single values"),
        ({"stiffness": [[100.0], [300.0, 400.0]]}, "'stiffness' is varied over single values"),
        ({"stiffness": {100.0, 200.0}}, "'stiffness' is varied over single values"),
    ],
)
def test_what_cannot_be_varied_is_refused(vary: dict, says: str) -> None:
    """The message names the parameter."""
    with pytest.raises(zw.InputError, match=says):
        zw.simulation.simulate_batch(PADDLE, zw.Wall(300.0), zw.operators.Finger(), 0.1, vary=vary)


@pytest.mark.parametrize(
    ("environment", "vary"),
    [
        (zw.GeneralizedMaxwell(0, branches=[(800, 3)]), {"branches": [[(800, 3)], [(200, 20), (50, 1)]]}),
        (zw.NonlinearSpring([0, 0.01], [0, 3]), {"positions": [[0, 0.01], [0, 0.02]]}),
        (zw.NonlinearSpring([0, 0.01], [0, 3]), {"forces": np.array([[0, 3], [0, 4]])}),
    ],
)
def test_a_parameter_that_is_a_list_is_not_varied(environment, vary: dict) -> None:
    """One message, whatever the shape."""
    with pytest.raises(zw.InputError, match="simulate each value on its own"):
        zw.simulation.simulate_batch(PADDLE, environment, zw.operators.Finger(), 0.1, vary=vary)


def test_free_loops_at_the_edge_of_friction_have_the_bits_of_each_alone() -> None:
    """Hands that push with the stiction, give or take the last digits: they rest, or creep onwards."""
    count = 3 * BLOCK
    rng = np.random.default_rng(3)
    friction, stiffness = rng.uniform(0.001, 0.5, count), rng.uniform(100, 2000, count)
    edge = stiffness * 22.4e-6 * 7 + friction  # the wall pushes from the seventh count
    pushes = edge + rng.integers(-3, 4, count) * np.spacing(edge)
    vary = {"environment.stiffness": stiffness, "coulomb_friction": friction, "force": pushes}
    hand, start = zw.operators.ConstantForce(1.0), {"initial_position": 7.5 * 22.4e-6}
    batch = zw.simulation.simulate_batch(PADDLE, zw.Wall(1.0), hand, 0.003, vary=vary, together=True, **start)
    assert (batch.velocity >= 0).all()
    assert 0 < (batch.velocity > 0).sum() < count
    for i in range(count):
        own = PADDLE.replace(coulomb_friction=float(friction[i]))
        wall, push = zw.Wall(float(stiffness[i])), zw.operators.ConstantForce(float(pushes[i]))
        _same(batch.isel(case=i), zw.simulate(own, wall, push, 0.003, **start))
        general = zw.simulate(own, wall, push, 0.003, points_per_sample=2, **start)
        assert float(general.velocity[-1]) == pytest.approx(float(batch.velocity[i]), rel=1e-12, abs=1e-17)


def test_values_varied_together_are_equally_many() -> None:
    """The message counts them."""
    with pytest.raises(zw.InputError, match="stiffness 2, force 3"):
        zw.simulation.simulate_batch(
            PADDLE, zw.Wall(1.0), zw.operators.ConstantForce(1.0), 0.1,
            vary={"stiffness": [1, 2], "force": [1, 2, 3]}, together=True,
        )  # fmt: skip


def test_ctrl_c_keeps_the_loops_that_are_finished() -> None:
    """The others are NaN, and the attribute says how many are there."""

    def stop(done: int, total: int) -> None:
        raise KeyboardInterrupt

    vary = {"stiffness": np.linspace(50.0, 1500.0, 60 * BLOCK)}
    batch = zw.simulation.simulate_batch(
        PADDLE, zw.Wall(1.0), zw.operators.Dowel(), 1.0, vary=vary, workers=1, progress=stop
    )
    finished = np.isfinite(batch.position.values)
    assert BLOCK <= finished.sum() < finished.size
    assert batch.attrs["interrupted"].startswith(f"{finished.sum()} of ")
