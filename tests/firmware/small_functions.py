"""Small functions, each hard for the emitter in its own way; m is an array of 4, x real and k whole."""

from __future__ import annotations

import math
from inspect import isfunction
from typing import Any, NamedTuple

Array = Any


class Pair(NamedTuple):
    first: float
    second: float


def nested_returns(m: Array, x: float, k: int) -> float:
    if x > 0.0:
        if k > 3:
            return 1.0
        if k > 1:
            x += 0.5
        else:
            return -x
    elif k == 2:
        return 2.0 * x
    return x + 10.0


def break_written_out(m: Array, x: float, k: int) -> float:
    total = 0.0
    for i in (1.0, 2.0, 3.0):
        if x < i:
            break
        if i == 2.0:
            continue
        total += i
    return total


def break_in_loop(m: Array, x: float, k: int) -> float:
    total = 0.0
    for i in range(50):
        if i > k:
            break
        if i % 3 == 1:
            continue
        total += x * i
    return total


def swapped(m: Array, x: float, k: int) -> float:
    a, b = x, 1.0
    for _ in range(40):
        a, b = b, a + b
        if b > 100.0:
            a, b = b, a
    return a - b


def remembered(m: Array, x: float, k: int) -> float:
    last, worst = x, 0.0
    for i in range(k):
        before = last
        last = m[i % 4] + 0.5 * last
        worst = max(worst, abs(last - before))
    return worst


def merged(m: Array, x: float, k: int) -> float:
    if k > 2:
        a, b = x, 1.0
    else:
        a, b = 1.0, x
    c = a
    a = a * 2.0
    return c - a * b


def loops_in_loops(m: Array, x: float, k: int) -> float:
    for i in range(k):
        for j in range(i, 9):
            if m[j % 4] > x:
                return float(10 * i + j)
        m[i % 4] -= x
    return -1.0


def two_loops(m: Array, x: float, k: int) -> float:
    for i in range(k):
        if m[i % 4] > x:
            return m[i % 4]
    for i in range(k, 0, -2):
        if m[i % 4] < -x:
            return float(i)
    return x


def mixed(m: Array, x: float, k: int) -> float:
    n = k // 2 - 3
    return 2 * x + k / 4 + n * (k % 3) + float(-n) + int(x) + math.floor(x) + math.ceil(x) + max(k, x, 1)


def chained(m: Array, x: float, k: int) -> float:
    return 1.0 if -1 < x <= k < 5 else (2.0 if 0.0 == x == -0.0 else 3.0)


def known_and_not(m: Array, x: float, k: int) -> float:
    table = (1.0, 4.0, 9.0, 16.0)
    known = 2
    for i in range(3):
        known += i
    return table[k % 4] + table[known - 3] * x if known > 4 and x > 0.0 else table[0] - x


def changed_by_a_loop_in_a_branch(m: Array, x: float, k: int) -> float:
    a = x
    if k > 2:
        while a > 0.5:
            a *= 0.5
        a = a + 1.0
    return a + x


def stop_read_once(m: Array, x: float, k: int) -> float:
    total, n = 0.0, k
    for i in range(n + 1):
        n += 1
        total += x + n * i
    return total


def counter_after_another(m: Array, x: float, k: int) -> float:
    total = 0.0
    for i in range(3):
        total += m[i]
    while total < 20.0:
        total += abs(x) + 1.0
        for i in range(3):
            m[i] += total
    return total


def not_computed(m: Array, x: float, k: int) -> float:
    n = k - 5
    if n > 0 and 12 % n == 0:
        return 1.0
    return 2.0 if 0 <= n < 4 and m[n] > 0.0 else 3.0


def _stores(m: Array, i: int, x: float) -> bool:
    m[i] += x
    return m[i] > 1.0


def called_if_needed(m: Array, x: float, k: int) -> float:
    if k > 2 or _stores(m, 1, x):
        m[0] = m[0] * 0.5
    return m[0] + (1.0 if k < 4 and _stores(m, 2, -x) else 0.0)


def place_asked_once(m: Array, x: float, k: int) -> float:
    m[1 if _stores(m, 2, x) else 0] += 1.0
    return m[0] - m[1]


def stop_asked_once(m: Array, x: float, k: int) -> float:
    total = 0.0
    for i in range(k if _stores(m, 2, x) else 2 * k):
        total += m[2] * i
    return total


def records(m: Array, x: float, k: int) -> float:
    pair = Pair(x, second=2.0) if k > 3 else Pair(m[0], x)
    low, high = _ordered(pair.first, pair.second)
    return low - 3.0 * high


def _ordered(a: float, b: float) -> tuple[float, float]:
    return (b, a) if b < a else (a, b)


def whole_quotient(m: Array, x: float, k: int) -> float:
    return x + (k - 5) // 3


def whole_zero(m: Array, x: float, k: int) -> float:
    return x / float(-k * 0) + x / float(int(0.1 * x)) + (0.0 - float(k - k)) / x


def ends(m: Array, x: float, k: int) -> float:
    big = 1e300 * abs(x)
    return min(big * 1e10, -big) / (big - big) + math.sqrt(abs(x))


NUMPY = (whole_zero, ends)
"""Those that divide by 0."""

_HERE = [f for f in dict(globals()).values() if isfunction(f) and f.__module__ == __name__]

FUNCTIONS = tuple(f for f in _HERE if not f.__name__.startswith("_") and f not in NUMPY)
"""Those that Python computes as they stand."""
