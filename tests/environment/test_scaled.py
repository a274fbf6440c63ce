"""A law times a factor: every force is, exactly, and the time in which it relaxes stays."""

from __future__ import annotations

from fractions import Fraction

import pytest

import zwidth as zw
from zwidth.quantity.exact import Interval

FACTOR, PERIOD = Fraction(7, 3), Fraction(1, 1300)
LAWS = {
    "wall": zw.Wall("310.7", "0.41"),
    "clamped wall": zw.Wall("310.7", "0.41", clamped=True),
    "Maxwell": zw.Maxwell("145.1", "11.3"),
    "standard linear solid": zw.StandardLinearSolid("310.7", "145.1", "11.3", "tustin"),
    "generalized Maxwell": zw.GeneralizedMaxwell("310.7", [("145.1", "11.3"), ("90.2", "1.7")]),
}


@pytest.mark.parametrize("name", LAWS)
def test_the_pulse_transfer_function_is_times_the_factor(name: str) -> None:
    law = LAWS[name]
    scaled = law.scaled(FACTOR)
    assert scaled.clamped == law.clamped
    z = Fraction(-3, 5)

    def value(of: zw.Environment) -> Fraction:
        top, bottom = of.pulse_transfer_function(PERIOD)
        at = [sum(c * z**k for k, c in enumerate(reversed(side))) for side in (top, bottom)]
        return Fraction(at[0] / at[1])

    assert value(scaled) == FACTOR * value(law)


def test_a_contact_gives_the_force_times_the_factor() -> None:
    contact = zw.HuntCrossley("5000", "1.5", "3")
    there = ("0.004", "0.02")
    assert float(contact.scaled(FACTOR).force(*there)) == pytest.approx(
        float(FACTOR) * float(contact.force(*there)), rel=1e-15
    )


def test_both_ends_of_an_interval_are_scaled() -> None:
    scaled = zw.StandardLinearSolid((300, 320), 145, (10, 12)).scaled(Fraction(2))
    assert scaled.stiffness == Interval(600, 640)
    assert scaled.branch_damping == Interval(20, 24)


def test_the_largest_gain_of_a_solid_is_that_of_its_closed_form() -> None:
    """b/(μ0 T/2 + μ1 η1 T/(2 η1 + μ1 T)), bracketed within 1 %."""
    solid, device = zw.StandardLinearSolid(310, 145, 11), zw.Device(damping=0.3, sample_period="1 ms")
    bracket = zw.limit(device, solid, "gain")
    need = 310 * 0.0005 + 145 * 11 * 0.001 / (22 + 0.145)
    assert bracket.proved_passive <= 0.3 / need <= bracket.proved_active
    assert bracket.proved_active / bracket.proved_passive < 1.01
