"""Wave variables as in the textbook, sampled as they stand: v is a backward difference.

    f = √(2w) ν − w v,    u = √(2w) v − ν,    v = (x_k − x_{k−1})/T

In continuous time that is passive for every delay (Anderson and Spong 1989; Niemeyer and Slotine 1991).
Sampled it is not: the hold gives out energy, and the computed damper w is late by half a period and more.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import sqrt
from typing import ClassVar

from zwidth.links.memory import (
    ENERGY,
    FRESH,
    HEARD_WAVE,
    NUMBER,
    OWN_NUMBERS,
    OWN_STATE,
    PERIOD,
    POSITION,
    WAVE,
    apply,
)
from zwidth.links.waves import Waves
from zwidth.native.compiled import Array, compiled

NAIVE_WAVES = 3.0

_IMPEDANCE = OWN_NUMBERS
_MOVED, _NEXT = OWN_STATE, OWN_STATE + 1
"""The displacement of the last period, and the wave that was computed with it."""


@compiled
def force(p: Array, s: Array) -> float:
    """Of the newest wave, used once, less that of the computed damper."""
    root = sqrt(p[_IMPEDANCE] / p[PERIOD])
    received = s[HEARD_WAVE] if s[FRESH] > 0.0 else 0.0
    s[FRESH] = 0.0
    s[_NEXT] = root * s[_MOVED] - received
    return apply(p, s, 2.0 * root * received - root * root * s[_MOVED])


@compiled
def send(p: Array, s: Array, moved: float) -> None:
    """The wave of the sample; the displacement is for the next."""
    root = sqrt(p[_IMPEDANCE] / p[PERIOD])
    wave = s[_NEXT]
    s[_MOVED], s[WAVE] = moved, wave
    s[ENERGY] += wave * wave
    s[POSITION] += wave / root
    s[NUMBER] += 1.0


@dataclass(frozen=True)
class NaiveWaves(Waves):
    """Wave variables of the textbook, ``f = √(2w) ν − w v`` with a backward difference: not passive.

    Parameters
    ----------
    device
        What the port drives.
    impedance
        w > 0 [N·s/m; N·m·s/rad]; None: the device's damping.

    Raises
    ------
    InputError
        If a number is missing or out of its bounds.
    """

    title: ClassVar[str] = "textbook waves"
    code: ClassVar[float] = NAIVE_WAVES
    steps: ClassVar = (force, send)
