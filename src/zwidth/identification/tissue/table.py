"""A table of text, in lines or in HTML."""

from __future__ import annotations

from html import escape


def lines_of(table: list[list[str]]) -> list[str]:
    """One line per row, columns aligned."""
    widths = [max(len(row[i]) for row in table) for i in range(len(table[0]))]
    return ["  ".join(c.ljust(w) for c, w in zip(row, widths, strict=True)).rstrip() for row in table]


def html_of(table: list[list[str]]) -> str:
    """The first row as the head."""
    head, *lines = ["".join(f"<td>{escape(cell)}</td>" for cell in row) for row in table]
    body = "".join(f"<tr>{line}</tr>" for line in lines)
    return f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"
