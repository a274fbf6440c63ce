"""A map and its certificates with a progress bar, once they have taken over a second."""

from __future__ import annotations

from functools import wraps
from typing import Any

import xarray as xr

from zwidth.passivity.certificate import Certificate
from zwidth.progress import progress_bar
from zwidth.study.maps import certificates as _certificates
from zwidth.study.maps import robust as _robust
from zwidth.study.maps import z_width as _map


@wraps(_map.z_width)
def z_width(*args: Any, **kwargs: Any) -> xr.Dataset:
    """As in `maps.z_width`, with a bar of the chunks."""
    if "progress" in kwargs:
        return _map.z_width(*args, **kwargs)
    with progress_bar("chunks") as progress:
        return _map.z_width(*args, progress=progress, **kwargs)


@wraps(_robust.robust_boundary)
def robust_boundary(*args: Any, **kwargs: Any) -> xr.Dataset:
    """As in `maps.robust`, with a bar of the points."""
    if "progress" in kwargs:
        return _robust.robust_boundary(*args, **kwargs)
    with progress_bar("points") as progress:
        return _robust.robust_boundary(*args, progress=progress, **kwargs)


@wraps(_certificates.z_width_certificate)
def z_width_certificate(*args: Any, **kwargs: Any) -> Certificate | None:
    """As in `maps.certificates`, with a bar of the columns."""
    if "progress" in kwargs:
        return _certificates.z_width_certificate(*args, **kwargs)
    with progress_bar("columns") as progress:
        return _certificates.z_width_certificate(*args, progress=progress, **kwargs)
