"""Two hands that try to take energy out: they hold each speed within a period, and no law can ask for more.

In a period a hand that goes Δx puts in

    b Δx²/T + f_c |Δx| − f Δx

beside the kinetic energy, which comes back: no motion between two samples costs it less.  For the force f
most comes out at Δx = (|f| − f_c) T/(2b) sgn f, (|f| − f_c)² T/(4b).
"""

from __future__ import annotations

from typing import NamedTuple

from zwidth.links import laws
from zwidth.links.kernel import End
from zwidth.links.memory import ACTING, COULOMB, DAMPING, PERIOD, RESOLUTION
from zwidth.links.wire import deliver, post
from zwidth.loop.law import measured
from zwidth.native.compiled import Array, compiled


class Hand(NamedTuple):
    """What one hand does.

    Until sample `until` it goes `size` [m; rad] in each period, or `draws` times that where there are any,
    and turns round after every `half` periods.  Then it takes what there is to take, at most `most` in a
    period, and rests where the force is below friction.
    """

    size: float
    half: int
    until: int
    most: float
    draws: Array


@compiled
def displacement(hand: Hand, p: Array, k: int, force: float) -> float:
    """Where a hand goes in period k."""
    if k < hand.until:
        way: float = hand.size * (hand.draws[k] if hand.draws.size > 0 else 1.0)
        return way if (k // hand.half) % 2 == 0 else -way
    more = abs(force) - p[COULOMB]
    if more <= 0.0:
        return 0.0
    far = min(more * p[PERIOD] / (2.0 * p[DAMPING]), hand.most) if p[DAMPING] > 0.0 else hand.most
    return far if force > 0.0 else -far


@compiled
def put_in(p: Array, force: float, moved: float) -> float:
    """What a hand puts in over a period [J]."""
    work: float = (p[DAMPING] * abs(moved) / p[PERIOD] + p[COULOMB]) * abs(moved) - force * moved
    return work


@compiled
def reading(p: Array, x: float) -> float:
    """Of an encoder whose edges are at whole counts."""
    return measured(x, p[RESOLUTION], 0.0)


@compiled
def try_hands(near: End, leader: Hand, far: End, follower: Hand, positions: Array, forces: Array) -> float:
    """The least that both hands have put in, over all samples [J]; below 0 it has come out of nothing.

    Both arrays have a row for each end; positions starts with where each hand starts.
    """
    samples = forces.shape[1]
    total, least = 0.0, 0.0
    for k in range(samples):
        total += one_end(near, leader, k, positions[0, :], forces[0, :])
        total += one_end(far, follower, k, positions[1, :], forces[1, :])
        post(far.hears, near.state)
        post(near.hears, far.state)
        least = min(least, total)
    return least


@compiled
def one_end(end: End, hand: Hand, k: int, positions: Array, forces: Array) -> float:
    """A period of one end: hear, push, move, and make a packet; returns what the hand puts in."""
    deliver(end.hears, k, end.state)
    p = end.numbers
    laws.force(end.code, p, end.state)
    f = end.state[ACTING]
    x = positions[k]
    after = x + displacement(hand, p, k, f)
    laws.send(end.code, p, end.state, reading(p, after) - reading(p, x))
    positions[k + 1], forces[k] = after, f
    return put_in(p, f, after - x)
