"""Numbers and units as people read them."""

from math import inf

import pytest

from zwidth.quantity.spoken import answers_in
from zwidth.quantity.text import (
    alike,
    enough,
    in_a_table,
    in_unit,
    in_words,
    quantity_unit,
    readable,
    shown,
    shown_at_least,
    shown_at_most,
    unit_text,
)


@pytest.mark.parametrize(
    ("value", "unit", "text"),
    [
        (22.4e-6, "m", "22.4 µm"),
        (0.12, "N", "0.12 N"),
        (0.00336, "N", "3.36 mN"),
        (999.96e-6, "s", "1 ms"),
        (-0.001427, "J", "-1.427 mJ"),
        (300, "N/m", "300 N/m"),
        (0.15, "N*m*s/rad", "0.15 N·m·s/rad"),
        (5, "1", "5"),
        (0, "m", "0 m"),
        (1e30, "J", "1e+30 J"),
        (5e-324, "J", "4.941e-324 J"),
        (inf, "N/m", "any"),
        (None, "N/m", "none"),
    ],
)
def test_a_value_with_its_unit(value, unit, text):
    assert shown(value, unit) == text


def test_a_value_in_a_unit_that_is_kept():
    assert in_unit(0.0123456789, "N*s/m") == "0.0123457 N·s/m"
    assert in_unit(-2.39684e-05, "N*m") == "-23.9684 µN·m"
    assert in_unit(7.123456e-05, "N*m*s/rad") == "71.2346 µN·m·s/rad"
    assert (in_unit(None, "N/m"), in_unit(inf, "N/m")) == ("none", "any")


def test_units_and_keys_in_words():
    assert unit_text("kg*m^2") == "kg·m²"
    assert quantity_unit("damping") == "N·s/m"
    assert quantity_unit("stiffness", "rotary") == "N·m/rad"
    assert in_words("coulomb_friction") == "Coulomb friction"


def test_a_number_in_a_table():
    numbers = (1234567.0, 12345.6, 999.96, 0.00012345)
    assert [in_a_table(number) for number in numbers] == ["1.235e+06", "12346", "1000", "0.0001234"]
    assert in_a_table(0.98765, 3) == "0.988"


@pytest.mark.parametrize(
    ("value", "unit", "text"),
    [
        (0.1427, "J", "0.1427 J"),
        (0.001427, "J", "1.427 mJ"),
        (2.03254e-6, "J", "2.033 µJ"),
        (-22.4e-6, "m", "-22.4 µm"),
        (2.5e-5, "rad", "25 µrad"),
        (54190, "m/s", "54.19 km/s"),
        (1e-5, "N*m", "10 µN·m"),
        (1e-5, "N*s/m", "1e-05 N·s/m"),
        (1e-30, "m", "1e-30 m"),
        (0, "m", "0 m"),
        (300, "N/m", "300 N/m"),
        (5e-5, "1", "5e-05"),
    ],
)
def test_a_prefix_takes_the_place_of_an_exponent(value, unit, text):
    assert readable(value, unit) == text


def test_values_of_one_line_have_one_prefix():
    """Torques and angles that of the smallest, unless another is far above; lengths each their own."""
    assert alike("N*m*s/rad", (0, 3.781e-5), (4, 6)) == ("0 µN·m·s/rad", "37.81 µN·m·s/rad")
    assert alike("N*m*s/rad", (0.00125, 3.7e-5), (4, 6)) == ("1250 µN·m·s/rad", "37 µN·m·s/rad")
    assert alike("N*m", (0.0027471, 0.05), (4, 4)) == ("2.747 mN·m", "50 mN·m")
    assert alike("N*m*s/rad", (2.0, 3.7e-5), (4, 4)) == ("2 N·m·s/rad", "37 µN·m·s/rad")
    assert alike("m", (0.3, 0.0001), (4, 4)) == ("0.3 m", "100 µm")


def test_a_limit_is_rounded_to_the_side_on_which_it_holds():
    assert shown_at_most(416.96, "N/m") == "416.9 N/m"
    assert shown_at_least(416.92, "N/m") == "417 N/m"
    assert enough(7.12345612e-05, "N*m*s/rad") == "71.2346 µN·m·s/rad"
    with answers_in("deg"):
        assert shown_at_most(1.0, "N*m/rad") == "0.01745 N·m/deg"
        assert shown_at_least(1.0, "N*m/rad") == "0.01746 N·m/deg"
