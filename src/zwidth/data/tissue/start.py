"""Where a fit begins: the best of many relaxation times, the springs by least squares.

With the rates 1/τᵢ given, the force is linear in K, B and the μᵢ, all ≥ 0.  So a grid of rates is tried, one
branch after the other, each the one that leaves the least; that needs no guess from a person.
"""

from __future__ import annotations

import numpy as np

from zwidth.data.tissue.model import Model, Record
from zwidth.errors import InputError
from zwidth.model.environment.modes import decaying
from zwidth.native.compiled import Array

RATES = 25
"""In the grid, from a third of one per record to the fastest that samples show."""

MOST_ROWS = 4000
STARTS = 3

_LEAST_SHARE = 1e-3


def starting_points(model: Model, record: Record) -> list[Array]:
    """Parameters > 0 from which the fit may begin, the best first."""
    if not model.linear:
        return [_contact(record)]
    rows = slice(None, None, max(1, record.time.size // MOST_ROWS))
    h, moved = np.diff(record.time), np.diff(record.position)
    target = record.force[rows]
    fixed = _fixed_columns(model, record, h, moved, rows)
    if not model.branches:
        return [_positive(_nonnegative(fixed, target)[0], record)]
    step = _step(record)
    grid = np.geomspace(0.3 / (record.time[-1] - record.time[0]), 1.0 / float(np.median(h)), RATES)
    columns = [decaying(h, moved, float(rate), step)[rows] for rate in grid]
    found = []
    for first in _ranked(fixed, columns, [], target)[:STARTS]:
        chosen = [first]
        while len(chosen) < model.branches:
            chosen.append(_ranked(fixed, columns, chosen, target)[0])
        springs, _ = _nonnegative(fixed + [columns[i] for i in chosen], target)
        found.append(_as_parameters(_positive(springs, record), grid[chosen], len(fixed)))
    return found


def _fixed_columns(model: Model, record: Record, h: Array, moved: Array, rows: slice) -> list[Array]:
    if model.name == "maxwell":
        return []
    columns = [record.position[rows]]
    if model.name == "kelvin-voigt":
        columns.append(np.append(0.0, moved / h)[rows])
    return columns


def _step(record: Record) -> float:
    """The jump of position at the first sample, as far as it is known."""
    if record.response == "force":
        return 0.0 if record.rest is None else float(record.position[0] - record.rest)
    return float(record.position[0]) if not record.rest else 0.0


def _ranked(fixed: list[Array], columns: list[Array], chosen: list[int], target: Array) -> list[int]:
    """The branches not yet chosen, that which leaves the least first."""
    before = fixed + [columns[i] for i in chosen]
    left = [i for i in range(len(columns)) if i not in chosen]
    return sorted(left, key=lambda i: _nonnegative([*before, columns[i]], target)[1])


def _nonnegative(columns: list[Array], target: Array) -> tuple[Array, float]:
    from scipy.optimize import nnls

    matrix = np.stack(columns, axis=1)
    size = np.linalg.norm(matrix, axis=0)
    size[size == 0.0] = 1.0
    square: Array = np.linalg.qr(np.column_stack([matrix / size, target]), mode="r")  # type: ignore[assignment]
    solution, left = nnls(square[:, :-1], square[:, -1])
    return solution / size, float(left)


def _positive(springs: Array, record: Record) -> Array:
    """Zeros replaced by a small share of the others: a logarithm needs a number."""
    largest = float(springs.max())
    if largest <= 0.0:
        largest = float(np.abs(record.force).max() / np.abs(record.position).max())
    return np.maximum(springs, _LEAST_SHARE * largest)


def _as_parameters(springs: Array, rates: Array, fixed: int) -> Array:
    branches = springs[fixed:]
    pairs = np.stack([branches, branches / rates], axis=1)[np.argsort(-rates)]
    return np.concatenate([springs[:fixed], pairs.ravel()])


def _contact(record: Record) -> Array:
    """ln f = ln K + n ln u + λ u̇, where the contact pushes."""
    depth, force = record.position, record.force
    pushes = (depth > 0.02 * depth.max()) & (force > 0.02 * force.max())
    if np.count_nonzero(pushes) < 4:
        raise InputError(
            "a Hunt–Crossley contact is fitted where x > 0 and f > 0: fewer than 4 samples are there; "
            "give positions that are positive inside the tissue, forces that are positive out of it"
        )
    speed = np.gradient(depth, record.time)[pushes]
    matrix = np.stack([np.ones(speed.size), np.log(depth[pushes]), speed], axis=1)
    solution, *_ = np.linalg.lstsq(matrix, np.log(force[pushes]), rcond=None)
    size = float(np.abs(speed).max())
    return np.array(
        [np.exp(solution[0]), min(max(solution[1], 1.0), 5.0), max(solution[2], 1e-2 / size if size else 1.0)]
    )
