"""`zwidth.simulate` and `zwidth.simulate_batch` with a progress bar on what takes over a second."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import ParamSpec, TypeVar

import zwidth.traces.accessor  # noqa: F401 - gives every trace its `.zwidth`
from zwidth.loop import batch as _batch
from zwidth.loop import simulate as _simulate
from zwidth.traces.progress import progress_bar

P = ParamSpec("P")
R = TypeVar("R")


def _with_bar(function: Callable[P, R], what: str) -> Callable[P, R]:
    @wraps(function)
    def run(*args: P.args, **kwargs: P.kwargs) -> R:
        if "progress" in kwargs:
            return function(*args, **kwargs)
        with progress_bar(what) as progress:
            kwargs["progress"] = progress
            return function(*args, **kwargs)

    return run


simulate = _with_bar(_simulate.simulate, "samples")
simulate_batch = _with_bar(_batch.simulate_batch, "loops")
