"""Help that fits the terminal: no option, no quoted value and no name such as `virtual-coupling` in two."""

from __future__ import annotations

import argparse
import re
from collections.abc import Iterable, Iterator

from zwidth.cli.width import columns, width_of, wrapped

_USAGE = re.compile(r"\[[^\]]*\]|-\S+ '[^']*'|-\S+ [^\s\[-]\S*|\S+")
"""What of a usage line stays together: what stands in brackets, and an option with its value."""

_OPTION = re.compile(r"--?[a-z][\w.-]* '[^']*'|--?[a-z][\w.-]* [^\s-]\S*|\S+")
"""The same of an example."""

_ON = " \\"
"""Where it ends a line, a shell reads on in the next."""


class Help(argparse.RawDescriptionHelpFormatter):
    """The help of every command, in the columns of a report."""

    def __init__(self, prog: str) -> None:
        super().__init__(prog, width=columns())

    def _format_usage(self, usage: str | None, *rest: object) -> str:
        text = super()._format_usage(usage, *rest)  # type: ignore[arg-type]
        if usage is None:
            return text
        hanging = " " * len(f"usage: {self._prog} ")
        lines = (_filled(line, _USAGE, self._width, hanging) for line in text.strip("\n").split("\n"))
        return "\n".join("\n".join(line) for line in lines) + "\n\n"

    def _fill_text(self, text: str, width: int, indent: str) -> str:
        """Sentences as paragraphs, whatever lines they stand in; examples that a shell can read."""
        return "\n".join(f"{indent}{line}" for line in _told(_paragraphs(text), width - len(indent)))

    def _split_lines(self, text: str, width: int) -> list[str]:
        return [*wrapped(" ".join(text.split()), width)]


def _told(paragraphs: Iterable[str], width: int) -> Iterator[str]:
    for text in paragraphs:
        yield from (
            _filled(text, _OPTION, width, " " * 6, _ON) if text[:9] == "  zwidth " else wrapped(text, width)
        )


def _paragraphs(text: str) -> Iterator[str]:
    """Lines that belong together in one; what is set in is a line of its own."""
    so_far = ""
    for line in text.split("\n"):
        if so_far and line and not line.startswith(" ") and not so_far.startswith(" "):
            so_far += f" {line}"
            continue
        if so_far:
            yield so_far
        so_far = line
        if not line:
            yield ""
    yield so_far


def _filled(line: str, together: re.Pattern[str], width: int, hanging: str, on: str = "") -> Iterator[str]:
    """The line in several of at most `width` columns, each but the last ended by `on`, the others set in."""
    so_far = line[: len(line) - len(line.lstrip())]
    if width_of(line) <= width:
        yield line
        return
    room, blank = width - len(on), ""
    for piece in together.findall(line):
        joined = f"{so_far}{blank}{piece}"
        if blank and width_of(joined) > room:
            yield so_far + on
            joined = hanging + piece
        so_far, blank = joined, " "
    yield so_far
