"""Values found in JSON text, and decimal numbers read and written, against Python's own."""

import json
from decimal import ROUND_HALF_UP, Decimal

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from zwidth.machine.servo.devices.json_text import (
    ABSENT,
    first_element,
    is_string,
    member,
    next_element,
    read_decimal,
    skip_value,
    write_decimal,
)

NAMES = st.text(st.characters(codec="utf-8", exclude_characters='"\\', min_codepoint=32), max_size=6)
VALUES = st.recursive(
    st.none()
    | st.booleans()
    | st.integers()
    | st.floats(allow_nan=False, allow_infinity=False)
    | st.text(max_size=8),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(NAMES, inner, max_size=4),
    max_leaves=12,
)
LAYOUTS = st.sampled_from([{}, {"indent": 2}, {"separators": (",", ":")}])


def array(text):
    return np.frombuffer(text.encode() if isinstance(text, str) else text, np.uint8)


def value_at(data, at):
    return json.loads(bytes(data[at : skip_value(data, at, len(data))]))


@given(st.dictionaries(NAMES, VALUES, max_size=6), LAYOUTS)
def test_each_member_is_found_and_no_other(document, layout):
    data = array(json.dumps(document, ensure_ascii=False, **layout))
    for name, value in document.items():
        assert value_at(data, member(data, 0, len(data), array(name))) == value
    if "absent one" not in document:
        assert member(data, 0, len(data), array("absent one")) == ABSENT


@given(st.lists(VALUES, max_size=6), LAYOUTS)
def test_each_element_is_found_in_its_order(values, layout):
    data = array(json.dumps(values, **layout))
    found, at = [], first_element(data, 0, len(data))
    while at >= 0:
        found.append(value_at(data, at))
        at = next_element(data, at, len(data))
    assert at == ABSENT
    assert found == values


@given(st.dictionaries(NAMES, VALUES, min_size=1, max_size=4), st.data())
def test_text_that_is_cut_is_not_read_over_its_end(document, data):
    """A member behind the cut is not found, and nothing beyond it is looked at."""
    text = json.dumps(document, ensure_ascii=False).encode()
    cut = data.draw(st.integers(0, len(text) - 1))
    inbox = array(text)
    assert skip_value(inbox, 0, cut) == -1
    assert member(inbox, 0, cut, array("absent one")) == -1


@pytest.mark.parametrize(
    "text", ["", "[]", '"a"', "{a:1}", '{"a" 1}', '{"a":1 "b":2}', '{"a":1', '{"a', '{"a":}']
)
def test_what_is_no_object_has_no_member(text):
    """−1, which is not ABSENT."""
    data = array(text)
    assert member(data, 0, len(data), array("b")) == -1


def test_a_name_within_another_is_not_that_name():
    """The service's state has both."""
    data = array('{"current_cursor_position": 1, "cursor_position": 2, "cursor_position_old": 3}')
    assert value_at(data, member(data, 0, len(data), array("cursor_position"))) == 2


def test_a_string_is_compared_to_its_end():
    data = array('"049D"')
    assert is_string(data, 0, len(data), array("049D"))
    assert not is_string(data, 0, len(data), array("049"))
    assert not is_string(data, 0, len(data), array("049DD"))
    assert not is_string(data, 0, len(data), array("049E"))


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


def test_rounding_is_half_away_from_zero():
    for quarters in range(-50, 51):
        exact = Decimal(quarters) / 4
        assert Decimal(written(quarters / 4, 1)) == exact.quantize(Decimal("0.1"), ROUND_HALF_UP)
