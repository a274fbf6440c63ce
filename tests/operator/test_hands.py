"""What each hand does in time, by values worked out on another road; and which hand is the usual one."""

from __future__ import annotations

import math

import numpy as np
import pytest

import zwidth as zw
from zwidth.errors import InputError
from zwidth.model.operator import (
    OPERATORS,
    ConstantForce,
    Cycle,
    Dowel,
    Finger,
    FingersOn,
    Guide,
    HandsOn,
    MaliciousTouch,
    SoftTouch,
    TypicalTouch,
    usual_hand,
)
from zwidth.model.operator.named import usual_kind
from zwidth.show.explorer.computing import hand_kind_of, operator_of
from zwidth.show.explorer.play import played
from zwidth.show.explorer.state import State

PADDLE = zw.catalogue.device("haptic-paddle")
TIMES = np.arange(601) * 0.001


def test_a_constant_force_is_the_same_in_every_interval():
    signals = ConstantForce(0.7).signals(TIMES)
    assert signals.force.tolist() == [0.7] * 600
    assert ConstantForce(0.7).hand == (0, 0, 0)


def test_a_finger_approaches_and_stops_where_it_presses():
    """At 0.25 m/s from −30 mm it is at −5 mm after 0.1 s, and stops 1.5 N / 300 N/m = 5 mm inside."""
    finger = Finger(stiffness=300, force=1.5, speed=0.25, start=-0.03)
    anchor = finger.signals(TIMES).anchor
    assert anchor[100] == pytest.approx(-0.005, abs=1e-15)
    arrival = round((0.03 + 0.005) / 0.25 / 0.001)
    assert anchor[arrival - 1] < 0.005
    assert set(anchor[arrival + 1 :]) == {0.005}
    assert np.allclose(np.diff(anchor[: arrival - 1]), 0.25e-3, rtol=1e-9)
    assert finger.initial_position == -0.03


def test_the_finger_has_the_published_numbers_and_the_chosen_damping_ratio():
    """0.006 kg and 500 N/m (Gillespie & Cutkosky 1996); the damping is half of critical."""
    mass, stiffness, damping = Finger().hand
    assert (mass, stiffness) == (0.006, 500)
    assert damping / (2 * math.sqrt(mass * stiffness)) == pytest.approx(0.5, abs=0.01)


def test_the_typical_touch_is_the_finger_at_moderate_speed():
    typical = TypicalTouch()
    assert typical.hand == Finger().hand
    assert typical.describe().startswith("typical touch")
    assert typical.speed < MaliciousTouch().speed


def test_the_malicious_touch_is_tuned_to_the_paddle_on_its_stiff_wall():
    """√(k/m_h) is √(K/m) at 770 N/m, and c is above K T/2 − b by less than a third."""
    touch = MaliciousTouch()
    mass, damping, period = (float(PADDLE.exact(key)) for key in ("mass", "damping", "sample_period"))
    assert math.sqrt(touch.stiffness / touch.mass) == pytest.approx(math.sqrt(770 / mass), rel=0.01)
    least = 770 * period / 2 - damping
    assert least < touch.damping < least * 4 / 3


def test_a_soft_touch_grows_and_stays():
    force, anchor, _, _ = SoftTouch(force=0.2, rise=0.4, start=-0.002).signals(TIMES)
    assert force[0] == 0
    assert force[100] == pytest.approx(0.05, rel=1e-14)
    assert set(force[400:]) == {0.2}
    assert set(anchor) == {-0.002}
    assert set(SoftTouch(force=0.2, rise=0).signals(TIMES).force) == {0.2}


def test_the_soft_touch_lies_in_the_window_where_the_coarse_encoder_buzzes():
    """f_c < F < K Δ − f_c at 240 and 120 N/m with Δ = 2.24 mm; no force does so at 80 and 90 N/m."""
    friction, edge = float(PADDLE.exact("coulomb_friction")), 100 * float(PADDLE.exact("resolution"))
    for stiffness in (240, 120):
        assert friction < SoftTouch().force < stiffness * edge - friction
    for stiffness in (80, 90):
        assert stiffness * edge - friction < friction


def test_a_dowel_weighs_what_its_wood_weighs():
    """A rod of 8 mm and 150 mm: 7.540 cm³, at 0.65 g/cm³ 4.90 g, the default; twice as thick, four times."""
    assert Dowel.of_size(0.15, 0.008).mass == pytest.approx(7.5398e-6 * 650, rel=1e-4)
    assert Dowel().mass == pytest.approx(Dowel.of_size(0.15, 0.008).mass, rel=1e-3)
    thick = Dowel.of_size(0.15, 0.016, force=3)
    assert thick.mass == pytest.approx(4 * Dowel.of_size(0.15, 0.008).mass, rel=1e-14)
    assert thick.force == 3


@pytest.mark.parametrize(
    ("make", "said"),
    [
        *(
            (lambda size=size: Dowel.of_size(*size), "must be > 0 and finite")
            for size in ((0, 0.008), (0.15, -0.008), (float("nan"), 0.008), (0.15, float("inf")))
        ),
        (lambda: Cycle(low=1e-3, high=1e-3), "low must be < high"),
    ],
)
def test_a_hand_that_cannot_be_is_refused(make, said):
    with pytest.raises(InputError, match=said):
        make()


def test_a_dowel_only_pushes():
    force, anchor, _, _ = Dowel(force=3.5).signals(TIMES)
    assert set(force) == {3.5}
    assert anchor is None
    assert Dowel().hand == (0.0049, 0, 0)
    gripped = Dowel(damping=0.05, start=-0.01).signals(TIMES).anchor
    assert set(gripped) == {-0.01}


def test_a_guide_pushes_at_constant_speed_and_holds():
    """From −4 mm at 0.05 m/s: at the surface after 0.08 s, at 9 mm from 0.26 s on."""
    signals = Guide(start=-0.004, speed=0.05, depth=0.009).signals(TIMES)
    position = signals.position
    assert position[80] == pytest.approx(0, abs=1e-17)
    assert position[259] < 0.009
    assert set(position[261:]) == {0.009}
    assert signals.switch_position is None


def test_a_cycle_is_one_sample_in_and_one_out():
    position = Cycle(low=-2e-6, high=3e-4).signals(TIMES).position
    assert position[:4].tolist() == [-2e-6, 3e-4, -2e-6, 3e-4]


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
def test_what_turns_is_a_knob_or_a_wheel(inertia, kind):
    assert type(usual_hand(turning(inertia))) is kind
    assert OPERATORS[usual_kind(turning(inertia))] is kind
    assert type(usual_hand(zw.catalogue.device("haptic-paddle"))) is Finger


def test_fingers_on_a_knob_are_two_fingers_at_its_edge():
    """At the edge, 15 mm from the axis, each has the mass, spring, damper and force of a finger."""
    one, both, r = Finger(), FingersOn(), 0.015
    for name in ("mass", "stiffness", "damping"):
        assert getattr(both, name) / r**2 / 2 == pytest.approx(getattr(one, name), rel=1e-9)
    assert both.force / r / 2 == pytest.approx(one.force)


def test_explore_and_play_hold_a_wheel_with_two_hands():
    wheel = turning("0.006 kg*m^2")
    state = State.of(wheel, zw.Wall("0.3 N*m/deg"))
    assert hand_kind_of(state) == "hands-on"
    assert operator_of(state) == HandsOn()
    assert operator_of(state.with_extra("operator", {"type": "finger", "force": "1 N*m"})) == Finger(force=1)
    assert played(wheel, zw.Wall("0.3 N*m/deg")).hand == HandsOn().hand
