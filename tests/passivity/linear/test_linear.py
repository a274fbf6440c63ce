"""The linear criterion decided: poles anywhere, equality, narrow resonances, random laws."""

from __future__ import annotations

from fractions import Fraction
from math import acos, pi
from random import Random

import numpy as np
import pytest
from polynomials import product
from strategies import seeds

from zwidth import checker
from zwidth.model.environment.environment import RationalFunction
from zwidth.passivity.certificate import certify
from zwidth.passivity.criterion_choice import Decision
from zwidth.passivity.linear.boundary import smallest_holding
from zwidth.passivity.linear.criterion import (
    LinearProof,
    LinearRefutation,
    decide_linear,
    frequency,
    tightest,
)
from zwidth.passivity.linear.loop import loop_from
from zwidth.passivity.witness.sinusoid import LONGEST_PERIOD, negative_band, simplest_between
from zwidth.passivity.witness.violation import Violation, refute_linear
from zwidth.passivity.witness.witness import Setting

T = Fraction(1, 1000)
BILLIONTH = Fraction(1, 10**9)


def add(a, b):
    """The sum of two polynomials in descending coefficients."""
    size = max(len(a), len(b))
    padded = [(Fraction(0),) * (size - len(p)) + tuple(p) for p in (a, b)]
    return tuple(x + y for x, y in zip(*padded, strict=True))


def law(numerator, denominator, damping, delay=Fraction(0), period=T):
    """The loop of H(z) given by descending coefficients."""
    h = RationalFunction(tuple(map(Fraction, numerator)), tuple(map(Fraction, denominator)))
    return loop_from(h, Fraction(damping), period, Fraction(delay))


def setting(loop):
    return Setting(loop, Fraction(0), Fraction(0), False)


def assert_passive(loop):
    """Proved, and the checker accepts the certificate."""
    assert isinstance(decide_linear(loop), LinearProof)
    verification = checker.verify(certify(Decision(setting(loop))))
    assert verification.valid, verification.reason


def assert_active(loop, reason=None):
    """Refuted, and a motion extracts energy in exact arithmetic."""
    refutation = decide_linear(loop)
    assert isinstance(refutation, LinearRefutation)
    assert reason in (None, refutation.reason)
    witness = refute_linear(setting(loop), refutation.reason)
    assert witness is not None
    assert witness.exact_energy > 0
    assert witness.verify()


def needs(loop, theta):
    """T/2 Re{(1 − z⁻¹) z⁻ᵈ H}/(1 − cos ωT) at many ωT, d whole samples, in floats [N·s/m]."""
    late = np.exp(-1j * theta)
    n, d = (np.polyval(np.array(part[::-1], float), late) for part in (loop.numerator, loop.denominator))
    return 0.0005 * ((1 - late) * late ** float(loop.whole_delay) * n / d).real / (1 - np.cos(theta))


def required(loop):
    """The smallest double b that is proved."""
    guess, _ = tightest(loop)
    return smallest_holding(lambda b: isinstance(decide_linear(loop.with_damping(b)), LinearProof), guess)


@pytest.mark.parametrize(("k", "cosine"), [("37.5", "0.4"), ("220", "-0.85"), ("3.1", "0.992")])
def test_lossless_resonator_on_the_circle(k, cosine):
    """k (z − 1)(c₀z − 1)/(z² − 2c₀z + 1): passive iff b ≥ kT/2 for k > 0, at no b for k < 0.

    T H/(z − 1) = kT (c₀z − 1)/(z² − 2c₀z + 1) has real part −kT/2 on the circle.
    """
    k, cosine = Fraction(k), Fraction(cosine)
    numerator = [c * k for c in product((1, -1), (cosine, -1))]
    denominator = (1, -2 * cosine, 1)
    limit = k * T / 2
    assert_passive(law(numerator, denominator, limit))
    assert_passive(law(numerator, denominator, limit * 2))
    assert_active(law(numerator, denominator, limit * (1 - BILLIONTH)))
    negative = [-c for c in numerator]
    for damping in (limit, 100 * limit):
        assert_active(law(negative, denominator, damping), "unstable environment")


def test_poles_on_the_circle_need_whole_samples():
    numerator, denominator = product((30, -30), ("0.4", -1)), (1, "-0.8", 1)
    assert isinstance(decide_linear(law(numerator, denominator, 50, T / 3)), LinearRefutation)


@pytest.mark.parametrize("k", ["12.5", "-12.5"])
def test_integrator_of_position(k):
    assert_active(law([k], (1, -1), "0.7"))


@pytest.mark.parametrize("quarter", [(1, 1), (1, 0, 1), (1, 0, 0, 0, -1)])
def test_poles_at_quarter_turns(quarter):
    """Poles at −1, ±j and the fourth roots of one are places like any other: a supremum and a decision."""
    loop = law((12, "-3.5"), quarter, "0.7")
    decision = decide_linear(loop)
    need, cosine = tightest(loop)
    assert need > 0
    assert -1 <= cosine <= 1
    if isinstance(decision, LinearProof):
        assert_passive(loop)
    else:
        assert_active(loop)


def test_negative_static_stiffness():
    """H(1) < 0 gives energy to a slow press, although the criterion itself is met."""
    numerator = add((Fraction(-3), Fraction("1.2")), product((20,), (1, -1)))
    loop = law(numerator, (1, "-0.4"), 2)
    assert loop.static_stiffness < 0
    assert_active(loop, "negative static stiffness")


@pytest.mark.parametrize("place", ["0.6", "1", "-1", "1.7", "-2.5"])
def test_cancelled_poles_play_no_part(place):
    """A pole under a zero, inside, on or outside the circle: the force is that of the law without it."""
    common = (1, -Fraction(place))
    numerator, denominator = product((300, -120), common), product((1, "-0.3"), common)
    plain = law((300, -120), (1, "-0.3"), 1)
    limit = Fraction(repr(required(plain)))
    assert required(law(numerator, denominator, 1)) == required(plain)
    assert_passive(law(numerator, denominator, limit * (1 + BILLIONTH)))
    assert_active(law(numerator, denominator, limit * (1 - BILLIONTH)))


@pytest.mark.parametrize("place", ["1", "-1", "1.0000001", "-1.4"])
def test_poles_not_quite_cancelled(place):
    """A zero 1e-9 beside a pole on or outside the circle does not hide it."""
    pole, zero = (1, -Fraction(place)), (1, -Fraction(place) - BILLIONTH)
    loop = law(product((300,), zero), product((1,), pole), 50)
    assert isinstance(decide_linear(loop), LinearRefutation)


@pytest.mark.parametrize(
    ("numerator", "denominator", "limit", "whole", "hair"),
    [
        (["412.7"], [1], "0.20635", 0, Fraction(1, 10**30)),
        ([500], [1], "0.75", 1, BILLIONTH),
        ([500], [1], "1.25", 2, BILLIONTH),
        ([350, -350], [1, 0], "0.35", 0, BILLIONTH),
    ],
    ids=["spring", "a sample late", "two samples late", "damper, H(1) = 0"],
)
def test_passive_at_its_limit_and_active_a_hair_below(numerator, denominator, limit, whole, hair):
    """A spring needs (2d + 1) K T/2, a damper b = |B|; each claim has its evidence."""
    for share in (1, 1 + hair):
        assert_passive(law(numerator, denominator, Fraction(limit) * share, whole * T))
    assert_active(law(numerator, denominator, Fraction(limit) * (1 - hair), whole * T))


def resonance(radius, hertz, gain):
    """300 + gain (z − 1)²/(z² − 2 r cos φ z + r²)."""
    r, c = Fraction(radius), Fraction(f"{np.cos(2 * pi * hertz / 1000):.12f}")
    denominator = (Fraction(1), -2 * r * c, r * r)
    return add(product((300,), denominator), product((Fraction(gain),), (1, -1), (1, -1))), denominator


def test_resonance_that_a_grid_misses():
    """A resonance narrower than the spacing of 10⁶ grid points is found, proved above and refuted below."""
    loop = law(*resonance(1 - Fraction(1, 10**8), 175.00021, "2e-6"), 1)
    b = required(loop)
    grid = float(needs(loop, np.pi * np.arange(1, 10**6 + 1) / 10**6).max())
    assert b > grid * 1.005
    assert frequency(tightest(loop)[1], T) == pytest.approx(175.00021, abs=1e-3)
    assert_passive(loop.with_damping(Fraction(repr(b)) * (1 + BILLIONTH)))
    refuted = decide_linear(loop.with_damping(Fraction(repr(grid)) * (1 + BILLIONTH)))
    assert isinstance(refuted, LinearRefutation)


def test_published_narrow_peak():
    """H = 300 and a resonance at 175 Hz of pole radius 1 − 1e-5: the supremum lies far above a 10⁴ grid's."""
    loop = law(*resonance(1 - Fraction(1, 10**5), 175, "0.0002"), 1)
    close = needs(loop, 2 * np.pi * 0.175 + np.linspace(-1e-3, 1e-3, 400001)).max()
    assert required(loop) == pytest.approx(float(close), rel=1e-6)


def test_order_forty():
    random = Random(40)
    r = Fraction("0.97")
    denominator = product(*((1, -2 * r * Fraction(k, 21), r * r) for k in range(-19, 21, 2)))
    numerator = [Fraction(f"{random.gauss(0, 1):.6f}") for _ in range(41)]
    if sum(numerator) * sum(denominator) < 0:
        numerator = [-c for c in numerator]
    loop = law(numerator, denominator, 1)
    b = Fraction(repr(required(loop)))
    assert_passive(loop.with_damping(b * (1 + BILLIONTH)))
    assert_active(loop.with_damping(b * (1 - BILLIONTH)))


def random_law(seed):
    """A stable H(z) of order 1 to 10 with H(1) ≥ 0, and a delay of none, one or broken samples."""
    random = np.random.default_rng(seed)
    order, roots = int(random.integers(1, 11)), []
    while len(roots) < order:
        if order - len(roots) >= 2 and random.random() < 0.8:
            root = 0.97 * np.sqrt(random.random()) * np.exp(1j * pi * random.random())
            roots += [root, root.conj()]
        else:
            roots.append(random.uniform(-0.97, 0.97))
    denominator, numerator = np.real(np.poly(roots)), random.normal(size=order + 1)
    if numerator.sum() * denominator.sum() < 0:
        numerator = -numerator
    delay = [Fraction(0), T, Fraction(int(random.integers(1, 3000)), 10**6)][seed % 3]
    return law(*([repr(float(c)) for c in part] for part in (numerator, denominator)), 5, delay)


@seeds(8)
def test_random_laws(seed):
    """At b (1 + 1e-9) the checker accepts the certificate; at b (1 − 1e-9) the violation, and a motion gains.

    Where the criterion is violated in so narrow a band that no period of 10 000
    samples falls into it, there is no motion to be checked, and none is given.
    """
    loop = random_law(seed)
    limit = Fraction(repr(required(loop)))
    assert_passive(loop.with_damping(limit * (1 + BILLIONTH)))
    below = loop.with_damping(limit * (1 - BILLIONTH))
    refutation = decide_linear(below)
    assert isinstance(refutation, LinearRefutation)
    violation = Violation(setting(below), refutation)
    assert violation.verify()
    band = negative_band(below)
    assert band is not None
    if violation.witness is not None or simplest_between(*band).denominator <= LONGEST_PERIOD:
        assert_active(below)


@pytest.mark.parametrize("seed", [375, 26283])
def test_random_laws_with_a_peak_beside_simple_fractions(seed):
    """A violation in a band that only periods of over 10 000 samples reach is proved without a motion."""
    test_random_laws.hypothesis.inner_test(seed)


@pytest.mark.parametrize("seed", range(6))
def test_supremum_against_a_fine_grid(seed):
    """No frequency of a grid asks for more than the supremum, and one near it asks for nearly as much."""
    loop = random_law(501 + 3 * seed)
    top, cosine = tightest(loop)
    theta = np.linspace(1e-3, pi, 20001)
    grid = needs(loop, theta)
    assert grid.max() <= top * (1 + 1e-9) + 1e-15
    assert grid.max() >= top * (1 - 1e-3)
    place = theta[grid.argmax()]
    at_place = loop.required_damping_at(Fraction(np.cos(place)))
    assert abs(acos(float(cosine)) - place) < 1e-2 or at_place > top * (1 - 1e-3)
