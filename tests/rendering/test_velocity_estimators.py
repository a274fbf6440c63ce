"""Dampers on estimators that are not linear: each against its law written plainly, and against the truth."""

from fractions import Fraction

import numpy as np
import pytest
from prescribed import COUNT, DEVICE, PERIOD, commands, wandering
from scipy.linalg import solve_discrete_are

import zwidth as zw
from zwidth.model.rendering import AdaptiveWindow, Damper, Kalman, TickTime
from zwidth.model.rendering.velocity import gains

FREE = zw.PulseTransferFunction([0], [1])
"""No force and no surface: a damper of 1 N·s/m on it commands its velocity."""


def estimated(positions, estimator, **options):
    return commands(positions, Damper(1, estimator), environment=FREE, **options)


def adaptive(readings, noise, longest, best):
    """The definition with np.polyfit, the readings before the first one equal to it."""
    padded = np.concatenate((np.full(longest, readings[0]), readings))
    velocities = []
    for k in range(longest, len(padded)):
        slope = 0.0
        for n in range(1, longest + 1):
            past = padded[k - n : k + 1]
            t = np.arange(-n, 1)
            trial = np.polyfit(t, past - past[-1], 1)[0] if best else (past[-1] - past[0]) / n
            if np.any(np.abs(past - (past[-1] + trial * t)) > noise * (1 + 1e-6)):
                break
            slope = trial
        velocities.append(slope / PERIOD)
    return np.array(velocities)


def ticks(readings, count, period):
    """In whole counts and exact time."""
    velocities, v, last, side = [], Fraction(0), None, 0
    counts = np.rint(readings / count).astype(int).tolist()
    for k, now in enumerate(counts):
        moved = now - counts[max(k - 1, 0)]
        if moved:
            sign = 1 if moved > 0 else -1
            edges = abs(moved) - (side == -sign)
            v = Fraction(sign * edges, k - last) if last is not None else Fraction(0)
            last, side = k, sign
        elif last is not None:
            v = max(min(v, Fraction(1, k - last)), Fraction(-1, k - last))
        velocities.append(float(v) * count / period)
    return np.array(velocities)


@pytest.mark.parametrize("fit", ["end", "best"])
@pytest.mark.parametrize(("noise", "longest"), [(None, 15), (3.3e-5, 7), (1e-4, 40)])
def test_the_window_is_that_of_its_definition(noise, longest, fit):
    x = wandering()
    read, v = estimated(x, AdaptiveWindow(noise, longest, fit))
    expected = adaptive(read, COUNT if noise is None else noise, longest, fit == "best")
    assert v == pytest.approx(expected, abs=1e-9)
    assert len(np.unique(np.round(v, 9))) > 20


def test_ticks_are_timed():
    x = wandering(speed=0.02)
    read, v = estimated(x, TickTime())
    assert v == pytest.approx(ticks(read, COUNT, PERIOD), abs=1e-9)
    assert (v != 0).mean() > 0.3


@pytest.mark.parametrize("estimator", [TickTime(), AdaptiveWindow(), AdaptiveWindow(fit="best")])
def test_without_a_resolution_they_are_differences(estimator):
    """Every sample is a tick, and no line fits but a straight motion, whose slope is the same."""
    x = wandering()
    read, v = estimated(x, estimator, device=DEVICE.replace(resolution=0))
    assert v[1:] == pytest.approx(np.diff(read) / PERIOD, abs=1e-12)


def test_trembling_about_an_edge_has_no_velocity():
    """The same edge to and fro; the backward difference sees a count a sample each way."""
    x = 1e-3 + 2e-6 * np.sin(np.arange(300) * 1.9)
    read, v = estimated(x, TickTime())
    assert np.abs(np.diff(read)).max() == pytest.approx(COUNT)
    assert np.abs(v).max() < 1e-9


@pytest.mark.parametrize("density", [0.02, 1.0, 50.0, 3e4])
def test_the_kalman_gains_are_those_of_the_riccati_equation(density):
    a = np.array([[1, PERIOD], [0, 1]])
    q = density**2 * np.array([[PERIOD**3 / 3, PERIOD**2 / 2], [PERIOD**2 / 2, PERIOD]])
    scale = np.diag([1 / COUNT, PERIOD / COUNT])  # in counts per sample, so that SciPy keeps its digits
    unit = np.linalg.inv(scale)
    p = solve_discrete_are(
        (scale @ a @ unit).T, np.array([[1.0], [0]]), scale @ q @ scale, np.array([[1 / 12]])
    )
    gain = p[:, 0] / (p[0, 0] + 1 / 12)
    assert gains(density, COUNT, PERIOD) == pytest.approx(tuple(gain), rel=1e-7)


def test_the_kalman_filter_runs_with_its_gains():
    """Predict and correct, from rest at the first reading; by default a count is wandered in ten samples."""
    for given, density in ((None, (3 * COUNT**2 / (10 * PERIOD) ** 3) ** 0.5), (2.5, 2.5)):
        read, v = estimated(wandering(), Kalman(given))
        alpha, beta = gains(density, COUNT, PERIOD)
        state, expected = np.array([read[0], 0.0]), []
        for reading in read:
            state = np.array([state[0] + PERIOD * state[1], state[1]])
            state += np.array([alpha, beta / PERIOD]) * (reading - state[0])
            expected.append(state[1])
        assert v == pytest.approx(np.array(expected), abs=1e-11)


def test_without_quantization_the_kalman_filter_has_one_fast_pole():
    """α = 1, β = 3 − √3, whatever the acceleration; a little quantization is near it."""
    assert gains(1, 0, PERIOD) == (1.0, 3 - 3**0.5)
    assert gains(1, 1e-12, PERIOD) == pytest.approx((1.0, 3 - 3**0.5), abs=1e-6)


SPEEDS = np.array([0.0021, 0.0077, 0.0183])
"""Slower than a count a sample, 0.02 m/s."""


@pytest.mark.parametrize("speed", SPEEDS)
def test_at_low_speed_they_are_quieter_than_the_backward_difference(speed):
    """A staircase: differences are whole counts; the window errs by Δ/(N T) at most."""
    x = 1e-3 + speed * PERIOD * np.arange(3000)
    read, v = estimated(x, AdaptiveWindow())
    settled = slice(200, None)
    assert np.abs(v[settled] - speed).max() < COUNT / (15 * PERIOD)
    rough = np.var((np.diff(read) / PERIOD)[settled])
    assert rough == pytest.approx(speed * (COUNT / PERIOD - speed), rel=0.05)  # Bernoulli's
    quiet = {
        "window": np.var(v[settled]),
        "best": np.var(estimated(x, AdaptiveWindow(fit="best"))[1][settled]),
        "ticks": np.var(estimated(x, TickTime())[1][settled]),
        "kalman": np.var(estimated(x, Kalman())[1][settled]),
    }
    most = {"window": 0.02, "best": 0.01, "ticks": 0.3, "kalman": 0.1}
    assert {k: q / rough for k, q in quiet.items() if q > most[k] * rough} == {}


def test_a_fast_hand_is_followed_by_a_short_window():
    """Lag of the velocity behind the truth at 3 Hz and 0.5 m/s: half a sample is the least."""
    t = np.arange(4000) * PERIOD
    w = 2 * np.pi * 3
    x = 0.5 / w * np.sin(w * t)

    def lag(estimator):
        v = estimated(x, estimator)[1][1000:]
        c, s = (v * np.cos(w * t[1000:])).sum(), (v * np.sin(w * t[1000:])).sum()
        return np.arctan2(s, c) / w / PERIOD

    assert lag(AdaptiveWindow(longest=1)) == pytest.approx(0.5, abs=0.02)
    assert lag(TickTime()) == pytest.approx(0.5, abs=0.1)
    assert lag(AdaptiveWindow()) < 2.0
    assert lag(AdaptiveWindow(fit="best")) < 2.0
    assert lag(Kalman()) == pytest.approx(2.8, abs=0.1)
    assert lag(AdaptiveWindow(noise=1e-2)) == pytest.approx(7.5, abs=0.1)  # N/2 where the line always fits


def test_inside_only_and_pushing_only():
    x = wandering()
    read, v = estimated(x, TickTime())
    spring = 300 * np.maximum(read, 0)
    expected = np.where(read > 0, spring + 4 * v, 0)
    _, force = commands(x, Damper(4, TickTime()), environment=zw.Wall(300))
    assert force == pytest.approx(expected, abs=1e-9)
    assert expected.min() < -0.01
    _, clamped = commands(x, Damper(4, TickTime(), clamped=True), environment=zw.Wall(300))
    assert clamped == pytest.approx(np.maximum(expected, 0), abs=1e-9)
