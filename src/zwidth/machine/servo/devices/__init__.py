"""The devices that can be served, a file each."""

from zwidth.lazy import attach

__getattr__, __dir__, __all__ = attach(__name__)
