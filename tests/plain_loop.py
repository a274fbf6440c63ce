"""A sampled loop simulated in the plainest way, for tests to compare with.

Nothing of zwidth is used: positions in, energy taken out by the hand; floats or
Fractions, as given.
"""

from __future__ import annotations

from itertools import pairwise
from math import floor


def forces(numerator, denominator, positions, resolution=0, unilateral=False):
    """f(k) of H(z), coefficients in descending powers of z, by its difference equation."""
    order = len(denominator) - 1
    n = [0] * (order + 1 - len(numerator)) + list(numerator)
    measured = [resolution * floor(x / resolution) if resolution else x for x in positions]
    inside = [max(x, 0) for x in measured] if unilateral else measured
    out = []
    for k in range(len(inside)):
        value = sum(n[i] * inside[k - i] for i in range(min(k, order) + 1))
        value -= sum(denominator[i] * out[k - i] for i in range(1, min(k, order) + 1))
        out.append(value / denominator[0])
    return out


def energy_out(
    law,
    positions,
    *,
    damping,
    friction,
    period,
    resolution=0,
    whole=0,
    part=0,
    switches=None,
    unilateral=False,
):
    """Energy the hand takes out over the motion [J]: constant velocity between the given points."""
    f = forces(*law, positions, resolution, unilateral)
    switches = switches or positions[:-1]
    total = 0
    for k, (here, there) in enumerate(pairwise(positions)):
        early = f[k - whole - 1] if k > whole else 0
        late = f[k - whole] if k >= whole else 0
        legs = [(early, switches[k] - here, part), (late, there - switches[k], 1 - part)]
        for force, step, share in legs if part else legs[1:]:
            total -= force * step + friction * abs(step) + damping * step * step / (share * period)
    return total


def best_switch(here, there, early, late, *, damping, friction, period, part):
    """Where to be when the force changes from `early` to `late`, for the least net work.

    The work is a quadratic with a kink at either end of the step, so its least value
    is at a kink or where one of the three smooth pieces is stationary.
    """

    def work(y):
        a, b = y - here, there - y
        viscous = damping / period * (a * a / part + b * b / (1 - part))
        return early * a + late * b + friction * (abs(a) + abs(b)) + viscous

    middle = here + part * (there - here)
    gain = period / (2 * damping) * part * (1 - part)
    stationary = [middle - gain * (early - late + kink) for kink in (-2 * friction, 0, 2 * friction)]
    return min([here, there, *stationary], key=work)
