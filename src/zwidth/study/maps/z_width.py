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
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from zwidth.errors import InputError
from zwidth.model.device import Device
from zwidth.model.environment.velocity import VelocityEstimator
from zwidth.quantity.exact import RealLike
from zwidth.quantity.glossary import GLOSSARY
from zwidth.quantity.text import to_json
from zwidth.study.chunks.layout import Layers, Place
from zwidth.study.chunks.store import computed
from zwidth.study.chunks.workers import Finished, on_cluster, on_threads
from zwidth.study.maps.chunk import compute
from zwidth.study.maps.plan import Plan, plan, spring_limit, stable_limits
from zwidth.study.maps.request import FORMAT, Request, request
from zwidth.study.maps.scopes import scopes
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
    speed: float = SPEED,
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
        Known hands by name, as for `stability`. Default: "none", "finger" and "dowel".
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
        `free_mass`, `free_damping` and `free_friction`, the lower end.

    Raises
    ------
    InputError
        If a range, a hand or the device is not one; or the store or the cluster cannot be used.
    """
    asked = request(device, stiffness, virtual_damping, cells, velocity_filter, hands)
    if workers is not None and workers < 1:
        raise InputError(f"workers must be ≥ 1, got {workers}: someone has to compute")
    if not speed > 0:
        raise InputError(f"speed must be > 0, got {speed}: a hand at rest gains nothing from any wall")
    ready = plan(asked)

    def finished(left: list[Place]) -> Finished:
        if address is None:
            return on_threads(compute, ready, left, workers)
        return on_cluster(compute, ready, left, address)

    store = None if path is None else Path(path)
    with nullcontext() if store is None else alone(store):
        layers = computed(asked.layout, finished, store, progress)
    return _dataset(asked, ready, layers, speed)


def _dataset(asked: Request, ready: Plan, layers: Layers, speed: float) -> xr.Dataset:
    motion = asked.device.motion
    axes = {
        "stiffness": asked.stiffness.values,
        "virtual_damping": asked.virtual_damping.values,
    }
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
        variables[name] = ((), float(asked.device.exact(key)), {"units": GLOSSARY[key].unit_for(motion)})
    attrs = {
        "format": FORMAT,
        "device": asked.device.name,
        "motion": motion,
        "velocity_filter": asked.velocity_filter.describe(),
        "not_covered": ready.not_covered,
    }
    variables["spring_limit"] = (
        (),
        spring_limit(asked),
        {"units": units[0], "long_name": "stiffest spring, B = 0, that no hand takes energy out of"},
    )
    return xr.Dataset(variables, {**coordinates, "region": names}, attrs)


def _largest(mask: Any, stiffness: Any) -> float:
    rows = np.flatnonzero(mask.any(axis=1))
    return float(stiffness[rows[-1]]) if len(rows) else 0.0


_MEANINGS = {
    "passive": {"long_name": "no hand takes energy out, contact made and broken"},
    "passive_sustained": {"long_name": "no hand that keeps contact takes energy out"},
    "admissible_speed": {"long_name": "no hand up to this speed takes energy out"},
}
