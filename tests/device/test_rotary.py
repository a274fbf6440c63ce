"""A rotary device and its equivalent at the handle are the same physics."""

from __future__ import annotations

import math
from fractions import Fraction
from typing import Any

import pytest
from hypothesis import given
from strategies import fractions

import zwidth as zw

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
def test_slips_are_refused(arguments, part):
    with pytest.raises(zw.InputError, match=part):
        zw.rotary(**{**WHEEL, **arguments})
