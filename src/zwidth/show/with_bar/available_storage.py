"""`zwidth.available_storage`: the states that no longer improve are counted."""

from __future__ import annotations

from functools import wraps
from typing import Any

from zwidth.passivity.storage import solution as _storage
from zwidth.progress import falling, progress_bar


@wraps(_storage.available_storage)
def available_storage(*args: Any, **kwargs: Any) -> _storage.AvailableStorage:
    """As in `passivity`, with a bar of the states that no longer improve."""
    if "progress" in kwargs:
        return _storage.available_storage(*args, **kwargs)
    with progress_bar("states") as progress:
        return _storage.available_storage(*args, progress=falling(progress), **kwargs)
