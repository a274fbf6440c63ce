"""The evidence in words: what each document shows, and that the checker accepts it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from zwidth.checker import EVIDENCE, Verified, verify
from zwidth.passivity.result import Answer, Evidence
from zwidth.passivity.verdict import Verdict
from zwidth.showing import Part

NAME = "verdict.json"
"""What the attached document is called."""

_NAMES = {
    "certificate": "The certificate",
    "violation": "The proof that energy comes out",
    "witness": "The motion",
}

_REFEREE = (
    "The independent checker, which shares no code with what found it, computes in exact arithmetic and"
)


class Examined(NamedTuple):
    """A document of the evidence: what it is called, what it shows, and what the checker found."""

    name: str
    shows: str
    found: Verified


def examined(verdict: Answer) -> list[Examined]:
    """Every piece of the evidence, read by the checker."""
    return [Examined(name, piece.describe(), verify(piece.to_dict())) for name, piece in _pieces(verdict)]


def checked(verdict: Answer, pieces: Sequence[Examined]) -> Iterator[Part]:
    """On what the outcome stands, piece by piece."""
    if isinstance(verdict, Verdict):
        yield f"Decided by: {verdict.decided_by}."
    if not pieces:
        yield "There is no document of it that the checker could read."
    for name, shows, found in pieces:
        said = "accepts it" if found.valid else "rejects it"
        yield f"{name}: {shows}. {_REFEREE} {said}: {found.reason}."


def _pieces(verdict: Answer) -> Iterator[tuple[str, Evidence]]:
    for name in EVIDENCE:
        piece = getattr(verdict, name, None)
        if piece is not None:
            yield _NAMES[name], piece
    bounded = getattr(verdict, "available_storage", None)
    if bounded is not None and bounded.certificate is not None:
        yield "The certificate for bounded hands", bounded.certificate
