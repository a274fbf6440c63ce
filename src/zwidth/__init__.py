"""Which virtual walls a haptic device can render without generating energy, proved."""

import sys

from zwidth.lazy import ABOVE, PublicRooms, attach

__getattr__, __dir__, __all__ = attach(__name__)
sys.meta_path.insert(0, PublicRooms(__name__))
ABOVE["plots"] = "zwidth.show.plots"

__version__ = "0.1.0"
