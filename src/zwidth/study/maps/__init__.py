"""Maps over parameters: which walls a device can render, and what makes them many."""

from zwidth.study.maps.lines import stability_boundary
from zwidth.study.maps.run import robust_boundary, z_width, z_width_certificate
from zwidth.study.maps.z_width import z_width_factors

__all__ = ["robust_boundary", "stability_boundary", "z_width", "z_width_certificate", "z_width_factors"]
