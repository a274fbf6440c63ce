"""An interval of the free mass with a stop or a start in it: slide to rest, then stay or slide on.

Under a constant force the velocity is 0 once at most, so that this is all that
can happen; the same as `step.advance` does, to the last bit, without its loop.
"""

from __future__ import annotations

from typing import NamedTuple

from zwidth.loop.free import free_response, free_stop
from zwidth.native.compiled import compiled


class Free(NamedTuple):
    """A free mass and its energies: what an interval changes."""

    position: float
    velocity: float
    side: float
    hand: float
    actuator: float
    viscous: float
    dry: float
    source: float


@compiled
def turn(
    free: Free,
    force: float,
    push: float,
    drag: float,
    coulomb: float,
    stiction: float,
    inverse: float,
    half_hand: float,
    h: float,
) -> Free:
    """The mass after an interval in which it stops, or in which it starts if it can.

    Parameters
    ----------
    free
        At the beginning: at rest, or its velocity is not 0.
    force, push
        f_a and F [N].
    drag, coulomb, stiction
        b, f_c and f_s.
    inverse, half_hand
        1/M and m_h/2.
    h
        Length of the interval [s].
    """
    left, rate = h, drag * inverse
    if free.side != 0.0:
        base = (push - free.side * coulomb - drag * free.velocity) * inverse
        t = min(h, free_stop(rate, free.velocity, base - force * inverse))
        free = _slid(free, 0.0, force, push, drag, coulomb, inverse, half_hand, t, base, force)
        left = h - t
    external = push - force
    if left <= 0.0 or abs(external) <= stiction:
        return free
    side = 1.0 if external > 0.0 else -1.0
    base = (external - side * coulomb) * inverse  # from rest it may be less than the last digit of either
    return _slid(free, side, force, push, drag, coulomb, inverse, half_hand, left, base, 0.0)


@compiled
def _slid(
    free: Free,
    side_after: float,
    force: float,
    push: float,
    drag: float,
    coulomb: float,
    inverse: float,
    half_hand: float,
    t: float,
    base: float,
    held: float,
) -> Free:
    """After a slide; its acceleration is that of `base` less `held` over the mass."""
    h1, h2, h3 = free_response(drag * inverse, t)
    v0, a0 = free.velocity, base - held * inverse
    v1 = 0.0 if side_after == 0.0 else (v0 + base * h1) - held * (inverse * h1)
    ahead = v0 * t + base * h2
    moved = ahead - held * (inverse * h2)
    squares = v0 * v0 * t + 2.0 * v0 * a0 * h2 + a0 * a0 * h3
    return Free(
        (free.position + ahead) - held * (inverse * h2),
        v1,
        side_after,
        free.hand + (push * moved - half_hand * (v1 - v0) * (v1 + v0)),
        free.actuator - force * moved,
        free.viscous + drag * squares,
        free.dry + coulomb * abs(moved),
        free.source + push * moved,
    )
