"""One certificate, violation or motion: what the checker finds of it."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from typing import Any, NamedTuple

from .corners import corners
from .document.effort import EACH, one_document, spend
from .document.fields import Row, read_document
from .document.refusal import Invalid
from .kinds import KINDS, fields_of, kind_of
from .scope import Scope

STOPPED = "the checker stopped at something that it does not foresee"
"""Nothing is accepted then; a document that brings it there shows a fault of the checker."""


class Verified(NamedTuple):
    """What the checker found.

    Parameters
    ----------
    valid
        True if the document proves what its kind says.
    reason
        What was proved; or why it is refused.
    energy, gain
        Of a motion: what all of it takes out, and one more round of its cycle [J]; of a port, what comes out
        above the level.
    scope
        What an accepted document is about; None of one that is refused, and of corners that show different
        things.
    rows
        The numbers that entered the proof, as they are shown.
    surplus
        Of an arm, what its joints damp beyond what the wall takes, at the middle of the region: a symmetric
        matrix, its rows from the diagonal on, to rounding [of the joints, or of the hand].
    """

    valid: bool
    reason: str
    energy: Fraction | None = None
    gain: Fraction | None = None
    scope: Scope | None = None
    rows: tuple[Row, ...] = ()
    surplus: tuple[tuple[float, ...], ...] = ()


def verify(document: Mapping[str, Any]) -> Verified:
    """Check one certificate, violation or motion, given as plain JSON data; never raises for what it says."""
    try:
        with one_document():
            return _verified(document)
    except Invalid as error:
        return Verified(False, str(error))
    except MemoryError:
        return Verified(False, "the document is too large to be checked")
    except (ArithmeticError, AttributeError, LookupError, RecursionError, TypeError, ValueError) as error:
        return Verified(False, f"{STOPPED}: {type(error).__name__}: {str(error)[:200]}")


def _verified(document: Mapping[str, Any]) -> Verified:
    spend(EACH)
    if not isinstance(document, Mapping):
        raise Invalid("a document must be an object with a kind")
    if document.get("kind") == "corners":
        found, covered, (told, motion) = corners(document)
    else:
        told, motion = read_document(fields_of(kind_of(document)), document)
        found = KINDS[told.kind].check(told)
        covered = KINDS[told.kind].scope(told) if found.valid else None
    rows = tuple(fields_of(told.kind).rows("", told, motion)) if found.valid else ()
    return Verified(found.valid, found.reason, found.energy, found.gain, covered, rows, found.surplus)
