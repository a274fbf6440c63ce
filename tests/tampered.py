"""Documents that were changed by hand, for tests of the checker."""

from __future__ import annotations

from collections.abc import Sequence
from copy import deepcopy
from typing import Any


def tampered(document: Any, path: Sequence[Any], value: Any) -> Any:
    """The document with one entry, which it has, replaced."""
    changed = deepcopy(document)
    inner = changed
    for key in path[:-1]:
        inner = inner[key]
    inner[path[-1]]  # a path that leads nowhere would make the test say nothing
    inner[path[-1]] = value
    return changed
