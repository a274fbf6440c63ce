"""How the step functions are compiled.

They take scalars and float64 arrays, neither allocate nor raise, and are the
same for the processor and for CUDA, which compiles what this decorator wraps.
Rounding is that of the source: no contraction, no reassociation, so that one
loop and a thousand side by side give the same bits.

What is kept on disk is keyed by the file of each function alone, although one
function holds the code of all that it calls.  So whatever is older than the
youngest source beside it is thrown away first.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any, TypeVar, cast

import numpy as np
from numba import njit
from numpy.typing import NDArray

Array = NDArray[np.float64]


_PACKAGE = Path(__file__).parent

_TOGETHER = (
    ("elementary", "scene", "rendering", "loop", "links", "network", "servo"),
    ("passivity/storage/solve",),
    ("checker/storage",),
    ("identification/tissue",),
    ("maps",),
)
"""Chapters whose functions call each other."""


def _discard_stale(chapters: tuple[str, ...]) -> None:
    folders = [_PACKAGE / chapter for chapter in chapters]
    youngest = max(path.stat().st_mtime for folder in folders for path in folder.rglob("*.py"))
    for index in (path for folder in folders for path in folder.rglob("*.nbi")):
        with suppress(OSError):
            if index.stat().st_mtime < youngest:
                index.unlink()


for _chapters in _TOGETHER:
    _discard_stale(_chapters)


def is_compiled(chapter: str) -> bool:
    """True where a chapter of the package, "loop", has been compiled before and is kept on disk."""
    return any((_PACKAGE / chapter).rglob("*.nbi"))


F = TypeVar("F", bound=Callable[..., Any])


def compiled(function: F) -> F:
    """Compile for the processor, kept on disk; the lock of Python is not held."""
    # nothing calls them by address: without the wrapper for that a tenth of the compiling is saved
    options: Any = {"cache": True, "nogil": True, "error_model": "numpy", "no_cfunc_wrapper": True}
    return cast(F, njit(**options)(function))
