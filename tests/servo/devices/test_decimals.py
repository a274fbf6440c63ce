"""Decimal numbers in bytes: read as Python reads them, written so that Python reads them back."""

from decimal import ROUND_HALF_UP, Decimal

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from zwidth.machine.servo.devices.json_text import read_decimal, write_decimal


def read(text, start=0):
    data = np.frombuffer(text.encode(), np.uint8)
    return read_decimal(data, start, len(data))


def written(value, decimals):
    into = np.full(40, ord("#"), np.uint8)
    end = write_decimal(value, decimals, into, 3)
    assert bytes(into[:3]) == b"###"
    assert bytes(into[end:]) == b"#" * (40 - end)
    assert end - 3 <= 12 + decimals
    return bytes(into[3:end]).decode()


@given(st.integers(-(10**15) + 1, 10**15 - 1), st.integers(-15, 0), st.sampled_from(["", "e3", "E-4", "e+2"]))
def test_fifteen_digits_are_read_to_the_nearest_float(digits, point, exponent):
    text = f"{Decimal(digits).scaleb(point):f}{exponent}"
    assert read(text + ",") == (float(text), len(text))


@given(st.floats(allow_nan=False, allow_infinity=False, min_value=-1e200, max_value=1e200))
def test_any_float_is_read_within_its_last_places(value):
    found, end = read(repr(value) + " ")
    assert end == len(repr(value))
    assert found == pytest.approx(value, rel=3 * np.finfo(float).eps, abs=1e-300)


@pytest.mark.parametrize(
    "text", ["", "-", ".", "x1", "1.", "1.,", "1e", "1e,", "-,", "12", "1.5", "1e5", "+1,"]
)
def test_what_is_no_number_or_not_finished_is_not_read(text):
    """A number that the text ends with may go on in what has not come yet."""
    assert read(text)[1] == -1


@given(st.floats(-1e6, 1e6), st.integers(1, 9))
def test_what_is_written_is_the_value_rounded(value, decimals):
    """Half a unit of the last decimal away at most, apart from the one rounding of the product."""
    text = written(value, decimals)
    whole, _, fraction = text.partition(".")
    assert len(fraction) == decimals
    assert whole.lstrip("-") == str(int(whole.lstrip("-")))
    half = Decimal("0.5").scaleb(-decimals)
    assert abs(Decimal(text) - Decimal(value)) <= half + abs(Decimal(value)) * Decimal(2) ** -52


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.0, "0.000"),
        (-0.0, "0.000"),
        (-0.0004, "0.000"),
        (-0.0006, "-0.001"),
        (0.9996, "1.000"),
        (999.9996, "1000.000"),
        (float("nan"), "0.000"),
        (float("inf"), "0.000"),
        (1e30, "1000000000.000"),
        (-1e30, "-1000000000.000"),
    ],
)
def test_edges_of_writing(value, text):
    """Neither −0 nor a number that C would not read; what is no number is 0."""
    assert written(value, 3) == text


def test_eight_digits_of_a_float32_come_back():
    """What firmware prints of its float32 with nine digits is the same float32 again."""
    for value in np.random.default_rng(3).normal(0.0, 0.2, 300).astype(np.float32):
        found, _ = read(f"{value:.9g} ")
        assert np.float32(found) == value


def test_rounding_is_half_away_from_zero():
    for quarters in range(-50, 51):
        exact = Decimal(quarters) / 4
        assert Decimal(written(quarters / 4, 1)) == exact.quantize(Decimal("0.1"), ROUND_HALF_UP)
