"""The hand where nobody says which: of the size of what it holds."""

from __future__ import annotations

import pytest

import zwidth as zw
from zwidth.model.operator import OPERATORS, Finger, FingersOn, HandsOn, usual_hand
from zwidth.model.operator.named import usual_kind
from zwidth.show.explorer.computing import hand_kind_of, operator_of
from zwidth.show.explorer.play import played
from zwidth.show.explorer.state import State


def turning(inertia: object) -> zw.Device:
    """A device that turns, of this inertia."""
    return zw.rotary(inertia=inertia, damping="2 mN*m*s/rad", rate="1 kHz")


@pytest.mark.parametrize(
    ("inertia", "kind"),
    [
        ("2e-5 kg*m^2", FingersOn),
        ("0.000299 kg*m^2", FingersOn),
        ("0.0003 kg*m^2", HandsOn),
        (("2e-5", "0.006"), HandsOn),
        (None, HandsOn),
    ],
)
def test_what_turns_is_a_knob_or_a_wheel(inertia: object, kind: type[Finger]) -> None:
    assert type(usual_hand(turning(inertia))) is kind
    assert OPERATORS[usual_kind(turning(inertia))] is kind
    assert type(usual_hand(zw.catalogue.device("haptic-paddle"))) is Finger


def test_fingers_on_a_knob_are_two_fingers_at_its_edge() -> None:
    """At the edge, 15 mm from the axis, each has the mass, spring, damper and force of a finger."""
    one, both, r = Finger(), FingersOn(), 0.015
    for name in ("mass", "stiffness", "damping"):
        assert getattr(both, name) / r**2 / 2 == pytest.approx(getattr(one, name), rel=1e-9)
    assert both.force / r / 2 == pytest.approx(one.force)


def test_explore_and_play_hold_a_wheel_with_two_hands() -> None:
    wheel = turning("0.006 kg*m^2")
    state = State.of(wheel, zw.Wall("0.3 N*m/deg"))
    assert hand_kind_of(state) == "hands-on"
    assert operator_of(state) == HandsOn()
    assert operator_of(state.with_extra("operator", {"type": "finger", "force": "1 N*m"})) == Finger(force=1)
    assert played(wheel, zw.Wall("0.3 N*m/deg")).hand == HandsOn().hand
