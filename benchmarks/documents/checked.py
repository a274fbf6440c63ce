"""The checker, and nothing else of it is known here."""

from __future__ import annotations

from typing import Any, NamedTuple

from zwidth.checker import verify


class Answer(NamedTuple):
    """What the checker said of a document."""

    valid: bool
    reason: str


def ask(document: Any) -> Answer:
    """The checker's answer; anything that it raises goes on."""
    if isinstance(document, dict) and document.get("kind") == "corners":
        return _corners(document)
    found = verify(document)
    return Answer(bool(found.valid), str(found.reason))


def _corners(document: dict[str, Any]) -> Answer:
    """Corners are taken apart by what reads files, and each of them is checked alone."""
    from zwidth.errors import InputError
    from zwidth.passivity.certificate import verify_document

    try:
        found = verify_document(document)
    except InputError as error:
        return Answer(False, str(error))
    return Answer(bool(found.valid), str(found.reason))
