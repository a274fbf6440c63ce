"""A word to people who wait for the compiler."""

from __future__ import annotations

import sys


def warn_of_compiling() -> None:
    """Say that the simulator is being compiled, where it has not been yet."""
    from zwidth.loop.compiled import is_compiled

    if not is_compiled() and sys.stderr is not None:
        print("zwidth: compiling the simulator, once; this takes some seconds", file=sys.stderr)
