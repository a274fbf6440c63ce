"""What the checker reads out of a document, for tests that look inside."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import Any

from zwidth.checker.arm.cells import constant
from zwidth.checker.arm.region import Claim, claim_of
from zwidth.checker.document.fields import Read
from zwidth.checker.document.file import read_document
from zwidth.checker.kinds import fields_of, kind_of
from zwidth.checker.loop.loop import Loop, loop_of


def read(document: Mapping[str, Any]) -> Read:
    """The document as its kind declares it."""
    return read_document(fields_of(kind_of(document)), document)[0]


def loop(document: Mapping[str, Any]) -> Loop:
    """The loop of a document."""
    return loop_of(read(document).loop)


def claim(document: Mapping[str, Any]) -> Claim:
    """What is to be shown of an arm."""
    return claim_of(read(document))


def matrix_at(document: Mapping[str, Any], place: Sequence[Fraction]) -> list[list[float]]:
    """What the joints of an arm damp beyond what the wall takes, its rows from the diagonal on."""
    rows = claim(document).matrix([constant(x) for x in place])
    return [[x.middle / 2**x.bits for x in row] for row in rows]
