"""What a law in the loop remembers after each reading that may come next: the step of the simulator itself.

A row holds the memory of the law and, behind it, the forces of the last readings, the one that
acts in this interval first, that of the last reading last: as many as a delay keeps waiting, and one.
"""

from __future__ import annotations

import numpy as np

from zwidth.loop.kernel import commanded
from zwidth.loop.law import RESOLUTION
from zwidth.loop.plant import STATE_SIZE
from zwidth.native.compiled import Array, compiled


@compiled
def after_reading(law: Array, row: Array, waiting: int, count: int, state: Array) -> None:
    """Take one reading, in counts; the row moves on; state is scratch."""
    size = row.size - waiting
    force = commanded(state, law, row[:size], law[RESOLUTION] * count)
    for i in range(size, row.size - 1):
        row[i] = row[i + 1]
    row[row.size - 1] = force


@compiled
def after_every_reading(
    law: Array, rows: Array, counts: Array, waiting: int, lowest: int, highest: int, state: Array, out: Array
) -> None:
    """Fill in out, (rows, counts within reach, row): each row after each reading on the board.

    The middle of the second axis is the same reading once more; a reading off the board leaves
    what was there.
    """
    reach = out.shape[1] // 2
    for i in range(rows.shape[0]):
        for move in range(-reach, reach + 1):
            count = int(counts[i]) + move
            if lowest <= count <= highest:
                here = out[i, move + reach, :]
                for j in range(here.size):
                    here[j] = rows[i, j]
                after_reading(law, here, waiting, count, state)


def scratch() -> Array:
    """For `state`."""
    return np.zeros(STATE_SIZE)
