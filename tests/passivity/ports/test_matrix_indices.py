"""Indices of several axes: closed forms, dense grids, motions replayed by scipy."""

from __future__ import annotations

from fractions import Fraction
from math import inf, isclose, pi, sqrt

import control
import numpy as np
import pytest
import scipy.linalg
import scipy.signal
from hypothesis import given, settings
from hypothesis import strategies as st
from matrix_systems import least_eigenvalue, matrix, random_system, responses

import zwidth as zw

indices = zw.ports.passivity_indices
NOTHING = ([0], [1])
LAG, UNIT = ([1], [1, 1]), np.eye(2)


def diagonal(first, second):
    """Two axes that do not act on each other."""
    return matrix([[first, NOTHING], [NOTHING, second]])


def over(den, rows):
    """Numerators over one denominator."""
    return matrix([[(num, den) for num in row] for row in rows])


ZOO = {  # system, ν, its frequency [Hz], ρ, its frequency [Hz]
    "gyrator": (over([1], [[[0], [1]], [[-1], [0]]]), 0, None, 0, None),
    "rotating mass": (over([1, 0, 1], [[[1, 0], [1]], [[-1], [1, 0]]]), 0, None, 0, None),
    "masses and dampers": (over([1], [[[2, 5], [0.5, 2]], [[0.5, 2], [1, 2]]]), 1, None, 0, inf),
    "coupled integrators": (over([1, 0], [[[3], [1]], [[1], [2]]]), 0, None, 0, None),
    "one lag felt by both": (matrix([[LAG, LAG], [LAG, LAG]]), 0, None, Fraction(1, 2), None),
    "an axis without output": (diagonal(LAG, NOTHING), 0, None, 1, None),
    "a lag across": (matrix([[LAG, LAG], [NOTHING, LAG]]), Fraction(-1, 16), sqrt(15) / (2 * pi), -inf, None),
    "one sample late across": (
        matrix([[([2], [1]), ([1], [1, 0])], [NOTHING, ([2], [1])]], 0.02), Fraction(3, 2), None, None, None
    ),
    "unstable": (diagonal(([1], [1, -1]), ([1], [1, 2])), -inf, None, -1, None),
    "nothing": (diagonal(NOTHING, NOTHING), 0, None, inf, None),
}  # fmt: skip


@pytest.mark.parametrize("name", ZOO)
def test_matrices_in_closed_form(name):
    g, nu, nu_at, rho, rho_at = ZOO[name]
    found = indices(g)
    for index, value, at in ((found.input, nu, nu_at), (found.output, rho, rho_at)):
        if value is None:
            continue
        assert index.exact == value if abs(value) < inf else index.value == value
        assert index.frequency == (at if at is None else pytest.approx(at, rel=1e-12))
        if abs(value) < inf:
            assert index.certificate(value).verify()
            assert index.refute(value) is None
            assert not index.at_least(value + Fraction(1, 10**9))
            assert index.refute(value + Fraction(1, 10**6)).verify()
    assert found.passive == (nu >= 0)


REFUSED = {
    "residue not symmetric": over([1, 0], [[[1], [3]], [[-3], [1]]]),
    "residue not positive": over([1, 0], [[[1], [3]], [[3], [1]]]),
    "residue complex and not positive": over([1, 0, 1], [[[1, 0], [1.01]], [[-1.01], [1, 0]]]),
    "double integrator": diagonal(([1], [1, 0, 0]), LAG),
    "grows with the square of the frequency": diagonal(([1, 0, 0], [1]), LAG),
    "a pole on the axis across": matrix([[([3], [1, 2]), NOTHING], [([1], [1, 0, 1]), ([1, 0], [1, 1])]]),
    "unstable across": matrix([[LAG, ([1], [1, -2])], [NOTHING, LAG]]),
}


@pytest.mark.parametrize("name", REFUSED)
def test_poles_that_no_level_allows(name):
    index = indices(REFUSED[name]).input
    assert index.value == -inf
    assert index.reason
    assert not index.at_least(-(10**6))
    assert index.refute(0).verify()


def test_an_input_without_effect():
    """The second input moves nothing and its output is moved by the first: no ρ at all."""
    output = indices(matrix([[LAG, NOTHING], [LAG, NOTHING]])).output
    assert output.value == -inf
    assert "input without effect" in output.reason
    assert output.refute(-100).verify()


def test_an_irrational_index_lies_between_its_bounds():
    """The static matrix (1 1; 1 3) has the least eigenvalue 2 − √2 at every frequency."""
    found = indices(control.ss([], [], [], [[1, 1], [1, 3]]))
    low, high = found.input.bounds
    assert (2 - low) ** 2 >= 2 >= (2 - high) ** 2
    assert high - low < Fraction(1, 10**20)
    assert found.input.exact is None
    assert found.input.frequency is None
    assert isclose(found.output.value, 1 / (2 + sqrt(2)), rel_tol=1e-15)


seeds = st.integers(0, 2**32 - 1)


@settings(max_examples=15, deadline=None)
@given(seeds, st.integers(2, 3), st.integers(1, 6), st.booleans())
def test_a_dense_grid_of_eigenvalues_never_falls_below(seed, axes, order, discrete):
    g = random_system(seed, order, axes, discrete=discrete)
    found = indices(g)
    omega = np.linspace(0, pi / 0.01, 3001) if discrete else np.r_[0, np.geomspace(1e-3, 1e5, 3001)]
    points = np.exp(1j * 0.01 * omega) if discrete else 1j * omega
    there = responses(g, points)
    for index, matrices in ((found.input, there), (found.output, np.linalg.inv(there))):
        if abs(index.value) == inf:
            continue
        values = least_eigenvalue(matrices)
        assert values.min() >= index.value - 1e-9 * max(1, np.abs(values).max())
        assert values.min() <= index.value + 1e-3 * (1 + abs(index.value))
        if index.frequency is not None and index.frequency < inf:
            omega_at = 2 * pi * index.frequency
            response = g(np.exp(0.01j * omega_at) if discrete else 1j * omega_at)
            reached = least_eigenvalue(response if index is found.input else np.linalg.inv(response))
            assert isclose(reached, index.value, rel_tol=1e-6, abs_tol=1e-9)
        assert index.certificate().verify()


quarters = st.integers(1, 9).map(lambda k: k / 4)
entries = st.tuples(st.lists(quarters, min_size=2, max_size=3), st.lists(quarters, min_size=3, max_size=3))


@settings(max_examples=15, deadline=None)
@given(st.lists(entries, min_size=2, max_size=3))
def test_a_diagonal_system_has_the_least_index_of_its_entries(parts):
    size = range(len(parts))
    together = indices(matrix([[parts[i] if i == j else NOTHING for j in size] for i in size]))
    alone = [indices(control.tf(*part)) for part in parts]
    for name in ("input", "output"):
        index, others = getattr(together, name), [getattr(found, name) for found in alone]
        least = min(others, key=lambda other: other.bounds[0] if other.bounds else -inf)
        if least.bounds is None:
            assert index.bounds is None
            continue
        assert index.bounds[0] <= least.bounds[1]
        assert least.bounds[0] <= index.bounds[1]
        assert index.exact == least.exact or index.exact is None or least.exact is None


@pytest.mark.parametrize(("seed", "discrete"), [(0, False), (1, False), (2, True), (5, True)])
def test_both_sides_of_a_matrix_index(seed, discrete):
    index = indices(random_system(seed, 4, 2, discrete=discrete)).input
    size = Fraction(repr(abs(index.value)))
    assert index.certificate(index.bounds[0] - size / 10**9).verify()
    above = index.bounds[1] + size / 10**4
    assert not index.at_least(above)
    assert index.refute(above).verify()


def in_state_space(g):
    """Entry by entry: python-control converts several axes only with a library that is not asked for."""
    if isinstance(g, control.StateSpace):
        return g
    rows = []
    for i in range(g.noutputs):
        entries = [control.ss(control.tf(g.num[i][j], g.den[i][j])) for j in range(g.ninputs)]
        row = control.append(*entries)
        rows.append(control.ss(row.A, row.B, np.ones((1, len(entries))) @ row.C, row.D.sum(axis=0)[None]))
    a = scipy.linalg.block_diag(*(row.A for row in rows))
    c = scipy.linalg.block_diag(*(row.C for row in rows))
    return control.ss(a, np.vstack([r.B for r in rows]), c, np.vstack([r.D for r in rows]))


@pytest.mark.parametrize(
    ("g", "kind"),
    [
        (random_system(0, 4, 2, throughput=0), "burst"),
        (random_system(3, 5, 3, throughput=0), "burst"),
        (matrix([[([3, -0.5], [1, -0.5]), LAG], [NOTHING, ([3, 4], [1, 1])]]), "polynomial"),
    ],
)
def test_a_motion_of_several_axes_replayed_by_scipy(g, kind):
    motion = indices(g).witness
    assert motion.kind == kind
    system = in_state_space(g)
    t, u, y = (np.array(x) for x in motion.signals(40001))
    _, replayed, _ = scipy.signal.lsim((system.A, system.B, system.C, system.D), u.T, t)
    assert np.abs(replayed.T - y).max() < 1e-4 * np.abs(y).max()
    share = -np.trapezoid((u * replayed.T).sum(axis=0), t) / np.trapezoid((u * u).sum(axis=0), t)
    assert isclose(share, motion.share, rel_tol=1e-3)
    assert share > 0


@pytest.mark.parametrize("seed", [2, 5, 8])
def test_a_discrete_motion_of_several_axes_replayed_by_scipy(seed):
    g = random_system(seed, 3, 2, throughput=-0.1, discrete=True)
    motion = indices(g).witness
    _, u, y = motion.signals()
    _, replayed, _ = scipy.signal.dlsim((g.A, g.B, g.C, g.D, 0.01), np.array(u).T)
    assert np.allclose(replayed.T, y, rtol=1e-8, atol=1e-8)
    assert isclose(-np.sum(np.array(u) * replayed.T) / np.sum(np.square(u)), motion.share, rel_tol=1e-6)
    assert motion.share > 0


def test_a_burst_says_amplitude_and_phase_of_every_input():
    """The antisymmetric part turns: (1 1/s; −1/s 1)-like ports lose most to a turning input."""
    g = matrix([[([1], [1, 1]), ([3], [1, 1])], [([-3], [1, 1]), ([1], [1, 1])]])
    motion = indices(g).witness
    (first, start), (second, turned) = motion.phasors
    assert (round(first, 6), round(second, 6)) == (1, 1)
    assert isclose(abs(turned - start), pi / 2, rel_tol=1e-4)
    # Re of 1/(s + 1) ∓ 3j/(s + 1) at jω is (1 ∓ 3ω)/(1 + ω²): least at 3ω² − 2ω − 3 = 0
    assert isclose(2 * pi * indices(g).input.frequency, (1 + sqrt(10)) / 3, rel_tol=1e-12)


def test_the_output_index_is_the_input_index_of_the_inverse():
    """ρ(M s + B) = ν((M s + B)⁻¹), the inverse of a mass matrix with dampers written out."""
    m, b = [[2, 0.5], [0.5, 1]], [[3, 1], [1, 2]]
    p = [[[m[i][j], b[i][j]] for j in range(2)] for i in range(2)]
    det = np.polysub(np.polymul(p[0][0], p[1][1]), np.polymul(p[0][1], p[1][0]))
    impedance = matrix([[(p[i][j], [1]) for j in range(2)] for i in range(2)])
    minus = [-c for c in p[0][1]]
    mobility = matrix([[(p[1][1], det), (minus, det)], [(minus, det), (p[0][0], det)]])
    first, second = indices(impedance), indices(mobility)
    assert first.output.exact == second.input.exact == 0
    low, high = first.input.bounds
    other_low, other_high = second.output.bounds
    assert low <= other_high
    assert other_low <= high
    assert isclose(float(low), (5 - sqrt(5)) / 2, rel_tol=1e-15)


def test_several_axes_of_every_kind_of_system():
    """A transfer matrix, its state space, and that of scipy are one system."""
    a, b, c, d = [[-1, 0], [0, -2]], [[1, 0], [0, 1]], [[1, 0.5], [0, 1]], [[0, 0], [0, 1]]
    g = matrix([[([1], [1, 1]), ([0.5], [1, 2])], [NOTHING, ([1, 3], [1, 2])]])
    same = [g, control.ss(a, b, c, d), scipy.signal.StateSpace(a, b, c, d)]
    found = [indices(system) for system in same]
    assert len({f.input.bounds for f in found}) == 1
    assert len({f.output.bounds for f in found}) == 1


HIDDEN = {  # and whether what is hidden decays
    "not reached": (control.ss([[-1, 0], [0, 2]], [[1, 1], [0, 0]], [[1, 1], [1, 1]], UNIT), False),
    "not seen": (control.ss([[-1, 0], [0, 2]], [[1, 1], [1, 0]], [[1, 0], [1, 0]], UNIT), False),
    "decays": (control.ss([[-1, 0], [0, -2]], [[1, 1], [0, 0]], [[1, 1], [1, 1]], UNIT), True),
    "two equal poles, both seen": (control.ss(-UNIT, UNIT, UNIT, UNIT), True),
    "unstable but not hidden": (control.ss(np.diag([2, 2, -1]), np.eye(3)[:, :2], np.eye(3)[:2], UNIT), True),
    "cancels within an entry": (diagonal(([1, -1], [1, 0, -1]), LAG), False),
}


@pytest.mark.parametrize("why", HIDDEN)
def test_hidden_modes_of_several_axes(why):
    g, decay = HIDDEN[why]
    found = indices(g)
    assert found.hidden_modes_decay == decay
    assert ("cancelled mode" in repr(found)) != decay


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ((control.ss(-UNIT, UNIT, [[1, 2]], [[0, 0]]),), "2 inputs and 1 output;"),
        ((control.ss(-UNIT, UNIT, UNIT, 0 * UNIT, None),), "dt=None"),
        ((matrix([[([1, 0, 0], [1, 2]), NOTHING], [NOTHING, LAG]], 0.1),), "more zeros than poles"),
        ((control.ss(-UNIT, UNIT, UNIT, UNIT * np.nan),), "finite"),
        ((control.ss(-np.eye(61), np.ones((61, 2)), np.ones((2, 61)), UNIT),), "order 61"),
        ((control.ss([], [], [], np.eye(7)),), "7 inputs"),
        ((diagonal(([1], [1] + [0] * 60 + [1]), LAG),), "at most 60"),
        ((control.ss(-UNIT, UNIT, UNIT, UNIT), zw.Device(damping=1, rate=1000)), "as H"),
    ],
)
def test_what_is_refused_of_several_axes(arguments, message):
    with pytest.raises(zw.InputError, match=message):
        indices(*arguments)
