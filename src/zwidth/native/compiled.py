"""How the step functions are compiled: ahead, to C, with the package.

They take scalars and contiguous arrays, do not raise, and are written in the part of Python that
`native.statements` translates.  Rounding is that of the source: no contraction, no reassociation, so that one
loop and a thousand side by side give the same bits, as do C and Python.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import Any, TypeVar, cast

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

F = TypeVar("F", bound=Callable[..., Any])


def compiled(function: F) -> F:
    """A step function: run by the library that was built of it, the lock of Python not held meanwhile.

    Where there is no library it runs as it is written.
    """
    call: Callable[..., Any] | None = None

    @wraps(function)
    def step(*arguments: Any) -> Any:
        nonlocal call
        if call is None:
            from zwidth.native.library import bound

            call = bound(function) or function
        return call(*arguments)

    step.py_func = function  # type: ignore[attr-defined]
    return cast(F, step)
