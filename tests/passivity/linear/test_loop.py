"""The criterion's polynomial against its formula, evaluated with mpmath at many digits."""

from __future__ import annotations

from fractions import Fraction
from random import Random

import mpmath
import pytest
from strategies import seeds

import zwidth as zw
from zwidth.model.environment.environment import RationalFunction
from zwidth.passivity.linear.loop import LARGEST_DEGREE, linear_loop, loop_from

mpmath.mp.dps = 40


def decimal(random, low=-5.0, high=5.0):
    """A number as a person types it."""
    return Fraction(f"{random.uniform(low, high):.4f}")


def random_law(random):
    """A proper H(z) of order 0 to 6, descending powers, with its leading denominator not 0."""
    order = random.randint(0, 6)
    zeros = random.randint(0, order)
    numerator = tuple(decimal(random) for _ in range(zeros + 1))
    return RationalFunction(numerator, (Fraction("1.7"), *(decimal(random, -1, 1) for _ in range(order))))


def random_loop(random):
    """H(z), b, T and a delay of none, whole or broken samples."""
    period = decimal(random, 0.0005, 0.01)
    share = random.choice([Fraction(0), Fraction(1), Fraction(3), Fraction("0.37"), Fraction("2.815")])
    h = random_law(random)
    return h, decimal(random, 0.01, 3), period, share * period


def horner(descending, z):
    """A polynomial of rational coefficients at a point of the plane."""
    total = mpmath.mpf(0)
    for c in descending:
        total = total * z + mpmath.mpf(int(c.numerator)) / int(c.denominator)
    return total


def at(h, z):
    """H at a point of the plane."""
    return horner(h.numerator, z) / horner(h.denominator, z)


def needed(h, period, delay, turn):
    """½[A + √(A² + T² α(1−α)|H|²)] with A = (T/2) Re{(1 − z⁻¹) z⁻ᵈ(1 − α + α z⁻¹) H}/(1 − cos ωT)."""
    z = mpmath.expjpi(2 * mpmath.mpf(turn))
    t = mpmath.mpf(period.numerator) / period.denominator
    whole, part = divmod(delay / period, 1)
    alpha = mpmath.mpf(part.numerator) / part.denominator
    value = at(h, z)
    late = z ** (-int(whole)) * (1 - alpha + alpha / z) * value
    a = t / 2 * ((1 - 1 / z) * late).real / (1 - z.real)
    if alpha == 0:
        return a
    return (a + mpmath.sqrt(a * a + t * t * alpha * (1 - alpha) * abs(value) ** 2)) / 2


@seeds(20)
def test_criterion_has_the_sign_of_what_the_formula_asks(seed):
    random = Random(seed)
    h, damping, period, delay = random_loop(random)
    loop = loop_from(h, damping, period, delay)
    q = [int(c) for c in loop.criterion.coeffs()]
    for _ in range(12):
        turn = random.uniform(0.001, 0.5)
        c = mpmath.cospi(2 * mpmath.mpf(turn))
        value = horner(q[::-1], c)
        assert (value > 0) == (mpmath.mpf(float(damping)) > needed(h, period, delay, turn))


@seeds(15)
def test_required_damping_at_a_frequency(seed):
    random = Random(1000 + seed)
    h, damping, period, delay = random_loop(random)
    loop = loop_from(h, damping, period, delay)
    for _ in range(12):
        turn = random.uniform(0.05, 0.5)
        c = Fraction(float(mpmath.cospi(2 * mpmath.mpf(turn))))
        turn = mpmath.acos(mpmath.mpf(c.numerator) / c.denominator) / (2 * mpmath.pi)
        expected = needed(h, period, delay, turn)
        scale = float(period) * float(abs(at(h, mpmath.expjpi(2 * turn))))
        assert loop.required_damping_at(c) == pytest.approx(float(expected), rel=1e-9, abs=1e-9 * scale)


def test_common_factors_are_cancelled():
    plain = loop_from(RationalFunction((Fraction(3), Fraction(-2)), (Fraction(5), Fraction(1))),
                      Fraction(2), Fraction(1, 500), Fraction(0))  # fmt: skip
    r = Fraction("0.3")
    doubled = RationalFunction(
        (Fraction(3), -2 - 3 * r, 2 * r), (Fraction(5), 1 - 5 * r, -r)
    )  # both times (z − 0.3)
    same = loop_from(doubled, Fraction(2), Fraction(1, 500), Fraction(0))
    assert (same.numerator, same.denominator) == (plain.numerator, plain.denominator)


def test_more_zeros_than_poles_is_refused():
    h = RationalFunction((Fraction(1), Fraction(2), Fraction(3)), (Fraction(4), Fraction(1)))
    with pytest.raises(zw.InputError, match="more zeros than poles"):
        loop_from(h, Fraction(1), Fraction(1, 1000), Fraction(0))


def test_a_delay_beyond_reach_is_refused():
    device = zw.Device(damping="0.4", rate=1000, delay=Fraction(LARGEST_DEGREE + 3, 1000))
    with pytest.raises(zw.InputError, match="can be certified"):
        linear_loop(device, zw.Wall(200))


def test_static_stiffness():
    """H(1) is numerator sum over denominator sum, and None with a pole there."""
    h = RationalFunction((Fraction(7), Fraction("-2.5")), (Fraction(2), Fraction("-0.5")))
    assert loop_from(h, Fraction(1), Fraction(1, 700), Fraction(0)).static_stiffness == 3
    integrator = RationalFunction((Fraction(7),), (Fraction(2), Fraction(-2)))
    assert loop_from(integrator, Fraction(1), Fraction(1, 700), Fraction(0)).static_stiffness is None


@seeds(20)
def test_many_places_at_once_have_the_same_needs(seed):
    """Bit for bit those of one place after the other, at the ends and at a pole on the circle too."""
    random = Random(seed)
    loop = loop_from(*random_loop(random))
    cosines = [-1.0, 1.0, 0.0, *(random.uniform(-1, 1) for _ in range(20))]
    assert loop.required_dampings_at(cosines) == [loop.required_damping_at(Fraction(c)) for c in cosines]
    integrator = loop_from(
        RationalFunction((Fraction(3),), (Fraction(1), Fraction(-1))), *random_loop(random)[1:]
    )
    assert integrator.required_dampings_at([1.0, 0.3]) == [
        integrator.required_damping_at(Fraction(c)) for c in (1.0, 0.3)
    ]
