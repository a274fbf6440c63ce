"""The quadratic form of two sequences: by matrices in time, by complex numbers on a grid."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest

from zwidth.passivity.coupling.loop_forms import TwoSignalForm

F = Fraction


def random_terms(random, count=4):
    """Terms with short polynomials of general rationals."""

    def polynomial():
        return [F(int(n), 7) for n in random.integers(-9, 10, random.integers(1, 4))]

    def signal():
        return polynomial(), polynomial()

    return [(F(int(random.integers(-5, 6)), 3), signal(), signal()) for _ in range(count)]


def entries(terms, theta):
    """The Hermitian 2 × 2 matrix at one angle, from complex numbers."""
    late = np.exp(-1j * theta)
    total = np.zeros((2, 2), complex)
    for c, p, q in terms:
        left = np.array([sum(float(a) * late**i for i, a in enumerate(part)) for part in p])
        right = np.array([sum(float(a) * late**i for i, a in enumerate(part)) for part in q])
        total += float(c) * np.outer(right.conj(), left)
    return (total + total.conj().T) / 2


@pytest.mark.parametrize("seed", range(5))
def test_need_and_decision_agree_with_eigenvalues(seed):
    """The least multiple of D² that makes every Hermitian matrix ≥ 0, and the exact decision about it."""
    random = np.random.default_rng(seed)
    square = [(F(1), s, s) for _, s, _ in random_terms(random, 2)]
    terms = [*square, (F(-2), ([F(0)], [F(1)]), ([F(0)], [F(1)])), *random_terms(random, 1)]
    form = TwoSignalForm.of(terms)
    angles = np.linspace(1e-3, np.pi, 400)
    for theta in angles[::40]:
        matrix = entries(terms, theta)
        if matrix[0, 0].real > 1e-9:
            expected = abs(matrix[0, 1]) ** 2 / matrix[0, 0].real - matrix[1, 1].real
            assert form.need(np.cos([theta]))[0] == pytest.approx(expected, rel=1e-8, abs=1e-9)
    if form.first_is_nonnegative():
        more = F(float(max(form.need(np.cos(angles)).max(), 0.0)) * 1.01 + 0.01)
        least = [np.linalg.eigvalsh(entries(terms, t) + np.diag([0, float(more)]))[0] for t in angles]
        assert form.is_nonnegative(more) == (min(least) >= -1e-9)
        assert not form.is_nonnegative(F(-1000))


def test_a_decided_form_is_nonnegative_in_time():
    """(D − ½ w(k−1))² + w² of random finite sequences; with −w² it is not."""
    mixed = ([F(0), F(-1, 2)], [F(1)])
    alone = ([F(1)], [F(0)])
    assert TwoSignalForm.of([(F(1), mixed, mixed), (F(1), alone, alone)]).is_nonnegative()
    lacking = TwoSignalForm.of([(F(1), mixed, mixed), (F(-1), alone, alone)])
    assert not lacking.is_nonnegative(F(10**6))
    assert not lacking.first_is_nonnegative()
