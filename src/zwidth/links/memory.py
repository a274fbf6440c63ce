"""What a port knows, as its step functions see it: float64 in flat arrays.

`p` does not change: the device, then from OWN_NUMBERS on what the law has of its own.  `s` is the state: the
newest packet heard, the packet to be sent next, the force of this period, then from OWN_STATE on the law's.
"""

from __future__ import annotations

from zwidth.compiled import Array, compiled

PERIOD, DAMPING, COULOMB, RESOLUTION, FORCE_LIMIT, FORCE_STEP = range(6)
OWN_NUMBERS = 6
NUMBERS_SIZE = 9

HEARD_NUMBER, HEARD_WAVE, HEARD_ENERGY, HEARD_POSITION, FRESH = range(5)
"""Of the newest packet; FRESH is 1 where it came in this period.  HEARD_NUMBER is −1 before any."""
BASE_ENERGY, BASE_POSITION = 5, 6
"""What the other end had sent before the first packet that was heard."""
NUMBER, WAVE, ENERGY, POSITION = range(7, 11)
"""Of the packet that is sent next."""
FORCE = 11
"""On the device in this period [N; N·m], positive along x."""
OWN_STATE = 12
LOSSES = 20
"""Where what friction has taken is kept."""
STATE_SIZE = 150


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
def within_actuator(p: Array, force: float) -> float:
    """The force in steps of the converter and within the limit, both rounded towards 0 [N; N·m]."""
    size = abs(force)
    if p[FORCE_LIMIT] > 0.0:
        size = min(size, p[FORCE_LIMIT])
    if p[FORCE_STEP] > 0.0:
        size = p[FORCE_STEP] * (size // p[FORCE_STEP])
    return size if force >= 0.0 else -size
