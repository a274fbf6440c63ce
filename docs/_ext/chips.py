"""What a step of an emitted law costs on small chips, computed where the docs are built."""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from pathlib import Path

BENCHMARKS = Path(__file__).parent.parent.parent / "benchmarks"

SAMPLES = 500

HOW = "`python benchmarks/targets.py` in a checkout prints it where they are."


def costs(markdown: Callable[[Sequence[str], list[Sequence[str]]], str]) -> str:
    """A table for each chip; for one whose tools are not here, what is missing and how to get it."""
    if str(BENCHMARKS) not in sys.path:
        sys.path.insert(0, str(BENCHMARKS))
    try:
        import targets
    except ImportError as error:  # what the tests need is not installed
        return f"Not computed: these docs were built without {error.name}. {HOW}\n"
    parts = []
    for name in targets.TARGETS:
        parts.append(f"**{name}**\n")
        missing = targets.lacks(name)
        if missing:
            parts.append(f"Not computed: these docs were built without {', '.join(missing)}. {HOW}\n")
            continue
        try:
            parts.append(markdown(targets.HEAD, list(targets.rows(name, SAMPLES))))
        except (AssertionError, OSError) as error:
            reason = str(error).strip().split("\n")[-1]
            parts.append(f"Not computed: the emulator failed where these docs were built ({reason}). {HOW}\n")
    return "\n".join(parts)
