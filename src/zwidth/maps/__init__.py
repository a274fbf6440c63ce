"""Maps over parameters: which walls a device can render, and what makes them many."""

from zwidth.maps.boundary import stability_boundary
from zwidth.maps.factors import z_width_factors
from zwidth.maps.run import robust_boundary, z_width, z_width_certificate
from zwidth.maps.sweeps.files import load_sweep
from zwidth.maps.sweeps.run import sweep

__all__ = [
    "load_sweep",
    "robust_boundary",
    "stability_boundary",
    "sweep",
    "z_width",
    "z_width_certificate",
    "z_width_factors",
]
