"""Where stability with a known hand ends, in the plane of walls (K, B).

The curve of all walls with poles on the unit circle at e^{jωT}, ω from 0 to the Nyquist frequency, by
D-decomposition; without delay, hand and friction it is

    κ = 2β (2 − β)/(2 + β),    κ = K T²/m,  β = B T/m       (largest: κ = 0.68629 at β = 0.82843)
"""

from __future__ import annotations

from collections.abc import Callable
from math import pi
from typing import Any

import numpy as np
import xarray as xr

from zwidth.errors import InputError
from zwidth.loop.sampled_plant import Motion
from zwidth.model.device import Device
from zwidth.model.environment import BackwardDifference, Wall
from zwidth.model.environment.velocity import VelocityEstimator
from zwidth.model.operator.hand_impedance import HandImpedance, as_hand
from zwidth.passivity.stability.characteristic import (
    PRECISIONS,
    Curve,
    curve,
    family,
    last_stable,
    line,
    plain,
)
from zwidth.passivity.stability.known_hand import largest_stable, motion_of, plain_of
from zwidth.quantity.balls import precision
from zwidth.quantity.exact import RealLike
from zwidth.quantity.parameter import read_number

_SLOWEST = 1e-4
"""Smallest angle ωT on the curve, as a part of π."""


def stability_boundary(
    device: Device,
    hand: Any = None,
    delay: RealLike | None = None,
    *,
    velocity_filter: VelocityEstimator | None = None,
    points: int = 1000,
) -> xr.Dataset:
    """The walls (K, B) with poles on the unit circle, and which of them bound the stable region.

    Floats, good to a few digits less than a double; `stability` decides single walls exactly.

    Parameters
    ----------
    device
        Certain values, with a mass.
    hand
        None, a certain `HandImpedance`, or a linear operator.
    delay
        In place of the device's [s], of any length.
    velocity_filter
        Of the walls, as for `Wall`. Default: the backward difference.
    points
        How many frequencies, ≥ 2; each of the two straight lines has as many.

    Returns
    -------
    xarray.Dataset
        Over `point`: `frequency` [Hz], `stiffness`, `virtual_damping`, and `bounds`, True where the stable
        region ends. The points come in three runs: the curve, the line of poles at z = −1, the line at z = 1.

    Raises
    ------
    InputError
        If a parameter is an interval, the mass is unknown, or points < 2.
    """
    if points < 2:
        raise InputError(f"points must be ≥ 2, got {points}: a curve has two ends")
    given = device if delay is None else device.replace(delay=delay)
    motion = motion_of(given, as_hand(hand))
    if not motion.is_certain:
        raise InputError("a boundary is of one device and one hand; robust_boundary covers intervals")
    velocity = BackwardDifference() if velocity_filter is None else velocity_filter
    with precision(PRECISIONS[0]):
        polynomials = plain(family(motion, velocity.transfer(motion.period)))
    # close together near 0, where slow hands and long delays are
    angles = np.unique(
        np.concatenate([np.geomspace(_SLOWEST, 1, points // 2), np.linspace(0, 1, points - points // 2 + 2)])
    )
    found = curve(polynomials, pi * angles[(angles > 0) & (angles < 1)])
    bound = found.damping[found.bounds]  # the straight lines go half as far again
    reach = 1.5 * float(bound.max()) if len(bound) and bound.max() > 0 else 1.0
    runs = [found, *(line(polynomials, angle, np.linspace(0, reach, points)) for angle in (pi, 0.0))]
    return _dataset(runs, given, float(motion.period))


def _dataset(runs: list[Curve], device: Device, period: float) -> xr.Dataset:
    angle, stiffness, damping, bounds = (np.concatenate(parts) for parts in zip(*runs, strict=True))
    units = {name: device.unit(name) for name in ("stiffness", "virtual_damping")}
    return xr.Dataset(
        {
            "frequency": ("point", angle / (2 * pi * period), {"units": "Hz"}),
            "stiffness": ("point", stiffness, {"units": units["stiffness"]}),
            "virtual_damping": ("point", damping, {"units": units["virtual_damping"]}),
            "bounds": ("point", bounds),
        },
        attrs={"device": device.name, "motion": device.motion},
    )


# The stiffest walls that every hand within intervals holds still, against virtual damping.


_NEAR = 1e-6
"""Relative difference of two limits that is more than floats are wrong."""


def robust_boundary(
    device: Device,
    hand: Any,
    virtual_damping: tuple[RealLike, RealLike],
    *,
    points: int = 20,
    velocity_filter: VelocityEstimator | None = None,
    progress: Callable[[int, int], None] = lambda done, total: None,
) -> xr.Dataset:
    """How stiff a wall may be for every hand within intervals, over its virtual damping.

    Parameters
    ----------
    device
        With a mass; mass and damping may be intervals.
    hand
        A `HandImpedance` of intervals, None, or a linear operator.
    virtual_damping
        Ends of the range of B [N·s/m; N·m·s/rad].
    points
        How many B, ≥ 2.
    velocity_filter
        Of the walls, as for `Wall`. Default: the backward difference.
    progress
        Is told how many points are done, and of how many.

    Returns
    -------
    xarray.Dataset
        Over virtual_damping: `guaranteed`, a stiffness that the independent checker accepts for all values,
        0.4 % below `refuted` at best; `refuted`, above which one of them is shaken, and `mass`, `damping` and
        `hand_stiffness` of device and hand together there. NaN where no stiffness is proved.

    Raises
    ------
    InputError
        As `stability`, or if the range or the number of points cannot be.
    """
    low, high = (read_number(end, "virtual_damping", "virtual_damping") for end in virtual_damping)
    if low >= high or points < 2:
        raise InputError(
            "virtual_damping runs from its smaller to its larger end, over ≥ 2 points; "
            f"got {low:g} … {high:g} and {points}"
        )
    velocity = BackwardDifference() if velocity_filter is None else velocity_filter
    axis = np.linspace(float(low), float(high), points)
    rows = []
    for done, b in enumerate(axis, start=1):
        rows.append(_limits(device, as_hand(hand), Wall(1, float(b), velocity)))
        progress(done, points)
    units = {key: device.unit(key) for key in ("stiffness", "mass", "damping")}
    columns = zip(*rows, strict=True)
    kinds = ("stiffness", "stiffness", "mass", "damping", "stiffness")
    names = ("guaranteed", "refuted", "mass", "damping", "hand_stiffness")
    variables: dict[str, Any] = {
        name: ("virtual_damping", np.array(values), {"units": units[kind]})
        for name, values, kind in zip(names, columns, kinds, strict=True)
    }
    unit = {"units": device.unit("virtual_damping")}
    return xr.Dataset(
        variables,
        {"virtual_damping": ("virtual_damping", axis, unit)},
        {"device": device.name, "hand": as_hand(hand).describe(device.motion), "motion": device.motion},
    )


def _limits(device: Device, hand: HandImpedance, wall: Wall) -> tuple[float, ...]:
    """What is proved for all, and the corner with the smallest limit."""
    motion = motion_of(device, hand)
    found, _ = largest_stable(motion, wall, device.motion)
    worst = min(
        (largest_stable(corner, wall, device.motion)[0] or 0.0, *(float(ends[0]) for ends in corner[:3]))
        for corner in _weakest(motion, wall)
    )
    return (np.nan if found is None else found, *worst)


def _weakest(motion: Motion, wall: Wall) -> list[Motion]:
    """The corners whose limit is the smallest as floats have it: the others need not be decided exactly."""
    law = wall.damped_spring(motion.period)
    corners = list(motion.grid(2))
    ends = [last_stable(plain_of(corner, law.velocity), float(law.damping)) for corner in corners]
    limits = [0.0 if end is None else end.stiffness for end in ends]
    enough = min(limits) * (1 + _NEAR)
    return [corner for corner, limit in zip(corners, limits, strict=True) if limit <= enough]
