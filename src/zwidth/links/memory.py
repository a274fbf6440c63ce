"""What a port knows, as its step functions see it: float64 in flat arrays.

`p` does not change: the device, then from OWN_NUMBERS on what the law has of its own.  `s` is the state: the
newest packet heard, the packet to be sent next, forces, then from OWN_STATE on the law's.
"""

from __future__ import annotations

from zwidth.compiled import Array, compiled

PERIOD, DAMPING, COULOMB, RESOLUTION, FORCE_LIMIT, FORCE_STEP, LATE = range(7)
"""LATE: in how many periods the force that is computed now begins to act."""
OWN_NUMBERS = 7
NUMBERS_SIZE = 10
MOST_LATE = 7

HEARD_NUMBER, HEARD_WAVE, HEARD_ENERGY, HEARD_POSITION, FRESH = range(5)
"""Of the newest packet; FRESH is 1 where it came in this period.  HEARD_NUMBER is −1 before any."""
BASE_ENERGY, BASE_POSITION = 5, 6
"""What the other end had sent before the first packet that was heard."""
NUMBER, WAVE, ENERGY, POSITION = range(7, 11)
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


@compiled
def hear(s: Array, number: float, wave: float, energy: float, position: float) -> None:
    """Take in a packet: the newest counts, and what is older or the same again changes nothing.

    The energy that it tells is a sum, which never falls.  Of a first packet that is not the other end's very
    first the sums so far count for nothing: another may have used them.
    """
    if number <= s[HEARD_NUMBER]:
        return
    if s[HEARD_NUMBER] < 0.0 and number > 0.0:
        s[BASE_ENERGY], s[BASE_POSITION] = energy, position
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
