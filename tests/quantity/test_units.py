"""Values with units are exact, and a wrong one is refused in one clear message."""

from __future__ import annotations

from decimal import Decimal
from fractions import Fraction

import mpmath
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from strategies import decimals, texts, toml_values

from zwidth.errors import InputError
from zwidth.quantity.exact import Exact, Interval
from zwidth.quantity.glossary import GLOSSARY
from zwidth.quantity.units import parse, parse_number, spelled, unit_of

EXACT = {
    ("Hz", "1000"): ["1 kHz"],
    ("m", "224/10000000"): ["22.4 um", "22.4 µm", "22.4 μm", "22.4um"],
    ("N*s/m", "3/20"): ["0.15 N*s/m", "0.15 N·s/m", "0.15 N s/m", "0.15 kg/s", "0.15 Ns/m"],
    ("N*s/m", "0.15"): [Decimal("0.15"), 0.15],
    ("Hz", "1"): ["60 1/min", "60/min", "1 s^-1"],
    ("s", "3/10000"): ["0.3 ms"],
    ("s", "1/3000"): ["1/3000 s", "1/3000"],
    ("N/m", "5000"): ["5 N/mm"],
    ("N", "0.980665"): ["100 gf", "0.1 kgf", "0.1 kp"],
    ("N*m", "1/100"): ["10 mN*m"],
    ("N*m/rad", "9/5"): ["1.8 N*m/rad", "1.8 N*m"],
    ("N*m*s/rad", "2"): ["2 N*m*s", "2 N*m*s/rad"],
    ("kg", "1/2"): ["500 g"],
    ("kg*m^2", "3/1000000"): ["30 g*cm^2", "30 g cm²", "30 g*cm**2", "30 gcm²", "30 gcm2"],
    ("H", "11/20000"): ["0.55 mH"],
    ("V", "12"): ["12 V"],
    ("A", "33/10"): ["3.3 A"],
    ("rad", "1/200"): ["5 mrad"],
    ("N*m", "20"): ["20 Nm"],
    ("N*m/rad", "20"): ["20 Nm/rad"],
    ("N*m", "1/50"): ["20 mNm", "20 Nmm"],
    ("N*m", "1/50000"): ["20 µNm"],
    ("N*m", "1/5"): ["20 Ncm"],
    ("N*m*s/rad", "1/20"): ["0.05 Nms/rad", "0.05 Nms", "50 mNms/rad"],
    ("N*m/A", "9/10"): ["0.9 Nm/A"],
    ("V*s/rad", "9/10"): ["0.9 Vs/rad"],
    ("rad/N/m", "2"): ["2 rad/Nm"],
    ("kg*m^2", "3/500"): ["0.006 kgm²", "0.006 kg m2", "0.006 kg*m2", "0.006 kgm2"],
    ("m", "1/50000000"): ["20 nm"],
    ("s", "2"): ["2 seconds"],
    ("deg", "180"): ["180 degrees", "180 deg"],
    ("N", "-3"): ["−3 N"],
    ("s", "1/1000"): ["1e-3"],
    ("m", "7"): [7],
}

WRONG = {
    ("N/m", 'is in N/m; got "5 kHz", a frequency (1/s)'): ["5 kHz"],
    ("Hz", "an angular speed (rad/s)"): ["60 rad/s"],
    ("N*m", "a rotary stiffness"): ["5 N*m/rad"],
    ("rad", "a torque or an energy"): ["1 N*m"],
    ("rad", "a length (m)"): ["1 m"],
    ("m", "a plain number"): ["5 mm/m"],
    ("Hz", 'did you mean "kHz"'): ["1 khz"],
    ("m", '"foo" is not a known unit'): ["5 foo"],
    ("m", "empty"): ["", "   ", ".."],
    ("m", "expected a number"): ["m", "9" * 200, "\x00\n\x1b[31m"],
    ("m", "finite"): ["nan", "-inf m", float("nan"), Decimal("sNaN")],
    ("m", 'write "0.15", with a point'): ["0,15"],
    ("N/m", 'write "300.5", with a point'): ["300,5"],
    ("N/m", 'write "-7.25 N/m", with a point'): ["-7,25 N/m"],
    ("N/m", 'write "1000000", without a comma'): ["1,000,000"],
    ("N/m", 'write "65536 N/m", without a comma'): ["65,536 N/m"],
    ("N/m", 'write "1000.5", without a comma'): ["1,000.5"],
    ("kg*m^2", 'write "0.006 kg*m^2", with a point'): ["0,006 kg*m^2"],
    ("N/m", 'write "0.15 N/m", with a point'): ["1,2,3"],
    ("N*m", "a newton metre is Nm"): ["20 nm"],
    ("N*m", 'did you mean "Nm"'): ["20 NM"],
    ("N*m*s/rad", "a torque or an energy"): ["20 Nm"],
    ("m", "in m^2"): ["1 m2"],
    ("m", "not a product of units"): ["1 m22", "1 m^", "1 m/", "1 m^22"],
    ("kg*m^2", "not a product of units such as kg*m^2"): ["1 %"],
    ("m", "not a known unit"): ["3 counts"],
    ("1", "not a known unit"): ["3 counts"],
    ("m", "magnitudes"): ["1e999 m", "1e40 km"],
    ("m", "m"): ["1e99999999999999999999"],
    ("m", "the number 2"): ["1 2 m"],
    ("m", "the number 0"): ["1 m/0"],
    ("m", "digits"): [10**1000, 10**5000, -(10**5000), Decimal("0." + "1" * 500)],
    ("m", "true or false"): [True],
    ("m", "nothing"): [None],
    ("m", "a table"): [{"a": 1}],
    ("m", "two ends"): [[1, 2, 3]],
    ("m", "a list"): [[[1, 2], 3]],
    ("m", "swap"): [[2, 1], "2..1"],
    ("m", "two numbers"): ["1...2", "1..2..3"],
    ("m", "after the second"): ["1 mm .. 2"],
}


def attempt(value: object, unit: str) -> tuple[Exact | Interval | None, str]:
    """What `parse` returns, or the message of its InputError."""
    try:
        return parse(value, unit, "x"), ""
    except InputError as error:
        return None, str(error)


@pytest.mark.parametrize(("unit", "expected"), EXACT)
def test_values_are_exact(unit, expected):
    for value in EXACT[unit, expected]:
        parsed = parse(value, unit, "value")
        assert isinstance(parsed, Exact)
        assert parsed.fraction == Fraction(expected), value


@pytest.mark.parametrize(
    ("text", "unit", "expected"),
    [
        ("3 deg", "rad", lambda: mpmath.pi / 60),
        ("3°", "rad", lambda: mpmath.pi / 60),
        ("3 degrees", "rad", lambda: mpmath.pi / 60),
        ("0.25 turn", "rad", lambda: mpmath.pi / 2),
        ("2 rev", "rad", lambda: 4 * mpmath.pi),
        ("7 N*m/deg", "N*m/rad", lambda: 1260 / mpmath.pi),
    ],
)
def test_degrees_and_turns_are_rounded_once(text, unit, expected):
    """π enters through 40 digits, so the result is the nearest double."""
    with mpmath.workdps(60):
        nearest = float(expected())
    assert float(parse_number(text, unit, "angle")) == nearest


@pytest.mark.parametrize(
    "text", ["500", "500 counts", "500 count", "500 steps", "500 counts/turn", "500 cpr", "500 /rev"]
)
def test_counts_may_be_called_counts(text):
    assert parse_number(text, "1", "counts_per_turn").fraction == 500


@pytest.mark.parametrize(
    ("value", "low", "high"),
    [
        ("0.1..0.2", "0.1", "0.2"),
        ("0.1 .. 0.2 N", "0.1", "0.2"),
        ("100 … 200 mN", "0.1", "0.2"),
        ("100 mN .. 0.2 N", "0.1", "0.2"),
        (["100 mN", 0.2], "0.1", "0.2"),
        ((Decimal("0.1"), Decimal("0.2")), "0.1", "0.2"),
        (Interval(0.1, 0.2), "0.1", "0.2"),
        ("0.1..0.1", "0.1", "0.1"),
    ],
)
def test_intervals(value, low, high):
    assert parse(value, "N", "friction") == Interval(low, high)


@pytest.mark.parametrize(("unit", "part"), WRONG)
def test_wrong_values_are_refused(unit, part):
    """One line that names the quantity and says what is wrong."""
    for value in WRONG[unit, part]:
        with pytest.raises(InputError) as caught:
            parse(value, unit, "stiffness")
        message = str(caught.value)
        assert part in message
        assert message.startswith("stiffness")
        assert len(message) < 300
        assert message.isprintable()


@pytest.mark.parametrize("quantity", GLOSSARY.values(), ids=GLOSSARY.keys())
def test_every_unit_of_the_glossary_is_understood(quantity):
    """Otherwise its own unit could not be typed."""
    for unit in (quantity.unit, quantity.rotary_unit):
        assert parse_number(f"2 {unit}", unit, quantity.name).fraction == 2


@given(decimals("-1000", "1000"), st.sampled_from(["um", "mm", "cm", "m", "km"]))
def test_a_prefix_is_a_power_of_ten(number, unit):
    power = {"um": -6, "mm": -3, "cm": -2, "m": 0, "km": 3}[unit]
    assert parse_number(f"{number:f} {unit}", "m", "x").fraction == Fraction(number) * Fraction(10) ** power


@settings(max_examples=100)
@given(texts(), st.sampled_from(["m", "N*s/m", "N*m*s/rad", "1", "Hz"]))
@example("1 .. 2 ..", "m")
@example("1 " + "m*" * 40, "m")
def test_any_text_gives_a_value_or_an_input_error(text, unit):
    value, message = attempt(text, unit)
    assert isinstance(value, (Exact, Interval)) if not message else message.isprintable()


@settings(max_examples=80)
@given(toml_values())
def test_any_toml_value_gives_a_value_or_an_input_error(value):
    assert len(attempt(value, "m")[1]) < 400


@settings(max_examples=80)
@given(st.text(alphabet="kmNsHzgrad*/^-+123µ ", max_size=12))
def test_units_never_break(text):
    try:
        unit = unit_of(text)
    except InputError:
        return
    assert unit.scale > 0


def test_rpm_is_a_speed():
    """A turn in a minute, π/30 rad/s; not a frequency."""
    assert float(parse_number("60 rpm", "rad/s", "speed")) == float(2 * mpmath.pi)
    assert float(parse_number("90 rpm", "rad/s", "speed")) == float(
        parse_number("1.5 rev/s", "rad/s", "speed")
    )
    with pytest.raises(InputError, match="angular speed"):
        parse_number("60 rpm", "Hz", "rate")


@pytest.mark.parametrize(
    ("written", "meant"),
    [("msec", "ms"), (" µm ", "um"), ("°", "deg"), ("Nm", "N*m"), ("mN·m", "mN*m"), ("N mm", "N*mm")],
)
def test_a_spelling_is_the_unit_that_is_meant(written, meant):
    assert unit_of(spelled(written)) == unit_of(meant)
    assert spelled("parsec") == "parsec", "for whoever reads it to refuse"
