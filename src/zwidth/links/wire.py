"""One way of a link as the kernels see it: what was sent, and what is heard at which sample."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from zwidth.links.memory import ENERGY, NUMBER, POSITION, WAVE, hear
from zwidth.native.compiled import Array, compiled

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Ticks = NDArray[np.int64]


class Wire(NamedTuple):
    """`when` and `again` of each packet are as of `Schedule.arrivals`; the rest is filled by and by.

    `first` has for each sample the packet that is heard first, `following` for each packet the next one
    that is heard at the same sample, duplicates counted on behind the packets; −1 for none.
    """

    when: Ticks
    again: Ticks
    first: Ticks
    following: Ticks
    told: Array


def wire_of(when: Ticks, again: Ticks, samples: int) -> Wire:
    """An empty one."""
    count = when.size
    return Wire(when, again, np.full(samples + 1, -1), np.full(2 * count, -1), np.zeros((count, 3)))


@compiled
def post(wire: Wire, s: Array) -> None:
    """Put the packet that the state holds on the way."""
    number = int(s[NUMBER])
    count = wire.when.size
    wire.told[number, 0], wire.told[number, 1], wire.told[number, 2] = s[WAVE], s[ENERGY], s[POSITION]
    for due, node in ((wire.when[number], number), (wire.again[number], number + count)):
        if 0 <= due < wire.first.size:
            wire.following[node] = wire.first[due]
            wire.first[due] = node


@compiled
def deliver(wire: Wire, k: int, s: Array) -> None:
    """Let a port hear all that arrives at sample k."""
    node = wire.first[k]
    while node >= 0:
        number = node % wire.when.size
        hear(s, float(number), wire.told[number, 0], wire.told[number, 1], wire.told[number, 2])
        node = wire.following[node]
