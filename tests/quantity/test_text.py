"""Numbers and units as people read them, in the unit of angle in which the question was asked."""

from math import inf, pi

import pytest

from zwidth.errors import InputError
from zwidth.quantity.exact import Interval
from zwidth.quantity.spoken import answers_as_typed, answers_in, spoken
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
    told,
    told_quantity,
    unit_text,
)
from zwidth.quantity.units import parse, parse_number


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


ROTARY = ("rad", "rad/s", "N*m/rad", "N·m·s/rad", "s/rad", "N*m*s/rad/J", "N*m/rad^1.5")


def test_nobody_asked():
    assert all(spoken(unit) == (1.0, unit) for unit in ROTARY)
    with answers_as_typed():
        parse_number("0.3 N*m/rad", "N*m/rad", "stiffness")
        assert all(spoken(unit) == (1.0, unit) for unit in ROTARY)


def test_the_stiffness_says_in_which_angle():
    """Whatever the encoder was typed in; where it was typed in none, the others say."""
    for typed, told_in in (("15 N*m/rad", "rad"), ("0.3 N*m/deg", "deg"), ("15", "turn")):
        with answers_as_typed():
            parse_number("0.001 turn", "rad", "resolution")
            parse_number(typed, "N*m/rad", "stiffness")
            assert spoken("N*m/rad")[1] == f"N*m/{told_in}"


def test_whoever_types_degrees():
    """Every angle of the answer is in degrees once one was typed so, above and below the bar."""
    with answers_as_typed():
        value = parse_number("0.4 N*m/deg", "N*m/rad", "stiffness")
        assert told_quantity(value, "stiffness", "rotary") == "0.4 N·m/deg"
        assert told(parse_number("7", "rad", "position"), "rad") == f"{7 * 180 / pi:.6g} deg"
        assert shown(0.0002, "N*m*s/rad") == "3.491 µN·m·s/deg"
        assert in_unit(pi, "rad/s") == "180 deg/s"
        assert readable(pi / 1800, "rad") == "0.1 deg"
        assert told(2.0, "N*m/rad^1.5") == f"{2 * (pi / 180) ** 1.5:.6g} N·m/deg^1.5"
        assert told(Interval(pi / 180, pi / 18), "rad") == "1 … 10 deg"
        assert shown(3.0, "N*m") == "3 N·m"
    assert shown(pi, "rad") == "3.142 rad"


def test_an_interval_of_degrees():
    with answers_as_typed():
        parse("5 .. 10 °", "rad", "position")
        assert spoken("rad") == (180 / pi, "deg")


def test_what_was_refused_was_not_typed():
    with answers_as_typed():
        with pytest.raises(InputError, match="damping is in"):
            parse_number("3 deg", "N*m*s/rad", "damping")
        assert spoken("rad") == (1.0, "rad")


def test_turns_and_rpm():
    with answers_in("rpm"):
        assert told(pi, "rad/s") == "30 rpm"
        assert told(pi, "rad") == f"{pi:.6g} rad"
    with answers_in("turn"):
        assert told(pi, "N*m*s/rad") == f"{2 * pi**2:.6g} N·m·s/turn"
    with answers_as_typed():
        parse_number("120 rpm", "rad/s", "speed")
        parse_number("3 deg/s", "rad/s", "speed")
        assert (spoken("rad/s")[1], spoken("rad")[1]) == ("rpm", "deg")


def test_an_unknown_angle():
    with pytest.raises(InputError, match="rad, deg or turn"), answers_in("gon"):
        pass


def test_counts_are_no_turns():
    """65 536 counts per turn is no answer in turns."""
    with answers_as_typed():
        parse_number("65536 counts/turn", "1", "counts_per_turn")
        assert spoken("rad") == (1.0, "rad")
