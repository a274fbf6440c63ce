"""The checker, and nothing else of it is known here."""

from __future__ import annotations

from typing import Any, NamedTuple

from zwidth.checker import STOPPED, verify


class Answer(NamedTuple):
    """What the checker said of a document."""

    valid: bool
    reason: str


def ask(document: Any) -> Answer:
    """The checker's answer; anything that it raises goes on.

    Raises
    ------
    RuntimeError
        If the checker stopped at something that it does not foresee.
    """
    found = verify(document)
    if found.reason.startswith(STOPPED):
        raise RuntimeError(found.reason)
    return Answer(bool(found.valid), str(found.reason))
