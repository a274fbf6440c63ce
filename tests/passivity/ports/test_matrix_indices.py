"""Indices of several axes: closed forms, dense grids, motions replayed by scipy."""

from __future__ import annotations

from fractions import Fraction
from math import inf, isclose, pi, sqrt

import control
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from matrix_systems import LAG, NOTHING, diagonal, least_eigenvalue, matrix, random_system, responses

import zwidth as zw

indices = zw.ports.passivity_indices
UNIT = np.eye(2)


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


HIDDEN = {  # and whether what is hidden decays
    "not reached": (control.ss([[-1, 0], [0, 2]], [[1, 1], [0, 0]], [[1, 1], [1, 1]], UNIT), False),
    "not seen": (control.ss([[-1, 0], [0, 2]], [[1, 1], [1, 0]], [[1, 0], [1, 0]], UNIT), False),
    "decays": (control.ss([[-1, 0], [0, -2]], [[1, 1], [0, 0]], [[1, 1], [1, 1]], UNIT), True),
    "two equal poles, both seen": (control.ss(-UNIT, UNIT, UNIT, UNIT), True),
    "unstable but not hidden": (control.ss(np.diag([2, 2, -1]), np.eye(3)[:, :2], np.eye(3)[:2], UNIT), True),
    "cancels": (control.tf([1, -1], [1, 0, -1]), False),
    "cancels and decays": (control.tf([1, 1], [1, 3, 2]), True),
    "cancels within an entry": (diagonal(([1, -1], [1, 0, -1]), LAG), False),
}


@pytest.mark.parametrize("why", HIDDEN)
def test_hidden_modes(why):
    g, decay = HIDDEN[why]
    found = indices(g)
    assert found.hidden_modes_decay == decay
    assert ("cancelled mode" in repr(found)) != decay
