"""Which test it is, from the data: what is held.

relaxation   the probe is held, and the force fades
creep        the force is held, and the probe sinks in
loading      neither is: the probe goes in, or in and out

Held is what stays in a narrow band for most of the time.  Where both do, it is what stays there longer; where
they do for nearly as long, as a force that has faded quickly does, it is the quieter: what a machine holds it
holds by what it measures well.
"""

from __future__ import annotations

from typing import Literal

import numpy as np

from zwidth.native.compiled import Array

Kind = Literal["relaxation", "creep", "loading"]
KINDS: tuple[Kind, ...] = ("relaxation", "creep", "loading")

BAND = 0.03
"""Of the range of a quantity, within which it is held."""

MOST = 0.45
"""Of the time, for which something is held in a relaxation or creep test."""

ALIKE = 0.05
"""Of the time; what is held for so little longer is not told apart by it."""

NOISES = 6.0
"""Times its noise, within which a quantity never changes."""


def kind_of(time: Array, indentation: Array, force: Array) -> Kind:
    """The kind of a test."""
    probe, push = held_for(time, indentation), held_for(time, force)
    if max(probe, push) < MOST:
        return "loading"
    if abs(probe - push) < ALIKE:
        return "relaxation" if _noise(indentation) <= _noise(force) else "creep"
    return "relaxation" if probe >= push else "creep"


def held_for(time: Array, values: Array) -> float:
    """The share of the time for which a quantity stays within `BAND` of its range about one value."""
    span = float(np.ptp(values))
    noise = noise_of_differences(values)
    if span <= NOISES * noise or span == 0.0:
        return 1.0
    width = max(BAND * span, NOISES * noise)
    weight = np.gradient(time)
    order = np.argsort(values)
    ordered, total = values[order], np.concatenate([[0.0], np.cumsum(weight[order])])
    ends = np.searchsorted(ordered, ordered + width, side="right")
    return float((total[ends] - total[: ordered.size]).max() / total[-1])


def _noise(values: Array) -> float:
    """Of a quantity, as a share of its range."""
    span = float(np.ptp(values))
    return noise_of_differences(values) / span if span else 0.0


def noise_of_differences(values: Array) -> float:
    """The standard deviation of white noise on a smooth quantity, by its second differences."""
    if values.size < 4:
        return 0.0
    second = np.diff(values, 2)
    return float(np.median(np.abs(second - np.median(second)))) / 0.6745 / np.sqrt(6.0)


def changes(values: Array) -> bool:
    """True where a quantity goes further than its noise does."""
    return bool(np.ptp(values) > NOISES * noise_of_differences(values) and np.ptp(values) > 0)
