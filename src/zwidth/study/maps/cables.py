"""Walls that are passive while contact lasts on a device with a transmission: where to look, and between.

The criterion at one angle is a quadratic in H = K + B V.  Doubles at many angles say for each B which run of
K to decide exactly at its ends; of what lies between, `holds_between` is the proof.
"""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from zwidth.model.environment import Wall
from zwidth.passivity.linear.transmission import Elastic, holds_between
from zwidth.passivity.transmission import elastic_of
from zwidth.quantity.balls import precision
from zwidth.quantity.exact import Exact
from zwidth.study.maps.request import Request

_ANGLES = 200
"""Evenly, and as many over the logarithm: a dip between two of them is found where the ends are decided."""


def allowed_walls(asked: Request) -> NDArray[np.int64]:
    """For each B the first run of stiffnesses that doubles allow: where it begins and ends, 2 × n."""
    elastic = _elastic(asked, Fraction(1), 0)
    delay, velocity = elastic.loop.whole_delay, asked.velocity_filter.transfer(elastic.loop.period)
    theta = np.concatenate([np.geomspace(1e-3, np.pi, _ANGLES), np.linspace(0, np.pi, _ANGLES)[1:]])
    with precision(elastic.bits):
        sums = np.array([[complex(s) for s in elastic.sums(Fraction(float(x)))] for x in np.cos(theta)])
    late, squared, curve = sums[:, 1], sums[:, 2].real, sums[:, 3]
    above, below = (np.polyval([float(c) for c in part], 1 / late) for part in velocity)
    hold = (1 - late) * late**delay
    found = []
    for damping in asked.virtual_damping.values:
        law = (asked.stiffness.values[:, None] + damping * above / below) * hold
        allowed = (abs(1 + law * curve) ** 2 >= squared * abs(law) ** 2).all(axis=1)
        turns = np.flatnonzero(np.diff([False, *allowed, False]))
        found.append(turns[:2] if len(turns) else (0, 0))
    return np.array(found, dtype=np.int64).T


def joined(asked: Request, damping: float, low: int, high: int, proved: Callable[[int], bool]) -> bool:
    """Whether all K between two that are proved are proved with them, at once or by halves."""
    ends, half = [Exact(float(asked.stiffness.values[i])).fraction for i in (low, high)], (low + high) // 2
    three = (_elastic(asked, k, damping) for k in (ends[0], (ends[0] + ends[1]) / 2, ends[1]))
    if high - low < 2 or holds_between(*three):
        return True
    return proved(half) and all(joined(asked, damping, *part, proved) for part in ((low, half), (half, high)))


def _elastic(asked: Request, stiffness: Fraction, damping: float) -> Elastic:
    wall = Wall(Exact(stiffness), Exact(damping), velocity_filter=asked.velocity_filter)
    found = elastic_of(asked.whole, wall)
    assert found is not None
    return found
