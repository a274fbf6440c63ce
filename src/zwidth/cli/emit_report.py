"""What was emitted, as a report in the terminal: what is proved, in which numbers, where the files are."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from rich.text import Text

from zwidth.cli.page import below, grid, headline, items, page, section
from zwidth.passivity.outcome import TOLD

if TYPE_CHECKING:
    from zwidth.firmware.emit import Emitted


def print_emitted(found: Emitted, written: Sequence[Path]) -> None:
    """Print the report on standard output.

    Parameters
    ----------
    found
        The law as text.
    written
        Where its files are.
    """
    with page() as out:
        out.print(headline(found.judged.outcome, TOLD[found.judged.outcome].terminal, found.claim))
        out.print(below(grid(_rows(found, written))))
        section(out, "assumes", items(found.beside, "dim"))


def _rows(found: Emitted, written: Sequence[Path]) -> Iterator[tuple[str, str | Text]]:
    yield "law", found.environment.describe(found.device.motion)
    yield from found.numbers
    folders = {path.parent for path in written}
    yield "written", f"{', '.join(sorted(map(str, folders)))}: {', '.join(path.name for path in written)}"
