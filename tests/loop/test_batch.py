"""Many loops: the same bits as alone, on any number of threads."""

from __future__ import annotations

from dataclasses import replace
from itertools import product

import numpy as np
import pytest

import zwidth as zw
from zwidth.loop.batch import BLOCK

PADDLE = zw.catalogue.device("haptic-paddle")


def _same(batch, trace) -> None:
    for kept in ("position", "velocity", *(key for key in trace if key.endswith(("_work", "_loss")))):
        assert float(batch[kept]) == float(trace[kept][-1]), kept
    assert float(batch.deepest_position) == trace.position.values.max()
    assert float(batch.peak_actuator_force) == np.abs(trace.actuator_force.values).max()
    assert float(batch.energy_extracted) == (-trace.hand_work.values).max()
    assert int(batch.stops) == trace.attrs["stops"]
    last = trace.position.values[(trace.sizes["time"] - 1) - (trace.sizes["time"] - 1) // 4 :]
    assert float(batch.swing) == last.max() - last.min()


@pytest.mark.parametrize("delay", [0.0, 2e-3])
def test_free_loops_have_the_bits_of_each_alone(delay):
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


DOWEL, FINGER = zw.operators.Dowel(), zw.operators.Finger()
OTHERS = {
    "memory, a tied hand, part of a sample of delay": (
        {"delay": 3e-4},
        zw.Wall(300.0, damping=0.2),
        FINGER,
        {"environment.stiffness": [200.0, 900.0], "operator.damping": [0.1, 1.0, 4.0]},
    ),
    "points": (
        {},
        zw.NonlinearSpring([-0.01, -0.002, 0, 0.02], [-3, -0.1, 0, 7]),
        DOWEL,
        {"device.damping": [0.1, 0.4]},
    ),
    "contact": (
        {},
        zw.HuntCrossley(1),
        DOWEL,
        {"environment.stiffness": [1e3, 3e4], "exponent": [1, 1.5], "dissipation": [0, 2]},
    ),
    "clamped": (
        {},
        zw.Wall(500.0, 0.3),
        DOWEL,
        {"clamped": [False, True], "environment.damping": [0.0, 0.3]},
    ),
}


@pytest.mark.parametrize("name", OTHERS)
def test_loops_of_every_other_kind_have_the_bits_of_each_alone(name):
    """One by one, on two threads."""
    changes, law, hand, vary = OTHERS[name]
    device = PADDLE.replace(**changes)
    batch = zw.simulation.simulate_batch(device, law, hand, 0.3, vary=vary, workers=2)
    for values in product(*vary.values()):
        parts = {"device": device, "environment": law, "operator": hand}
        for key, value in zip(vary, values, strict=True):
            part, _, own = f"environment.{key}".rpartition(".")
            part = part.rpartition(".")[2]
            parts[part] = replace(parts[part], **{own: value})
        chosen = {key.rpartition(".")[2]: value for key, value in zip(vary, values, strict=True)}
        _same(batch.sel(chosen), zw.simulate(*parts.values(), 0.3))


ALONE = "simulate each value on its own"
TABLE = zw.NonlinearSpring([0, 0.01], [0, 3])


@pytest.mark.parametrize(
    ("vary", "says", "options"),
    [
        ({}, "vary needs", {}),
        ({"stiffness": []}, "vary needs", {}),
        ({"stifness": [1.0]}, "no parameter 'stifness'", {}),
        ({"damping": [0.1]}, "ambiguous", {}),
        ({"device.stiffness": [1.0]}, "no parameter 'device.stiffness'", {}),
        ({"environment.stiffness": [-1.0]}, "stiffness must be", {}),
        ({"device.mass": [0.0]}, "mass must be > 0", {}),
        *(
            ({"stiffness": values}, "'stiffness' is varied over single values", {})
            for values in ([[100.0, 200.0], [300.0, 400.0]], [[100.0], [300.0, 400.0]], {100.0, 200.0})
        ),
        ({"stiffness": [1, 2], "force": [1, 2, 3]}, "stiffness 2, force 3", {"together": True}),
        (
            {"branches": [[(800, 3)], [(200, 20), (50, 1)]]},
            ALONE,
            {"environment": zw.GeneralizedMaxwell(0, branches=[(800, 3)])},
        ),
        ({"positions": [[0, 0.01], [0, 0.02]]}, ALONE, {"environment": TABLE}),
        ({"forces": np.array([[0, 3], [0, 4]])}, ALONE, {"environment": TABLE}),
    ],
)
def test_what_cannot_be_varied_is_refused(vary, says, options):
    given = {"environment": zw.Wall(300.0), **options}
    hand = zw.operators.ConstantForce(1.0) if "together" in options else zw.operators.Finger()
    with pytest.raises(zw.InputError, match=says):
        zw.simulation.simulate_batch(device=PADDLE, operator=hand, duration=0.1, vary=vary, **given)


def test_free_loops_at_the_edge_of_friction_have_the_bits_of_each_alone():
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


def test_ctrl_c_keeps_the_loops_that_are_finished():
    def stop(done: int, total: int) -> None:
        raise KeyboardInterrupt

    vary = {"stiffness": np.linspace(50.0, 1500.0, 60 * BLOCK)}
    batch = zw.simulation.simulate_batch(
        PADDLE, zw.Wall(1.0), zw.operators.Dowel(), 1.0, vary=vary, workers=1, progress=stop
    )
    finished = np.isfinite(batch.position.values)
    assert BLOCK <= finished.sum() < finished.size
    assert batch.attrs["interrupted"].startswith(f"{finished.sum()} of ")
