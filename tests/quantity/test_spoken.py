"""Answers in the unit of angle in which the question was asked."""

from math import pi

import pytest

from zwidth.errors import InputError
from zwidth.quantity.exact import Interval
from zwidth.quantity.spoken import answers_as_typed, answers_in, spoken
from zwidth.quantity.text import in_unit, readable, shown, told, told_quantity
from zwidth.quantity.units import parse, parse_number

ROTARY = ("rad", "rad/s", "N*m/rad", "N·m·s/rad", "s/rad", "N*m*s/rad/J", "N*m/rad^1.5")


def test_nobody_asked():
    assert all(spoken(unit) == (1.0, unit) for unit in ROTARY)
    with answers_as_typed():
        parse_number("0.3 N*m/rad", "N*m/rad", "stiffness")
        assert all(spoken(unit) == (1.0, unit) for unit in ROTARY)


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
