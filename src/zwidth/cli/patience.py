"""A word to people who wait for the compiler."""

from __future__ import annotations

import sys
from pathlib import Path


def warn_of_compiling() -> None:
    """Say that the simulator is being compiled, where it has not been yet."""
    from zwidth.loop.compiled import is_compiled

    if not is_compiled():
        _say("compiling the simulator")


def warn_of_compiling_the_game() -> None:
    """Say that the game of the worst hand is being compiled, where it has not been yet."""
    from zwidth.passivity.worst_hand import sweep

    if not any((Path(sweep.__file__).parent / "__pycache__").glob("sweep.sweep*.nbi")):
        _say("compiling the game of the worst hand")


def _say(what: str) -> None:
    if sys.stderr is not None:
        print(f"zwidth: {what}, once; this takes some seconds", file=sys.stderr)
