"""H(z) against scipy.signal, high-precision arithmetic and the definitions."""

from fractions import Fraction
from functools import reduce

import mpmath
import numpy as np
import pytest
import scipy.signal
from hypothesis import given, settings
from hypothesis import strategies as st

from zwidth.errors import InputError
from zwidth.model.environment.discretization import CHOICES, ROUNDED, as_discretization, discretize

T = Fraction(1, 800)
SCIPY = {
    "backward": "backward_diff",
    "forward": "euler",
    "tustin": "bilinear",
    "zoh": "zoh",
    "impulse": "impulse",
}
SUBSTITUTION = {
    "backward": lambda z, t: (z - 1) / (t * z),
    "forward": lambda z, t: (z - 1) / t,
    "tustin": lambda z, t: 2 * (z - 1) / (t * (z + 1)),
}


def exact(values):
    """Floats as the decimals that they show."""
    return tuple(Fraction(repr(float(v))) for v in values)


def value(transfer, z):
    """H(z) in mpmath."""
    top, bottom = (horner(_mp(p), z) for p in transfer)
    return top / bottom


def horner(coefficients, z):
    """A polynomial in descending powers at z."""
    return reduce(lambda total, c: total * z + c, coefficients, mpmath.mpf(0))


def _mp(values):
    return [mpmath.mpf(v.numerator) / v.denominator for v in values]


@st.composite
def stable_laws(draw):
    """H(s) with real and complex poles, some of them repeated or at the origin."""
    real = draw(st.lists(st.floats(0.5, 3000), min_size=1, max_size=3))
    pairs = draw(st.lists(st.tuples(st.floats(1, 500), st.floats(1, 2000)), max_size=2))
    den = np.poly([-p for p in real])
    for decay, ring in pairs:
        den = np.polymul(den, [1, 2 * decay, decay**2 + ring**2])
    order = len(den) - 1
    num = draw(st.lists(st.floats(-50, 50), min_size=1, max_size=order))
    num = [round(c, 6) * 700.0 ** (len(num) - 1 - i) * 1.0 for i, c in enumerate(num)]
    return (*num, 3.5), tuple(den)


LAWS = [
    ((650.0, 9.1e4), (1.0, 370.0)),
    ((2.5, 900.0, 4.4e5), (1.0, 260.0, 3.1e5)),
    ((7.0, 2.0e3, 9.0e5), (1.0, 320.0, 249400.0, 4868000.0)),
    ((310.0,), (0.7, 90.0, 2.0e4)),
]


# scipy refuses an impulse-invariant direct term
CASES = [(law, m) for law in LAWS for m in sorted(SCIPY) if m != "impulse" or len(law[0]) < len(law[1])]


@pytest.mark.parametrize(("law", "method"), CASES)
def test_agrees_with_scipy_in_frequency_response(law, method):
    """scipy.signal.cont2discrete gives the same H(e^jθ) wherever it can do the method."""
    num, den = law
    ours = discretize(exact(num), exact(den), method, T)
    top, bottom, _ = scipy.signal.cont2discrete((num, den), float(T), SCIPY[method])
    angles = np.array([0.3, 1.0, 2.0, 3.1])
    _, theirs = scipy.signal.freqz(np.ravel(top), bottom, worN=angles)
    mine = [complex(value(ours, mpmath.expj(a))) for a in angles]
    assert mine == pytest.approx(theirs, rel=1e-9)


@settings(max_examples=40, deadline=None)
@given(stable_laws(), st.sampled_from(sorted(SUBSTITUTION)), st.floats(0.1, 3))
def test_substitution_is_exact(law, method, angle):
    """H(z) is H(s) at the substituted s, to 40 digits."""
    num, den = exact(law[0]), exact(law[1])
    with mpmath.workdps(60):
        z = mpmath.expj(angle)
        s = SUBSTITUTION[method](z, mpmath.mpf(T.numerator) / T.denominator)
        expected, got = value((num, den), s), value(discretize(num, den, method, T), z)
        assert abs(got - expected) <= abs(expected) * mpmath.mpf(10) ** -40


def _impulse_response(num, den, t):
    """h(t) from the partial fractions."""
    slope = [c * (len(den) - 1 - i) for i, c in enumerate(den[:-1])]
    terms = [horner(num, p) / horner(slope, p) * mpmath.exp(p * t) for p in POLES]
    return mpmath.re(mpmath.fsum(terms))


def _series(transfer, count):
    """First terms of H(z) in powers of 1/z."""
    top, bottom = (list(p) for p in transfer)
    top = [Fraction(0)] * (len(bottom) - len(top)) + top
    out = []
    for k in range(count):
        term = (top[k] if k < len(top) else 0) - sum(
            bottom[i] * out[k - i] for i in range(1, min(k, len(bottom) - 1) + 1)
        )
        out.append(term / bottom[0])
    return out


NUM, DEN = exact([7.0, 2.0e3, 9.0e5]), exact([1.0, 320.0, 249400.0, 4868000.0])
POLES = [mpmath.mpf(-20), mpmath.mpc(-150, 470), mpmath.mpc(-150, -470)]


def test_impulse_is_the_sampled_impulse_response():
    with mpmath.workdps(50):
        num, den = _mp(NUM), _mp(DEN)
        for k, term in enumerate(_series(discretize(NUM, DEN, "impulse", T), 8)):
            expected = _impulse_response(num, den, k * mpmath.mpf(1) / 800) / 800
            assert abs(_mp([term])[0] - expected) < 1e-13 * 7


def test_zero_order_hold_is_the_sampled_step_response():
    with mpmath.workdps(40):
        num, den = _mp(NUM), _mp(DEN)
        response = np.cumsum([float(c) for c in _series(discretize(NUM, DEN, "zoh", T), 6)])
        for k in range(6):
            step = mpmath.quad(lambda t: _impulse_response(num, den, t), [0, k * mpmath.mpf(1) / 800])
            assert response[k] == pytest.approx(float(step), rel=1e-11, abs=1e-15)


def test_impulse_keeps_the_direct_term():
    """H(s) = 5 + 3/(s + 40): the 5 stays and the rest is sampled."""
    transfer = discretize(exact([5.0, 203.0]), exact([1.0, 40.0]), "impulse", T)
    first, second, *_ = _series(transfer, 2)
    assert float(first) == pytest.approx(5 + 3 / 800, rel=1e-15)
    assert float(second) == pytest.approx(3 / 800 * np.exp(-40 / 800), rel=1e-13)


def test_matched_places_poles_and_zeros():
    """Roots are the exponentials; the two missing zeros give one at z = −1; the rest gain agrees."""
    num, den = exact([2.0, 300.0]), exact(np.poly([-90.0, -400.0, -1300.0]))
    transfer = discretize(num, den, "matched", T)
    top, bottom = ([float(c) for c in p] for p in transfer)
    assert np.sort(np.roots(top)) == pytest.approx(np.sort([-1.0, np.exp(-150 / 800)]), rel=1e-12)
    expected = np.exp(np.array([-1300.0, -400.0, -90.0]) / 800)
    assert np.sort(np.roots(bottom)) == pytest.approx(expected, rel=1e-10)
    assert np.polyval(top, 1) / np.polyval(bottom, 1) == pytest.approx(float(num[-1] / den[-1]), rel=1e-10)


@pytest.mark.parametrize(
    ("num", "den", "power"), [([6.0, 0.0], [1.0, 70.0], 1), ([6.0], [1.0, 70.0, 0.0], -1)]
)
def test_matched_gain_at_low_frequency_with_a_root_at_the_origin(num, den, power):
    """H(z)/((z − 1)/T)^k tends to H(s)/s^k."""
    transfer = discretize(exact(num), exact(den), "matched", T)
    with mpmath.workdps(50):
        z = mpmath.exp(mpmath.mpf("1e-12"))
        ratio = value(transfer, z) / ((z - 1) * 800) ** power
        assert float(ratio) == pytest.approx(6 / 70, rel=1e-9)


@pytest.mark.parametrize("method", sorted(ROUNDED))
def test_rounded_coefficients_are_the_nearest_doubles(method):
    """With one pole all coefficients are known in closed form: compare with 80 digits."""
    mu, p = Fraction("731.3"), Fraction("412.7")
    top, bottom = discretize((mu, Fraction(0)), (Fraction(1), p), method, T)
    with mpmath.workdps(80):
        x = mpmath.mpf(p.numerator) / p.denominator / 800
        pole = mpmath.exp(-x)
        k = mpmath.mpf(mu.numerator) / mu.denominator
        expected = {
            "zoh": [k, -k],
            "impulse": [k - k * x, -k * pole],
            "matched": [k * (1 - pole) / x, -k * (1 - pole) / x],
        }[method]
        assert [float(c) for c in top] == [float(c) for c in expected]
        assert [float(c) for c in bottom] == [1.0, float(-pole)]


def test_repeated_poles_and_undamped_ones():
    """A double pole, an integrator and a lossless resonance have a hold equivalent like any other."""
    integrator = discretize(exact([3.0]), exact([1.0, 0.0]), "zoh", T)
    assert integrator.numerator == (Fraction(3, 800),)
    assert integrator.denominator == (1, -1)
    double = discretize(exact([1.0]), exact([1.0, 200.0, 1.0e4]), "zoh", T)
    a = np.exp(-100 / 800)
    assert [float(c) for c in double.denominator] == pytest.approx([1, -2 * a, a * a], rel=1e-15)
    resonance = discretize(exact([1.0]), exact([1.0, 0.0, 9.0e4]), "zoh", T)
    assert resonance.denominator[2] == 1
    assert float(resonance.denominator[1]) == -2 * np.cos(300 / 800)


@pytest.mark.parametrize("method", CHOICES)
def test_a_constant_stays_itself(method):
    """H(s) = K is K under every discretization, exactly."""
    assert discretize(exact([0.0, 0.6]), exact([0.2]), method, T) == ((Fraction(3),), (Fraction(1),))


def test_derivative_under_backward_and_tustin():
    """K + B s is the wall with backward difference, or has a pole at z = −1."""
    assert discretize(exact([2.0, 300.0]), exact([1.0]), "backward", T) == (
        (300 * T + 2, Fraction(-2)),
        (T, Fraction(0)),
    )
    assert discretize(exact([2.0, 300.0]), exact([1.0]), "tustin", T).denominator == (T, T)


def test_precision_of_the_caller_is_restored():
    """Ball arithmetic at high precision leaves the caller's setting alone."""
    import flint

    before = flint.ctx.prec
    discretize(exact([1.0]), exact([1.0, 3.0]), "zoh", T)
    assert flint.ctx.prec == before


@pytest.mark.parametrize(
    ("num", "den", "method", "said"),
    [
        *(([2, 300], [1], m, 'use "backward" or "tustin"') for m in ("forward", "zoh", "impulse", "matched")),
        ([5], [1, -800], "backward", "still to come"),
        ([5], [1, -1600], "tustin", "still to come"),
        ([1], [1, -1e7], "zoh", "no double holds"),
        ([1], [1] * 42, "zoh", "order 41"),
    ],
)
def test_what_has_no_pulse_transfer_function_is_refused(num, den, method, said):
    with pytest.raises(InputError, match=said):
        discretize(exact(num), exact(den), method, T)


def test_very_fast_modes_decay_to_exact_zeros():
    fast = discretize(exact([1e12]), exact([1.0, 1e12]), "zoh", T)
    assert fast == ((Fraction(1),), (Fraction(1), Fraction(0)))


@pytest.mark.parametrize("name", ["euler", "", None, 3, ["zoh"]])
def test_unknown_names_are_refused_with_the_choices(name):
    with pytest.raises(InputError, match=r'"backward", .*"matched"'):
        as_discretization(name)
