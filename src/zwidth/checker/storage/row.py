"""A storage function over a table re-checked: laws in a row, their states and forces listed one by one.

The document lists states, each with its count and the force that acts until the next sample, and
where every reading leads.  It is checked that the list is closed: from each state every reading
on the board leads to a state of that reading; and that no move takes out more than V falls, by
the rules of `storage_proof`.  That the list is what the law does is not checked here: this needs the law.
"""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from math import ceil
from typing import Any

from ..contact.law import read_losses
from ..contact.row_motion import read_words
from ..document.reading import Invalid, get, integer, number
from .board import MOST_MOVES, MOST_VALUES, costs_of, longest_move, signed, values_of

_EXACT = 2**53
MOST_STATES = 1_000_000


def storage_of_row(document: Mapping[str, Any]) -> str:
    import numpy as np  # loaded only where a storage function is to be checked

    losses = read_losses(document)
    if losses.part < 1:
        raise Invalid("laws in a row are checked for delays of whole samples")
    read_words(document)
    domain, table = get(document, "domain"), get(document, "table")
    low, high = (signed(get(domain, k)) for k in ("lowest_count", "highest_count"))
    fastest, steps = longest_move(domain), integer(get(domain, "steps_per_count"), 1)
    reach, unit = ceil(fastest), number(get(document, "force_unit"))
    states = integer(get(table, "states"), 1)
    if high < low or unit <= 0 or reach * steps > MOST_MOVES:
        raise Invalid("the board is empty, or its moves are longer than can be checked")
    if states > MOST_STATES or states * max(2 * reach + 1, steps + 1) > MOST_VALUES:
        raise Invalid("the table is larger than can be checked")
    counts = values_of(get(table, "counts"), (states,))
    successors = values_of(get(table, "successors"), (states, 2 * reach + 1))
    _require_closed(counts, successors, low, high, reach)
    _require_starts(get(table, "starts"), states)
    forces = _in_units(values_of(get(table, "forces"), (states,), "<f8"), unit)
    value = values_of(get(document, "storage"), (states, steps + 1))
    if value.min() < 0:
        raise Invalid("a storage function must be bounded below by 0")
    costs = costs_of(losses, unit, 1, losses.part, fastest, steps)  # a force is rounded down once
    largest = int(value.max()) + int(abs(costs).max()) + max(map(abs, forces)) * (len(costs) + 1)
    if largest >= _EXACT:
        raise Invalid("the numbers are too large to be compared exactly")
    from .moves import first_violation_in_table

    at = first_violation_in_table(
        value, successors, np.array(forces, np.int64), costs.astype(np.int64), steps
    )
    if at >= 0:
        raise Invalid(f"from state {at} a move takes out more energy than was stored")
    return (
        f"no move takes out more than the storage function falls, in any of {states} states that the table "
        f"lists for readings from {low} to {high}, for moves of up to {float(fastest):.6g} counts a sample"
    )


def _require_closed(counts: Any, successors: Any, low: int, high: int, reach: int) -> None:
    """Every reading on the board leads to a state of that reading."""
    import numpy as np

    if counts.min() < low or counts.max() > high:
        raise Invalid("a state of the table is not on the board")
    then = counts[:, None] + np.arange(-reach, reach + 1)
    on_board = (then >= low) & (then <= high)
    reached = successors[on_board]
    if reached.min() < 0 or reached.max() >= len(counts) or (successors[~on_board] != -1).any():
        raise Invalid("the table is not closed: a reading on the board leads nowhere")
    if (counts[reached] != then[on_board]).any():
        raise Invalid("a reading leads to a state of another reading")


def _require_starts(starts: Any, states: int) -> None:
    if not isinstance(starts, list) or not 0 < len(starts) <= states:
        raise Invalid("the table must say where a hand may begin")
    if any(integer(s) >= states for s in starts):
        raise Invalid("the hand begins in a state that is not in the table")


def _in_units(forces: Any, unit: Fraction) -> list[int]:
    """Each force, a double and so a rational, rounded down to whole units."""
    import numpy as np

    if not np.isfinite(forces).all():
        raise Invalid("a force is no number")
    several, where = np.unique(forces, return_inverse=True)
    units = [int(Fraction(float(f)) // unit) for f in several]
    return [units[i] for i in where.ravel()]
