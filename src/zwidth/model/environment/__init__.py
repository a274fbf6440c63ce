"""What the hand meets: walls, solids, transfer functions; contacts and springs that are not linear."""

from zwidth.lazy import attach

__getattr__, __dir__, __all__ = attach(__name__)
