"""Devices: valid, exact, what was assumed of them; at a handle; actuators by Abbott & Okamura 2005, IV-B."""

from __future__ import annotations

import math
import pickle
from fractions import Fraction
from typing import Any

import pytest
from hypothesis import given
from strategies import devices, fractions

import zwidth as zw
from zwidth.model.device import actuator_checks

NEEDED: dict[str, Any] = {"damping": 0.15, "sample_period": 0.001}
POSITIVE = ("mass", "sample_period", "force_limit", "force_resolution", "motor_inductance", "supply_voltage")
NOT_NEGATIVE = ("damping", "coulomb_friction", "resolution", "delay")
TINY = Fraction(1, 10**40)


def test_rate_and_period_are_exact_reciprocals():
    """3 kHz is a third of a millisecond, which no float is."""
    device = zw.Device(damping=0.15, rate=3000)
    assert device.exact("sample_period") == Fraction(1, 3000)
    assert device.replace(rate=Fraction(1, 3)).exact("sample_period") == 3
    assert zw.Device(damping=1, rate=(1000, 2000)).sample_period == zw.Interval(0.0005, 0.001)


@pytest.mark.parametrize("key", NOT_NEGATIVE)
def test_bounds_that_include_zero(key):
    """0 is accepted, the next number below is not."""
    assert getattr(zw.Device(**{**NEEDED, key: 0}), key) == 0
    with pytest.raises(zw.InputError, match=f"{key} must be ≥ 0"):
        zw.Device(**{**NEEDED, key: -TINY})
    with pytest.raises(zw.InputError, match=f"{key} must be ≥ 0"):
        zw.Device(**{**NEEDED, key: (-TINY, 1)})


@pytest.mark.parametrize("key", POSITIVE)
def test_bounds_that_exclude_zero(key):
    """The smallest positive number is accepted, 0 is not."""
    assert zw.Device(**{**NEEDED, key: TINY}).exact(key) == TINY
    with pytest.raises(zw.InputError, match=f"{key} must be > 0"):
        zw.Device(**{**NEEDED, key: 0})


@pytest.mark.parametrize(
    ("arguments", "part"),
    [
        ({"damping": 0.15}, "got neither"),
        ({"damping": 0.15, "rate": 1000, "sample_period": 0.001}, "got both"),
        ({"damping": 0.15, "rate": 0}, "rate must be > 0"),
        ({"damping": 0.15, "rate": "fast"}, "rate"),
        ({"damping": None, "rate": 1000}, r"damping \[N\*s/m\] is needed"),
        ({"damping": float("nan"), "rate": 1000}, "damping"),
        ({"damping": 1, "rate": 1000, "motion": "both"}, "motion"),
    ],
)
def test_messages_name_the_argument(arguments, part):
    with pytest.raises(zw.InputError, match=part):
        zw.Device(**arguments)


def test_what_was_not_given_is_remembered():
    """An ideal encoder that was assumed is not one that was stated."""
    assumed = zw.Device(**NEEDED)
    stated = zw.Device(**NEEDED, coulomb_friction=0, resolution=0, delay=0)
    assert assumed.assumed == ("coulomb_friction", "resolution", "delay")
    assert stated.assumed == ()
    assert assumed == stated
    assert hash(assumed) == hash(stated)
    assert "assumed" not in repr(assumed)


def test_replace_keeps_what_was_assumed():
    device = zw.Device(**NEEDED, coulomb_friction=0.1)
    assert device.replace(mass=1).assumed == ("resolution", "delay")
    assert device.replace(delay=0).assumed == ("resolution",)
    assert device.replace(rate=2000).assumed == ("resolution", "delay")
    assert pickle.loads(pickle.dumps(device)).assumed == device.assumed


def test_mass_may_be_unknown():
    """No criterion depends on it."""
    device = zw.Device(**NEEDED)
    assert device.mass is None
    assert "mass" not in device.parameters()
    with pytest.raises(zw.InputError, match="mass has no single value"):
        device.exact("mass")
    with pytest.raises(zw.InputError, match="delay has no single value, it is the interval 1 … 2 ms"):
        device.replace(delay="1 .. 2 ms").exact("delay")


@given(devices())
def test_replace_without_changes_is_the_same_device(device):
    twin = device.replace()
    assert twin == device
    assert repr(twin) == repr(device)
    assert twin.assumed == device.assumed
    assert device.is_certain
    assert not device.replace(damping=(0, 1)).is_certain


def test_a_name_is_text_in_a_notebook():
    shown = zw.Device(**NEEDED, name="<b>x</b> & y")._repr_html_()
    assert "<caption>&lt;b&gt;x&lt;/b&gt; &amp; y</caption>" in shown


WHEEL: dict[str, Any] = {"inertia": 0.02, "damping": 0.05, "rate": 1000}


def test_without_a_radius_it_is_rotary_and_what_was_not_given_stays_assumed():
    """In N·m and rad."""
    wheel = zw.rotary(**WHEEL, counts_per_turn=4096, coulomb_friction=0.1)
    assert wheel.motion == "rotary"
    assert wheel.exact("mass") == Fraction(2, 100)
    assert float(wheel.resolution) == 2 * math.pi / 4096
    assert wheel.assumed == ("delay",)
    handle = zw.rotary(damping=1, rate=1000, handle_radius=0.1)
    assert (handle.assumed, handle.mass) == (("coulomb_friction", "resolution", "delay"), None)


@given(fractions(), fractions(), fractions(), fractions(), fractions("0.01", "1"))
def test_the_equivalent_at_the_handle(inertia, damping, friction, angle, radius):
    """m = J/r², b/r², f_c/r, rΔθ; and both stiffness limits scale as K = K_θ/r²."""
    given_values: dict[str, Any] = {
        "inertia": inertia,
        "damping": damping,
        "coulomb_friction": friction,
        "resolution": angle,
        "force_limit": friction,
        "force_resolution": damping,
        "rate": 1000,
    }
    turning = zw.rotary(**given_values)
    handle = zw.rotary(**given_values, handle_radius=radius)
    assert handle.motion == "linear"
    assert handle.exact("mass") == inertia / radius**2
    assert handle.exact("force_limit") == friction / radius
    assert handle.exact("force_resolution") == damping / radius
    for k in (lambda d: d.exact("damping"), lambda d: d.exact("coulomb_friction") / d.exact("resolution")):
        assert k(handle) * radius**2 == k(turning)


def test_intervals_take_their_worst_ends():
    handle = zw.rotary(damping=(1, 2), resolution=0.001, rate=1000, handle_radius=(0.1, 0.2))
    assert handle.damping == zw.Interval(25, 200)
    assert handle.resolution == zw.Interval("0.0001", "0.0002")
    counts = zw.rotary(damping=1, rate=1, counts_per_turn=(1000, 2000)).resolution
    assert counts == zw.Interval(math.pi / 1000, math.pi / 500)


@pytest.mark.parametrize(
    ("arguments", "part"),
    [
        ({"handle_radius": 0}, "handle_radius must be > 0 m"),
        ({"counts_per_turn": 0}, "counts_per_turn must be > 0"),
        ({"counts_per_turn": 4096, "resolution": 0.001}, "got both"),
        ({"inertia": -1}, "inertia must be > 0"),
        ({"handle_radius": "wide"}, "handle_radius"),
        ({"damping": -1}, r"damping must be ≥ 0 N\*m\*s/rad"),
    ],
)
def test_slips_of_a_rotary_device_are_refused(arguments, part):
    with pytest.raises(zw.InputError, match=part):
        zw.rotary(**{**WHEEL, **arguments})


PADDLE = zw.catalogue.device("haptic-paddle")


def test_the_paddle_s_numbers():
    """13 times finer at 300 N/m, and a rise of 0.15 ms, 15 % of a sample."""
    resolution, rise = actuator_checks(PADDLE, 300)
    assert resolution.ratio.fraction == 300 * Fraction("22.4e-6") / (Fraction(20, 65536) * Fraction("1.65"))
    assert int(resolution.ratio) == 13
    assert rise.value == pytest.approx(0.15e-3, rel=0.01)
    assert rise.ratio.fraction == Fraction("0.15125")
    assert resolution.ok
    assert rise.ok
    assert "13.3 to 1" in resolution.text
    knob = zw.rotary(damping=0.01, rate=1000, counts_per_turn=4096, force_resolution=1e-4)
    assert actuator_checks(knob, 1)[0].unit == "N*m"


def test_both_sides_of_the_bounds():
    """Fine from 10 to 1 on, quick up to a fifth of a sample."""
    step = PADDLE.exact("force_resolution")
    stiffness = 10 * step / PADDLE.exact("resolution")
    assert actuator_checks(PADDLE, stiffness)[0].ok is True
    assert actuator_checks(PADDLE, stiffness * (1 - Fraction(1, 10**9)))[0].ok is False
    period = 5 * Fraction("0.15125e-3")
    assert actuator_checks(PADDLE.replace(sample_period=period), 300)[1].ok is True
    assert actuator_checks(PADDLE.replace(sample_period=period - Fraction(1, 10**12)), 300)[1].ok is False


@pytest.mark.parametrize(
    ("device", "stiffness", "part"),
    [
        (PADDLE.replace(motor_inductance=None), 300, "motor_inductance"),
        (zw.catalogue.device("phantom"), 300, "the encoder's resolution"),
        (PADDLE.replace(force_resolution=None), 300, "force_resolution"),
        (PADDLE, None, "a stiffness"),
        (PADDLE, 0, "a stiffness"),
        (PADDLE.replace(resolution=0), 300, "an ideal encoder"),
    ],
)
def test_what_is_unknown_is_said(device, stiffness, part):
    check = actuator_checks(device, stiffness)[part == "motor_inductance"]
    assert check.ok is None
    assert check.ratio is None
    assert part in check.text
    assert "supply_voltage" not in check.text


def test_actuators_take_the_worst_ends_of_intervals():
    wide = PADDLE.replace(supply_voltage=(6, 12), resolution=("11.2e-6", "22.4e-6"))
    fine, quick = actuator_checks(wide, (300, 600)), actuator_checks(PADDLE, 300)
    assert fine[0].ratio is not None
    assert quick[0].ratio is not None
    assert fine[0].ratio.fraction * 2 == quick[0].ratio.fraction
    assert fine[1].value == 2 * quick[1].value
    assert fine[1].ok is False
