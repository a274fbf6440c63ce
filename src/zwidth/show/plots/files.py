"""A picture as a file: the same picture gives the same bytes."""

from __future__ import annotations

from collections.abc import Callable
from io import BytesIO
from pathlib import Path
from typing import Any

from matplotlib import rc_context
from matplotlib.figure import Figure
from matplotlib.text import Text

from zwidth.errors import InputError
from zwidth.showing import OBEYED, printable
from zwidth.writing import check_target, writing_whole

ENDINGS = ("png", "svg", "pdf")

_METADATA: dict[str, dict[str, Any]] = {
    "png": {},
    "svg": {"Date": None},
    "pdf": {"CreationDate": None},
}
"""No date in a file."""


def save_figure(draw: Callable[[], Figure], path: str | Path, overwrite: bool = False) -> None:
    """Draw and write to a file; its ending, png, svg or pdf, says how.

    Raises
    ------
    InputError
        If the ending is another one, the file exists, or it cannot be written.
    """
    target = Path(path)
    ending = target.suffix.removeprefix(".").lower()
    if ending not in ENDINGS:
        raise InputError(
            f"a picture is written as .png, .svg or .pdf, got {target.name!r}; for example check.png"
        )
    check_target(target, overwrite, "overwrite=True")
    picture = encoded(draw(), ending)
    with writing_whole(target) as file:
        file.write(picture)


def encoded(figure: Figure, ending: str, dpi: float = 160) -> bytes:
    """The figure as a file of one of `ENDINGS`."""
    picture = BytesIO()
    with rc_context({"svg.hashsalt": "zwidth"}):
        _printable(figure).savefig(picture, format=ending, dpi=dpi, metadata=_METADATA[ending])
    return picture.getvalue()


def _printable(figure: Figure) -> Figure:
    """No control characters, of which an SVG must have none."""
    for text in figure.findobj(Text):
        if OBEYED.search(text.get_text()):
            text.set_text(printable(text.get_text()))
    return figure
