"""The servo: a wall rendered on a device in real time, watched while it runs, recorded, and ended safely."""

from zwidth.lazy import attach

__getattr__, __dir__, __all__ = attach(__name__)
