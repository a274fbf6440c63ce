"""What a port knows, as its step functions see it: float64 in flat arrays.

`p` does not change: the device, then from OWN_NUMBERS on what the law has of its own.  `s` is the state: what
was heard and told of one run of the other end, the packet to be sent next, forces, then from OWN_STATE on the
law's.
"""

from __future__ import annotations

import numpy as np

from zwidth.native.compiled import Array, compiled

PERIOD, DAMPING, COULOMB, RESOLUTION, FORCE_LIMIT, FORCE_STEP, LATE = range(7)
"""LATE: in how many periods the force that is computed now begins to act."""
OWN_NUMBERS = 7
NUMBERS_SIZE = 10
MOST_LATE = 7

HEARD_NUMBER, HEARD_WAVE, HEARD_ENERGY, HEARD_POSITION, FRESH = range(5)
"""Of the newest packet; FRESH is 1 where it came in this period.  HEARD_NUMBER is −1 before any."""
COUNTED, USED, ENERGY, POSITION = range(5, 9)
"""What is used of the energy and the position heard; the sums of the packet that is sent next."""
LINE = 9
"""So many, from 0 on, are about one run of the other end: each run has its own."""
NUMBER, WAVE = 9, 10
"""Of the packet that is sent next."""
FORCE, ACTING = 11, 12
"""That is computed newest, and that acts in this period [N; N·m], positive along x."""
_FORCES = 13
OWN_STATE = _FORCES + MOST_LATE + 1
LOSSES = 48
"""Where what friction has taken is kept."""
MOVING = 179
"""1 between receive and send, which are called in turn."""
STATE_SIZE = 180
NEW_LINE = np.array([-1.0, *[0.0] * (LINE - 1)])


@compiled
def hear(s: Array, number: float, wave: float, energy: float, position: float) -> None:
    """Take in a packet: the newest counts, and what is older or the same again changes nothing.

    The energy that it tells is a sum, which never falls.
    """
    if number <= s[HEARD_NUMBER]:
        return
    s[HEARD_NUMBER], s[HEARD_WAVE], s[HEARD_POSITION], s[FRESH] = number, wave, position, 1.0
    s[HEARD_ENERGY] = max(s[HEARD_ENERGY], energy)


@compiled
def apply(p: Array, s: Array, force: float) -> float:
    """What the actuator makes of a force: in steps and within the limit, both rounded towards 0 [N; N·m]."""
    size = abs(force)
    if p[FORCE_LIMIT] > 0.0:
        size = min(size, p[FORCE_LIMIT])
    if p[FORCE_STEP] > 0.0:
        size = p[FORCE_STEP] * (size // p[FORCE_STEP])
    f = size if force >= 0.0 else -size
    s[FORCE] = f
    s[ACTING] = queued(p, s, _FORCES, f)
    return f


@compiled
def queued(p: Array, s: Array, at: int, value: float) -> float:
    """Put a value into the queue that begins at `at`; the one of LATE periods ago comes out."""
    late = int(p[LATE])
    for k in range(late, 0, -1):
        s[at + k] = s[at + k - 1]
    s[at] = value
    out: float = s[at + late]
    return out
