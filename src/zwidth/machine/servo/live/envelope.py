"""The last seconds of some curves, as they are drawn: lowest and highest in equal spans of time.

A graph is some hundred points wide, ten seconds of a loop are ten thousand samples and more.  One sample for
each point would hide a buzz, or show it as a slow wave that is not there; lowest and highest hide nothing.
What is kept does not grow, however long the loop runs and however fast.
"""

from __future__ import annotations

from threading import Lock
from typing import NamedTuple

import numpy as np

from zwidth.native.compiled import Array

SPAN = 10.0
"""How long a graph goes back [s]."""


class Band(NamedTuple):
    """Lowest and highest of each curve in each span."""

    times: Array
    """Middle of each span [s]."""
    low: Array
    high: Array
    newest: int
    """Number of the newest span in it, to ask for what comes after."""


class Envelope:
    """Lowest and highest of each curve in so many spans, the last `SPAN` seconds in all.

    Parameters
    ----------
    curves
        How many.
    spans
        How many.
    """

    def __init__(self, curves: int, spans: int) -> None:
        self._width = SPAN / spans
        self._number = np.full(spans, -1, np.int64)
        self._low, self._high = np.full((2, spans, curves), np.nan)
        self._newest = -1
        self._lock = Lock()

    def add(self, times: Array, curves: Array) -> None:
        """Samples, one a row, later than those before."""
        if not len(times):
            return
        numbers = np.floor(times / self._width).astype(np.int64)
        first = np.flatnonzero(np.diff(numbers, prepend=numbers[0] - 1))
        low = np.fmin.reduceat(curves, first, axis=0)
        high = np.fmax.reduceat(curves, first, axis=0)
        with self._lock:
            self._keep(numbers[first], low, high)

    def _keep(self, numbers: np.ndarray[tuple[int], np.dtype[np.int64]], low: Array, high: Array) -> None:
        size = len(self._number)
        if numbers[0] == self._newest:  # a span that is not over yet
            at = numbers[0] % size
            low[0], high[0] = np.fmin(low[0], self._low[at]), np.fmax(high[0], self._high[at])
        numbers, low, high = numbers[-size:], low[-size:], high[-size:]
        at = numbers % size
        self._number[at], self._low[at], self._high[at] = numbers, low, high
        self._newest = int(numbers[-1])

    def after(self, number: int) -> Band:
        """The spans that are over and later than a number; none twice."""
        with self._lock:
            wanted = np.arange(max(number + 1, self._newest - len(self._number) + 1, 0), max(self._newest, 0))
            at = wanted[self._number[wanted % len(self._number)] == wanted]
            found = at % len(self._number)
            newest = max(self._newest - 1, number)
            return Band((at + 0.5) * self._width, self._low[found], self._high[found], newest)

    def drawn(self, columns: int) -> tuple[Array, Array]:
        """Lowest and highest of each curve in so many equal parts of the last `SPAN` seconds; else NaN."""
        size = len(self._number)
        with self._lock:
            numbers = np.arange(self._newest - size + 1, self._newest + 1)
            held = (self._number[numbers % size] == numbers)[:, None]
            low = np.where(held, self._low[numbers % size], np.nan)
            high = np.where(held, self._high[numbers % size], np.nan)
        edges = np.arange(columns) * size // columns
        if columns > size:
            return low[edges], high[edges]
        return np.fmin.reduceat(low, edges, axis=0), np.fmax.reduceat(high, edges, axis=0)
