"""The loop in an address: what is written is read again, and nothing that is written there is a traceback."""

from __future__ import annotations

from fractions import Fraction
from urllib.parse import parse_qsl

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import zwidth as zw
from zwidth import rendering
from zwidth.errors import InputError
from zwidth.explorer import starts
from zwidth.explorer.state import LARGEST_FILE, LONGEST_QUERY, State, from_file, from_query
from zwidth.specification.environments import TYPES

THIRD = zw.Exact(Fraction(1, 3))


def read_again(state: State) -> State:
    return from_query(parse_qsl(state.query(), keep_blank_values=True))


@pytest.mark.parametrize("kind", TYPES)
@pytest.mark.parametrize("own", [starts.OWN_LINEAR, starts.OWN_ROTARY])
def test_every_environment_comes_back_from_the_address(kind: str, own: str) -> None:
    """Of a linear and of a rotary device, the same device and the same environment, to the last digit."""
    state = starts.with_environment(starts.with_device(starts.first(), starts.own_device(own)), kind)
    again = read_again(state)
    assert again == state
    assert again.loop() == state.loop()


def test_laws_intervals_and_extras_come_back() -> None:
    """A chain of laws with numbers that are no decimals, an interval, a hand and a coupling."""
    device = zw.Device(damping=("0.1", "0.2"), rate="1 kHz", name="a & b = “c”, <d>")
    law = zw.render(zw.Wall(THIRD), rendering.PassivityController(largest_damping=THIRD))
    state = State.of(device, law).with_extra("operator", {"type": "dowel", "force": "3 N"})
    state = state.with_extra("coupling", {"stiffness": "100 N/m", "link_delay": "2 ms"})
    again = read_again(state)
    assert again == state
    assert again.loop() == state.loop()
    assert again.loop().device.name == device.name


def test_the_address_has_units() -> None:
    """Each quantity is a text with its unit, so that who reads it need not guess."""
    pairs = dict(parse_qsl(starts.first().query()))
    assert pairs["environment.stiffness"] == "200 N/m"
    assert pairs["device.sample_period"] == "0.001 s"


@pytest.mark.parametrize(
    ("pairs", "says"),
    [
        ([("stiffness", "300")], "is no parameter"),
        ([("device.damping", "1"), ("device.damping", "2")], "twice"),
        ([("device.damping", "0.1"), ("device.rate", "1 kHz")], "no environment"),
        ([("environment.type", "wall"), ("environment.stiffness", "3")], "no device"),
        ([("device.catalogue", "../../etc/passwd")], "no environment"),
        ([("device.catalogue", "/etc/passwd"), ("environment.type", "wall")], "the catalogue has no device"),
        ([("law.2.type", "damper")], "without a gap"),
        ([("device.name", "x" * LONGEST_QUERY)], "longer than"),
        ([("device.damping", "[1, 2")], "no list"),
    ],
)  # fmt: skip
def test_what_cannot_be_used_is_said(pairs: list[tuple[str, str]], says: str) -> None:
    """One message, which says what was given; a name is never a path."""
    with pytest.raises(InputError, match=says):
        from_query(pairs)


HEADS = st.sampled_from(["device", "environment", "law.1", "law.99", "operator", "coupling", "x", "", "law."])
NAMES = st.sampled_from(
    ["damping", "rate", "type", "stiffness", "environment", "elements", "catalogue", "", "a.b"]
)
VALUES = st.one_of(
    st.text(max_size=30),
    st.sampled_from(
        ["0.1", "1 kHz", "wall", "scene", "nan", "1e999", "[", "{ type = 3 }", "[[1,2]]", "true", "inf N/m"]
    ),
)


@settings(max_examples=150, deadline=None)
@given(st.lists(st.tuples(st.builds(lambda h, n: f"{h}.{n}", HEADS, NAMES), VALUES), max_size=6))
def test_whatever_the_address_says_it_is_a_loop_or_a_message(pairs: list[tuple[str, str]]) -> None:
    """Never another exception."""
    try:
        state = from_query(pairs)
    except InputError:
        return
    assert read_again(state) == state


@settings(max_examples=80, deadline=None)
@given(st.text(max_size=200))
def test_whatever_a_file_says_it_is_a_loop_or_a_message(text: str) -> None:
    """The same of a file."""
    try:
        from_file(text, "file.toml")
    except InputError:
        return


def test_a_file_is_a_loop_or_a_device_and_not_too_large() -> None:
    """With an environment it is the loop, without it the device alone, named after the file."""
    device = '[device]\ndamping = 0.1\nrate = "1 kHz"\n'
    state, alone = from_file(device, "mine.toml")
    assert state is None
    assert alone.name == "mine"
    state, _ = from_file(f'{device}[environment]\ntype = "wall"\nstiffness = 300\n', "mine.toml")
    assert state is not None
    assert state.loop().environment == zw.Wall(300)
    with pytest.raises(InputError, match="64 kB"):
        from_file("#" * (LARGEST_FILE + 1), "mine.toml")


def test_what_a_specification_cannot_say_is_refused() -> None:
    """An environment of one's own has no words in an address."""

    class Own(zw.Wall):
        pass

    with pytest.raises(InputError, match="no Own"):
        State.of(starts.own_device(starts.OWN_LINEAR), Own(300))


def test_another_device_keeps_the_wall_and_another_kind_of_motion_gets_its_own() -> None:
    """A stiffness in N/m is none in N·m/rad."""
    state = starts.first().changed("environment.stiffness", "345 N/m").settled()
    linear = starts.with_device(state, starts.own_device(starts.OWN_LINEAR))
    assert linear.loop().environment == zw.Wall(345)
    rotary = starts.with_device(state, starts.own_device(starts.OWN_ROTARY))
    assert rotary.loop().device.motion == "rotary"
    assert rotary.loop().environment != zw.Wall(345)
