"""Sliders and entries: there is one for every number, and each says what the class reads."""

from __future__ import annotations

from fractions import Fraction
from urllib.parse import parse_qsl

import pytest
from hypothesis import given
from hypothesis import strategies as st

import zwidth as zw
from zwidth.errors import InputError
from zwidth.model.rendering import LAWS
from zwidth.model.specification.environments import TYPES
from zwidth.quantity.parameter import parameters_of
from zwidth.show.explorer import controls as of
from zwidth.show.explorer import starts
from zwidth.show.explorer.controls import Control, read_entry
from zwidth.show.explorer.state import State, catalogued, from_query, scale_of


def answers(state: State, control: Control) -> None:
    shares = [control.said(share) for share in (0.0, 1.0)] if control.scale is not None else []
    texts = [control.text] if control.text else []
    for value in [*shares, *(read_entry(control, text) for text in texts)]:
        try:
            state.changed(control.path, value).settled()
        except InputError:
            assert value not in texts, f"{control.path} refuses what it shows: {value}"


@pytest.mark.parametrize("name", zw.catalogue.names())
def test_a_catalogue_device_has_a_slider_for_every_number(name: str) -> None:
    device = catalogued(name)
    state = State.of(device, zw.Wall(200))
    controls = of.device_controls(state, device)
    assert len(controls) == len([p for p in parameters_of(zw.Device).values() if p.is_number])
    by_path = {control.path: control for control in controls}
    texts = {key: by_path[f"device.{key}"].text for key in ("damping", "rate")}
    shown = zw.Device(**texts, motion=device.motion)
    assert (shown.damping, shown.sample_period) == (device.damping, device.sample_period)
    for control in controls:
        answers(state, control)


@pytest.mark.parametrize("kind", TYPES)
@pytest.mark.parametrize("own", [starts.OWN_LINEAR, starts.OWN_ROTARY])
def test_every_environment_has_a_control_for_every_key(kind: str, own: str) -> None:
    """Those of the environment behind a coupling too; what is shown can be typed and sent."""
    state = starts.with_environment(starts.with_device(starts.first(), starts.own_device(own)), kind)
    loop = state.loop()
    controls = of.environment_controls(state, loop.environment, loop.device.motion)
    expected = {f"environment.{key}" for key, p in TYPES[kind].keys.items() if p.form != "environment"}
    assert expected <= {control.path for control in controls}
    again = from_query(parse_qsl(state.query(), keep_blank_values=True))
    assert again == state
    assert again.loop() == loop
    for control in controls:
        answers(state, control)


@pytest.mark.parametrize("name", LAWS)
def test_every_law_can_be_switched_on_and_off(name: str) -> None:
    before = starts.first().settled()
    state = starts.with_law(before, name, on=True)
    loop = state.loop()
    controls = of.law_controls(state, 1, loop.environment.laws[0], loop.device.motion)  # type: ignore[attr-defined]
    assert {control.path.rpartition(".")[2] for control in controls} == set(LAWS[name].keys)
    for control in controls:
        answers(state, control)
    assert starts.with_law(state, name, on=False) == before


def test_laws_keep_the_order_of_the_registry() -> None:
    state = starts.first()
    for name in ("saturation", "force-bounding", "extrapolation"):
        state = starts.with_law(state, name, on=True)
    assert [law["type"] for law in state.laws] == ["extrapolation", "force-bounding", "saturation"]


@given(st.floats(1e-9, 1e9), st.floats(0, 1))
def test_a_slider_comes_back_to_where_it_was(value: float, share: float) -> None:
    """To three digits; its middle is the number that it began with."""
    scale = scale_of(value, "N/m", has_zero=True)
    assert scale.share(value) == pytest.approx(0.5)
    assert scale.share(scale.value(share)) == pytest.approx(share, abs=2e-3) or share < 2e-3
    assert scale.value(0.0) == 0.0


def test_what_is_typed_is_exact() -> None:
    """A decimal means itself, and an emptied entry takes the number out, unless it is needed."""
    state = starts.first()
    assert state.changed("device.damping", "0.1 N*s/m").loop().device.exact("damping") == Fraction(1, 10)
    controls = {c.path: c for c in of.device_controls(state, state.loop().device)}
    assert read_entry(controls["device.coulomb_friction"], " ") is None
    with pytest.raises(InputError, match="is needed"):
        read_entry(controls["device.damping"], "")
