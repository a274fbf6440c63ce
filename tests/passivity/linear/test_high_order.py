"""Laws of order about 110: each is decided, or said to be undecided, or refused by its size."""

from __future__ import annotations

from fractions import Fraction
from math import cos
from random import Random

import polynomials
import pytest
from flint import fmpq_poly, fmpz_poly

import zwidth as zw
from zwidth.passivity.linear import criterion, positivity
from zwidth.passivity.linear.loop import LARGEST_DIGITS, linear_loop
from zwidth.passivity.parameter_limits import provable
from zwidth.passivity.witness.sinusoid import sinusoids
from zwidth.quantity.exact import Exact

DEVICE = zw.Device(damping="0.5", sample_period="1 ms", coulomb_friction="0.1")


def stable_law(order, seed, digits=3):
    """Random poles inside a radius of 0.8, a random numerator."""
    random = Random(seed)
    pairs = [(random.uniform(0.3, 0.8), random.uniform(0.1, 3.0)) for _ in range(order // 2)]
    factors = [(1, Fraction(f"{-2 * r * cos(a):.2f}"), Fraction(f"{r * r:.2f}")) for r, a in pairs]
    denominator = [Fraction(f"{float(c):.12e}") for c in polynomials.product(*factors)]
    numerator = [1000, *(Fraction(f"{random.uniform(-10, 10):.{digits}f}") for _ in range(order))]
    return zw.PulseTransferFunction(numerator, denominator)


def law_of_criterion(criterion, order, damping, period):
    """The law of so many samples' memory whose criterion is this polynomial in cos ωT."""
    cosines = [Fraction(0)] * (order + 2)
    rest = criterion - fmpq_poly([int(2 * damping / period)])
    while rest.degree() >= 0:
        wave = fmpz_poly.chebyshev_t(rest.degree())
        share = rest[rest.degree()] / wave[rest.degree()]
        cosines[rest.degree()] = Fraction(int(share.p), int(share.q))
        rest -= share * fmpq_poly(wave)
    numerator = [(b - a) / 2 for a, b in zip(cosines, cosines[1:], strict=False)]
    numerator[0] = cosines[1] / 2 - cosines[0]
    return zw.PulseTransferFunction(numerator, [1] + [0] * order)


def nearly_touching(order):
    """(c^order + (10⁹ c − 1)²)/10⁶: positive, by 10 to the power −9·order at the least."""
    return (fmpq_poly([0] * order + [1]) + fmpq_poly([-1, 10**9]) ** 2) / 10**6


@pytest.mark.parametrize("seed", range(2))
def test_a_law_of_order_110_is_active_with_little_damping_and_passive_with_much(seed):
    law = stable_law(110, seed)
    assert zw.check(DEVICE, law).outcome == "active"
    verdict = zw.check(DEVICE.replace(damping=1000), law)
    assert verdict.outcome == "passive"
    assert verdict.certificate.verify()


def test_the_largest_gain_is_a_boundary():
    law = stable_law(60, 3)
    device = DEVICE.replace(damping=3, resolution="1 um")
    gain = zw.check(device, law).max_gain

    def holds(value):
        return provable(lambda g: (device, law.scaled(g)), Exact(value).fraction)

    assert holds(gain)
    assert not holds(gain * (1 + 1e-9))


def test_a_criterion_that_all_but_touches_zero_is_undecided():
    """Nearer than any proof could say: the verdict says so, and what damping would do."""
    device = zw.Device(damping=10**12, sample_period="1 ms")
    law = law_of_criterion(nearly_touching(110), 110, Fraction(10**12), Fraction(1, 1000))
    loop = linear_loop(device, law)
    assert loop.criterion.degree() == 110
    verdict = zw.check(device, law)
    assert verdict.outcome == "undecided"
    assert "so close to its limit" in verdict.claim
    assert verdict.required_damping == pytest.approx(1e12)
    more = zw.check(device.replace(damping=2 * 10**12), law)
    assert more.outcome == "passive"


def test_an_unstable_law_is_refuted_however_close_its_criterion_comes(monkeypatch):
    """Stability does not wait for the sign of the criterion."""
    monkeypatch.setattr(positivity, "MOST_WORDS", 0)
    law = zw.PulseTransferFunction(["0.1", "0.2", "-0.1"], [1, "-1.2345", "0.1"])
    verdict = zw.check(DEVICE.replace(damping=777), law)
    assert verdict.outcome == "active"


def test_too_many_digits_are_refused_before_they_are_worked_with():
    random = Random(1)
    uneven = [Fraction(1, random.randint(10**49, 10**50)) for _ in range(120)]
    with pytest.raises(zw.InputError, match=f"more than {LARGEST_DIGITS} digits.*fewer digits"):
        zw.check(DEVICE, zw.PulseTransferFunction([1000 + v * 10**48 for v in uneven], [1] + [0] * 119))


def test_many_corners_of_a_law_of_high_order_are_refused():
    device = zw.Device(
        damping=30, sample_period=("1 ms", "1.1 ms"), delay=("0.1 ms", "50.1 ms"), coulomb_friction=1
    )
    wall = zw.Wall(stiffness=(100, 300), damping=("0.1", "0.5"))
    with pytest.raises(zw.InputError, match=r"16 corners.*at most 8.*single values"):
        zw.check(device, wall)
    short = device.replace(delay=("0.1 ms", "0.2 ms"))
    assert zw.check(short, wall).outcome in ("undecided", "active")


def test_pieces_of_a_delay_are_counted(monkeypatch):
    law = stable_law(10, 5)
    device = zw.Device(damping="22.75", sample_period="1 ms", delay=(0, "3 ms"))
    assert len(zw.check(device, law).certificate.documents[0]["proof"]["pieces"]) > 3
    monkeypatch.setattr(criterion, "MOST_PIECES", 40)
    assert zw.check(device, law).finding == "between corners"


def test_a_law_of_order_110_is_led_into_the_wall():
    """Numbers beyond the largest double on the way, and none of them is made one."""
    loop = linear_loop(DEVICE, stable_law(110, 0))
    patterns = list(sinusoids(loop, unilateral=True))
    assert patterns
    assert all(pattern.ends_inside for pattern in patterns)
