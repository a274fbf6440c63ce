"""What a person waits for, with a progress bar once it takes over a second; each loads just what it needs."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from zwidth.progress import with_bar

if TYPE_CHECKING:  # as they are, several signatures and all
    from zwidth.data.identification.device.identify import identify as identify
    from zwidth.loop.batch import simulate_batch as simulate_batch
    from zwidth.loop.simulate import simulate as simulate
    from zwidth.passivity.bracket.passive_limit import passive_limit as passive_limit
    from zwidth.passivity.storage.solution import available_storage as available_storage
    from zwidth.study.bench.bench import compare as compare

_COUNTED = {
    "available_storage": ("zwidth.passivity.storage.solution", "states", True),
    "compare": ("zwidth.study.bench.bench", "laws", False),
    "identify": ("zwidth.data.identification.device.identify", "samples", False),
    "passive_limit": ("zwidth.passivity.bracket.passive_limit", "loops", False),
    "simulate": ("zwidth.loop.simulate", "samples", False),
    "simulate_batch": ("zwidth.loop.batch", "loops", False),
}
"""By function, where it is, what is counted, and whether that falls to 0."""

_TRACED = ("compare", "simulate", "simulate_batch")


def __getattr__(name: str) -> Any:
    if name not in _COUNTED:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    if name in _TRACED:
        import_module("zwidth.loop.traces.accessor")  # gives every trace its `.zwidth`
    place, what, falls = _COUNTED[name]
    globals()[name] = found = with_bar(getattr(import_module(place), name), what, falls)
    return found
