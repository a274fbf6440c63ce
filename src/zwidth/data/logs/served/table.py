"""A recording as the table of a log: when a sample was taken, the position as read, the force given.

A row whose sample had no good answer has no position: nothing was read.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from zwidth.data.logs.block import Finding
from zwidth.data.logs.served.contents import COLUMNS, Head, rows_lost
from zwidth.data.logs.served.mcap import mcap_parts
from zwidth.data.logs.table import PIECE, Table, Values

GOOD = 0.0
"""The status of a sample that was read."""


def served_table(path: Path, head: Head) -> Table:
    """The table of a recording; its columns are known by what they are called."""
    position, force = COLUMNS[head.motion]
    hand = force.replace("force", "hand_force")  # only a simulated device tells it
    known: dict[str, Any] = {
        key: head.about[key] for key in ("resolution_m", "resolution_rad") if key in head.about
    }
    table = Table(
        source=str(path),
        units=dict.fromkeys(head.columns),
        read=lambda names: _read(path, head, names, table.notes),
        attributes={"motion": head.motion, **known},
        means={
            "time": "time_s",
            "position": position,
            "hand_force": hand if hand in head.columns else None,
            "actuator_force": force,
        },
    )
    return table


def _read(
    path: Path, head: Head, names: tuple[str, ...], notes: dict[str, Finding]
) -> Iterator[tuple[Values, ...]]:
    chosen = [head.columns.index(name) for name in names]
    waiting: list[Any] = []
    last, lost = False, 0
    for part in mcap_parts(path, head):
        waiting.append(_with_gaps(part.rows, head)[:, chosen])
        lost += rows_lost(part.events)
        last = part.last
        if sum(map(len, waiting)) >= PIECE // 4:
            yield tuple(np.concatenate(waiting).T)
            waiting = []
    if waiting:
        yield tuple(np.concatenate(waiting).T)
    if not last:
        notes["cut"] = Finding(kind="cut off", text="the recording has no end: it was cut off there")
    if lost:
        text = f"{lost} rows were lost while recording, because the disk or the processor was too slow"
        notes["lost"] = Finding(kind="rows lost", text=text, samples=lost)


def _with_gaps(rows: Any, head: Head) -> Any:
    """Nothing was read where there was no good answer."""
    silent = rows[:, head.columns.index("status")] != GOOD
    if silent.any():
        rows = rows.copy()
        rows[silent, head.columns.index(COLUMNS[head.motion][0])] = np.nan
    return rows
