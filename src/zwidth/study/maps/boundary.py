"""Where stability with a known hand ends, in the plane of walls (K, B).

The curve of all walls with poles on the unit circle at e^{jωT}, ω from 0 to the Nyquist frequency, by
D-decomposition; without delay, hand and friction it is

    κ = 2β (2 − β)/(2 + β),    κ = K T²/m,  β = B T/m       (largest: κ = 0.68629 at β = 0.82843)
"""

from __future__ import annotations

from math import pi
from typing import Any

import numpy as np
import xarray as xr

from zwidth.errors import InputError
from zwidth.model.device import Device
from zwidth.model.environment import BackwardDifference
from zwidth.model.environment.velocity import VelocityEstimator
from zwidth.model.operator.hand_impedance import as_hand
from zwidth.passivity.stability.characteristic import PRECISIONS, Curve, curve, family, line, plain
from zwidth.passivity.stability.known_hand import motion_of
from zwidth.quantity.balls import precision
from zwidth.quantity.exact import RealLike

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
    reach = _reach(found)
    runs = [found, *(line(polynomials, angle, np.linspace(0, reach, points)) for angle in (pi, 0.0))]
    return _dataset(runs, given, float(motion.period))


def _reach(found: Curve) -> float:
    """Virtual damping up to which the straight lines go: where the curve bounds, and half as far again."""
    dampings = found.damping[found.bounds]
    return 1.5 * float(dampings.max()) if len(dampings) and dampings.max() > 0 else 1.0


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
