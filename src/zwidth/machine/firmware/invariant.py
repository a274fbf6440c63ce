"""What a program can remember, after any number of calls with any input in its range.

It is m ← A m + Σ b_i s_i, where the s_i are no sums of it and have ranges of their own; so what each makes of
it is summed with its signs, Σ_k A^k b_i s_i, and likewise of each rounding.  The s_i that depend on what is
remembered, in a way that is no sum, are followed from rest until they grow no more.

It begins at some m₀, which endless s_i with Σ b_i s_i = (I − A) m₀ would have left.  What no s_i of
the ranges leaves of that is added.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from zwidth.machine.firmware.bound import WIDER, Bound, Source
from zwidth.machine.firmware.evaluation import Arithmetic, Evaluation, NoBound
from zwidth.machine.firmware.program import Operation, Program, Variable
from zwidth.native.compiled import Array

_MOST_PASSES = 60
_MOST_POWERS = 200_000
_SETTLED = 1e-9
"""Relative: what grows by less has settled, and is widened by as much."""

_BETWEEN = 1e-12
"""Relative: what each of the products that make powers of a matrix is off, for up to a thousand places."""
_TINY = 1e-290
"""The same of very small ones."""
_LEFT_OUT = 1e-7
"""Relative: the end of a response that is bounded, not summed."""

Places = list[tuple[float, float, float]]
"""Low, high and error of every place of the memory."""


@dataclass(frozen=True, eq=False)
class Rest:
    """What a program remembers at first: anything on a straight line between some of its ends, m × n.

    Place by place the computed one is off by `error`.
    """

    ends: Array
    error: tuple[float, ...]

    @property
    def places(self) -> Places:
        """The same, place by place."""
        low, high = self.ends.min(axis=0), self.ends.max(axis=0)
        return [(float(a), float(b), e) for a, b, e in zip(low, high, self.error, strict=True)]


@dataclass(frozen=True, eq=False)
class Invariant:
    """Bounds that hold at every call: of the memory, of every result, and of what the program gives back."""

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
    """Bounds of everything in a program with one array of memory, called for ever; see `Evaluation`."""
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
    """What is remembered after one more call at least, and for ever."""
    places = [k for k, b in enumerate(after) if not _is_kept(k, b)]
    found = [
        (min(m[0], b.low), max(m[1], b.high), max(m[2], b.error)) for m, b in zip(memory, after, strict=True)
    ]
    if not places:
        return found
    a = np.zeros((len(places), len(places)))
    driven, off = _Driven(len(places)), _Driven(len(places))
    for row, k in enumerate(places):
        b = after[k]
        for s, c in b.terms.items():
            if s.place in places:
                a[row, places.index(s.place)] = c
            else:
                driven.add(row, s, c, s.low, s.high)
                off.add(row, s, c, -s.error, s.error)
        for s, d in b.noise.items():
            off.add(row, s, d, s.low, s.high)
        driven.add(row, row, 1.0, b.rest_low, b.rest_high)
        off.add(row, row, 1.0, -b.own, b.own)
    total, most = _gains(a.tobytes(), len(a))
    low, high = driven.response(a, total)
    _, error = off.response(a, total)
    error = error + most @ np.array([rest.error[k] for k in places])
    beside = total @ driven.beside(a, rest.ends[:, places])
    for row, k in enumerate(places):
        if a[row].any():
            found[k] = (float(low[row] - beside[row]), float(high[row] + beside[row]), float(error[row]))
    return found


class _Driven:
    """What m ← A m + Σ b_i s_i is driven by: b_i, and the range of s_i; those with the same b_i are one."""

    def __init__(self, size: int) -> None:
        self.size = size
        self.rows: dict[Source | int, dict[int, float]] = {}
        self.range: dict[Source | int, tuple[float, float]] = {}

    def add(self, row: int, source: Source | int, coefficient: float, low: float, high: float) -> None:
        """One b_i in one place; anything drives a place of its own, too."""
        self.rows.setdefault(source, {})[row] = coefficient
        self.range[source] = low, high

    def columns(self) -> tuple[Array, Array, Array]:
        """(b, low, high)."""
        together: dict[tuple[tuple[int, float], ...], tuple[float, float]] = {}
        for source, rows in self.rows.items():
            (low, high), key = self.range[source], tuple(rows.items())
            before = together.get(key, (0.0, 0.0))
            together[key] = before[0] + low, before[1] + high
        b = np.zeros((self.size, len(together)))
        for column, key in enumerate(together):
            for row, coefficient in key:
                b[row, column] = coefficient
        ends = np.array(list(together.values()))
        return b, ends[:, 0], ends[:, 1]

    def response(self, a: Array, total: Array) -> tuple[Array, Array]:
        """The least and the most of Σ Aʲ b_i s_i, for any s_i in their ranges."""
        b, low, high = self.columns()
        if not all(np.isfinite(it).all() for it in (b, low, high)):
            raise NoBound("what it remembers, or the error of it, has no bound")
        up, down = _responses(a.tobytes(), b.tobytes(), total.tobytes(), *b.shape)
        slack = WIDER * (up - down) @ np.maximum(np.abs(low), np.abs(high))
        return up @ low + down @ high - slack, up @ high + down @ low + slack

    def beside(self, a: Array, ends: Array) -> Array:
        """What no s_i of the ranges leaves of (I − A) m₀: largest at an end, as it is affine in between."""
        b, low, high = self.columns()
        middle, half = (low + high) / 2, (high - low) / 2
        left = ends - ends @ a.T
        size = np.abs(ends) + np.abs(ends) @ np.abs(a).T + np.abs(b) @ np.maximum(np.abs(low), np.abs(high))
        shares = np.linalg.lstsq(b * half, (left - b @ middle).T, rcond=None)[0]
        left = left - (middle + half * np.clip(shares, -1.0, 1.0).T) @ b.T
        most: Array = (np.abs(left) + 1e-15 * (len(a) + len(low)) * size).max(axis=0)
        return most


def _is_kept(place: int, after: Bound) -> bool:
    """Whether nothing is ever stored there."""
    (only, *more) = after.terms.items() or ((None, 0.0),)
    same = only[0] is not None and only[0].place == place and only[1] == 1.0 and not more
    return same and not after.noise and after.rest_low == after.rest_high == after.own == 0.0


@lru_cache(maxsize=64)
def _responses(a_of: bytes, b_of: bytes, total_of: bytes, n: int, count: int) -> tuple[Array, Array]:
    """Σ max(Aʲ b, 0) and Σ min(Aʲ b, 0) at least so far from 0, with what is left out and what rounding did.

    Of the computed V_j ← A V_j the rounding is η ≤ γ |A| |V_j|, of which Aⁱ makes no more than G η in all.
    """
    a, total = np.frombuffer(a_of).reshape(n, n), np.frombuffer(total_of).reshape(n, n)
    v = np.frombuffer(b_of).reshape(n, count)
    up, down = np.zeros_like(v), np.zeros_like(v)
    for j in range(_MOST_POWERS):
        if j % 16 == 0 and (total @ np.abs(v) <= _LEFT_OUT * (up - down).max(axis=0)).all():
            break
        up, down = up + np.maximum(v, 0.0), down + np.minimum(v, 0.0)
        v = a @ v
    rounding = total @ (_BETWEEN * np.abs(a) @ ((up - down) * (1 + 1e-9) + _TINY))
    more = (total @ (np.abs(v) + rounding) + rounding) * (1 + 1e-9)
    return up * (1 + 1e-9) + more, down * (1 + 1e-9) - more


@lru_cache(maxsize=64)
def _gains(of: bytes, n: int) -> tuple[Array, Array]:
    """G ≥ Σ |Aᵏ|, and sup |Aᵏ|: of the computed powers' sum S and what rounding did, G ≥ S + S |δA| G."""
    a = np.frombuffer(of).reshape(n, n)
    total, power, most = np.zeros_like(a), np.eye(n), np.zeros_like(a)
    with np.errstate(all="ignore"):
        last = np.abs(np.linalg.matrix_power(a, _MOST_POWERS)).sum(axis=1).max()
    for count in range(_MOST_POWERS if last < 1e-9 else 0):
        norm = float(np.abs(power).sum(axis=1).max())
        if count and norm < 1e-9:
            rows = float(total.sum(axis=1).max())
            gain = _above((total + norm / (1 - norm) * rows) * (1 + 1e-9), _BETWEEN * np.abs(a))
            return gain, most + (gain - total)
        total += np.abs(power)
        most = np.maximum(most, np.abs(power))
        power = power @ a
        if not np.isfinite(norm) or norm > 1e12:
            break
    raise NoBound("it forgets nothing of what it has seen, so that its errors add up without end")


def _above(total: Array, off: Array) -> Array:
    """A G with G ≥ S + S |δA| G: it is above all such sums of a matrix that is off by so much."""
    gain, turned = total * (1 + 1e-9), total @ off
    for _ in range(_MOST_PASSES):
        more = total + turned @ gain
        if (more <= gain).all():
            return gain
        gain = np.maximum(gain, more) * (1 + 1e-9)
    raise NoBound("it forgets so slowly that nothing can be said of its errors")
