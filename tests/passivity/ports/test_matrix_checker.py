"""What the checker refuses of ports, and its algebra against another road."""

from __future__ import annotations

from cmath import exp
from functools import reduce
from itertools import combinations
from math import cos, sin
from operator import getitem

import control
import numpy as np
import pytest
from flint import fmpq, fmpq_mat
from matrix_systems import LAG, NOTHING, diagonal, matrix, random_system
from tampered import tampered

import zwidth as zw
from zwidth import checker
from zwidth.checker.port.index import _principal_sums
from zwidth.passivity.ports.circle import product
from zwidth.passivity.ports.port import leverrier, multiplied

indices, s = zw.ports.passivity_indices, control.tf("s")
LEAD = ([1, 3], [1, 2])
COUPLED = matrix([[LEAD, ([1], [1, 2])], [NOTHING, LEAD]])
"""Its input index is 1 − 1/32."""

ELSE = {"index": "output", "system.time": "discrete"}
PROOFS = [
    (
        (s + 2) / (s + 9),
        ELSE
        | {
            "level": "0.3",
            "system.denominator": ["1", "-9"],
            "system.numerator": ["1", "1"],
            "proof.offset": "-1",
            "proof.positivity.factor": ["-1", "3"],
        },
    ),
    (
        COUPLED,
        ELSE
        | {
            "level": "0.99",
            "system.denominator": ["1", "-1"],
            "system.numerators.0.1": ["9"],
            "system.numerators": [["1"]],
            "proof.offset": "0",
            "proof.minors": 1,
            "proof.minors.1.power": 1,
            "proof.minors.1.positivity.factor": ["2", "1"],
            "proof.minors.0.positivity.factor": ["-1", "3"],
            "proof.resolvent.denominator": ["1", "7"],
            "proof.resolvent.numerators.0.0": ["1", "1"],
        },
    ),
]
BURST = {
    "motion.power": "0",
    "motion.step_rad_per_s": "1" * 200,
    "motion.cycles": "1",
    "system.time": "discrete",
}
GROWN = {"motion.lowest_power": "0", "motion.duration_s": "-1"}
MOTIONS = [
    ((s + 3) / (s + 1) ** 2, "burst", BURST | {"level": "-1"}),
    (1 / (1 - s), "polynomial", GROWN | {"motion.kind": "dance"}),
    (random_system(0, 4, 2, throughput=0), "burst", BURST | {"level": "-100", "motion.sine": 1}),
    (diagonal(([1], [-1, 1]), LAG), "polynomial", GROWN | {"motion.coefficients": 1}),
    (
        random_system(2, 3, 2, throughput=-0.1, discrete=True),
        "sequence",
        {"motion.latent.1": ["1"], "level": "-100"},
    ),
]


def refused(document, changes):
    """As it is it is accepted, with any of the changes it is not; a number of entries is a list cut short."""
    assert checker.verify(document).valid
    for path, value in changes.items():
        keys = [int(key) if key.isdigit() else key for key in path.split(".")]
        whole = reduce(getitem, keys, document)
        value = whole[:value] if isinstance(whole, list) and isinstance(value, int) else value
        assert not checker.verify(tampered(document, keys, value)).valid, path


@pytest.mark.parametrize(("g", "changes"), PROOFS)
def test_the_checker_refuses_a_false_proof(g, changes):
    refused(indices(g).input.certificate().to_dict(), changes)


@pytest.mark.parametrize(("g", "kind", "changes"), MOTIONS)
def test_the_checker_refuses_a_false_motion(g, kind, changes):
    document = indices(g).witness.to_dict()
    assert document["motion"]["kind"] == kind
    refused(document, changes)


def test_the_checker_refuses_an_unstable_port_that_is_positive_on_the_axis():
    """1/(1 − s) has Re > 0 on the axis: the sign alone is no proof."""
    good = indices(1 / (1 + s)).input.certificate(0).to_dict()
    answer = checker.verify(tampered(good, ("system", "denominator"), ["-1", "1"]))
    assert not answer.valid
    assert "root lies outside" in answer.reason


def test_the_checker_refuses_an_unstable_port_of_positive_eigenvalues():
    """diag(1/(1 − s), 1): positive on the axis; with its true resolvent a root lies outside."""
    good = indices(diagonal(LAG, ([1], [1]))).input.certificate(0).to_dict()
    assert checker.verify(good).valid
    bad = tampered(good, ("system",), {**good["system"], "denominator": ["-1", "1"]})
    bad["system"]["numerators"] = [[["1"], ["0"]], [["0"], ["-1", "1"]]]
    # M = N + g d = diag(2 − s, 2(1 − s)); D M⁻¹ = diag((1 − s)/(2 − s), 1/2)
    resolvent = {"denominator": ["-2", "4"], "numerators": [[["-2", "2"], ["0"]], [["0"], ["-1", "2"]]]}
    bad["proof"]["resolvent"] = resolvent
    answer = checker.verify(bad)
    assert not answer.valid
    assert "root lies outside" in answer.reason


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
    top, bottom = rng.integers(-9, 9, (size, size)), rng.integers(1, 9, (size, size))
    a = [[fmpq(int(p), int(q)) for p, q in zip(*row, strict=True)] for row in zip(top, bottom, strict=True)]
    found, exact = leverrier(a, fmpq(1)), fmpq_mat(a)
    assert [1, *found.minors] == [(-1) ** k * c for k, c in enumerate(exact.charpoly().coeffs()[::-1])]
    one = fmpq_mat([[int(i == j) for j in range(size)] for i in range(size)])
    assert multiplied(a, found.adjugate) == (exact.det() * one).tolist()


def test_numbers_on_the_circle():
    """a(ζ) b̄(ζ) and products of such numbers against complex arithmetic at one angle."""
    zeta = exp(-0.7j)
    a, b, e = [1, -2, 3, 5], [4, 0, -1, 2], [2, 7, 1, -3]
    c = fmpq(*cos(0.7).as_integer_ratio())

    def at(x):
        real, imaginary = (int(v.p) / int(v.q) for v in (x.real(c), x.imaginary(c)))
        return real + 1j * sin(0.7) * imaginary

    va, vb, ve = (sum(c * zeta**k for k, c in enumerate(p)) for p in (a, b, e))
    first, second = product(a, b), product(e, a)
    expected = va * vb.conjugate(), ve * va.conjugate()
    assert at(first) == pytest.approx(expected[0])
    assert at(first * second.conjugate()) == pytest.approx(expected[0] * expected[1].conjugate())
    assert at(first - second / 3) == pytest.approx(expected[0] - expected[1] / 3)
