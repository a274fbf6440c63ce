"""The passive region of a map, column by column, as certificates that anyone can check.

    b ≥ (2d + 1) K T/2 + |B| Σ|w_j|   and   f_c ≥ (K + |B| ‖h_v‖₁) Δ/2

At one B both right sides grow with K, and so does what a delay of part of a sample asks for: what holds
at the largest K said to be passive holds at all 0 ≤ K below it.  So one certificate of that wall covers
its column.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np

from zwidth.errors import InputError
from zwidth.model.device import Device
from zwidth.model.environment import BackwardDifference, Wall
from zwidth.model.environment.velocity import VelocityEstimator
from zwidth.passivity.certificate import Certificate
from zwidth.passivity.check import check

if TYPE_CHECKING:
    import xarray as xr


def z_width_certificate(
    device: Device,
    found: xr.Dataset,
    *,
    velocity_filter: VelocityEstimator | None = None,
    progress: Callable[[int, int], None] = lambda done, total: None,
) -> Certificate | None:
    """The certificate of the stiffest passive wall of each virtual damping; None where no cell is passive.

    Each of its documents is accepted by the independent checker, and with it every softer wall of its column
    is passive, contact made and broken.

    Parameters
    ----------
    device
        Of the map.
    found
        A map as `z_width` returns it.
    velocity_filter
        Of the map. Default: the backward difference.
    progress
        Is told how many columns are done, and of how many.

    Raises
    ------
    InputError
        If a wall said to be passive is not proved so: the map is of another device or filter.
    """
    velocity = BackwardDifference() if velocity_filter is None else velocity_filter
    passive = found["passive"].transpose("stiffness", "virtual_damping").values
    columns = np.flatnonzero(passive.any(axis=0))
    documents: list[dict[str, Any]] = []
    for done, column in enumerate(columns, start=1):
        k = float(found["stiffness"][np.flatnonzero(passive[:, column])[-1]])
        b = float(found["virtual_damping"][column])
        documents += _documents(device, Wall(k, b, velocity))
        progress(done, len(columns))
    return Certificate(tuple(documents)) if documents else None


def _documents(device: Device, wall: Wall) -> tuple[dict[str, Any], ...]:
    verdict = check(device, wall, iterate=False)
    if verdict.certificate is None or verdict.outcome != "passive":
        raise InputError(
            f"the map says that {wall.describe(device.motion)} is passive, and of this device that is not "
            "proved: it is a map of another device or velocity filter"
        )
    return verdict.certificate.documents
