"""What a person waits for, with a progress bar once it takes over a second; each loads just what it needs."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import ParamSpec, TypeVar

from zwidth.progress import progress_bar

P = ParamSpec("P")
R = TypeVar("R")


def with_bar(function: Callable[P, R], what: str) -> Callable[P, R]:
    """The same function, with a bar of what is counted where nobody else asks to be told of its progress."""

    @wraps(function)
    def run(*args: P.args, **kwargs: P.kwargs) -> R:
        if "progress" in kwargs:
            return function(*args, **kwargs)
        with progress_bar(what) as progress:
            kwargs["progress"] = progress
            return function(*args, **kwargs)

    return run
