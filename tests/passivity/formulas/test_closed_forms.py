"""Closed forms against the exact engine: refuted just below, proved at and just above."""

from __future__ import annotations

from fractions import Fraction
from itertools import product
from math import inf
from random import Random

import pytest
from strategies import seeds

import zwidth as zw
from zwidth.passivity import formulas as forms
from zwidth.passivity.linear.criterion import LinearProof, LinearRefutation, decide_linear
from zwidth.passivity.linear.loop import loop_from
from zwidth.passivity.witness.motion import Motion, Repeat, best_waits
from zwidth.passivity.witness.witness import Setting

TINY = Fraction(1, 10**12)


def draw(random, low, high):
    value = low * (high / low) ** random.random()
    return Fraction(f"{value:.3e}")


def proved(environment, damping, period, delay=Fraction(0)):
    h = environment.pulse_transfer_function(period)
    decision = decide_linear(loop_from(h, damping, period, delay))
    assert isinstance(decision, (LinearProof, LinearRefutation))
    return isinstance(decision, LinearProof)


def assert_boundary(environment, bound, period, delay=Fraction(0)):
    """The closed form is the last damping that the exact engine proves."""
    value = zw.Exact(bound).fraction
    assert not proved(environment, value * (1 - TINY), period, delay)
    assert proved(environment, value * (1 + TINY), period, delay)
    if isinstance(bound, zw.Exact):
        assert proved(environment, value, period, delay)


@seeds(20)
def test_kelvin_voigt(seed):
    """K T/2 + |B|, B of either sign."""
    random = Random(seed)
    k, t = draw(random, 1, 1e5), draw(random, 1e-5, 0.1)
    b = random.choice([-1, 1]) * draw(random, 1e-3, 50)
    assert_boundary(zw.Wall(k, b), forms.kelvin_voigt_damping(k, b, t), t)


@seeds(20)
def test_window(seed):
    """Windows of 1 to 3 samples for B > 0, of any length for B < 0."""
    random = Random(seed)
    k, t, b = draw(random, 1, 1e5), draw(random, 1e-5, 0.1), draw(random, 1e-3, 50)
    n = random.choice([1, 2, 3])
    wall = zw.Wall(k, b, zw.rendering.Window(n))
    assert_boundary(wall, forms.window_damping(k, b, n, t), t)
    n = random.randint(1, 14)
    wall = zw.Wall(k, -b, zw.rendering.Window(n))
    assert_boundary(wall, forms.window_damping(k, -b, n, t), t)


@pytest.mark.parametrize("discretization", ["backward", "tustin"])
@seeds(20)
def test_standard_linear_solid(seed, discretization):
    """Backward Euler and Tustin, relaxation times from far below to far above T."""
    random = Random(seed)
    mu0, mu1 = draw(random, 1, 1e4), draw(random, 1, 1e4)
    t = draw(random, 1e-4, 0.05)
    eta1 = mu1 * t * draw(random, 1e-3, 1e3)
    bound = forms.standard_linear_solid_damping(mu0, mu1, eta1, t, discretization)
    assert_boundary(zw.StandardLinearSolid(mu0, mu1, eta1, discretization), bound, t)


def test_tustin_has_no_limit_at_zero_branch_damping():
    """η1 → 0 costs μ1 T/2 more than η1 = 0, where the branch is absent."""
    t = Fraction(1, 1000)
    bound = forms.standard_linear_solid_damping(37, 53, "1e-30", t, "tustin")
    assert bound.fraction == Fraction(90, 2000)
    assert_boundary(zw.StandardLinearSolid(37, 53, "1e-30", "tustin"), bound, t)
    assert_boundary(zw.StandardLinearSolid(37, 53, 0, "tustin"), zw.Exact("0.0185"), t)


def test_negative_branch_damping_voids_the_criterion():
    """With η1 < 0 no damping is proved, and the closed form says so instead of answering."""
    t = Fraction(1, 1000)
    assert not proved(zw.StandardLinearSolid(37, 53, "-0.2"), Fraction(10**6), t)
    with pytest.raises(zw.InputError, match=r"branch_damping must be > 0, got -0\.2"):
        forms.standard_linear_solid_damping(37, 53, "-0.2", t)


@seeds(20)
def test_spring_with_fractional_delay(seed):
    """(K T/4)[2d + 1 + 2α + √…] for any real delay, and its inverse."""
    random = Random(seed)
    k, t = draw(random, 1, 1e5), draw(random, 1e-5, 0.1)
    delay = t * Fraction(random.randint(0, 4999), 1000)
    bound = forms.spring_damping(k, t, delay)
    assert_boundary(zw.Wall(k), bound, t, delay)
    assert float(forms.spring_stiffness(bound, t, delay)) == pytest.approx(float(k), rel=1e-14)


@seeds(20)
def test_whole_delay_is_rational(seed):
    """(2d + 1) K T/2 exactly; a delay just short of a whole number joins it continuously."""
    random = Random(seed)
    k, t, d = draw(random, 1, 1e5), draw(random, 1e-5, 0.1), random.randint(0, 8)
    assert forms.spring_damping(k, t, d * t).fraction == (2 * d + 1) * k * t / 2
    near = forms.spring_damping(k, t, (d + 1 - Fraction(1, 10**15)) * t)
    assert float(near) == pytest.approx(float((2 * d + 3) * k * t / 2), rel=1e-14)


def test_published_delay_values():
    """K = 500 N/m at 1 kHz: 0.25, 0.75, 1.25 N·s/m for 0, 1, 2 samples of delay."""
    found = [forms.spring_damping(500, "0.001", Fraction(d, 1000)).fraction for d in range(3)]
    assert found == [Fraction(1, 4), Fraction(3, 4), Fraction(5, 4)]


def test_rational_root_is_exact():
    """Where the discriminant is a square the bound is rational: d = 0, α = 3/8 gives √4 = 2."""
    bound = forms.spring_damping(800, "0.001", Fraction(3, 8000))
    assert bound.fraction == Fraction(1, 5) * (Fraction(7, 4) + 2)
    assert_boundary(zw.Wall(800), bound, Fraction(1, 1000), Fraction(3, 8000))


def test_paddle_limits():
    """The paddle: 2b/T = 300 N/m binds, 2f_c/Δ = 10 714 N/m; 820 by the mass–damper fit; 107 coarser."""
    sampling, quantization = forms.abbott_okamura_stiffness("0.15", "0.12", "22.4e-6", "0.001")
    assert sampling.fraction == 300
    assert quantization.fraction == Fraction(75000, 7)
    assert forms.abbott_okamura_stiffness("0.41", 0, 0, "0.001") == (820, inf)
    assert float(forms.abbott_okamura_stiffness("0.15", "0.12", "22.4e-4", "0.001")[1]) == pytest.approx(
        107.142857, rel=1e-8
    )


@seeds(20)
def test_abbott_okamura_against_the_engine(seed):
    """Sampling by the linear criterion, quantization by the energy of a step over one edge."""
    random = Random(seed)
    b, t = draw(random, 1e-3, 10), draw(random, 1e-5, 0.1)
    friction, step = draw(random, 1e-3, 1), draw(random, 1e-6, 1e-3)
    sampling, quantization = forms.abbott_okamura_stiffness(b, friction, step, t)
    assert proved(zw.Wall(sampling), b, t)
    assert not proved(zw.Wall(sampling.fraction * (1 + TINY)), b, t)
    k = quantization.fraction
    assert toggling_gain(zw.Wall(k * (1 + TINY)), b, friction, step, t, rest=2) > 0
    assert toggling_gain(zw.Wall(k), b, friction, step, t, rest=2) <= 0


def toggling_gain(wall, damping, friction, step, period, rest):
    """Energy per cycle of a tiny step over the edge at 4Δ and back, by the independent checker."""
    h = wall.pulse_transfer_function(period)
    setting = Setting(loop_from(h, damping, period, Fraction(0)), friction, step, True)
    edge, half = 4 * step, step * Fraction(1, 10**20)
    x = [Fraction(0), edge - half, edge - half]
    x += ([edge + half] * rest + [edge - half] * rest) * 2
    repeats = (Repeat(len(x) - 1 - 2 * rest, len(x) - 1, 1),)
    motion = Motion(tuple(x), (), repeats)
    return setting.energy(motion.repeated(2)) - setting.energy(motion)


@seeds(20)
def test_chattering_friction_is_necessary(seed):
    """For B ≥ −K T a tiny step over one edge gains below the bound and loses at it."""
    random = Random(seed)
    k, t, step = draw(random, 1, 1e4), draw(random, 1e-4, 0.01), draw(random, 1e-6, 1e-3)
    b = draw(random, 1e-3, 20) if seed % 2 else -k * t * Fraction(random.randint(0, 1000), 1000)
    bound = forms.quantized_kelvin_voigt_friction(k, b, step, t).fraction
    damping = forms.kelvin_voigt_damping(k, b, t).fraction
    rest = 1 if b > 0 else 2
    wall = zw.Wall(k, b)
    assert toggling_gain(wall, damping, bound * (1 - TINY), step, t, rest) > 0
    assert toggling_gain(wall, damping, bound, step, t, rest) < 0
    assert toggling_gain(wall, damping, bound * (1 + TINY), step, t, rest) < 0
    waits = best_waits(loop_from(wall.pulse_transfer_function(t), damping, t, Fraction(0)))
    assert waits.gain * float(step) / 2 == pytest.approx(float(bound), rel=1e-12)


@seeds(20)
def test_chattering_friction_is_the_one_norm(seed):
    """The largest force error over all encoder errors ±Δ/2, B of any sign and size."""
    random = Random(seed)
    k, t, step = draw(random, 1, 1e4), draw(random, 1e-4, 0.01), draw(random, 1e-6, 1e-3)
    b = random.choice([-1, 1]) * k * t * draw(random, 1e-3, 1e3)
    h = (k + b / t, -b / t)
    worst = max(h[0] * e + h[1] * past for e, past in product((-step / 2, step / 2), repeat=2))
    bound = forms.quantized_kelvin_voigt_friction(k, b, step, t).fraction
    assert bound == worst
    if b < -k * t:  # one edge shows only that K Δ/2 is necessary
        loop = loop_from(zw.Wall(k, b).pulse_transfer_function(t), abs(b), t, Fraction(0))
        assert best_waits(loop).gain == pytest.approx(float(k), rel=1e-12)
        assert bound > k * step / 2


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: forms.kelvin_voigt_damping(-1, 0, "0.001"), "stiffness must be ≥ 0, got -1"),
        (lambda: forms.kelvin_voigt_damping(1, 0, 0), "sample_period must be > 0 s, got 0"),
        (lambda: forms.kelvin_voigt_damping(1, "nan", 1), "damping is in .*: it must be finite"),
        (lambda: forms.window_damping(1, 1, 4, "0.001"), "at most 3 samples, got 4"),
        (lambda: forms.window_damping(1, -1, 0, "0.001"), "samples is a whole number"),
        (lambda: forms.window_damping(1, -1, 1.5, "0.001"), "samples is a whole number"),
        (lambda: forms.standard_linear_solid_damping(1, 0, 1, 1), "branch_stiffness must be > 0"),
        (lambda: forms.standard_linear_solid_damping(1, 1, 0, 1), "kelvin_voigt_damping"),
        (lambda: forms.standard_linear_solid_damping(1, 1, 1, 1, "zoh"), "'zoh'"),
        (lambda: forms.spring_damping(1, 1, -1), "delay must be ≥ 0 s, got -1"),
        (lambda: forms.spring_stiffness(-1, 1), "damping must be ≥ 0"),
        (lambda: forms.abbott_okamura_stiffness(1, -1, 1, 1), "coulomb_friction must be ≥ 0"),
        (lambda: forms.abbott_okamura_stiffness(1, 1, -1, 1), "resolution must be ≥ 0"),
        (lambda: forms.quantized_kelvin_voigt_friction(1, 1, -1, 1), "resolution must be ≥ 0"),
        (lambda: forms.quantized_kelvin_voigt_friction(True, 1, 1, 1), "stiffness is in N/m; got true"),
    ],
)
def test_outside_the_hypotheses(call, message):
    with pytest.raises(zw.InputError, match=message):
        call()
