"""What makes a Z-width large: a 2⁴ factorial design, as Colgate & Brown (1994) made on their device.

Rate, damping, resolution and velocity filter at two levels each, sixteen maps on one grid.  The
effect of a factor is the mean area at its high level less that at its low one; the
effect of several together is half the change of one effect with another, and so on:

    effect(S) = (1/8) Σ_runs area · Π_{i ∈ S} (±1)
"""

from __future__ import annotations

from collections.abc import Mapping
from itertools import combinations, product
from math import fsum
from typing import Any

import numpy as np
import xarray as xr

from zwidth.errors import InputError
from zwidth.model.device import Device
from zwidth.model.environment import BackwardDifference, OnePole
from zwidth.model.environment.velocity import VelocityEstimator
from zwidth.quantity.exact import Exact, RealLike
from zwidth.quantity.units import parse_number
from zwidth.study.maps.z_width import SPEED, z_width

FACTORS = ("rate", "damping", "resolution", "filter")

_FILTERS = (BackwardDifference(), OnePole("0.033"))
"""None, and a first-order low-pass of 30 rad/s."""


def z_width_factors(
    device: Device,
    stiffness: tuple[RealLike, RealLike],
    virtual_damping: tuple[RealLike, RealLike],
    *,
    rate: tuple[RealLike, RealLike],
    damping: tuple[RealLike, RealLike],
    resolution: tuple[RealLike, RealLike],
    filters: tuple[VelocityEstimator, VelocityEstimator] = _FILTERS,
    cells: tuple[int, int] = (100, 100),
    hands: Mapping[str, Any] | None = None,
    speed: float = SPEED,
) -> xr.Dataset:
    """Areas of the Z-width for all sixteen combinations of two levels of four factors, and their effects.

    Parameters
    ----------
    device
        Certain values, with a mass; its rate, damping and resolution are replaced.
    stiffness, virtual_damping, cells, hands, speed
        Of every map, as for `z_width`; an area is counted within these ranges.
    rate, damping, resolution
        The low and the high level: 1/T [Hz], b [N·s/m; N·m·s/rad] and Δ [m; rad].
    filters
        The velocity estimators of the low and the high level. Default: the backward difference, and a
        one-pole filter of 33 ms, 30 rad/s.

    Returns
    -------
    xarray.Dataset
        `area` over (rate, damping, resolution, filter, region) with levels "low" and "high", and `effect`
        over (term, region), terms written "rate", "rate × damping", …

    Raises
    ------
    InputError
        As `z_width`, or if the two levels of a factor are equal.
    """
    pairs = {"rate": rate, "damping": damping, "resolution": resolution}
    levels: dict[str, tuple[Any, Any]] = {
        name: _levels(name, pair, device.unit(name)) for name, pair in pairs.items()
    }
    levels["filter"] = filters
    areas: Any = None
    for run in product((0, 1), repeat=4):
        chosen = {name: levels[name][level] for name, level in zip(FACTORS, run, strict=True)}
        velocity = chosen.pop("filter")
        found = z_width(
            device.replace(**chosen), stiffness, virtual_damping, cells,
            velocity_filter=velocity, hands=hands, speed=speed,
        )  # fmt: skip
        if areas is None:
            areas, region, unit = (
                np.zeros((2, 2, 2, 2, found.sizes["region"])),
                found["region"],
                found["area"].attrs,
            )
        areas[run] = found["area"]
    names, effects = _effects(areas)
    return xr.Dataset(
        {"area": ((*FACTORS, "region"), areas, unit), "effect": (("term", "region"), effects, unit)},
        {**{name: ["low", "high"] for name in FACTORS}, "term": names, "region": region.values},
        {name: [str(level) for level in pair] for name, pair in levels.items()},
    )


def _levels(name: str, pair: tuple[RealLike, RealLike], unit: str) -> tuple[Exact, Exact]:
    low, high = (parse_number(value, unit, name) for value in pair)
    if low == high:
        raise InputError(f"{name} has the level {low:g} twice; an effect needs two")
    return low, high


def _effects(areas: Any) -> tuple[list[str], Any]:
    """The name and the effect of each of the fifteen terms."""
    sign = np.array([-1.0, 1.0])
    names, effects = [], []
    for size in range(1, 5):
        for term in combinations(range(4), size):
            weights = np.ones((2, 2, 2, 2))
            for axis in term:
                weights = weights * sign.reshape([-1 if k == axis else 1 for k in range(4)])
            names.append(" × ".join(FACTORS[axis] for axis in term))
            signed = (weights[..., None] * areas).reshape(16, -1)
            effects.append([fsum(runs) / 8 for runs in signed.T])  # what cancels is 0, not rounding
    return names, np.array(effects)
