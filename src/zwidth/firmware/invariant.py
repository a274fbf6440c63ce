"""What a program can remember, after any number of calls with any input in its range.

What is a sum of what was remembered before, m ← A m + r with |r| ≤ R, stays within Σ |Aᵏ| R, and its error
within Σ |Aᵏ| δ; anything else is followed from rest until it grows no more.

It begins at some m₀, which an endless r = (I − A) m₀ would have left.  So R is made no less than that.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from zwidth.firmware.bound import Bound
from zwidth.firmware.evaluation import Arithmetic, Evaluation, NoBound
from zwidth.firmware.program import Operation, Program, Variable

_MOST_PASSES = 60
_MOST_POWERS = 200_000
_SETTLED = 1e-9
"""Relative: what grows by less has settled, and is widened by as much."""

_BETWEEN = 1e-12
"""Relative: what the coefficients of a sum are off, and each of the products that make their powers."""

Places = list[tuple[float, float, float]]
"""Low, high and error of every place of the memory."""


@dataclass(frozen=True, eq=False)
class Rest:
    """What a program remembers at first: anything on a straight line between some of its ends.

    Parameters
    ----------
    ends
        m × n.
    error
        By how much the computed one is off, place by place.
    """

    ends: NDArray[np.float64]
    error: tuple[float, ...]

    @property
    def places(self) -> Places:
        """The same, place by place."""
        low, high = self.ends.min(axis=0), self.ends.max(axis=0)
        return [(float(a), float(b), e) for a, b, e in zip(low, high, self.error, strict=True)]


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
    rest: Rest,
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
    memory = rest.places
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


def _grown(rest: Rest, memory: Places, after: list[Bound]) -> Places:
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
    first = np.array([rest.error[k] for k in sums])
    total = _gains(a.tobytes(), len(a))
    size, error = total @ np.maximum(size, _endless(a, rest.ends[:, sums])), total @ (error + first)
    for row, k in enumerate(sums):
        found[k] = (-float(size[row]), float(size[row]), float(error[row]))
    return found


def _endless(a: NDArray[np.float64], ends: NDArray[np.float64]) -> NDArray[np.float64]:
    """The largest |(I − A) m₀|, which is at an end."""
    size = np.abs(ends) + np.abs(ends) @ np.abs(a).T
    most: NDArray[np.float64] = (np.abs(ends - ends @ a.T) + 1e-15 * len(a) * size).max(axis=0)
    return most


def _is_kept(place: int, after: Bound) -> bool:
    """Whether nothing is ever stored there."""
    return after.coefficients == {place: 1.0} and after.rest_low == after.rest_high == after.own == 0.0


@lru_cache(maxsize=64)
def _gains(of: bytes, n: int) -> NDArray[np.float64]:
    """G ≥ Σ |Aᵏ|: of the computed powers' sum S and what rounding did to each, G ≥ S + S |δA| G."""
    a = np.frombuffer(of).reshape(n, n)
    total, power = np.zeros_like(a), np.eye(n)
    for count in range(_MOST_POWERS):
        norm = float(np.abs(power).sum(axis=1).max())
        if count and norm < 1e-9:
            rows = float(total.sum(axis=1).max())
            return _above((total + norm / (1 - norm) * rows) * (1 + 1e-9), _BETWEEN * np.abs(a))
        total += np.abs(power)
        power = power @ a
        if not np.isfinite(norm) or norm > 1e12:
            break
    raise NoBound("it forgets nothing of what it has seen, so that its errors add up without end")


def _above(total: NDArray[np.float64], off: NDArray[np.float64]) -> NDArray[np.float64]:
    """A G with G ≥ S + S |δA| G: it is above all such sums of a matrix that is off by so much."""
    gain, turned = total * (1 + 1e-9), total @ off
    for _ in range(_MOST_PASSES):
        more = total + turned @ gain
        if (more <= gain).all():
            return gain
        gain = np.maximum(gain, more) * (1 + 1e-9)
    raise NoBound("it forgets so slowly that nothing can be said of its errors")
