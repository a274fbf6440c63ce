"""Libraries of the extra `serve`, loaded when they are used."""

from __future__ import annotations

import importlib
from typing import Any

from zwidth.errors import InputError


def library(module: str, name: str) -> Any:
    """A module of a library that may be missing.

    Parameters
    ----------
    module
        To import.
    name
        As its makers write it.
    """
    try:
        return importlib.import_module(module)
    except ImportError:
        raise InputError(
            f"{name} is not installed; pip install 'zwidth[serve]', or watch in the terminal without it"
        ) from None
