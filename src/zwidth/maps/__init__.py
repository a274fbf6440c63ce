"""Maps over parameters: which walls a device can render."""

from zwidth.maps.z_width import z_width

__all__ = ["z_width"]
