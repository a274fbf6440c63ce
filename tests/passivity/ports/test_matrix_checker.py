"""What the checker refuses of several axes, and the algebra on both sides against another road."""

from __future__ import annotations

from cmath import exp
from fractions import Fraction
from itertools import combinations
from math import cos, sin

import numpy as np
import pytest
from flint import fmpq, fmpq_mat
from matrix_systems import matrix, random_system
from tampered import tampered

import zwidth as zw
from zwidth import checker
from zwidth.checker.port.index import _principal_sums
from zwidth.passivity.ports.circle import product
from zwidth.passivity.ports.port import leverrier, multiplied

indices = zw.ports.passivity_indices


def proved():
    """A port of two axes with the input index 1 − 1/32."""
    lead = ([1, 3], [1, 2])
    return indices(matrix([[lead, ([1], [1, 2])], [([0], [1]), lead]])).input


def test_the_checker_refuses_a_false_matrix_proof():
    assert proved().exact == Fraction(31, 32)
    document = proved().certificate().to_dict()
    assert checker.verify(document).valid
    changes = [
        (("level",), "0.99"),
        (("index",), "output"),
        (("system", "time"), "discrete"),
        (("system", "denominator"), ["1", "-1"]),
        (("system", "numerators", 0, 1), ["9"]),
        (("system", "numerators"), [["1"]]),
        (("proof", "offset"), "0"),
        (("proof", "minors"), document["proof"]["minors"][:1]),
        (("proof", "minors", 1, "power"), 1),
        (("proof", "minors", 1, "positivity", "factor"), ["2", "1"]),
        (("proof", "minors", 0, "positivity", "factor"), ["-1", "3"]),
        (("proof", "resolvent", "denominator"), ["1", "7"]),
        (("proof", "resolvent", "numerators", 0, 0), ["1", "1"]),
    ]
    for path, value in changes:
        assert not checker.verify(tampered(document, path, value)).valid, path


def test_the_checker_refuses_an_unstable_port_of_positive_eigenvalues():
    """diag(1/(1 − s), 1): positive on the axis; with its true resolvent a root lies outside."""
    lag, nothing, one = ([1], [1, 1]), ([0], [1]), ([1], [1])
    good = indices(matrix([[lag, nothing], [nothing, one]])).input.certificate(0).to_dict()
    assert checker.verify(good).valid
    bad = tampered(good, ("system",), {**good["system"], "denominator": ["-1", "1"]})
    bad["system"]["numerators"] = [[["1"], ["0"]], [["0"], ["-1", "1"]]]
    # M = N + g d = diag(2 − s, 2(1 − s)); D M⁻¹ = diag((1 − s)/(2 − s), 1/2)
    resolvent = {"denominator": ["-2", "4"], "numerators": [[["-2", "2"], ["0"]], [["0"], ["-1", "2"]]]}
    bad["proof"]["resolvent"] = resolvent
    answer = checker.verify(bad)
    assert not answer.valid
    assert "root lies outside" in answer.reason


def test_the_checker_refuses_a_false_motion_of_several_axes():
    split = matrix([[([1], [-1, 1]), ([0], [1])], [([0], [1]), ([1], [1, 1])]])
    delayed = random_system(2, 3, 2, throughput=-0.1, discrete=True)
    systems = (random_system(0, 4, 2, throughput=0), split, delayed)
    burst, grown, late = (indices(system).witness.to_dict() for system in systems)
    assert [d["motion"]["kind"] for d in (burst, grown, late)] == ["burst", "polynomial", "sequence"]
    assert all(checker.verify(document).valid for document in (burst, grown, late))
    false = [
        tampered(burst, ("motion", "power"), "0"),
        tampered(burst, ("motion", "step_rad_per_s"), "1" * 200),
        tampered(burst, ("motion", "cycles"), "1"),
        tampered(burst, ("motion", "sine"), burst["motion"]["sine"][:1]),
        tampered(burst, ("level",), "-100"),
        tampered(burst, ("system", "time"), "discrete"),
        tampered(grown, ("motion", "lowest_power"), "0"),
        tampered(grown, ("motion", "duration_s"), "-1"),
        tampered(grown, ("motion", "coefficients"), grown["motion"]["coefficients"][:1]),
        tampered(late, ("motion", "latent", 1), ["1"]),
        tampered(late, ("level",), "-100"),
    ]
    assert [checker.verify(document).valid for document in false] == [False] * len(false)


@pytest.mark.parametrize("size", [1, 2, 3, 5])
def test_the_checkers_sums_of_principal_minors(size):
    """Berkowitz's recursion against every principal minor by numpy."""
    rng = np.random.default_rng(size)
    a = rng.integers(-4, 5, (size, size)) + 1j * rng.integers(-4, 5, (size, size))
    a = a + a.conj().T
    found = _principal_sums([[(int(x.real), int(x.imag)) for x in line] for line in a])
    for k in range(1, size + 1):
        minors = [np.linalg.det(a[np.ix_(s, s)]).real for s in combinations(range(size), k)]
        assert found[k - 1] == round(sum(minors))


@pytest.mark.parametrize("size", [1, 2, 3, 4])
def test_leverrier_against_flint(size):
    """Characteristic polynomial, determinant and adjugate of rational matrices."""
    rng = np.random.default_rng(size)
    a = [[fmpq(int(rng.integers(-9, 9)), int(rng.integers(1, 9))) for _ in range(size)] for _ in range(size)]
    found = leverrier(a, fmpq(1))
    assert [1, *found.minors] == [(-1) ** k * c for k, c in enumerate(fmpq_mat(a).charpoly().coeffs()[::-1])]
    unit = fmpq_mat([[int(i == j) for j in range(size)] for i in range(size)])
    assert multiplied(a, found.adjugate) == (fmpq_mat(a).det() * unit).tolist()


def test_numbers_on_the_circle():
    theta = 0.7
    zeta = exp(-1j * theta)
    a, b, e = [1, -2, 3, 5], [4, 0, -1, 2], [2, 7, 1, -3]

    def value(p):
        return sum(c * zeta**k for k, c in enumerate(p))

    def at(x):
        c = fmpq(Fraction(cos(theta)).numerator, Fraction(cos(theta)).denominator)
        real, imaginary = (float(Fraction(int(v.p), int(v.q))) for v in (x.real(c), x.imaginary(c)))
        return real + 1j * sin(theta) * imaginary

    first, second = product(a, b), product(e, a)
    expected = value(a) * value(b).conjugate(), value(e) * value(a).conjugate()
    assert at(first) == pytest.approx(expected[0])
    assert at(first * second.conjugate()) == pytest.approx(expected[0] * expected[1].conjugate())
    assert at(first - second / 3) == pytest.approx(expected[0] - expected[1] / 3)
