"""Libraries that an extra brings: imported where they are needed, else refused by one message."""

from __future__ import annotations

from importlib import import_module
from typing import Any

from zwidth.errors import InputError
from zwidth.installing import line


def library(module: str, cannot: str) -> Any:
    """A library that reads the logs of others; `cannot` begins the message where it is not installed, such as
    "a.parquet is not read: Parquet"."""
    try:
        return import_module(module)
    except ImportError:
        name = module.partition(".")[0]
        raise InputError(f"{cannot} takes {name}, which is not installed; type", line("logs")) from None


def parquet(cannot: str) -> Any:
    """What reads and writes Parquet."""
    return library("pyarrow.parquet", f"{cannot}: Parquet")
