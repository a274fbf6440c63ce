"""An arm against a real wall: a spring and a damper in continuous time, on one side of x = 0 only."""

from __future__ import annotations

from math import ceil, sqrt

from zwidth.loop.pair.curve import advance_on
from zwidth.loop.plant import POSITION, VELOCITY, Plant
from zwidth.native.compiled import Array, compiled

_LOOKS = 8
"""How often in a stretch it is looked whether the arm has met or left the wall, at least."""

_BISECTIONS = 60


@compiled
def advance_against(state: Array, free: Plant, inside: Plant, curve: Array, h: float, work: Array) -> None:
    """Move by h seconds under a constant actuator force; as `inside` where x > 0, as `free` elsewhere.

    The instant at which x passes 0 is found to the last bits, so that the wall gives back no more than it
    took.  An arm that goes in and out again between two looks is not seen to have met it.
    """
    looks = _LOOKS
    if inside.stiffness > 0.0:  # 20 in the half period of a contact
        looks = max(looks, ceil(h * 20.0 / 3.2 * sqrt(inside.stiffness / inside.mass)))
    for look in range(looks):
        left = h * (look + 1) / looks - h * look / looks
        x = state[POSITION]
        within = x > 0.0 or (x == 0.0 and state[VELOCITY] > 0.0)
        for _ in range(4):  # it passes 0 once, or not at all; more often only by rounding
            before = state.copy()
            advance_on(state, inside if within else free, curve, 0.0, 0.0, 0.0, left, work)
            if (state[POSITION] > 0.0) == within or state[POSITION] == 0.0:
                break
            low, high = 0.0, left
            for _ in range(_BISECTIONS):
                middle = 0.5 * (low + high)
                if middle <= low or middle >= high:
                    break
                state[:] = before
                advance_on(state, inside if within else free, curve, 0.0, 0.0, 0.0, middle, work)
                if (state[POSITION] > 0.0) == within:
                    low = middle
                else:
                    high = middle
            state[:] = before
            advance_on(state, inside if within else free, curve, 0.0, 0.0, 0.0, low, work)
            left -= low
            within = not within
