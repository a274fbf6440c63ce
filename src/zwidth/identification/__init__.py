"""Device, hand and tissue, identified from what was recorded."""

from zwidth.identification.device.identified import Estimate, Identified
from zwidth.identification.recording import identify, log_from

__all__ = ["Estimate", "Identified", "identify", "log_from"]
