"""The Z-width of a device: which walls (K, B) it can render, cell by cell.

    passive            b ≥ (2d + 1) K T/2 + |B| Σ|w_j|   and   f_c ≥ (K + |B| ‖h_v‖₁) Δ/2
    sustained          the criterion for contact that is kept, b ≥ (T/2) Re{(1 − z⁻¹) H}/(1 − cos ωT)
    admissible speed   of hands from which such a wall keeps its energy although it is not passive
    stable with a hand all poles of device, hand and wall inside the unit circle

The upper end of the Z-width is the stiffest of these walls; the lower end is what the device
itself lets one feel in free air: its inertia, damping and friction (Colgate & Brown 1994).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from contextlib import nullcontext
from itertools import combinations, product
from math import fsum
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from zwidth.errors import InputError
from zwidth.model.device import Device
from zwidth.model.environment import BackwardDifference, OnePole
from zwidth.model.environment.velocity import VelocityEstimator
from zwidth.quantity.exact import Exact, RealLike
from zwidth.quantity.glossary import GLOSSARY
from zwidth.quantity.parameter import read_number
from zwidth.quantity.text import to_json
from zwidth.quantity.units import parse_number
from zwidth.study.chunks.layout import Finished, Layers, Place, on_cluster, on_threads
from zwidth.study.chunks.store import computed
from zwidth.study.maps.kernel import compute
from zwidth.study.maps.plan import Plan, plan, spring_limit, stable_limits
from zwidth.study.maps.request import FORMAT, Request, request, scopes
from zwidth.writing import alone

Progress = Callable[[int, int], None]

SPEED = 0.5
"""Of a hand that is quick but not violent [m/s; rad/s]."""


def z_width(
    device: Device,
    stiffness: tuple[RealLike, RealLike],
    virtual_damping: tuple[RealLike, RealLike],
    cells: tuple[int, int] = (200, 200),
    *,
    velocity_filter: VelocityEstimator | None = None,
    hands: Mapping[str, Any] | None = None,
    speed: RealLike = SPEED,
    path: str | PathLike[str] | None = None,
    address: str | None = None,
    workers: int | None = None,
    progress: Progress = lambda done, total: None,
) -> xr.Dataset:
    """Map the walls that a device can render over stiffness and virtual damping.

    A cell stands for the wall at its middle.  `passive…` and `stable_…` are True only where proved, by exact
    decisions or in balls that hold the true numbers; `admissible_speed` is rounded down.

    Parameters
    ----------
    device
        Certain values, with a mass.
    stiffness, virtual_damping
        Ends of the ranges of K ≥ 0 [N/m; N·m/rad] and B [N·s/m; N·m·s/rad].
    cells
        How many along K and along B.
    velocity_filter
        Of the walls, as for `Wall`. Default: the backward difference.
    hands
        Known hands by name, as for `stability`. Default: "none", "finger" and "dowel"; with a transmission
        nobody, for there their stability is not known.
    speed
        Up to which a hand must not gain energy for a wall to count as `quiet` [m/s; rad/s].
    path
        Directory of a zarr store, written chunk by chunk; one that was begun is gone on with.
    address
        Of a Dask scheduler whose workers compute the chunks, ``tcp://…``. Default: threads of this process.
    workers
        How many threads. Default: one for each processor.
    progress
        Is told how many chunks are done, and of how many.

    Returns
    -------
    xarray.Dataset
        Over (stiffness, virtual_damping): `passive`, `passive_sustained`, as long as contact lasts, `quiet`,
        `admissible_speed` and `stable_NAME` of each hand; what each is about is in its attribute `scope`, as
        JSON. Over virtual_damping the curves where they end,
        `limit_passive` and `limit_NAME`, NaN where nothing is stable. Of each region its `area` and its
        `largest_stiffness`, by counting cells.  Where no condition covers contact made and broken, the
        attribute `not_covered` says of which walls: there `passive` and `quiet` are False for want of a
        condition, except at B = 0; `spring_limit` is the stiffest passive spring.
        `free_mass`, `free_damping` and `free_friction`, the lower end, of both sides of a transmission. With
        one `passive` is what holds for every transmission, `passive_sustained` is exact of this one where
        friction is viscous and the encoder ideal, and `quiet` no more than `passive`.

    Raises
    ------
    InputError
        If a range, a hand or the device is not one; or the store or the cluster cannot be used.
    """
    asked = request(device, stiffness, virtual_damping, cells, velocity_filter, hands)
    if workers is not None and workers < 1:
        raise InputError(f"workers must be ≥ 1, got {workers}: someone has to compute")
    quiet = float(
        read_number(speed, "speed", "speed", bound="> 0", why="a hand at rest gains nothing from any wall")
    )
    ready = plan(asked)

    def finished(left: list[Place]) -> Finished:
        if address is None:
            return on_threads(compute, ready, left, workers)
        return on_cluster(compute, ready, left, address)

    store = None if path is None else Path(path)
    with nullcontext() if store is None else alone(store):
        layers = computed(asked.layout, finished, store, progress)
    return _dataset(asked, ready, layers, quiet)


def _dataset(asked: Request, ready: Plan, layers: Layers, speed: float) -> xr.Dataset:
    motion = asked.device.motion
    axes = {"stiffness": asked.stiffness.values, "virtual_damping": asked.virtual_damping.values}
    coordinates = {
        name: (name, values, {"units": GLOSSARY[name].unit_for(motion), "long_name": GLOSSARY[name].meaning})
        for name, values in axes.items()
    }
    dims = tuple(axes)
    variables: dict[str, Any] = {
        name: (dims, values, dict(_MEANINGS.get(name, {}))) for name, values in layers.items()
    }
    variables["admissible_speed"][2]["units"] = GLOSSARY["velocity"].unit_for(motion)
    variables["quiet"] = (dims, layers["admissible_speed"] >= speed, {"speed": speed})
    units = [GLOSSARY[name].unit_for(motion) for name in axes]
    variables["limit_passive"] = (dims[1], ready.limit, {"units": units[0]})
    for hand in ready.hands:
        limits = stable_limits(hand, ready.damping)
        variables[f"limit_{hand.name}"] = (dims[1], limits, {"units": units[0]})
    about = scopes(asked, speed)
    names = list(about)
    for name, scope in about.items():
        variables[name][2]["scope"] = to_json(scope.to_dict(), indent=None)
    cell = asked.stiffness.width * asked.virtual_damping.width
    masks = [np.asarray(variables[name][1]) for name in names]
    variables["area"] = (
        "region",
        [mask.sum() * cell for mask in masks],
        {"units": f"({units[0]})*({units[1]})"},
    )
    variables["largest_stiffness"] = (
        "region", [_largest(mask, axes["stiffness"]) for mask in masks], {"units": units[0]},
    )  # fmt: skip
    for name, key in (
        ("free_mass", "mass"),
        ("free_damping", "damping"),
        ("free_friction", "coulomb_friction"),
    ):
        unit = {"units": GLOSSARY[key].unit_for(motion)}
        variables[name] = ((), float(asked.whole.motor_side.exact(key)) + _behind(asked.whole, key), unit)
    attrs = {
        "format": FORMAT,
        "device": asked.device.name,
        "motion": motion,
        "velocity_filter": asked.velocity_filter.describe(),
        "not_covered": ready.not_covered,
        "transmission": about["passive_sustained"].transmission,
    }
    variables["spring_limit"] = (
        (),
        spring_limit(asked),
        {"units": units[0], "long_name": "stiffest spring, B = 0, that no hand takes energy out of"},
    )
    return xr.Dataset(variables, {**coordinates, "region": names}, attrs)


def _behind(device: Device, key: str) -> float:
    """What of it is on the hand's side of a transmission; nan where it is not known."""
    found = getattr(device.transmission, f"handle_{key}", 0.0)
    return float("nan") if found is None else float(found)


def _largest(mask: Any, stiffness: Any) -> float:
    rows = np.flatnonzero(mask.any(axis=1))
    return float(stiffness[rows[-1]]) if len(rows) else 0.0


_MEANINGS = {
    "passive": {"long_name": "no hand takes energy out, contact made and broken"},
    "passive_sustained": {"long_name": "no hand that keeps contact takes energy out"},
    "admissible_speed": {"long_name": "no hand up to this speed takes energy out"},
}


# What makes a Z-width large: a 2⁴ factorial design, as Colgate & Brown (1994) made on their device.


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
    speed: RealLike = SPEED,
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
    runs = []
    for run in product((0, 1), repeat=4):
        chosen = {name: levels[name][level] for name, level in zip(FACTORS, run, strict=True)}
        velocity = chosen.pop("filter")
        found = z_width(
            device.replace(**chosen), stiffness, virtual_damping, cells,
            velocity_filter=velocity, hands=hands, speed=speed,
        )  # fmt: skip
        runs.append(found["area"])
    areas, region, unit = np.reshape(runs, (2, 2, 2, 2, -1)), found["region"], found["area"].attrs
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
    signs = 2.0 * np.indices((2, 2, 2, 2)) - 1
    names, effects = [], []
    for size in range(1, 5):
        for term in combinations(range(4), size):
            names.append(" × ".join(FACTORS[axis] for axis in term))
            signed = (signs[list(term)].prod(axis=0)[..., None] * areas).reshape(16, -1)
            effects.append([fsum(runs) / 8 for runs in signed.T])  # what cancels is 0, not rounding
    return names, np.array(effects)
