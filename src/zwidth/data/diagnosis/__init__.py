"""Why did it shake?  From one recording of a vibration to its cause, and to the one number to change."""

from zwidth.lazy import attach

__getattr__, __dir__, __all__ = attach(__name__)
