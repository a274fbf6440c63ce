"""Functions outside of what can be emitted; a comment marks the line."""

from __future__ import annotations

import math
import os
from typing import Any

import numpy as np

Array = Any

WHERE = float(os.name == "posix")


def power(m: Array, x: float, k: int) -> float:
    y = x + 1.0
    return y**2.5  # here: Pow


def library(m: Array, x: float, k: int) -> float:
    return math.sin(x)  # here: math.sin


def of_arrays(m: Array, x: float, k: int) -> float:
    return float(np.sum(m))  # here: np.sum


def comprehension(m: Array, x: float, k: int) -> float:
    return sum([x for _ in range(3)])  # here: sum


def text(m: Array, x: float, k: int) -> float:
    name = "x"  # here: 'x'
    return x if name else 0.0


def raising(m: Array, x: float, k: int) -> float:
    if x < 0.0:
        raise ValueError  # here: raise
    return x


def one_way(m: Array, x: float, k: int) -> float:
    if x > 0.0:
        y = 1.0
    return y  # here: y has no value on some way


def whole_then_real(m: Array, x: float, k: int) -> float:
    total = 0
    for i in range(40):
        total = total + x * i  # here: write 0.0
    return total


def over_an_array(m: Array, x: float, k: int) -> float:
    total = 0.0
    for value in m:  # here: range
        total += value
    return total


def other_step(m: Array, x: float, k: int) -> float:
    total = 0.0
    for _ in range(0, 50, k):  # here: step
        total += x
    return total


def loop_else(m: Array, x: float, k: int) -> float:
    while x > 1.0:
        x -= 1.0
    else:
        x = 0.0  # here: else
    return x


def beyond(m: Array, x: float, k: int) -> float:
    return m[4]  # here: there is no number at 4 of 4


def real_index(m: Array, x: float, k: int) -> float:
    return m[x]  # here: an index is a whole number


def itself(m: Array, x: float, k: int) -> float:
    return itself(m, x - 1.0, k) if x > 0.0 else x  # here: itself calls itself


def real_quotient(m: Array, x: float, k: int) -> float:
    return x // 0.5  # here: //


def no_value(m: Array, x: float, k: int) -> float:
    n = 3 - 3
    return x * int(1e300) + n  # here: no whole number of 32 bits


def of_conditions(m: Array, x: float, k: int) -> float:
    return x + (x > 0.0)  # here: arithmetic is for numbers


def two_lengths(m: Array, x: float, k: int) -> tuple[float, ...]:
    if x > 0.0:
        return x, x
    return x, x, x  # here: as many


def sent_along(m: Array, x: float, k: int) -> float:
    pair = (x, x)
    return max(*pair)  # here: one by one


def unknown_name(m: Array, x: float, k: int) -> float:
    return x + nowhere  # type: ignore[name-defined]  # noqa: F821  # here: nowhere


def told_when_it_runs(m: Array, x: float, k: int) -> float:
    return x + WHERE  # here: WHERE is not known here


def changed_list(m: Array, x: float, k: int) -> float:
    pair = (x, x)
    pair[0] = 1.0  # type: ignore[index]  # here: only what is remembered
    return x


REFUSED = tuple(f for f in dict(globals()).values() if getattr(f, "__module__", "") == __name__)
