"""Tests of tissue: which test it is, the probe's history, noise, the model, intervals, slow branches."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.linalg import cholesky, solve_triangular
from scipy.optimize import least_squares
from scipy.stats import binom

import zwidth as zw
from zwidth.data.tissue.experiment.choice import Tried, not_told_apart, taken
from zwidth.data.tissue.experiment.estimate import (
    bends,
    covariance,
    likelihood,
    noise_of,
    solved,
    with_memory,
)
from zwidth.data.tissue.experiment.history import History, Trial, history_of, kind_of
from zwidth.data.tissue.experiment.prediction import Task, derivatives, fines_of, predicted
from zwidth.data.tissue.model import as_model

SOLID = zw.StandardLinearSolid(420, 260, 90)
TRUE = (420, 260, 90)
ONE = ("standard-linear-solid",)


def parameters(test: zw.tissue.TissueTest) -> list[float]:
    return [test.best[name] for name in test.best.model.parameters]


def remembering(white: np.ndarray, rho: np.ndarray | float) -> np.ndarray:
    """Noise of one variance that keeps the share ρ of what it was."""
    noise = white.copy()
    for k, share in enumerate(np.broadcast_to(rho, white.size - 1)):
        noise[k + 1] = share * noise[k] + np.sqrt(1 - share * share) * white[k + 1]
    return noise


def task_of(name: str, history: History, branches: int | None = None) -> Task:
    return Task(as_model(name, branches, "force"), history, fines_of(history)[0], True)


def relaxation(count: int = 300, begin: float = 0.5) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    time = np.linspace(0, 6, count)
    s = np.clip((time - begin) / 0.3, 0, 1)
    depth = 0.004 * s**2 * (3 - 2 * s)
    return time, depth, exact(time, begin)


def exact(time: np.ndarray, begin: float) -> np.ndarray:
    """The force of that smooth ramp, by integration of q̇ = μ ẋ − q μ/η in steps of 0.1 ms."""
    fine = np.arange(0, 6.0001, 1e-4)
    s = np.clip((fine - begin) / 0.3, 0, 1)
    moved = np.diff(0.004 * s**2 * (3 - 2 * s))
    q, held = np.zeros(fine.size), np.exp(-1e-4 * 260 / 90)
    for k, step in enumerate(moved):
        q[k + 1] = held * q[k] + 260 * step * np.sqrt(held)
    return np.interp(time, fine, 420 * 0.004 * s**2 * (3 - 2 * s) + q)


def strokes() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """From 1 mm outside in and half out again, three times."""
    time = np.linspace(0, 6, 400)
    depth = -0.001 + 0.003 * (1 - np.cos(2 * np.pi * time / 6)) + 0.0008 * np.sin(9 * time) * (time / 6)
    return time, depth, zw.tissue.force_response(SOLID, time, np.maximum(depth, 0))


def creep() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    time = np.linspace(0, 8, 300)
    force = 2 * np.clip((time - 0.5) / 0.2, 0, 1)
    return time, zw.tissue.position_response(SOLID, time, force, 0.0), force


@pytest.mark.parametrize(
    ("arrays", "kind"), [(relaxation, "relaxation"), (creep, "creep"), (strokes, "loading")]
)
@pytest.mark.parametrize("noisy", [0.0, 0.01])
def test_which_test_it_is(arrays, kind, noisy):
    rng = np.random.default_rng(4)
    time, x, f = arrays()
    x, f = (v + noisy * np.ptp(v) * rng.normal(size=v.size) for v in (x, f))
    assert kind_of(time, x, f) == kind
    assert kind_of(time, 0.7 - x, -3 - f) == kind


@pytest.mark.parametrize("arrays", [relaxation, creep, strokes])
def test_without_noise_the_parameters_come_back_whatever_origin_and_sign(arrays):
    time, x, f = arrays()
    for test in (
        zw.tissue.fit_test(time, x, f, models=ONE),
        zw.tissue.fit_test(time + 55, 0.3 - x, 7 - f, models=ONE),
    ):
        assert parameters(test) == pytest.approx(TRUE, rel=3e-3)


def test_a_step_before_the_first_sample():
    time = np.geomspace(0.001, 8, 150)
    force = 0.004 * (420 + 260 * np.exp(-(time - 0.001) * 260 / 90))
    test = zw.tissue.fit_test(time, np.full(150, 0.004), -force, models=ONE)
    assert parameters(test) == pytest.approx(TRUE, rel=1e-5)
    assert test.test.starts_loaded
    assert any("begins loaded" in str(said) for said in test.best.findings)


def test_the_surface_is_found_where_the_probe_comes_from_outside():
    time, x, f = strokes()
    trial = Trial(time, x + 0.04, f, ())
    history = history_of(trial, "loading", "here")
    assert history.surface == pytest.approx(0.001, abs=2e-4)
    assert history.depth[0] == 0


def test_what_branches_hold_after_a_hole_in_which_the_probe_moved():
    time, x, f = strokes()
    keep = np.r_[0:180, 215:400]
    test = zw.tissue.fit_test(time[keep], x[keep], f[keep], models=ONE)
    assert parameters(test) == pytest.approx(TRUE, rel=3e-3)
    assert any("what the branches hold after it is fitted" in str(said) for said in test.best.findings)


@pytest.mark.parametrize("name", ["kelvin-voigt", "maxwell", "generalized-maxwell", "hunt-crossley"])
def test_derivatives_are_those_of_differences(name):
    """With a surface, a zero, and two holes."""
    time, x, f = strokes()
    history = history_of(Trial(time, x, f, ()), "loading", "here")._replace(begins=(150, 250))
    task = task_of(name, history)
    values = {"kelvin-voigt": (400, 20), "maxwell": (400, 90), "hunt-crossley": (4000, 1.4, 5)}
    own = values.get(name, (420, 200, 10, 260, 90))
    point = np.concatenate([np.log(own), [0.02], [0.15], np.full(task.held, 0.1)])
    found = derivatives(task, point)
    for k in range(point.size):
        up, down = point.copy(), point.copy()
        up[k] += 1e-4
        down[k] -= 1e-4
        expected = (predicted(task, up) - predicted(task, down)) / 2e-4
        assert found[:, k] == pytest.approx(expected, abs=1e-6 * np.abs(expected).max())


def test_whitening_is_that_of_the_whole_covariance():
    """At uneven times: |ε|² and ln det from the matrix exp(−|tᵢ − tⱼ|/τ)."""
    rng = np.random.default_rng(8)
    time = np.cumsum(rng.uniform(0.01, 0.2, 40))
    noise = with_memory(time, 0.13)
    values = rng.normal(size=40)
    matrix = np.exp(-np.abs(time[:, None] - time) / 0.13)
    white = solve_triangular(cholesky(matrix, lower=True), values, lower=True)
    assert np.abs(noise.whitened(values)) == pytest.approx(np.abs(white), rel=1e-9)
    assert noise.log_determinant == pytest.approx(np.linalg.slogdet(matrix)[1], rel=1e-9)
    expected = 40 * np.log(white @ white / 40) + noise.log_determinant
    assert likelihood(noise, values) == pytest.approx(expected, rel=1e-12)


def test_a_memory_is_seen_and_white_noise_has_none():
    rng = np.random.default_rng(5)
    time = np.cumsum(rng.uniform(0.005, 0.015, 500))
    columns = np.stack([np.ones(500), time], axis=1)
    white = rng.normal(size=500)
    noise = with_memory(time, 0.03)
    assert noise_of(time, white, columns).memory == 0
    assert 0.02 < noise_of(time, remembering(white, noise.between), columns).memory < 0.045


def candidate(name: str, branches: int | None, criterion: float) -> Tried:
    time, x, f = relaxation(40)
    history = history_of(Trial(time, x, f, ()), "relaxation", "here")
    return Tried(task_of(name, history, branches), None, criterion)  # type: ignore[arg-type]  # nothing here looks at the fit


@pytest.mark.parametrize(
    ("criteria", "best", "others"),
    [
        ((0.0, 4.0, 90.0), "standard-linear-solid", ()),  # a branch more gains nothing
        # … or not enough to be believed
        ((5.9, 0.0, 90.0), "standard-linear-solid", ("generalized-maxwell",)),
        ((6.1, 0.0, 90.0), "generalized-maxwell", ()),
        ((0.0, 4.0, 5.9), "standard-linear-solid", ("hunt-crossley",)),  # neither contains the other
        ((0.0, 4.0, 6.1), "standard-linear-solid", ()),
    ],
)
def test_the_simplest_within_6_is_taken_and_rivals_are_named(criteria, best, others):
    models = (("standard-linear-solid", None), ("generalized-maxwell", 2), ("hunt-crossley", None))
    every = [candidate(*model, value) for model, value in zip(models, criteria, strict=True)]
    every.sort(key=lambda each: each.criterion)
    chosen = taken(every)
    assert every[chosen].task.model.name == best
    assert tuple(every[k].task.model.name for k in not_told_apart(every, chosen)) == others


def test_two_branches_are_told_from_one_and_a_misfit_is_said():
    time, x, _ = relaxation(400)
    solid = zw.GeneralizedMaxwell(420, [(200, 10), (260, 200)])
    force = zw.tissue.force_response(solid, time, x) + np.random.default_rng(2).normal(0, 0.004, 400)
    test = zw.tissue.fit_test(time, x, force, models=("standard-linear-solid", "generalized-maxwell-2"))
    assert (test.best.model.branches, test.rivals, test.is_noise) == (2, (), True)
    alone = zw.tissue.fit_test(time, x, force, models=("maxwell",))
    assert not alone.is_noise
    assert "not noise" in alone.doubts[-1]


def test_intervals_hold_the_truth_as_often_as_they_say():
    """24 tests with noise of a memory of 3 samples: misses as a fair binomial may have them."""
    rng = np.random.default_rng(11)
    time, x, clean = relaxation(200)
    runs, held = 24, dict.fromkeys(("stiffness", "branch_stiffness", "branch_damping"), 0)
    for _ in range(runs):
        noise = remembering(rng.normal(0, 0.01, 200), np.exp(-1 / 3))
        best = zw.tissue.fit_test(time, x, clean + noise, models=ONE).best
        for name, value in zip(held, TRUE, strict=True):
            low, high = best.interval(name)
            held[name] += low <= value <= high
    fewest = binom.ppf(0.0005, runs, 0.95)
    assert min(held.values()) >= fewest


def test_a_fit_is_drawn():
    time, x, f = relaxation(60)
    test = zw.tissue.fit_test(time, x, f, models=("kelvin-voigt",))
    assert len(test.plot().axes) == 3
    figure = test.best.plot()
    assert len(figure.axes) == 2
    line = figure.axes[0].lines[1].get_ydata()
    assert line == pytest.approx(test.best.output - test.best.residuals)


def viscous(ramp: float, count: int = 200, slow: float = 0.0) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """A spring with a damper under 4 mm within a smooth ramp, and a hold."""
    time = np.linspace(0, 4, count)
    s = np.clip((time - slow) / ramp, 0, 1)
    depth = 0.004 * s**3 * (10 - 15 * s + 6 * s**2)
    speed = 0.004 * 30 * s**2 * (1 - s) ** 2 / ramp
    return time, depth, 400 * depth + 30 * speed


@pytest.mark.parametrize("slow", [0.0, 0.5])
def test_between_the_samples_of_a_quick_smooth_ramp_the_speed_is_that_of_a_smooth_curve(slow):
    """Eight samples: by a monotone cubic, or a spline that is not at rest before, the damper is 2 % off."""
    test = zw.tissue.fit_test(*viscous(0.16, slow=slow), models=("kelvin-voigt",))
    assert test.best["damping"] == pytest.approx(30, rel=5e-3)
    assert test.best["stiffness"] == pytest.approx(400, rel=2e-3)


def test_a_curve_that_fits_nearly_as_well_widens_the_interval():
    """Noise of 2 %: which curve the probe took is not seen, and the damper depends on it."""
    time, x, f = viscous(0.16, slow=0.5)
    f = f + np.random.default_rng(3).normal(0, 0.02 * f.max(), f.size)
    test = zw.tissue.fit_test(time, x, f, models=("kelvin-voigt",))
    own = test.tried[0]
    alone = covariance(own.found)[0]
    assert test.best.covariance[1, 1] == pytest.approx(alone[1, 1] + own.apart[1, 1])
    assert own.apart[1, 1] > 0


def test_what_is_held_with_less_noise_is_what_the_machine_held():
    """A spring with a damper rests within 0.1 s: depth and force are held for as long."""
    time, x, f = viscous(0.16, 400)
    noise = np.random.default_rng(1).normal(size=f.size)
    assert kind_of(time, x, f + 0.01 * f.max() * noise) == "relaxation"
    assert kind_of(time, x + 0.01 * x.max() * noise, f) == "creep"


def test_noise_with_a_memory_is_no_touch():
    """It strays for some samples together, before the probe touches: the surface is found all the same."""
    time, x, _ = relaxation(400)
    depth = 1.2 * x - 0.0008
    noise = remembering(np.append(0.0, np.random.default_rng(12).normal(size=399)), 0.8)
    force = zw.tissue.force_response(SOLID, time, np.maximum(depth, 0)) + 0.02 * noise
    history = history_of(Trial(time, depth, force, ()), "relaxation", "here")
    assert history.surface == pytest.approx(0.0008, abs=3e-4)


def test_a_branch_of_nothing_is_no_end_of_a_search():
    """It relaxes and creeps at one rate, as floats go: a search that strays there is told to come back."""
    history = history_of(Trial(*creep(), ()), "creep", "here")
    task = task_of("standard-linear-solid", history)
    found = predicted(task, np.append(np.log([420, 2.6e-38, 9e-39]), 0.0))
    assert (found == 0).all()


def test_the_ends_of_a_number_that_is_hardly_known():
    """A branch that relaxes within a sample: at both ends the fit, by another road, is as much worse."""

    def motion(time: np.ndarray) -> np.ndarray:
        s = np.clip(time / 0.5, 0, 1)
        return 0.003 * s**3 * (10 - 15 * s + 6 * s**2) + 0.0006 * (1 - np.cos(31 * time))

    def left(point: np.ndarray) -> np.ndarray:
        tissue = zw.StandardLinearSolid(*np.exp(point[:3]))
        return zw.tissue.force_response(tissue, fine, motion(fine))[::8] + point[3] - measured

    time = 0.02 * np.arange(300)
    fine, measured = np.linspace(0, time[-1], 8 * 299 + 1), 0.0
    measured = left(np.append(np.log([400, 300, 6]), 0.0)) + np.random.default_rng(4).normal(0, 0.08, 300)
    test = history_of(Trial(time, motion(time), measured, ()), "loading", "here")._replace(surface=None)
    task = task_of("standard-linear-solid", test)
    found = solved(task)
    best = 2 * least_squares(left, found.point).cost

    def worse(away: float) -> float:
        """Standard deviations."""
        branch, others = found.point[1] + away, found.point[[0, 2, 3]]
        cost = 2 * least_squares(lambda point: left(np.insert(point, 1, branch)), others).cost
        return float(np.sqrt((cost - best) / (best / 296)))

    sigma, t = float(np.sqrt(covariance(found)[0][1, 1])), 1.968
    below, above = bends(task, found)[1]
    assert 0.1 < sigma < 0.4
    assert worse(-t * sigma * (1 + below * t)) == pytest.approx(t, rel=0.08)
    assert worse(t * sigma * (1 + above * t)) == pytest.approx(t, rel=0.08)
    assert worse(t * sigma) < 0.9 * t


def short_ramp() -> tuple[np.ndarray, np.ndarray]:
    time = np.linspace(0, 4, 120)
    s = np.clip((time - 0.3) / 0.3, 0, 1)
    return time, 0.004 * s**2 * (3 - 2 * s)


def held(time_constant: float) -> zw.tissue.TissueTest:
    """A solid of 400 N/m and 250 N/m under it, with noise of 10 mN."""
    time, depth = short_ramp()
    force = zw.tissue.force_response(zw.StandardLinearSolid(400, 250, 250 * time_constant), time, depth)
    force = force + np.random.default_rng(1).normal(0, 0.01, time.size)
    return zw.tissue.fit_test(time, depth, force, models=("maxwell", *ONE))


def test_a_test_that_is_long_enough_says_nothing():
    test = held(0.8)
    assert test.slowest is None
    assert not test.doubts


@pytest.mark.parametrize("time_constant", [8.0, 100.0])
def test_the_bounds_hold_the_truth(time_constant):
    """A Maxwell body fits the second as well, and would have its own time known to a few per cent."""
    test = held(time_constant)
    slowest = test.slowest
    assert slowest.at_least < time_constant
    assert slowest.at_most is None or slowest.at_most > time_constant
    assert "hold for longer" in test.doubts[0]
    assert test.to_dict()["slowest_relaxation_time_s"]["at_least"] == slowest.at_least


def test_at_the_bound_the_likelihood_is_what_it_should_be():
    """By another road: rates on a grid, the springs and the zero by linear least squares."""
    test, (time, depth) = held(8.0), short_ramp()
    zeroed = test.test.force

    def left(time_constant: float) -> float:
        branch = zw.tissue.force_response(zw.Maxwell(1, time_constant), time, depth)
        columns = np.stack([depth, branch, np.ones_like(time)], axis=1)
        return float(np.linalg.lstsq(columns, zeroed, rcond=None)[1][0])

    least = min(left(tau) for tau in np.geomspace(3, 40, 400))
    variance = least / (time.size - 4)
    for bound in (test.slowest.at_least, test.slowest.at_most):
        assert (left(bound) - least) / variance == pytest.approx(1.658**2, rel=0.03)
