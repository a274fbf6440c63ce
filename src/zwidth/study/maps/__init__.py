"""Maps over parameters: which walls a device can render, and what makes them many."""

from zwidth.study.maps.boundary import stability_boundary
from zwidth.study.maps.factors import z_width_factors
from zwidth.study.maps.run import robust_boundary, z_width, z_width_certificate

__all__ = ["robust_boundary", "stability_boundary", "z_width", "z_width_certificate", "z_width_factors"]
