"""A motion against laws in a row re-counted: positions and the forces that were held, exactly.

    energy out = −Σ f Δx − Σ c(Δx)

The forces are those that the document lists.  That the law gives them is not checked here:
this needs the law.
"""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from typing import Any

from ..document.reading import Invalid, get, integer, numbers
from .bounds import require_within
from .law import read_losses

MOST_POSITIONS = 100_000


def row_motion_energy(document: Mapping[str, Any]) -> tuple[Fraction, Fraction]:
    """Energy the hand takes out over the motion, and by one more round of its cycle [J].

    `repeats` names the part that is done `times` times; it must return to where it began.
    """
    losses = read_losses(document)
    if losses.part < 1:
        raise Invalid("laws in a row are checked for delays of whole samples")
    read_words(document)
    x, forces = (_column(document, name) for name in ("positions", "forces"))
    if len(forces) != len(x) - 1:
        raise Invalid("there must be one force for each move")
    require_within(document, losses, x, ())
    part = get(document, "repeats")
    first, last, times = (integer(get(part, k)) for k in ("first", "last", "times"))
    if not 0 <= first < last < len(x) or times < 1 or x[first] != x[last]:
        raise Invalid("the repeated part must lie in the motion and return to where it began")

    def taken(begin: int, end: int) -> Fraction:
        moves = ((forces[k], x[k + 1] - x[k]) for k in range(begin, end))
        return -sum((f * d + losses.lost(d, losses.part) for f, d in moves), Fraction(0))

    gain = taken(first, last)
    return taken(0, first) + times * gain + taken(last, len(x) - 1), gain


def read_words(document: Mapping[str, Any]) -> None:
    """What is said of laws in a row: the proof is of the table, or of the forces, and not of these words."""
    words = get(document, "law")
    if not isinstance(get(words, "description"), str):
        raise Invalid("laws in a row are described in words")
    if not all(isinstance(get(words, f"counts_force_{k}"), bool) for k in ("limit", "resolution")):
        raise Invalid("counts_force_limit and counts_force_resolution must be true or false")


def _column(document: Mapping[str, Any], name: str) -> list[Fraction]:
    keys = [k for k in document if k.startswith(f"{name}_")]
    if len(keys) != 1:
        raise Invalid(f"{name} must be given once")
    return numbers(document[keys[0]], MOST_POSITIONS)
