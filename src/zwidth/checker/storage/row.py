"""A storage function over a table re-checked: laws in a chain, their states and forces listed one by one.

The document lists states, each with its count and the force that acts until the next sample, and
where every reading leads.  It is checked that the list is closed: from each state every reading
on the grid leads to a state of that reading; and that no move takes out more than V falls, by
the rules of `grid`.  That the list is what the law does is not checked here: this needs the law.
"""

from __future__ import annotations

from fractions import Fraction
from math import ceil
from typing import Any

from ..contact.law import LOSSES, TOLD_LAW, losses_of
from ..document.fields import List, Number, Packed, Read, Record, Whole, document
from ..document.number import down
from ..document.refusal import Invalid, reserve
from .domain import DOMAIN, DOUBLE, MOST_MOVES, MOST_VALUES, costs_of, spend_moves, storage_of, values_of

_EXACT = 2**53
MOST_STATES = 1_000_000

_TABLE = Record(
    {
        "states": Whole(least=1, most=MOST_STATES),
        "starts": List(Whole(least=0, most=MOST_STATES), least=1, most=MOST_STATES),
        "counts": Packed(),
        "successors": Packed(),
        "forces": Packed(),
    },
    shown=False,
)
ROW_STORAGE = document(
    {
        "loop": LOSSES,
        "law": TOLD_LAW,
        "domain": Record(DOMAIN),
        "table": _TABLE,
        "force_unit": Number(above=0, shown=False),
        "storage": Packed(),
    }
)


def storage_of_row(told: Read) -> str:
    """Say what was proved."""
    import numpy as np  # loaded only where a storage function is to be checked

    losses, domain, table = losses_of(told.loop), told.domain, told.table
    if losses.part < 1:
        raise Invalid("laws in a chain are checked for delays of whole samples")
    low, high, states = domain.lowest_count, domain.highest_count, table.states
    max_move, steps, unit = domain.largest_move_counts, domain.steps_per_count, told.force_unit
    reach = ceil(max_move)
    if high < low or reach * steps > MOST_MOVES:
        raise Invalid("the grid is empty, or its moves are longer than can be checked")
    if states * max(2 * reach + 1, steps + 1) > MOST_VALUES:
        raise Invalid("the table is larger than can be checked")
    reserve(24 * states * (2 * reach + steps + 2))
    spend_moves(states, states, (2 * reach + 1) * steps + 1, steps + 1)
    counts = values_of(table.counts, (states,))
    successors = values_of(table.successors, (states, 2 * reach + 1))
    _require_closed(counts, successors, low, high, reach)
    if len(table.starts) > states or max(table.starts) >= states:
        raise Invalid("the hand begins in a state that is not in the table")
    forces = _in_units(values_of(table.forces, (states,), DOUBLE), unit)
    value = storage_of(told.storage, (states, steps + 1))
    costs = costs_of(losses, unit, 1, losses.part, max_move, steps)  # a force is rounded down once
    largest = int(value.max()) + int(abs(costs).max()) + max(map(abs, forces)) * (reach + 1) * steps
    if largest >= _EXACT:
        raise Invalid("the numbers are too large to be compared exactly")
    from .moves import violated_in_table

    if violated_in_table(value, successors, np.array(forces, np.int64), costs):
        raise Invalid("a move takes out more energy than was stored")
    return proved(domain, states)


def proved(domain: Read, states: int) -> str:
    """What is known of a table once every move was tried."""
    return (
        f"no move takes out more than the storage function falls, in any of {states} states that the table "
        f"lists for readings from {domain.lowest_count} to {domain.highest_count}, "
        f"for moves of up to {down(domain.largest_move_counts)} counts a sample"
    )


def _require_closed(counts: Any, successors: Any, low: int, high: int, reach: int) -> None:
    """Every reading on the grid leads to a state of that reading."""
    import numpy as np

    if counts.min() < low or counts.max() > high:
        raise Invalid("a state of the table is not on the grid")
    then = counts[:, None] + np.arange(-reach, reach + 1)
    on_grid = (then >= low) & (then <= high)
    reached = successors[on_grid]
    if reached.min() < 0 or reached.max() >= len(counts) or (successors[~on_grid] != -1).any():
        raise Invalid("the table is not closed: a reading on the grid leads nowhere")
    if (counts[reached] != then[on_grid]).any():
        raise Invalid("a reading leads to a state of another reading")


def _in_units(forces: Any, unit: Fraction) -> list[int]:
    """Each force, a double and so a rational, rounded down to whole units."""
    import numpy as np

    if not np.isfinite(forces).all():
        raise Invalid("a force is no number")
    several, where = np.unique(forces, return_inverse=True)
    units = [int(Fraction(float(f)) // unit) for f in several]
    return [units[i] for i in where.ravel()]
