"""A table of text, in lines or in HTML."""

from __future__ import annotations

from zwidth.showing import Html, table


def lines_of(table: list[list[str]]) -> list[str]:
    """One line per row, columns aligned."""
    widths = [max(len(row[i]) for row in table) for i in range(len(table[0]))]
    return ["  ".join(c.ljust(w) for c, w in zip(row, widths, strict=True)).rstrip() for row in table]


def html_of(lines: list[list[str]]) -> Html:
    """The first row as the head."""
    return table(lines[0], lines[1:])
