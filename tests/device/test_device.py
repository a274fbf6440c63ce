"""The device validates itself, stays exact, and remembers what it assumed."""

from __future__ import annotations

import pickle
from fractions import Fraction
from typing import Any

import pytest
from hypothesis import given
from strategies import devices

import zwidth as zw

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
