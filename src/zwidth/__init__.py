"""Which virtual walls a haptic device can render without generating energy, proved."""

from zwidth.lazy import ABOVE, attach

__getattr__, __dir__, __all__ = attach(__name__)
ABOVE["plots"] = "zwidth.show.plots"
