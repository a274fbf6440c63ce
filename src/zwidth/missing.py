"""A file that is not there: which of those beside it may have been meant?"""

from __future__ import annotations

import os
from collections.abc import Iterable
from difflib import get_close_matches
from itertools import islice
from pathlib import Path

_MOST = 2000
"""Files of a folder that are looked at."""


def near_file(path: Path, others: Iterable[str] = ()) -> str | None:
    """The name nearest to that of a missing file; None where none is near.

    Parameters
    ----------
    path
        What is not there. Files beside it count that end as it does, .toml where it has no ending.
    others
        What may have been meant as well and is no file.
    """
    ending = path.suffix or ".toml"
    known = {name.removesuffix(ending): str(path.with_name(name)) for name in _beside(path, ending)}
    named = {name: name for name in others} | known
    near = get_close_matches(path.name.removesuffix(ending)[:100], list(named), n=1)
    return named[near[0]] if near else None


def did_you_mean(path: Path) -> str:
    """The end of a message about a missing file: "; did you mean …?", or nothing."""
    near = near_file(path)
    return "" if near is None else f'; did you mean "{near}"?'


def _beside(path: Path, ending: str) -> list[str]:
    try:
        with os.scandir(path.parent) as entries:
            return sorted(e.name for e in islice(entries, _MOST) if e.name.endswith(ending))
    except (OSError, ValueError):
        return []
