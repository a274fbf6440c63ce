"""What made a report: the versions of everything that had a part in it."""

from __future__ import annotations

from importlib.metadata import version
from platform import python_version

_LIBRARIES = ("matplotlib", "numpy", "python-flint", "scipy")


def versions(*more: str) -> list[tuple[str, str]]:
    """(name, version) of zwidth, Python and the libraries; `more` are those of one kind of file."""
    return [
        ("zwidth", version("zwidth")),
        ("Python", python_version()),
        *((name, version(name)) for name in sorted((*_LIBRARIES, *more))),
    ]
