"""The evidence in words: what each document shows, that the checker accepts it, and what it read there."""

from __future__ import annotations

from collections.abc import Iterator

from zwidth.checker import Verified, verify
from zwidth.passivity.result import EVIDENCE, Answer, Evidence
from zwidth.passivity.verdict import Verdict
from zwidth.quantity.text import in_words
from zwidth.showing import Part, Table

_NAMES = {
    "certificate": "The certificate",
    "violation": "The proof that energy comes out",
    "witness": "The motion",
}

_REFEREE = (
    "The independent checker, which shares no code with what found it, computes in exact arithmetic and"
)

_LONGEST = 40
"""Characters of one of them that are shown; the document has all."""

_MOST_ROWS = 24
"""Numbers that entered the proof up to which each is shown."""


def checked(verdict: Answer) -> Iterator[Part]:
    """On what the outcome stands, piece by piece; what the checker read is told once."""
    if isinstance(verdict, Verdict):
        yield f"Decided by: {verdict.decided_by}."
    pieces = list(_pieces(verdict))
    if not pieces:
        yield "There is no document of it that the checker could read."
    told: list[tuple[tuple[str, str], ...]] = []
    for name, piece in pieces:
        found = verify(piece.to_dict())
        said = "accepts it" if found.valid else "rejects it"
        yield f"{name}: {piece.describe()}. {_REFEREE} {said}: {found.reason}."
        rows = _rows(found)
        if 0 < len(rows) <= _MOST_ROWS and rows not in told:
            told.append(rows)
            yield Table(rows=rows, caption="What the checker read")


def _pieces(verdict: Answer) -> Iterator[tuple[str, Evidence]]:
    for name in EVIDENCE:
        piece = getattr(verdict, name, None)
        if piece is not None:
            yield _NAMES[name], piece
    bounded = getattr(verdict, "available_storage", None)
    if bounded is not None and bounded.certificate is not None:
        yield "The certificate for bounded hands", bounded.certificate


def _rows(found: Verified) -> tuple[tuple[str, str], ...]:
    return tuple(
        (in_words(row.name), f"{_shortened(row.text)} {row.unit}".rstrip())
        for row in found.rows
        if not row.told
    )


def _shortened(text: str) -> str:
    return text if len(text) <= _LONGEST else f"{text[:_LONGEST]}…"
