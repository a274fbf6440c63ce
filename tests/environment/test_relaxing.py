"""Relaxation, creep and the responses between: against inverse Laplace transforms and an integrator."""

from itertools import pairwise

import mpmath
import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

import zwidth as zw
from zwidth.data.tissue import creep, force_response, position_response, relaxation
from zwidth.model.environment.relaxing import Elements, compliance, elements

SOLIDS = [
    zw.Wall(120, 3.5),
    zw.Maxwell(37, 2.2),
    zw.StandardLinearSolid(90, 41, 1.7),
    zw.GeneralizedMaxwell(13, [(3.1, 1), (21, 0.13), (7, 69)]),
    zw.GeneralizedMaxwell(0, [(3.1, 1), (21, 0.13), (7, 69)]),
]
TIMES = [0.003, 0.07, 0.9, 4.1]


def impedance(solid):
    """H(s), written out."""
    k, b, branches = elements(solid)
    return lambda s: k + b * s + sum(m * n * s / (m + n * s) for m, n in branches)


@pytest.mark.parametrize("solid", SOLIDS, ids=lambda s: s.describe()[:12])
@pytest.mark.parametrize("time", TIMES)
def test_relaxation_and_creep_are_inverse_laplace_transforms(solid, time):
    """G of H(s)/s and J of 1/(s H(s)), by Talbot's contour."""
    h = impedance(solid)
    force = mpmath.invertlaplace(lambda s: h(s) / s, time, method="talbot")
    position = mpmath.invertlaplace(lambda s: 1 / (s * h(s)), time, method="talbot")
    assert relaxation(solid, time) == pytest.approx(float(force), rel=1e-11)
    assert creep(solid, time) == pytest.approx(float(position), rel=1e-11)


def test_before_the_step_there_is_nothing():
    """Zero for t < 0; the jump is at 0, after which the solid is at its stiffest."""
    solid = zw.StandardLinearSolid(90, 41, 1.7)
    assert list(relaxation(solid, [-1e-9, 0.0])) == [0.0, 131.0]
    assert list(creep(solid, [-1e-9, 0.0])) == pytest.approx([0.0, 1 / 131], rel=1e-15)


@settings(deadline=None, max_examples=60)
@example(1.0, 0.0, [(0.1, 1.0), (0.10000000000000002, 1.0)])
@given(
    st.floats(0.1, 1000),
    st.sampled_from([0.0, 0.0, 3.0]),
    st.lists(st.tuples(st.floats(0.1, 1000), st.floats(0.001, 100)), min_size=1, max_size=5),
)
def test_partial_fractions_add_up(spring, dashpot, branches):
    """1/H(s) at points of the right half plane, with its modes between poles that rounding tells apart."""
    parts = Elements(spring, dashpot, tuple(branches))
    at_once, flow, modes = compliance(parts)
    rates = sorted(m / n for m, n in branches)
    assert len(modes) == 1 + sum(b - a > 1e-12 * b for a, b in pairwise(rates)) + bool(dashpot)
    for s in (0.3, 7.0 + 2.0j, 400.0):
        h = spring + dashpot * s + sum(m * n * s / (m + n * s) for m, n in branches)
        assert at_once + flow / s + sum(a * r / (s + r) for r, a in modes) == pytest.approx(1 / h, rel=1e-9)


def motion(seed=5, samples=80):
    """Uneven times, a path with corners."""
    rng = np.random.default_rng(seed)
    t = np.cumsum(rng.uniform(0.002, 0.05, samples))
    return t, np.cumsum(rng.normal(0, 2e-3, samples)) + 0.01


@pytest.mark.parametrize("solid", SOLIDS[1:], ids=lambda s: s.describe()[:12])
@pytest.mark.parametrize("rest", [None, 0.0])
def test_force_under_straight_lines_is_that_of_an_integrator(solid, rest):
    """Each branch integrated from sample to sample, with a step at the first where it was not at rest."""
    t, x = motion()
    k, _, branches = elements(solid)
    start = 0.0 if rest is None else x[0] - rest
    expected, q = [k * x[0] + sum(m for m, _ in branches) * start], np.array([m * start for m, _ in branches])
    mu, eta = np.array(branches).T
    for i in range(1, t.size):
        slope = (x[i] - x[i - 1]) / (t[i] - t[i - 1])
        rate, span = (lambda _, q, v=slope: mu * v - q * mu / eta), (t[i - 1], t[i])
        q = solve_ivp(rate, span, q, rtol=1e-11, atol=1e-14, method="LSODA").y[:, -1]
        expected.append(k * x[i] + q.sum())
    assert force_response(solid, t, x, rest) == pytest.approx(expected, rel=1e-7, abs=1e-9)


def test_a_dashpot_adds_the_slope_before_each_sample():
    """K x + B v of a wall."""
    t, x = motion()
    f = force_response(zw.Wall(120, 3.5), t, x)
    assert f[0] == 120 * x[0]
    assert f[1:] == pytest.approx(120 * x[1:] + 3.5 * np.diff(x) / np.diff(t), rel=1e-14)


@pytest.mark.parametrize("solid", SOLIDS, ids=lambda s: s.describe()[:12])
def test_position_under_straight_lines_superposes_creep(solid):
    """A ramp of force is the integral of steps: ∫ J, by quadrature."""
    t, f = motion(seed=8, samples=12)
    slopes = np.diff(f) / np.diff(t)

    def at(time):
        total = f[0] * creep(solid, time - t[0])
        for i, slope in enumerate(slopes):
            if time > t[i]:
                end = min(time, t[i + 1])
                nodes, weights = np.polynomial.legendre.leggauss(60)
                s = t[i] + (nodes + 1) / 2 * (end - t[i])
                total += slope * (end - t[i]) / 2 * float(weights @ creep(solid, time - s))
        return float(total)

    assert position_response(solid, t, f, 0.0) == pytest.approx([at(v) for v in t], rel=1e-10)


def test_rest_of_a_solid_is_where_it_stays():
    """A held position, a held force: what has been for ever goes on."""
    solid, t = SOLIDS[3], np.linspace(0, 3, 7)
    assert force_response(solid, t, np.full(7, 0.02)) == pytest.approx([13 * 0.02] * 7, rel=1e-14)
    assert position_response(solid, t, np.full(7, 0.5)) == pytest.approx([0.5 / 13] * 7, rel=1e-14)


@pytest.mark.parametrize(
    ("asked", "said"),
    [
        (lambda: relaxation(zw.HuntCrossley(100), 1.0), "springs and dashpots side by side are those of"),
        (lambda: relaxation(zw.Wall(100, -0.1), 1.0), "a material has no damping below 0"),
        (lambda: relaxation(zw.StandardLinearSolid((1, 2), 3, 4), 1.0), "needs one value of it"),
        (lambda: creep(zw.Wall(0), 1.0), "nothing resists the force"),
        (lambda: position_response(zw.Maxwell(3, 2), [0, 1], [1, 1], rest=0.5), "without a spring flows"),
        (lambda: force_response(zw.Wall(3), [0, 0], [1, 1]), "times must increase"),
        (lambda: force_response(zw.Wall(3), [0, 1, 2], [1, 1]), "two arrays of one length"),
        (lambda: force_response(zw.Wall(3), [0, 1], [1, np.nan]), "must be finite"),
    ],
)
def test_what_is_no_material_no_sample_or_no_rest_is_refused(asked, said):
    with pytest.raises(zw.InputError, match=said):
        asked()
