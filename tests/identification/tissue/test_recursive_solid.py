"""A solid as a recursion; who finds it under noise, what bounds and a dead zone do, and five parameters."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.signal import lfilter

import zwidth as zw
from zwidth.data.tissue import RecursiveSolid, Solid, coefficients, force_response

T = 1e-3
PERIOD = Fraction(1, 1000)
START = (200, 200, 20)
positive = st.fractions(Fraction(1, 50), 900, max_denominator=997)


def motion(samples):
    t = T * np.arange(samples)
    tones = 3 * np.sin(4.4 * t) + np.sin(19.5 * t) + 0.5 * np.sin(71 * t)
    return t, 0.006 + 1e-3 * tones


def tissue(samples, *solid, noise=0.0, seed=1):
    t, x = motion(samples)
    f = force_response(zw.StandardLinearSolid(*solid), t, x)
    return x, f + noise * np.random.default_rng(seed).normal(0, 1, samples)


def mean_of_the_end(track, samples=5000):
    return [float(part[-samples:].mean()) for part in track[:3]]


def plain(x, f, rule, forgetting, noise, start):
    """Recursive least squares with matrices, started as the tracker."""
    p, b0, b1 = coefficients(*(float(v) for v in start), T, rule)
    scale, g = start[0] + start[1], T * start[1] / start[2]
    theta, cov = np.array([(1 + p) / g, (b0 + b1) / g / scale, -b1 / scale]), np.eye(3) / noise**2
    for k in range(1, len(x)):
        phi = np.array([-g * f[k - 1], g * scale * x[k], scale * (x[k] - x[k - 1])])
        gain = cov @ phi / (forgetting + phi @ cov @ phi)
        theta = theta + gain * (f[k] - f[k - 1] - phi @ theta)
        cov = (cov - np.outer(gain, phi @ cov)) / forgetting
        cov *= min(1.0, 3 / noise**2 / np.trace(cov))
    p, b1 = g * theta[0] - 1, -scale * theta[2]
    b0 = g * scale * theta[1] - b1
    mu0 = (b0 + b1) / (1 + p)
    if rule == "bilinear":
        mu1 = (b0 - b1) / (1 - p) - mu0
        return mu0, mu1, mu1 * T * (1 - p) / 2 / (1 + p)
    return mu0, b1 / p - mu0, -(b1 / p - mu0) * T * p / (1 + p)


@pytest.mark.parametrize("rule", ["bilinear", "backward"])
def test_least_squares_is_the_textbook_recursion(rule):
    """The compiled steps against matrices, where no bound is met."""
    x, f = tissue(400, 300, 150, 3, noise=1e-4)
    settings = RecursiveSolid(T, START, method="least-squares", rule=rule, forgetting="0.995", noise="0.001")
    track = settings.track(x, f)
    expected = plain(x, f, rule, 0.995, 0.001, START)
    assert [float(part[-1]) for part in track[:3]] == pytest.approx(expected, rel=1e-6)


@pytest.mark.parametrize(("rule", "law"), [("bilinear", "tustin"), ("backward", "backward")])
def test_each_rule_finds_what_its_controller_renders(rule, law):
    """Forces of the recursion itself, without noise: to the weight that the start has."""
    _, x = motion(3000)
    sides = zw.StandardLinearSolid(300, 150, 3, law).pulse_transfer_function(PERIOD)
    num, den = ([float(c) for c in side] for side in sides)
    settings = RecursiveSolid(T, START, method="least-squares", rule=rule, noise="0.0001")
    track = settings.track(x, lfilter(num, den, x))
    assert [float(part[-1]) for part in track[:3]] == pytest.approx([300, 150, 3], rel=1e-5)


@pytest.mark.parametrize("relaxation", [0.02, 0.1, 0.5])
def test_least_squares_is_biased_and_instruments_are_not(relaxation):
    """Noise of 10 mN on forces of some 2 N: instruments stay within 1 %, least squares does not."""
    true = 300.0, 150.0, 150.0 * relaxation
    x, f = tissue(60_000, *true, noise=0.01)
    found = {
        method: mean_of_the_end(RecursiveSolid(T, START, method=method, forgetting="0.9998").track(x, f))
        for method in ("least-squares", "instrumental")
    }
    assert found["instrumental"] == pytest.approx(true, rel=0.01)
    assert abs(found["least-squares"][2] / true[2] - 1) > 0.2


def test_output_error_arrives_too_but_later():
    """Without bias at 20 ms; of 0.5 s it has not found after 20 s what instruments have after 2 s."""
    quick, slow = (300.0, 150.0, 3.0), (300.0, 150.0, 75.0)
    x, f = tissue(40_000, *quick, noise=0.01)
    pole = RecursiveSolid(T, START, method="output-error", forgetting="0.9998").track(x, f)
    assert mean_of_the_end(pole) == pytest.approx(quick, rel=0.01)
    x, f = tissue(20_000, *slow, noise=0.001)
    late, early = (
        RecursiveSolid(T, START, method=method, forgetting="0.9998", noise="0.001").track(x, f)
        for method in ("output-error", "instrumental")
    )
    assert abs(late.branch_damping[-1] / 75 - 1) > 0.2
    assert early.branch_damping[2000:] == pytest.approx(75, rel=0.1)


def test_maxwell_and_kelvin_voigt_are_solids_too():
    """One has μ0 = 0; the other a branch so stiff that only its dashpot is seen."""
    t, x = motion(20_000)
    noise = np.random.default_rng(1).normal(0, 0.01, t.size)
    fluid = force_response(zw.Maxwell(150, 15), t, x) + noise
    mu0, mu1, eta1 = mean_of_the_end(RecursiveSolid(T, START, forgetting="0.9998").track(x, fluid))
    assert mu0 < 0.5
    assert (mu1, eta1) == pytest.approx((150, 15), rel=0.02)
    damped = force_response(zw.Wall(300, 2), t, x) + noise
    quick = RecursiveSolid(T, (200, 2000, 2), forgetting="0.9998")  # 1 ms at the start
    mu0, mu1, eta1 = mean_of_the_end(quick.track(x, damped))
    assert (mu0, eta1) == pytest.approx((300, 2), rel=0.02)
    assert mu1 > 1000


def test_a_tissue_that_changes_is_followed():
    t, x = motion(40_000)
    soft, stiff = (force_response(zw.StandardLinearSolid(mu0, 150, 15), t, x) for mu0 in (300, 600))
    f = np.where(t < 20, soft, stiff) + np.random.default_rng(3).normal(0, 0.01, t.size)
    follows, remembers = (RecursiveSolid(T, START, forgetting=keep).track(x, f) for keep in ("0.9995", 1))
    assert follows.stiffness[19_999] == pytest.approx(300, rel=0.02)
    assert follows.stiffness[-1] == pytest.approx(600, rel=0.02)
    assert abs(remembers.stiffness[-1] / 600 - 1) > 0.05


@pytest.mark.parametrize(
    ("options", "most"),
    [
        ({"method": "least-squares", "largest_trace": "0.01"}, 3e2),
        ({"method": "instrumental"}, 3e4),
    ],
)
def test_without_motion_nothing_winds_up(options, most):
    """A hand that rests for a minute: P stays within its bound, and the stiffness where it was."""
    x, f = tissue(10_000, 300, 150, 15, noise=0.01)
    rest = np.full(60_000, x[-1])
    settled = 300 * x[-1] + np.random.default_rng(5).normal(0, 0.01, rest.size)
    tracker = RecursiveSolid(T, START, **options).start()
    tracker.track(x, f)
    before = tracker.solid
    track = tracker.track(rest, settled)
    assert track.trace.max() <= most * (1 + 1e-12)
    assert track.stiffness == pytest.approx(before.stiffness, rel=0.1)


def test_without_a_bound_it_does_wind_up():
    """P grows as 1/λ per sample in what a resting hand does not show."""
    x, f = tissue(2000, 300, 150, 15, noise=0.01)
    settings = RecursiveSolid(T, START, method="least-squares", forgetting="0.99", largest_trace=10**30)
    tracker = settings.start()
    tracker.track(x, f)
    trace = tracker.track(np.full(2000, x[-1]), np.full(2000, 300 * x[-1])).trace
    assert np.log(trace[1500] / trace[1000]) == pytest.approx(-500 * np.log(0.99), rel=1e-3)


def test_dead_zone_and_outside_teach_nothing():
    x, f = tissue(500, 300, 150, 15)
    deaf = RecursiveSolid(T, START, dead_zone=100).track(x, f)
    assert np.ptp(deaf.stiffness) == 0
    x, f = tissue(10_000, 300, 150, 15, noise=0.01)
    tracker = RecursiveSolid(T, START, dead_zone="0.05").start()
    tracker.track(x, f)
    resting = tracker.track(np.full(5000, x[-1]), f[-1] + np.random.default_rng(5).normal(0, 0.01, 5000))
    assert np.count_nonzero(np.diff(resting.stiffness)) < 50
    outside = RecursiveSolid(T, START).track(-x, f)
    assert np.ptp(outside.stiffness) == 0
    assert np.ptp(RecursiveSolid(T, START).track(x, f).stiffness) > 0


@pytest.mark.parametrize("rule", ["ramp", "bilinear", "backward"])
@pytest.mark.parametrize("method", ["least-squares", "instrumental", "output-error"])
def test_what_is_returned_is_admissible(method, rule):
    """Forces that no solid gives: every number stays within its bounds, and those are reached."""
    bounds = {"stiffest": 500, "relaxation_times": ("0.002", "0.3")}
    force = 5 * np.random.default_rng(8).normal(size=4000).cumsum()
    track = RecursiveSolid(T, START, method=method, rule=rule, **bounds).track(motion(4000)[1], force)
    mu0, mu1, eta1 = track[:3]
    assert min(mu0.min(), mu1.min(), eta1.min()) >= 0
    assert max(mu0.max(), mu1.max()) <= 500
    relaxation = eta1[mu1 > 0] / mu1[mu1 > 0]
    assert relaxation.min() >= 0.002 * (1 - 1e-9)
    assert relaxation.max() <= 0.3 * (1 + 1e-9)
    assert mu0.max() == 500 or mu0.min() == 0


def test_sample_by_sample_is_the_same():
    x, f = tissue(300, 300, 150, 15, noise=0.01)
    settings = RecursiveSolid(T, START)
    tracker = settings.start()
    solids = [tracker.update(*pair) for pair in zip(x, f, strict=True)]
    track = settings.track(x, f)
    assert solids[-1] == Solid(*(float(part[-1]) for part in track[:3]))
    assert [s.stiffness for s in solids] == list(track.stiffness)
    settled = tracker.track(x, f).trace[-1]
    tracker.forget()
    assert tracker.update(x[0], f[0]) is not None
    assert settled < 1.1e4 < 1.9e4 < tracker.track(x[1:2], f[1:2]).trace[0]


def test_a_sample_that_was_not_measured_is_passed_over():
    x, f = tissue(10_000, 300, 150, 15, noise=0.01)
    tracker = RecursiveSolid(T, START).start()
    tracker.track(x[:5000], f[:5000])
    before = tracker.solid
    assert tracker.update(x[5000], np.nan) == tracker.update(np.inf, f[5001]) == before
    track = tracker.track(x[5002:], f[5002:])
    assert [float(part[-1]) for part in track[:3]] == pytest.approx([300, 150, 15], rel=0.1)


def test_five_parameters_are_not_identifiable():
    """Along the line of (1 + c z⁻¹) P grows as 1/λ per sample; the solid of equation (32) is anything."""
    _, x = motion(30_000)
    p, b0, b1 = coefficients(300.0, 150.0, 15.0, T, "bilinear")
    force = lfilter([b0, b1], [1, p], x - x[0]) + 300 * x[0]
    exact = zw.tissue.track_five_parameters(x[:2600], force[:2600], T, forgetting="0.99")
    grown = np.log(exact["trace"][2500] / exact["trace"][2000])
    assert grown == pytest.approx(-500 * np.log(0.99), rel=1e-3)
    assert abs(exact["stiffness"][2500] / 300 - 1) > 0.5
    noisy = force + np.random.default_rng(2).normal(0, 0.001, x.size)
    five = zw.tissue.track_five_parameters(x, noisy, T, forgetting="0.9998")
    three = RecursiveSolid(T, START, rule="bilinear", forgetting="0.9998", noise="0.001").track(x, noisy)
    assert abs(five["stiffness"][-1] / 300 - 1) > 0.5
    assert three.stiffness[-1] == pytest.approx(300, rel=0.01)
    assert three.branch_damping[-1] == pytest.approx(15, rel=0.05)


def test_a_million_samples():
    x, f = tissue(1_000_000, 300, 150, 15, noise=0.01)
    track = RecursiveSolid(T, START, forgetting="0.9999").track(x, f)
    assert mean_of_the_end(track, 100_000) == pytest.approx([300, 150, 15], rel=0.01)


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (lambda: RecursiveSolid(0, START), "sample_period must be > 0"),
        (lambda: RecursiveSolid(T, (1, 2)), r"initial is \(μ0, μ1, η1\), three numbers"),
        (lambda: RecursiveSolid(T, (1, 2, 0)), "initial branch_damping must be > 0"),
        (lambda: RecursiveSolid(T, START, method="magic"), 'method is "least-squares"'),
        (lambda: RecursiveSolid(T, START, rule="forward"), 'rule is "ramp"'),
        (lambda: RecursiveSolid(T, START, forgetting=2), "forgetting is at most 1"),
        (lambda: RecursiveSolid(T, START, dead_zone=-1), "dead_zone must be ≥ 0"),
        (lambda: RecursiveSolid(T, START, relaxation_times=(1, 1)), r"\(shortest, longest\)"),
        (lambda: RecursiveSolid(T, START).track([1.0], [1.0, 2.0]), "two arrays of one length"),
        (lambda: zw.tissue.track_five_parameters([1.0], [1.0, 2.0], T), "two arrays of one length"),
        (lambda: zw.tissue.solid_of(*[Fraction(1)] * 3, PERIOD, "bilinear"), r"p is > −1 and < 1 .*, got 1"),
        (lambda: zw.tissue.solid_of(0.2, 1.0, 1.0, T), "p is > −1 and < 0 for a solid that relaxes"),
    ],
)
def test_bad_input(make, said):
    with pytest.raises(zw.InputError, match=said):
        make()


@given(positive, positive, positive, st.sampled_from(["bilinear", "backward"]))
def test_there_and_back_exactly(mu0, mu1, eta1, rule):
    """For every rational solid, without rounding; equation (32) too, its slip in a1 corrected, at c = 1."""
    p, b0, b1 = coefficients(mu0, mu1, eta1, PERIOD, rule)
    assert zw.tissue.solid_of(p, b0, b1, PERIOD, rule) == (mu0, mu1, eta1)
    a1, _, b1, _, b3 = zw.tissue.five_parameters(mu0, mu1, eta1, PERIOD)
    assert zw.tissue.solid_of_five(a1, b1, b3, PERIOD) == (mu0, mu1, eta1)


@given(positive, positive, positive)
def test_there_and_back_of_the_material(mu0, mu1, eta1):
    """With an exponential: to the rounding that 1 + p leaves."""
    solid = [float(v) for v in (mu0, mu1, eta1)]
    back = zw.tissue.solid_of(*coefficients(*solid, 1e-3), 1e-3)
    lost = 1 + solid[2] / solid[1] / 1e-3 + solid[1] / solid[0] * solid[2] / solid[1] / 1e-3
    assert back == pytest.approx(solid, rel=1e-14 * lost * (1 + solid[0] / solid[1]))


@pytest.mark.parametrize(("rule", "method"), [("bilinear", "tustin"), ("backward", "backward")])
def test_the_recursion_is_the_transfer_function_of_the_environment(rule, method):
    """H(z) = (b0 + b1 z⁻¹)/(1 + p z⁻¹), exactly."""
    solid = Fraction(31, 7), Fraction(13, 3), Fraction(2, 9)
    num, den = zw.StandardLinearSolid(*solid, method).pulse_transfer_function(PERIOD)
    p, b0, b1 = coefficients(*solid, PERIOD, rule)
    assert (num[0] / den[0], num[1] / den[0], den[1] / den[0]) == (b0, b1, p)


def test_the_ramp_recursion_is_the_material_under_straight_lines():
    """Sample by sample, as the continuous-time response has it."""
    x = np.cumsum(np.random.default_rng(2).normal(0, 1e-3, 300))
    p, b0, b1 = coefficients(310.0, 150.0, 4.1, 1e-3)
    expected = force_response(zw.StandardLinearSolid(310, 150, 4.1), 1e-3 * np.arange(300), x)
    assert expected[1:] == pytest.approx(-p * expected[:-1] + b0 * x[1:] + b1 * x[:-1], abs=1e-12)


def test_the_printed_parameters_are_one_of_a_line():
    """Any factor (1 + c z⁻¹) explains the same forces exactly, and another c gives another solid."""
    solid = Fraction(300), Fraction(150), Fraction(15)
    x = [Fraction(int(v), 10**6) for v in np.random.default_rng(4).integers(0, 9000, 30)]
    p, b0, b1 = coefficients(*solid, PERIOD, "bilinear")
    force = [b0 * x[0]]
    for now, before in zip(x[1:], x, strict=False):
        force.append(-p * force[-1] + b0 * now + b1 * before)
    for c in (Fraction(1), Fraction(0), Fraction(-3, 7)):
        five = zw.tissue.five_parameters(*solid, PERIOD, c)
        for k in range(2, 30):
            terms = (-force[k - 1], -force[k - 2], x[k], x[k - 1], x[k - 2])
            assert force[k] == sum(a * b for a, b in zip(five, terms, strict=True))
        assert (zw.tissue.solid_of_five(five[0], five[2], five[4], PERIOD) == solid) is (c == 1)
