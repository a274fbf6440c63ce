"""Rotary devices: wheels, knobs, paddles.

A rotary device has torque and angle in the place of force and position:

    J θ̈ = τ_h − τ_a − τ_c sgn θ̇ − b θ̇

Everything that holds for the linear device holds with N → N·m and m → rad.
Seen at a handle of radius r, with x = r θ and f = τ/r, it is the linear device

    m = J/r²,   b/r²,   f_c = τ_c/r,   Δ = r Δθ,   F_max = τ_max/r.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

from zwidth.errors import InputError
from zwidth.model.device.device import Device
from zwidth.quantity.exact import Exact, Interval, ends
from zwidth.quantity.glossary import Quantity
from zwidth.quantity.parameter import Given, plain, read_number


def rotary(
    *,
    inertia: Given | None = None,
    damping: Given,
    coulomb_friction: Given | None = None,
    stiction: Given | None = None,
    friction_speed: Given | None = None,
    resolution: Given | None = None,
    counts_per_turn: Given | None = None,
    handle_radius: Given | None = None,
    force_limit: Given | None = None,
    force_resolution: Given | None = None,
    **rest: Any,
) -> Device:
    """A rotary device; with `handle_radius`, its linear equivalent at the handle.

    Parameters
    ----------
    inertia
        J about the axis, > 0 [kg·m²]; None where unknown.
    damping
        Viscous friction b, ≥ 0 [N·m·s/rad].
    coulomb_friction
        Coulomb friction torque τ_c, ≥ 0 [N·m].
    stiction
        Largest friction torque at rest, ≥ τ_c [N·m]; None: τ_c.
    resolution, counts_per_turn
        Δθ [rad], or N > 0 and then Δθ = 2π/N to double precision; one of the two at most. N is counts, not
        lines: with quadrature decoding an encoder of 500 lines gives 2000 counts per turn, at the axis whose
        angle θ is (times the gear ratio, where there is one).
    handle_radius
        r > 0 [m]. With it the result has motion "linear", in newtons and
        metres at the handle; without it "rotary", in N·m and rad.
    friction_speed
        Speed up to which the friction was seen, > 0 [rad/s]; None: it holds at every speed.
    force_limit, force_resolution
        Of the actuator, as torques [N·m].
    rest
        The other arguments of `Device`: rate or sample_period, delay, …
    """
    if counts_per_turn is not None:
        if resolution is not None:
            raise InputError(
                "give either resolution [rad] or counts_per_turn, got both; one follows from the other"
            )
        resolution = _count_angle(counts_per_turn)
    given: dict[str, Any] = {
        "mass": None if inertia is None else _positive(inertia, "inertia", "a body has inertia"),
        "damping": damping,
        "coulomb_friction": coulomb_friction,
        "stiction": stiction,
        "friction_speed": friction_speed,
        "resolution": resolution,
        "force_limit": force_limit,
        "force_resolution": force_resolution,
    }
    device = Device(**given, motion="rotary", **rest)
    if handle_radius is None:
        return device
    return at_handle(device, _positive(handle_radius, "handle_radius", "the handle turns about the axis"))


ROTARY: Mapping[str, Quantity] = MappingProxyType(
    {
        q.name: q
        for q in (
            Quantity("inertia", "J", "kg*m^2", "kg*m^2", "moment of inertia of a rotary device"),
            plain("counts_per_turn", "encoder counts in one turn", "N"),
            Quantity(
                "handle_radius",
                "r",
                "m",
                "m",
                "from the axis to the handle; turns a rotary device into its equivalent there",
            ),
        )
    }
)
"""What makes a device rotary."""

_POWER = {
    "mass": -2,
    "damping": -2,
    "coulomb_friction": -1,
    "stiction": -1,
    "friction_speed": 1,
    "resolution": 1,
    "force_limit": -1,
    "force_resolution": -1,
}
"""The power of the handle radius that takes each rotary quantity to the handle."""


def at_handle(device: Device, radius: Exact | Interval) -> Device:
    """The linear device that a rotary one is at a handle, r from its axis [m]."""
    changes: dict[str, Any] = {"motion": "linear"}
    for key, power in _POWER.items():
        value = getattr(device, key)
        if value is not None and key not in device.assumed:
            changes[key] = _scaled(value, radius, power)
    if device.transmission is not None:
        known = device.transmission.parameters().items()
        powers = {key: -1 if key.endswith("friction") else -2 for key, _ in known}
        there = {key: _scaled(value, radius, powers[key]) for key, value in known}
        changes["transmission"] = device.transmission.replace(**there, motion="linear")
    return device.replace(**changes)


def _scaled(value: Exact | Interval, radius: Exact | Interval, power: int) -> Exact | Interval:
    """value · radiusᵖ; both are ≥ 0, so the ends give the ends."""
    (low, high), (near, far) = ends(value), ends(radius)
    if power < 0:
        near, far = far, near
    if isinstance(value, Interval) or isinstance(radius, Interval):
        return Interval(low * near**power, high * far**power)
    return Exact(low * near**power)


def _count_angle(counts_per_turn: Given) -> Exact | Interval:
    low, high = ends(_positive(counts_per_turn, "counts_per_turn", "leave it out if unknown"))
    if low == high:
        return Exact(2 * math.pi / float(low))
    return Interval(2 * math.pi / float(high), 2 * math.pi / float(low))


def _positive(value: Given, key: str, why: str) -> Exact | Interval:
    number: Exact | Interval = read_number(
        value, ROTARY[key], key, uncertain=True, bound="> 0", why=why, motion="rotary"
    )
    return number
