"""One trial of a spreadsheet, in order, without rows that lack a number and stamps that come twice."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from zwidth.data.logs.block import Finding
from zwidth.data.tissue.experiment.reading import Raw
from zwidth.errors import InputError
from zwidth.native.compiled import Array

FEWEST = 12
"""Samples below which nothing is fitted."""

BACK = 0.5
"""Of the time of a trial by which a stamp falls back where the next trial begins."""


class Trial(NamedTuple):
    """Times that increase from 0, indentation and force as they stand in the file [s], [m], [N]."""

    time: Array
    indentation: Array
    force: Array
    findings: tuple[Finding, ...]


def one_trial(raw: Raw, number: int = 1) -> Trial:
    """The trial of a number from 1, of those that come one after the other."""
    said = list(raw.findings)
    parts, gone = _parts(raw)
    if gone:
        text = f"{gone} of {raw.time.size} rows lack a number and are left out"
        said.append(Finding(kind="missing", text=text, samples=gone))
    part, more = _in_order(parts[number - 1])
    said.extend(more)
    if part.shape[1] < FEWEST:
        raise InputError(
            f"{raw.source}: {part.shape[1]} samples are left; a fit of a tissue needs {FEWEST} at the least"
        )
    return Trial(part[0] - part[0, 0], part[1], part[2], tuple(said))


def places(raws: list[Raw]) -> list[tuple[Raw, int]]:
    """Every trial: where it stands, and its number there."""
    return [(raw, k + 1) for raw in raws for k in range(len(_parts(raw)[0]))]


def _parts(raw: Raw) -> tuple[list[Array], int]:
    """The rows of each trial, and how many rows lack a number."""
    table = np.stack([raw.time, raw.indentation, raw.force])
    finite = np.isfinite(table).all(axis=0)
    label = None if raw.trial is None else raw.trial[finite]
    return _trials(table[:, finite], label), int(np.count_nonzero(~finite))


def _trials(table: Array, label: Array | None) -> list[Array]:
    """Cut where the label changes, or where the time falls back by much of a trial."""
    if not table.shape[1]:
        return [table]
    if label is not None and np.unique(label).size > 1:
        cuts = np.flatnonzero(np.diff(label) != 0) + 1
    else:
        time = table[0]
        cuts_list, begin = [], 0
        for k in (np.flatnonzero(np.diff(time) < 0) + 1).tolist():
            if time[k - 1] - time[k] > BACK * (time[k - 1] - time[begin]):
                cuts_list.append(k)
                begin = k
        cuts = np.array(cuts_list, dtype=int)
    return [part for part in np.split(table, cuts, axis=1) if part.shape[1]]


def _in_order(part: Array) -> tuple[Array, Iterator[Finding]]:
    """Sorted by time, and of samples with one stamp the mean."""
    said = []
    if (np.diff(part[0]) < 0).any():
        out = int(np.count_nonzero(np.diff(part[0]) < 0))
        said.append(Finding(kind="order", text=f"{out} stamps go back: the rows are sorted", samples=out))
        part = part[:, np.argsort(part[0], kind="stable")]
    stamps, where, counts = np.unique(part[0], return_inverse=True, return_counts=True)
    if stamps.size < part.shape[1]:
        same = part.shape[1] - stamps.size
        text = f"{same} rows repeat the stamp before: of such samples the mean is taken"
        said.append(Finding(kind="repeated", text=text, samples=same))
        means = [np.bincount(where.ravel(), weights=column) / counts for column in part[1:]]
        part = np.stack([stamps, *means])
    return part, iter(said)
