"""Whether the libraries of the extra `explore` are here."""

from __future__ import annotations

from importlib.util import find_spec

from zwidth.errors import InputError


def need_libraries() -> None:
    """Nothing, if they are."""
    for module, name in (("panel", "Panel"), ("bokeh", "Bokeh")):
        if find_spec(module) is None:
            raise InputError(
                f"the explorer page is drawn by {name}, which is not installed: pip install 'zwidth[explore]'"
            )
