"""What the controller of a pair asks for, from the definitions alone: `from asked_forces import asked_of`."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

import zwidth as zw


def age_of(pair: zw.Pair, i: int) -> int:
    """Of what arm i receives, in samples."""
    return int(np.ceil(float(pair.sides[i].link_delay / pair.sample_period) - 1e-12))


def asked_of(pair: zw.Pair, i: int, k: int, reading: Callable, age: Callable | None = None) -> Any:
    """Of arm i at tick k; `reading(arm, tick)` is a number or a linear form, `age(arm, sample)` its age."""
    often, period = pair.own_readings, float(pair.sample_period)
    side, every = pair.sides[i], often // pair.readings[i]

    def received(i: int, k: int) -> int:
        return often * (k // often - (age(i, k // often) if age else age_of(pair, i)))

    def coupling(i: int, k: int, finer: int) -> Any:
        """Of arm i, its own speed over so many ticks."""
        K, B = float(pair.sides[i].stiffness), float(pair.sides[i].virtual_damping)
        sent = received(i, k)
        own, was = reading(i, k), reading(i, k - finer)
        other, old = reading(1 - i, sent), reading(1 - i, sent - often)
        return K * (own - other) + B * often / period * ((own - was) / finer - (other - old) / often)

    at = every * (k // every)
    local = float(side.local_damping) * (reading(i, at) - reading(i, at - every)) * often / (every * period)
    sent = float(side.reflection) * coupling(1 - i, received(i, k), often)
    return coupling(i, at, every) + local - sent
