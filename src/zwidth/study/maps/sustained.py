"""Which walls are passive as long as contact lasts: for each virtual damping an interval of stiffness.

With H = K + B V(z) and g = (1 − z⁻¹) z⁻ᵈ (1 − α + α z⁻¹) the criterion is, at each frequency,

    b² − b (T/2) Re{g H}/(1 − cos ωT) − ¼ T² α(1−α) |H|² ≥ 0,

concave in (K, B), and ‖h‖₁, which Coulomb friction has to cover, is convex: between two walls with
one B that are proved every wall is passive too.  Floats say where the interval may end; its ends
are decided exactly and accepted by the independent checker, and what lies between need not be.
"""

from __future__ import annotations

from collections.abc import Callable
from math import floor

import numpy as np
from numpy.typing import NDArray

from zwidth.model.environment import Wall
from zwidth.passivity.certificate import Certificate, certify
from zwidth.passivity.criterion_choice import Decision, decide
from zwidth.quantity.exact import Exact
from zwidth.study.maps.request import Array, Request

Proved = Callable[[int], bool]

_ANGLES = 2000


def sustained_walls(asked: Request) -> NDArray[np.int64]:
    """For each B the first stiffness of the axis that is proved, and the one past the last: 2 × n."""
    k, b = asked.stiffness.values, asked.virtual_damping.values
    found = np.zeros((2, len(b)), dtype=np.int64)
    for j, (low, high) in enumerate(_by_floats(asked, b).T):
        first, past = np.searchsorted(k, low, side="left"), np.searchsorted(k, high, side="right")
        if first < past:
            found[:, j] = _column(asked, float(b[j]), int(first), int(past))
    return found


def _by_floats(asked: Request, b: Array) -> Array:
    """For each B the stiffnesses that the criterion allows at frequencies on a grid: 2 × n."""
    device = asked.device
    period, damping = device.exact("sample_period"), float(device.exact("damping"))
    late = device.exact("delay") / period
    part = float(late - floor(late))
    theta = np.unique(
        np.concatenate([np.geomspace(1e-4, np.pi, _ANGLES), np.linspace(0, np.pi, _ANGLES)[1:]])
    )
    z = np.exp(1j * theta)
    above, below = (np.polyval([float(c) for c in p], z) for p in asked.velocity_filter.transfer(period))
    velocity = above / below
    hold = (1 - 1 / z) * z ** -floor(late) * (1 - part + part / z) / (4 * np.sin(theta / 2) ** 2)
    switching = part * (1 - part) / 4 * float(period)
    low, high = np.full(len(b), -np.inf), np.full(len(b), np.inf)
    for at in range(len(theta)):
        # (c₂ K + c₁) K ≤ c₀, all divided by T
        c2 = switching
        c1 = damping * hold[at].real + 2 * switching * b * velocity[at].real
        c0 = damping * (damping / float(period) - b * (hold[at] * velocity[at]).real)
        c0 = c0 - switching * b**2 * abs(velocity[at]) ** 2
        ends = _between(c2, c1, c0)
        low, high = np.maximum(low, ends[0]), np.minimum(high, ends[1])
    return np.array([low, high])


def _between(c2: float, c1: Array, c0: Array) -> tuple[Array, Array]:
    """The K with c₂ K² + c₁ K ≤ c₀, c₂ ≥ 0; an empty range where there are none."""
    with np.errstate(divide="ignore", invalid="ignore"):
        if c2 == 0:
            low, high = np.where(c1 < 0, c0 / c1, -np.inf), np.where(c1 > 0, c0 / c1, np.inf)
            never = (c1 == 0) & (c0 < 0)
        else:
            root = np.sqrt(c1**2 + 4 * c2 * c0)
            low, high = (-c1 - root) / (2 * c2), (-c1 + root) / (2 * c2)
            never = np.isnan(root)
    return np.where(never, np.inf, low), np.where(never, -np.inf, high)


def _column(asked: Request, damping: float, first: int, past: int) -> tuple[int, int]:
    """The walls of one B that are proved, both ends with a certificate; 0, 0 without one."""
    k = asked.stiffness.values

    def decided(i: int) -> Decision:
        wall = Wall(Exact(float(k[i])), Exact(damping), velocity_filter=asked.velocity_filter)
        return decide(asked.device, wall)

    def proved(i: int) -> bool:
        return decided(i).is_provable

    def accepted(i: int) -> bool:
        return Certificate((certify(decided(i)),)).verify()

    low, high = _exactly(proved, first, past)
    return (low, high) if low < high and accepted(low) and accepted(high - 1) else (0, 0)


def _exactly(proved: Proved, first: int, past: int) -> tuple[int, int]:
    """The proved part of a range that floats allow."""
    inside = next((i for i in (first, (first + past - 1) // 2, past - 1) if proved(i)), None)
    if inside is None:
        return 0, 0
    return _end(proved, inside, first, -1), _end(proved, inside, past - 1, 1) + 1


def _end(proved: Proved, inside: int, far: int, step: int) -> int:
    """The proved cell nearest to `far`: there, one short of it, or by halving."""
    for i in (far, far - step):
        if (i - inside) * step <= 0:
            return inside
        if proved(i):
            return i
    good, bad = inside, far - step
    while abs(bad - good) > 1:
        middle = (good + bad) // 2
        if proved(middle):
            good = middle
        else:
            bad = middle
    return good
