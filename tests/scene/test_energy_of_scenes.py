"""What the port puts into a scene is what its elements store and lose, and nothing comes from nowhere."""

from __future__ import annotations

import numpy as np
import pytest
from random_scenes import random_scene
from strategies import seeds

import zwidth as zw
from zwidth.model.scene import (
    Contact,
    CoulombFriction,
    Damper,
    Lever,
    Mass,
    NonlinearSpring,
    SceneRun,
    Spring,
)


def motion(seed: int, samples: int = 150) -> np.ndarray:
    """Jerks and slow ways of a hand, up to some centimetres."""
    rng = np.random.default_rng(seed)
    return np.cumsum(rng.normal(size=samples) * 10.0 ** rng.uniform(-5, -2.5)) + np.cumsum(
        rng.normal(size=samples) * (rng.random(samples) < 0.02) * 5e-3
    )


@seeds(12)
def test_the_energy_of_random_scenes_balances_to_rounding(seed):
    scene = random_scene(seed, 3 + seed % 40)
    run = SceneRun(scene, 0.001)
    x = motion(seed)
    f = run.follow(x)
    account = run.account()
    moved = float((np.abs(f) * np.abs(np.diff(x, prepend=0.0))).sum()) + float(np.abs(account.work).sum())
    assert float(account.lost.min()) >= 0.0
    assert np.abs(account.work - account.stored - account.lost).max() <= 1e-12 * moved
    assert abs(account.attrs["left_over_J"]) <= 1e-12 * moved
    assert account.attrs["port_work_J"] == pytest.approx(
        float(f @ np.diff(x, prepend=0.0)), abs=1e-12 * moved
    )
    assert account.attrs["port_work_J"] >= -1e-12 * moved


def test_kinetic_and_elastic_energy_are_those_of_the_textbook():
    """½ m u² of the velocity and ½ K d² of the positions that the run reports."""
    scene = zw.Scene(
        [
            Spring("handle", "a", 310),
            Mass("a", "0.21"),
            Lever("a", "b", "-1.7"),
            Mass("b", "0.013"),
            Spring("b", "handle", 57),
        ]
    )
    run = SceneRun(scene, 0.002)
    run.follow(motion(5))
    y, u = run.positions, run.velocities
    stored = dict(zip(run.account().element.values, run.account().stored.values, strict=True))
    assert y["b"] == pytest.approx(-1.7 * y["a"])
    assert u["b"] == pytest.approx(-1.7 * u["a"])
    assert stored["spring handle–a"] == pytest.approx(0.5 * 310 * (y["handle"] - y["a"]) ** 2)
    assert stored["spring b–handle"] == pytest.approx(0.5 * 57 * (y["b"] - y["handle"]) ** 2)
    assert stored["mass a"] == pytest.approx(0.5 * 0.21 * u["a"] ** 2)
    assert stored["mass b"] == pytest.approx(0.5 * 0.013 * u["b"] ** 2)


def test_a_mass_left_alone_swings_for_ever():
    run = SceneRun(zw.Scene([Spring("handle", "m", 3900), Mass("m", "0.1")]), 0.0063)
    run.step(0.01)
    before = float(run.account().stored.sum())
    run.follow(np.full(10**6, 0.01))
    assert float(run.account().stored.sum()) == pytest.approx(before, rel=1e-9)


def test_a_ball_between_two_walls_keeps_its_energy():
    scene = zw.Scene(
        [
            Spring("handle", "m", 10),
            Mass("m", "0.01"),
            Contact("m", "ground", 1e6, 0, 0.01),
            Contact("ground", "m", 1e6, 0, 0.01),
        ]
    )
    run = SceneRun(scene, 0.001)
    for _ in range(20):
        run.step(0.05)
    before = float(run.account().stored.sum())
    run.follow(np.full(20_000, 1.0))
    assert float(run.account().stored.sum()) == pytest.approx(before, rel=1e-10)


def test_contact_never_pulls_and_its_damper_only_takes():
    """Torn away at any speed the force stays at 0 or above; what was pressed in is lost or given back."""
    scene = zw.Scene([Contact("handle", "ground", 1000, 8, "0.001"), Damper("handle", "ground", "1e-9")])
    run = SceneRun(scene, 0.001)
    x = 0.002 * np.sin(np.arange(3000) * np.linspace(0.01, 2, 3000)) + 0.0005
    forces = run.follow(x)
    assert forces.min() > -1e-8
    assert forces.max() > 1.0
    lost = run.account().lost.values
    assert lost.min() >= 0.0
    assert lost.max() > 0.0


@pytest.mark.parametrize(("pull", "slides"), [(0.99, False), (1.01, True)])
def test_friction_holds_up_to_its_force(pull, slides):
    scene = zw.Scene([Spring("handle", "m", 100), Mass("m", "0.1"), CoulombFriction("m", "ground", 2)])
    run = SceneRun(scene, 0.001)
    run.follow(np.linspace(0, pull * 2 / 100, 200)[1:])
    run.follow(np.full(500, pull * 2 / 100))
    assert (abs(run.positions["m"]) > 1e-5) == slides
    if not slides:
        assert abs(run.positions["m"]) < 1e-15


def test_points_on_a_line_are_a_spring():
    rest = [Mass("m", "0.05"), Damper("m", "ground", "0.2")]
    line = [k * 0.01 for k in range(-5, 6)]
    curved = NonlinearSpring("handle", "m", line, [300 * x for x in line])
    x = 0.02 * np.sin(np.arange(2000) * 0.03)
    linear, through_points = (
        SceneRun(zw.Scene([spring, *rest]), 0.001).follow(x)
        for spring in (Spring("handle", "m", 300), curved)
    )
    assert np.abs(linear - through_points).max() < 1e-12


def test_frictions_in_a_row_slide_where_the_weakest_gives_way():
    """A drag of some micrometres against 2 kN: the force is the weakest one's, at once and to rounding."""
    scene = zw.Scene(
        [
            Mass("a", "0.1"),
            Mass("b", "0.1"),
            CoulombFriction("handle", "a", 2000),
            CoulombFriction("a", "b", 3000),
            CoulombFriction("b", "ground", 3100),
        ]
    )
    run = SceneRun(scene, 0.001)
    assert run.follow(3e-6 * np.arange(1, 200)) == pytest.approx(np.full(199, 2000.0), rel=1e-9)
    assert abs(run.account().attrs["left_over_J"]) <= 1e-12 * run.account().attrs["port_work_J"]


def test_frictions_that_hold_each_other_leave_the_weakest_to_slide():
    """Round a loop forces may grow while nothing moves; they end where one gives way, at some 2.44 N here."""
    scene = zw.Scene(
        [
            Mass("m", "0.005"),
            Damper("n", "ground", "0.013"),
            Spring("m", "handle", 1110),
            Contact("n", "m", 7456, 56),
            CoulombFriction("ground", "n", 420),
            CoulombFriction("handle", "m", 2280),
            CoulombFriction("m", "n", "2.44"),
        ]
    )
    run = SceneRun(scene, 0.1)
    y = 1e-4 * np.sin(0.6 * np.arange(1, 200))
    forces = run.follow(y)
    assert 2.4 < np.abs(forces).max() < 4
    assert abs(run.account().attrs["left_over_J"]) <= 1e-10 * float(np.abs(run.account().work).sum())
