"""What was emitted, as a report in the terminal: what is proved, in which numbers, where the files are."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from zwidth.cli.output import say_written
from zwidth.cli.page import Row, below, grid, headline, items, page, section
from zwidth.passivity.scope import TOLD

if TYPE_CHECKING:
    from zwidth.machine.firmware.emit import Emitted


def print_emitted(found: Emitted, written: Sequence[Path]) -> None:
    """Print the report on standard output, and where its files are."""
    with page() as out:
        out.print(headline(found.judged.outcome, TOLD[found.judged.outcome].terminal, found.claim))
        out.print(below(grid(_rows(found))))
        section(out, "assumes", items(found.beside, "dim"))
    say_written(*written)


def _rows(found: Emitted) -> Iterator[Row]:
    yield "law", found.environment.describe(found.device.motion)
    yield from found.numbers
