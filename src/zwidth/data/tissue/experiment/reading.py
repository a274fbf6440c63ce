"""The three columns of a test from a file, in SI units as they stand in it."""

from __future__ import annotations

from collections.abc import Mapping
from os import PathLike
from pathlib import Path
from typing import NamedTuple

import numpy as np

from zwidth.data.logs.block import Finding
from zwidth.data.logs.read import table_of_file
from zwidth.data.logs.table import Table, readable, understood_sheets
from zwidth.data.tissue.experiment.columns import recognised
from zwidth.errors import InputError
from zwidth.native.compiled import Array

MOST_ROWS = 10**6
"""Of a test; more are a log of something else."""


class Raw(NamedTuple):
    """Columns in SI units as they stand in the file, the number of the trial in each row, and how many other
    trials stand beside it."""

    source: str
    time: Array
    indentation: Array
    force: Array
    trial: Array | None
    findings: tuple[Finding, ...]
    beside: int = 1


def read_tests(
    path: str | PathLike[str],
    columns: Mapping[str, str] | None = None,
    units: Mapping[str, str] | None = None,
    sheet: str | None = None,
) -> list[Raw]:
    """Every test in a file that stands beside the others, or on another sheet of a workbook; one after the
    other they are still together.
    """
    with readable(str(path)):
        table = table_of_file(Path(path), sheet)
        found = []
        for each in understood_sheets(table, lambda each: recognised(each, columns, units)):
            first = _read(each, columns, units, 1)
            found += [first, *(_read(each, columns, units, k) for k in range(2, first.beside + 1))]
    return found


def _read(
    table: Table, columns: Mapping[str, str] | None, units: Mapping[str, str] | None, number: int
) -> Raw:
    """The columns of a table; of tests side by side that of a number."""
    known = recognised(table, columns, units, number)
    names = [known.time.name, known.indentation.name, known.force.name]
    wanted = [*names, known.trial] if known.trial else names
    pieces = list(table.read(tuple(wanted)))
    whole = [np.concatenate([piece[k] for piece in pieces]) for k in range(len(wanted))]
    if not pieces or whole[0].size > MOST_ROWS:
        raise InputError(
            f"{table.source} has {len(pieces) and whole[0].size} rows; a test has 1 to {MOST_ROWS}"
        )
    return Raw(
        table.source,
        _seconds(whole[0], known.time.factor),
        whole[1].astype(float) * known.indentation.factor,
        whole[2].astype(float) * known.force.factor,
        whole[3].astype(float) if known.trial else None,
        (*known.findings, *table.notes.values()),
        known.beside,
    )


def _seconds(stamps: np.ndarray, factor: float) -> Array:
    """Dates from the first one on: a double has no room for microseconds in a year's worth of seconds."""
    if stamps.dtype.kind == "M":
        since = (stamps - stamps[0]).astype("timedelta64[ns]")
        seconds = since.astype(float) / 1e9
        seconds[np.isnat(since)] = np.nan
        return np.asarray(seconds)
    if stamps.dtype.kind in "iu":
        stamps = stamps - stamps[0]
    return np.asarray(stamps.astype(float) * factor)
