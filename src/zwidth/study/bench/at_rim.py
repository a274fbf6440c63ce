"""A device that turns, on the bench of a handle: its rim at a radius r, where a finger touches it.

    x = r θ      f = τ/r      m = J/r²      K, B and b likewise over r²

The bench runs at the rim, in metres and newtons; what it finds is told about the axis.
"""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import TYPE_CHECKING

from zwidth.errors import InputError
from zwidth.model.device.device import Device
from zwidth.model.device.rotary import ROTARY, at_handle
from zwidth.model.environment.wall import Wall
from zwidth.quantity.exact import Exact, RealLike
from zwidth.quantity.parameter import read_number

if TYPE_CHECKING:
    import xarray as xr

_TURNED = {"N/m": ("N*m/rad", 2), "N": ("N*m", 1), "m": ("rad", -1), "N*s/m": ("N*m*s/rad", 2)}
"""What a unit at the rim is about the axis, and the power of the radius that takes a value there."""


def radius_of(device: Device, given: RealLike | None) -> Exact:
    """The radius at which a device that turns is touched [m]."""
    if given is None:
        raise InputError(
            f"the touches of the bench are a finger's, at a handle or rim, and {device.name} turns: say how "
            "far from the axis that is, --handle-radius '0.15 m' for a wheel, '2 cm' for a knob"
        )
    own = ROTARY["handle_radius"]
    radius: Exact = read_number(
        given, own, "handle_radius", bound="> 0", why="the handle turns about the axis", uncertain=False
    )
    return radius


def at_rim(device: Device, wall: Wall, radius: Exact) -> tuple[Device, Wall]:
    """The same device and wall, felt at the rim."""
    square = radius.fraction**2

    def over(value: object) -> Exact:
        if not isinstance(value, Exact):
            raise InputError("the bench simulates one loop: give numbers, no intervals")
        return Exact(Fraction(value.fraction / square))

    there = replace(wall, stiffness=over(wall.stiffness), damping=over(wall.damping))
    return at_handle(device, radius), there


def about_axis(scores: xr.Dataset, radius: float) -> xr.Dataset:
    """What was found at the rim, `radius` [m] from the axis, in torques and angles."""
    turned = scores.copy()
    for name, value in scores.data_vars.items():
        unit, power = _TURNED.get(value.attrs.get("units", ""), ("", 0))
        if unit:
            turned[name] = (value.dims, radius**power * value.values, {**value.attrs, "units": unit})
    return turned
