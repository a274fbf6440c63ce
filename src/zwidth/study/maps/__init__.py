"""Maps over parameters: which walls a device can render, and what makes them many."""

from zwidth.lazy import attach

__getattr__, __dir__, __all__ = attach(__name__)
