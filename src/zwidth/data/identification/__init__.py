"""Device, hand and tissue, identified from what was recorded."""

from zwidth.lazy import attach

__getattr__, __dir__, __all__ = attach(__name__)
