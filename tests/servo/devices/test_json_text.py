"""Values found in JSON text, against Python's own reader."""

import json

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
    skip_value,
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
