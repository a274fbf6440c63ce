"""Storage functions as both checks of the checker see them: the fast one and its slow twin."""

from __future__ import annotations

from typing import Any, NamedTuple

from zwidth.checker.document.file import read_document
from zwidth.checker.document.refusal import Invalid, one_document
from zwidth.checker.kinds import fields_of, kind_of
from zwidth.checker.storage.plainly import FAST, PLAINLY


class Said(NamedTuple):
    """Whether a check accepts, and what it says."""

    valid: bool
    words: str


def fast(document: Any) -> Said:
    """With numpy."""
    return _said(FAST, document)


def plainly(document: Any) -> Said:
    """With the standard library alone."""
    return _said(PLAINLY, document)


def _said(checks: Any, document: Any) -> Said:
    try:
        with one_document():
            told, _ = read_document(fields_of(kind_of(document)), document)
            return Said(True, checks[told.kind](told))
    except Invalid as error:
        return Said(False, str(error))
