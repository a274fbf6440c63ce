"""The loop in an address: what is written is read again, and nothing that is written there is a traceback."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path
from urllib.parse import parse_qsl

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import zwidth as zw
from zwidth.errors import InputError
from zwidth.model import rendering
from zwidth.show.explorer import starts
from zwidth.show.explorer.controls import read_entry
from zwidth.show.explorer.form import controls_of
from zwidth.show.explorer.state import LARGEST_FILE, LONGEST_QUERY, State, from_file, from_query

THIRD = zw.Exact(Fraction(1, 3))


def read_again(state: State) -> State:
    return from_query(parse_qsl(state.query(), keep_blank_values=True))


def test_laws_intervals_and_extras_come_back() -> None:
    device = zw.Device(damping=("0.1", "0.2"), rate="1 kHz", name="a & b = “c”, <d>")
    law = zw.render(zw.Wall(THIRD), rendering.PassivityController(largest_damping=THIRD))
    state = State.of(device, law).with_extra("operator", {"type": "dowel", "force": "3 N"})
    state = state.with_extra("coupling", {"stiffness": "100 N/m", "link_delay": "2 ms"})
    again = read_again(state)
    assert again == state
    assert again.loop() == state.loop()
    assert again.loop().device.name == device.name


def test_the_address_has_units() -> None:
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


@settings(max_examples=60, deadline=None)
@given(st.lists(st.tuples(st.builds(lambda h, n: f"{h}.{n}", HEADS, NAMES), VALUES), max_size=6))
def test_whatever_the_address_says_it_is_a_loop_or_a_message(pairs: list[tuple[str, str]]) -> None:
    try:
        state = from_query(pairs)
    except InputError:
        return
    assert read_again(state) == state


@settings(max_examples=80, deadline=None)
@given(st.text(max_size=200))
def test_whatever_a_file_says_it_is_a_loop_or_a_message(text: str) -> None:
    try:
        from_file(text, "file.toml", starts.first())
    except InputError:
        return


def test_a_file_is_a_loop_or_a_device_and_not_too_large() -> None:
    device = '[device]\ndamping = 0.1\nrate = "1 kHz"\n'
    shown = starts.first()
    state, alone, begun = from_file(device, "mine.toml", shown)
    assert not begun
    assert state is None
    assert alone.name == "mine"
    state = from_file(f'{device}[environment]\ntype = "wall"\nstiffness = 300\n', "mine.toml", shown).state
    assert state.loop().environment == zw.Wall(300)
    with pytest.raises(InputError, match="64 kB"):
        from_file("#" * (LARGEST_FILE + 1), "mine.toml", shown)


def test_an_environment_alone_is_put_on_the_device_that_is_shown() -> None:
    """Whose marks stay; one of another kind of motion is refused, and so is a file with neither."""
    own = from_file('[device]\nmotion = "rotary"\ndamping = "0.02 N*m*s/rad"\n', "wheel.toml", starts.first())
    wheel = starts.with_device(starts.first(), own.device, own.begun)
    text = '[environment]\ntype = "wall"\nstiffness = "12 N*m/rad"\n[[law]]\ntype = "passivity-controller"\n'
    state = from_file(text, "stop.toml", wheel).state
    assert state.device == wheel.device
    assert state.begun == wheel.begun == {"rate": "1 kHz"}
    assert [law["type"] for law in state.laws] == ["passivity-controller"]
    assert "wall, 12 N·m/rad" in state.loop().environment.describe("rotary")
    with pytest.raises(InputError, match="stiffness"):
        from_file(text, "stop.toml", starts.first())
    with pytest.raises(InputError, match="none of the tables"):
        from_file("", "stop.toml", wheel)


def test_what_a_specification_cannot_say_is_refused() -> None:
    class Own(zw.Wall):
        pass

    with pytest.raises(InputError, match="no Own"):
        State.of(starts.own_device(starts.OWN_LINEAR), Own(300))


def test_another_device_keeps_the_wall_and_another_kind_of_motion_gets_its_own() -> None:
    state = starts.first().changed("environment.stiffness", "345 N/m").settled()
    linear = starts.with_device(state, starts.own_device(starts.OWN_LINEAR))
    assert linear.loop().environment == zw.Wall(345)
    rotary = starts.with_device(state, starts.own_device(starts.OWN_ROTARY))
    assert rotary.loop().device.motion == "rotary"
    assert rotary.loop().environment != zw.Wall(345)


def test_what_a_file_does_not_give_is_begun_with_and_marked_until_it_is_set() -> None:
    """A wheel without damping and rate begins with both; a mark is in the address, and goes with a value."""
    given = from_file('[device]\nmotion = "rotary"\ninertia = "0.006 kg*m^2"\n', "wheel.toml", starts.first())
    assert given.begun == {"damping": "0.001 N*m*s/rad", "rate": "1 kHz"}
    state = starts.with_device(starts.first(), given.device, given.begun)
    assert read_again(state).begun == given.begun
    assert state.changed("device.rate", "2 kHz").settled().begun == {"damping": "0.001 N*m*s/rad"}
    assert not starts.with_device(state, starts.own_device(starts.OWN_ROTARY)).begun


def test_sources_without_a_damping_are_marked_unless_it_is_typed(tmp_path: Path) -> None:
    mine = tmp_path / "mine.toml"
    mine.write_text('[device]\nmass = "0.1 kg"\nrate = "1 kHz"\n', encoding="utf-8")
    assert starts.from_sources([str(mine)]).begun == {"damping": "0.1 N*s/m"}
    assert not starts.from_sources([str(mine)], {"damping": "0.3"}).begun
    assert "damping" in starts.from_sources(["omega.3"]).begun


def test_a_filter_of_the_velocity_is_a_word_and_its_numbers() -> None:
    state = starts.first().changed("environment.damping", "1 N*s/m").settled()
    for name, keys in (
        ("window", {"samples"}),
        ("one-pole", {"time_constant"}),
        ("filter", {"numerator", "denominator"}),
    ):
        shown = {one.path: one for one in controls_of(state, state.loop())}
        chosen = read_entry(shown["environment.velocity_filter"], name)
        state = state.changed("environment.velocity_filter", chosen).settled()
        shown = {one.path: one for one in controls_of(state, state.loop())}
        assert {f"environment.velocity_filter.{key}" for key in keys} <= shown.keys()
    assert shown["environment.velocity_filter"].text == "filter"


def test_a_question_in_degrees_is_kept_in_the_address() -> None:
    """With the loop, which is in SI; who types radians again reads radians."""
    knob = {"device.damping": "0.02 N*m*s/rad", "device.rate": "1 kHz", "device.motion": "rotary"}
    asked = from_query(
        [*knob.items(), ("environment.type", "wall"), ("environment.stiffness", "0.5 N*m/deg")]
    )
    assert asked.angles == ("deg",)
    pairs = dict(parse_qsl(asked.query()))
    assert pairs["answers.angle"] == "deg"
    assert pairs["environment.stiffness"].endswith("rad")
    assert from_query([*pairs.items()]).angles == ("deg",)
    assert asked.with_angles({"rad"}).angles == ()
    assert asked.with_angles(set()).angles == ("deg",)
    with pytest.raises(zw.InputError, match="told in rad, deg or turn"):
        from_query([*{**pairs, "answers.angle": "gon"}.items()])
