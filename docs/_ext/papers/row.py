"""A row of a paper's table."""

from __future__ import annotations

from typing import NamedTuple

PAGE = "gallery/plot_"
"""Where the gallery's pages are, seen from `docs/theory/`."""


class Row(NamedTuple):
    """A figure, table or statement: where it stands, what it claims, what is computed, whether both agree."""

    place: str
    claim: str
    found: str
    answer: str


def row(place: str, claim: str, found: str, agrees: bool | None, remark: str = "") -> Row:
    """The answer, then a remark, where there is one to make; None: it cannot be told."""
    word = "not to be told" if agrees is None else "yes" if agrees else "**no**"
    return Row(place, claim, found, f"{word}: {remark}" if remark else word)


def drawn(name: str, text: str = "drawn") -> str:
    """A link to the gallery's page of that name."""
    return f"[{text}]({PAGE}{name})"


def close(one: float, other: float, part: float = 1e-9) -> bool:
    """Equal but for rounding."""
    return abs(one - other) <= part * max(abs(one), abs(other))
