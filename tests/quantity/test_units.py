"""Values with units are exact, and a wrong one is refused in one clear message."""

from __future__ import annotations

from collections.abc import Callable
from decimal import Decimal
from fractions import Fraction
from typing import Any

import mpmath
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from strategies import decimals, texts, toml_values

from zwidth.errors import InputError
from zwidth.quantity.exact import Exact, Interval
from zwidth.quantity.glossary import GLOSSARY
from zwidth.quantity.units import parse, parse_number, spelled, unit_of

EXACT = [
    ("1 kHz", "Hz", "1000"),
    ("22.4 um", "m", "224/10000000"),
    ("22.4 µm", "m", "224/10000000"),  # micro sign
    ("22.4 μm", "m", "224/10000000"),  # Greek mu
    ("22.4um", "m", "224/10000000"),
    ("0.15 N*s/m", "N*s/m", "3/20"),
    ("0.15 N·s/m", "N*s/m", "3/20"),
    ("0.15 N s/m", "N*s/m", "3/20"),
    ("0.15 kg/s", "N*s/m", "3/20"),
    ("60 1/min", "Hz", "1"),
    ("60/min", "Hz", "1"),
    ("1 s^-1", "Hz", "1"),
    ("0.3 ms", "s", "3/10000"),
    ("1/3000 s", "s", "1/3000"),
    ("1/3000", "s", "1/3000"),
    ("5 N/mm", "N/m", "5000"),
    ("10 mN*m", "N*m", "1/100"),
    ("1.8 N*m/rad", "N*m/rad", "9/5"),
    ("1.8 N*m", "N*m/rad", "9/5"),
    ("2 N*m*s", "N*m*s/rad", "2"),
    ("2 N*m*s/rad", "N*m*s/rad", "2"),
    ("500 g", "kg", "1/2"),
    ("30 g*cm^2", "kg*m^2", "3/1000000"),
    ("30 g cm²", "kg*m^2", "3/1000000"),
    ("30 g*cm**2", "kg*m^2", "3/1000000"),
    ("0.55 mH", "H", "11/20000"),
    ("12 V", "V", "12"),
    ("3.3 A", "A", "33/10"),
    ("5 mrad", "rad", "1/200"),
    ("20 Nm", "N*m", "20"),
    ("20 Nm/rad", "N*m/rad", "20"),
    ("20 mNm", "N*m", "1/50"),
    ("20 µNm", "N*m", "1/50000"),
    ("20 Ncm", "N*m", "1/5"),
    ("20 Nmm", "N*m", "1/50"),
    ("0.05 Nms/rad", "N*m*s/rad", "1/20"),
    ("0.05 Nms", "N*m*s/rad", "1/20"),
    ("50 mNms/rad", "N*m*s/rad", "1/20"),
    ("0.9 Nm/A", "N*m/A", "9/10"),
    ("0.9 Vs/rad", "V*s/rad", "9/10"),
    ("2 rad/Nm", "rad/N/m", "2"),
    ("0.15 Ns/m", "N*s/m", "3/20"),
    ("0.006 kgm²", "kg*m^2", "3/500"),
    ("0.006 kg m2", "kg*m^2", "3/500"),
    ("0.006 kg*m2", "kg*m^2", "3/500"),
    ("0.006 kgm2", "kg*m^2", "3/500"),
    ("30 gcm²", "kg*m^2", "3/1000000"),
    ("30 gcm2", "kg*m^2", "3/1000000"),
    ("20 nm", "m", "1/50000000"),
    ("2 seconds", "s", "2"),
    ("180 degrees", "deg", "180"),
    ("−3 N", "N", "-3"),
    ("1e-3", "s", "1/1000"),
    (Decimal("0.15"), "N*s/m", "3/20"),
    (0.15, "N*s/m", "3/20"),
    (7, "m", "7"),
    ("180 deg", "deg", "180"),
]

WRONG = [
    ("5 kHz", "N/m", 'is in N/m; got "5 kHz", a frequency (1/s)'),
    ("60 rad/s", "Hz", "an angular speed (rad/s)"),
    ("5 N*m/rad", "N*m", "a rotary stiffness"),
    ("1 N*m", "rad", "a torque or an energy"),
    ("1 m", "rad", "a length (m)"),
    ("5 mm/m", "m", "a plain number"),
    ("1 khz", "Hz", 'did you mean "kHz"'),
    ("5 foo", "m", '"foo" is not a known unit'),
    ("", "m", "empty"),
    ("   ", "m", "empty"),
    ("m", "m", "expected a number"),
    ("nan", "m", "finite"),
    ("-inf m", "m", "finite"),
    (float("nan"), "m", "finite"),
    (Decimal("sNaN"), "m", "finite"),
    ("0,15", "m", 'write "0.15", with a point'),
    ("300,5", "N/m", 'write "300.5", with a point'),
    ("-7,25 N/m", "N/m", 'write "-7.25 N/m", with a point'),
    ("1,000,000", "N/m", 'write "1000000", without a comma'),
    ("65,536 N/m", "N/m", 'write "65536 N/m", without a comma'),
    ("1,000.5", "N/m", 'write "1000.5", without a comma'),
    ("0,006 kg*m^2", "kg*m^2", 'write "0.006 kg*m^2", with a point'),
    ("1,2,3", "N/m", 'write "0.15 N/m", with a point'),
    ("20 nm", "N*m", "a newton metre is Nm"),
    ("20 NM", "N*m", 'did you mean "Nm"'),
    ("20 Nm", "N*m*s/rad", "a torque or an energy"),
    ("1 m2", "m", "in m^2"),
    ("1 m22", "m", "not a product of units"),
    ("1 %", "kg*m^2", "not a product of units such as kg*m^2"),
    ("3 counts", "m", "not a known unit"),
    ("3 counts", "1", "not a known unit"),
    ("1e999 m", "m", "magnitudes"),
    ("1e40 km", "m", "magnitudes"),
    ("1e99999999999999999999", "m", "m"),
    ("1 2 m", "m", "the number 2"),
    ("1 m/0", "m", "the number 0"),
    ("1 m^", "m", "not a product of units"),
    ("1 m/", "m", "not a product of units"),
    ("1 m^22", "m", "not a product of units"),
    ("9" * 200, "m", "expected a number"),
    (10**1000, "m", "digits"),
    *(pytest.param(number, "m", "digits", id="unprintable") for number in (10**5000, -(10**5000))),
    (Decimal("0." + "1" * 500), "m", "digits"),
    (True, "m", "true or false"),
    (None, "m", "nothing"),
    ({"a": 1}, "m", "a table"),
    ([1, 2, 3], "m", "two ends"),
    ([[1, 2], 3], "m", "a list"),
    ([2, 1], "m", "swap"),
    ("2..1", "m", "swap"),
    ("1...2", "m", "two numbers"),
    ("1..2..3", "m", "two numbers"),
    ("1 mm .. 2", "m", "after the second"),
    ("..", "m", "empty"),
    ("\x00\n\x1b[31m", "m", "expected a number"),
]


def attempt(value: object, unit: str) -> tuple[Exact | Interval | None, str]:
    """What `parse` returns, or the message of its InputError."""
    try:
        return parse(value, unit, "x"), ""
    except InputError as error:
        return None, str(error)


@pytest.mark.parametrize(("given_value", "unit", "expected"), EXACT)
def test_values_are_exact(given_value: object, unit: str, expected: str) -> None:
    parsed = parse(given_value, unit, "value")
    assert isinstance(parsed, Exact)
    assert parsed.fraction == Fraction(expected)


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
def test_degrees_and_turns_are_rounded_once(text: str, unit: str, expected: Callable[[], Any]) -> None:
    """π enters through 40 digits, so the result is the nearest double."""
    with mpmath.workdps(60):
        nearest = float(expected())
    assert float(parse_number(text, unit, "angle")) == nearest


@pytest.mark.parametrize(
    "text", ["500", "500 counts", "500 count", "500 steps", "500 counts/turn", "500 cpr", "500 /rev"]
)
def test_counts_may_be_called_counts(text: str) -> None:
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
def test_intervals(value: object, low: str, high: str) -> None:
    assert parse(value, "N", "friction") == Interval(low, high)


@pytest.mark.parametrize(("value", "unit", "part"), WRONG)
def test_wrong_values_are_refused(value: object, unit: str, part: str) -> None:
    with pytest.raises(InputError) as caught:
        parse(value, unit, "stiffness")
    message = str(caught.value)
    assert part in message
    assert message.startswith("stiffness")
    assert len(message) < 300
    assert message.isprintable()


@pytest.mark.parametrize("quantity", GLOSSARY.values(), ids=GLOSSARY.keys())
def test_every_unit_of_the_glossary_is_understood(quantity) -> None:
    """Otherwise its own unit could not be typed."""
    for unit in (quantity.unit, quantity.rotary_unit):
        assert parse_number(f"2 {unit}", unit, quantity.name).fraction == 2


@given(decimals("-1000", "1000"), st.sampled_from(["um", "mm", "cm", "m", "km"]))
def test_a_prefix_is_a_power_of_ten(number: Decimal, unit: str) -> None:
    power = {"um": -6, "mm": -3, "cm": -2, "m": 0, "km": 3}[unit]
    assert parse_number(f"{number:f} {unit}", "m", "x").fraction == Fraction(number) * Fraction(10) ** power


@settings(max_examples=100)
@given(texts(), st.sampled_from(["m", "N*s/m", "N*m*s/rad", "1", "Hz"]))
@example("1 .. 2 ..", "m")
@example("1 " + "m*" * 40, "m")
def test_any_text_gives_a_value_or_an_input_error(text: str, unit: str) -> None:
    value, message = attempt(text, unit)
    assert isinstance(value, (Exact, Interval)) if not message else message.isprintable()


@settings(max_examples=80)
@given(toml_values())
def test_any_toml_value_gives_a_value_or_an_input_error(value: object) -> None:
    assert len(attempt(value, "m")[1]) < 400


@settings(max_examples=80)
@given(st.text(alphabet="kmNsHzgrad*/^-+123µ ", max_size=12))
def test_units_never_break(text: str) -> None:
    try:
        unit = unit_of(text)
    except InputError:
        return
    assert unit.scale > 0


def test_rpm_is_a_speed() -> None:
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
