"""Which check of a storage function is made: the fast one, or its slow twin where it cannot be."""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module

from ..document.fields import Read
from .coarse import coarse_storage
from .grid import storage
from .plainly import coarse_storage_plainly, row_storage_plainly, storage_plainly
from .row import storage_of_row

Check = Callable[[Read], str]

PLAINLY: dict[str, Check] = {
    "storage": storage_plainly,
    "coarse storage": coarse_storage_plainly,
    "row storage": row_storage_plainly,
}
"""With the standard library alone."""
FAST: dict[str, Check] = {
    "storage": storage,
    "coarse storage": coarse_storage,
    "row storage": storage_of_row,
}


def checked(told: Read) -> str:
    """Say what was proved."""
    return (FAST if _is_fast() else PLAINLY)[told.kind](told)


def _is_fast() -> bool:
    """True where what the fast checks need can be imported."""
    try:
        import_module("numpy")
    except ImportError:
        return False
    return True
