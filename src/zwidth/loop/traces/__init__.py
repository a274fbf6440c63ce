"""What people do with a trace: look, listen, save, load, compare."""

from importlib import import_module
from typing import Any

from zwidth.lazy import attach

_found, __dir__, __all__ = attach(__name__)


def __getattr__(name: str) -> Any:
    """A public name; with the first of them every trace gets its `.zwidth`, and xarray is loaded."""
    if name in __all__:
        import_module("zwidth.loop.traces.accessor")
    return _found(name)
