"""A motion against laws in a chain re-counted: positions and the forces that were held, exactly.

    energy out = −Σ f Δx − Σ c(Δx)

The forces are those that the document lists.  That the law gives them is not checked here:
this needs the law.
"""

from __future__ import annotations

from fractions import Fraction

from ..document.fields import Flag, Read, Record, Words, document, numbers
from ..document.refusal import Invalid
from ..document.unit import FORCE, LENGTH
from ..loop.motion import REPEAT, TOLD
from .bounds import BOUNDS, require_within
from .law import LOSSES, losses_of

MOST_POSITIONS = 100_000
MOST_WORDS = 10_000
MOST_PARAMETERS = 100_000

TOLD_LAW = Record(
    {
        "description": Words(MOST_WORDS),
        "specification": Words(MOST_PARAMETERS, default="", shown=False),
        "counts_force_limit": Flag(shown=False),
        "counts_force_resolution": Flag(shown=False),
    }
)
"""What is said of laws in a chain, and their parameters for who has the law: the proof is of the table, or of
the forces, and not of these words."""

ROW_MOTION = document(
    {
        "loop": LOSSES,
        "law": TOLD_LAW,
        "bounds": BOUNDS,
        **TOLD,
        "repeats": REPEAT,
        "positions": numbers(LENGTH, least=2, most=MOST_POSITIONS, shown=False),
        "forces": numbers(FORCE, least=1, most=MOST_POSITIONS, shown=False),
    }
)


def row_motion_energy(told: Read) -> tuple[Fraction, Fraction]:
    """Energy the hand takes out over the motion, and by one more round of its cycle [J].

    `repeats` names the part that is done `times` times; it must return to where it began.
    """
    losses = losses_of(told.loop)
    if losses.part < 1:
        raise Invalid("laws in a chain are checked for delays of whole samples")
    x, forces = told.positions, told.forces
    if len(forces) != len(x) - 1:
        raise Invalid("there must be one force for each move")
    require_within(told.bounds, losses, x, ())
    first, last, times = closed_cycle(told.repeats, x)

    def taken(begin: int, end: int) -> Fraction:
        moves = ((forces[k], x[k + 1] - x[k]) for k in range(begin, end))
        return -sum((f * d + losses.lost(d, losses.part) for f, d in moves), Fraction(0))

    gain = taken(first, last)
    return taken(0, first) + times * gain + taken(last, len(x) - 1), gain


def closed_cycle(part: Read, x: list[Fraction]) -> tuple[int, int, int]:
    """First and last sample of the part that is repeated, and how often; it returns to where it began."""
    first, last, times = part.first, part.last, part.times
    if not first < last < len(x) or x[first] != x[last]:
        raise Invalid("the repeated part must lie in the motion and return to where it began")
    return first, last, times
