"""How the step functions are compiled.

They take scalars and float64 arrays, neither allocate nor raise, and are the
same for the processor and for CUDA, which compiles what this decorator wraps.
Rounding is that of the source: no contraction, no reassociation, so that one
loop and a thousand side by side give the same bits.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar, cast

import numpy as np
from numba import njit
from numpy.typing import NDArray

Array = NDArray[np.float64]

F = TypeVar("F", bound=Callable[..., Any])


def compiled(function: F) -> F:
    """Compile for the processor, kept on disk; the lock of Python is not held."""
    return cast(F, njit(cache=True, nogil=True, error_model="numpy")(function))
