"""A map with a progress bar, once it has taken over a second."""

from __future__ import annotations

from functools import wraps
from typing import Any

import xarray as xr

from zwidth.maps import z_width as _map
from zwidth.traces.progress import progress_bar


@wraps(_map.z_width)
def z_width(*args: Any, **kwargs: Any) -> xr.Dataset:
    """As in `maps.z_width`, with a bar of the chunks."""
    if "progress" in kwargs:
        return _map.z_width(*args, **kwargs)
    with progress_bar("chunks") as progress:
        return _map.z_width(*args, progress=progress, **kwargs)
