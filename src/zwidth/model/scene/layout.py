"""Where everything stands in the two arrays of a scene that is stepped."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from zwidth.model.scene.nonlinear import CONTACT

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

# The packed scene: T; how many free nodes, linear elements and others; where the rows of the others begin,
# the factor, and N G⁻¹ Nᵀ.  A row is R and g, or a code and where its numbers begin; then two free nodes,
# each with its weight, and the weight of the port.  The factor has of each node where its column of L begins,
# how long that is, and 1/d; a column is places and values in turn.  Of friction the numbers are F and 1/ε.
PERIOD, NODES, LINEAR, OTHERS, OTHER_ROWS, FACTOR, COMPLIANCE = range(7)
HEADER = 7
ROW = 7

# What a scene remembers: the reading, the force and the work of the port, and the energy that is left over;
# then b of each linear element, the state and the force of each other, the velocity and the position of each
# free node, work and loss of each element, and room to compute in.
READING, FORCE, WORK, LEFT_OVER = range(4)
WAVES = 4


def scene_at_rest(p: Array, at: int, reading: float) -> Array:
    """What a scene remembers at rest, its port at a reading; contacts are as far apart as their gaps say."""
    n, linear, k = (int(p[at + i]) for i in (NODES, LINEAR, OTHERS))
    m = np.zeros(WAVES + linear + 2 * k + 2 * n + 2 * (linear + k) + n + k * (k + 6) + 1)
    m[READING] = reading
    for i in range(k):
        code, number = p[at + int(p[at + OTHER_ROWS]) + ROW * i :][:2]
        if code == CONTACT:
            m[WAVES + linear + i] = -p[at + int(number) + 2]
    return m
