"""What a program can remember, after any number of calls with any input in its range.

What is a sum of what was remembered before, m ← A m + r, stays within Σ |Aᵏ| |r|, and its error within
Σ |Aᵏ| δ; anything else is followed from rest until it grows no more.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from zwidth.firmware.bound import Bound
from zwidth.firmware.evaluation import Arithmetic, Evaluation, NoBound
from zwidth.firmware.program import Operation, Program, Variable

_MOST_PASSES = 60
_MOST_POWERS = 200_000
_SETTLED = 1e-9
"""Relative: what grows by less has settled, and is widened by as much."""

Places = list[tuple[float, float, float]]
"""Low, high and error of every place of the memory."""


@dataclass(frozen=True, eq=False)
class Invariant:
    """Bounds that hold at every call.

    Parameters
    ----------
    memory
        Of every place: low, high, error.
    values
        Of every result in the program.
    results
        Of what it gives back.
    """

    memory: Places
    values: dict[Variable, Bound]
    results: tuple[Bound, ...]


def invariant(
    program: Program,
    given: Mapping[Variable, Bound],
    rest: Places,
    arithmetic: Arithmetic,
    converter: Operation | None = None,
) -> Invariant:
    """Bounds of everything in a program that is called for ever.

    Parameters
    ----------
    program
        With one array of memory.
    given
        Of its parameters, at every call.
    rest
        What it remembers at first.
    arithmetic
        Of the machine.
    converter
        See `Evaluation`.

    Raises
    ------
    NoBound
        If there is no bound, or none was found; and why.
    """
    memory = list(rest)
    for _ in range(_MOST_PASSES):
        evaluation = Evaluation(arithmetic, converter)
        after, results = evaluation.run(program, given, memory)
        grown = _grown(rest, memory, after)
        if all(_within(new, old) for new, old in zip(grown, memory, strict=True)):
            return Invariant(memory, evaluation.seen, results)
        memory = [_widened(new, old) for new, old in zip(grown, memory, strict=True)]
    raise NoBound("what it remembers, or the error of it, grows from sample to sample")


def _within(new: tuple[float, float, float], old: tuple[float, float, float]) -> bool:
    return new[0] >= old[0] and new[1] <= old[1] and new[2] <= old[2]


def _widened(new: tuple[float, float, float], old: tuple[float, float, float]) -> tuple[float, float, float]:
    slack = _SETTLED * max(abs(new[0]), abs(new[1]))
    low = old[0] if new[0] >= old[0] else new[0] - slack
    high = old[1] if new[1] <= old[1] else new[1] + slack
    error = old[2] if new[2] <= old[2] else new[2] * (1 + _SETTLED)
    if not np.isfinite([low, high, error]).all():
        raise NoBound("what it remembers, or the error of it, has no bound")
    return low, high, error


def _grown(rest: Places, memory: Places, after: list[Bound]) -> Places:
    """What is remembered after one more call at least, and for ever where it is a sum."""
    sums = [k for k, b in enumerate(after) if b.coefficients and not _is_kept(k, b)]
    found = [
        (min(m[0], b.low), max(m[1], b.high), max(m[2], b.error)) for m, b in zip(memory, after, strict=True)
    ]
    if not sums:
        return found
    a = np.array([[(after[k].coefficients or {}).get(j, 0.0) for j in sums] for k in sums])
    size, error = np.empty(len(sums)), np.empty(len(sums))
    for row, k in enumerate(sums):
        b = after[k]
        others = [(c, found[j]) for j, c in (b.coefficients or {}).items() if j not in sums]
        size[row] = max(abs(b.rest_low), abs(b.rest_high)) + sum(abs(c) * max(-m[0], m[1]) for c, m in others)
        error[row] = b.own + sum(abs(c) * m[2] for c, m in others)
    # at rest at x it holds what an endless x would have left: that is within the sums but for its rounding
    first = np.array([rest[k][2] for k in sums])
    total = _gains(a)
    size, error = total @ size, total @ (error + first)
    for row, k in enumerate(sums):
        most = max(float(size[row]), -rest[k][0], rest[k][1])
        found[k] = (-most, most, float(error[row]))
    return found


def _is_kept(place: int, after: Bound) -> bool:
    """Whether nothing is ever stored there."""
    return after.coefficients == {place: 1.0} and after.rest_low == after.rest_high == after.own == 0.0


def _gains(a: NDArray[np.float64]) -> NDArray[np.float64]:
    """Σ |Aᵏ|, not less than it is."""
    total, power = np.zeros_like(a), np.eye(len(a))
    for count in range(_MOST_POWERS):
        norm = float(np.abs(power).sum(axis=1).max())
        if count and norm < 1e-9:
            rows = float(total.sum(axis=1).max())
            return (total + norm / (1 - norm) * rows) * (1 + 1e-9)
        total += np.abs(power)
        power = power @ a
        if not np.isfinite(norm) or norm > 1e12:
            break
    raise NoBound("it forgets nothing of what it has seen, so that its errors add up without end")
