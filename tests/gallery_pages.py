"""A gallery script as its page shows it: block by block, each figure as it is when its block ends."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
from matplotlib.figure import Figure

EXAMPLES = Path(__file__).parents[1] / "examples"


def figures(name: str) -> Iterator[Figure]:
    """Runs the script; yields each figure when the block that drew it ends, and then closes it."""
    space: dict[str, Any] = {"__name__": "__main__", "__file__": str(EXAMPLES / f"{name}.py")}
    for block in _blocks((EXAMPLES / f"{name}.py").read_text(encoding="utf-8")):
        exec(compile(block, f"{name}.py", "exec"), space)
        for number in plt.get_fignums():
            yield plt.figure(number)
        plt.close("all")


def _blocks(source: str) -> Iterator[str]:
    """The code between headings `# %%`, each on the line where it stands."""
    begin = 0
    for cut in [*(match.start() for match in re.finditer(r"^# %%", source, re.M)), len(source)]:
        yield "\n" * source.count("\n", 0, begin) + source[begin:cut]
        begin = cut


def artists(figure: Figure) -> int:
    """How many artists it has: what is drawn after the end of the block is never seen."""
    return sum(len(axes.get_children()) for axes in figure.axes)
