"""What a person waits for, with a progress bar once it has taken over a second."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import TYPE_CHECKING, Any, ParamSpec, TypeVar

import zwidth.traces.accessor  # noqa: F401 - gives every trace its `.zwidth`
from zwidth.bench import bench as _bench
from zwidth.identification import recording as _recording
from zwidth.loop import batch as _batch
from zwidth.loop import simulate as _simulate
from zwidth.passivity.bracket import passive_limit as _limit
from zwidth.passivity.storage import solution as _storage
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


def falling(progress: Callable[[int, int], None]) -> Callable[[int], None]:
    """Progress for a number that falls to 0, not always steadily: the most there were, less what is left."""
    most = 0

    def report(left: int) -> None:
        nonlocal most
        most = max(most, left)
        progress(most - left, most)

    return report


@wraps(_storage.available_storage)
def available_storage(*args: Any, **kwargs: Any) -> _storage.AvailableStorage:
    """As in `passivity`, with a bar of the states that no longer improve."""
    if "progress" in kwargs:
        return _storage.available_storage(*args, **kwargs)
    with progress_bar("states") as progress:
        return _storage.available_storage(*args, progress=falling(progress), **kwargs)


if TYPE_CHECKING:  # a decorator keeps one of several signatures
    from zwidth.bench.bench import compare as compare
    from zwidth.loop.simulate import simulate as simulate
else:
    compare = _with_bar(_bench.compare, "laws")
    simulate = _with_bar(_simulate.simulate, "samples")
simulate_batch = _with_bar(_batch.simulate_batch, "loops")
passive_limit = _with_bar(_limit, "loops")
identify = _with_bar(_recording.identify, "samples")
