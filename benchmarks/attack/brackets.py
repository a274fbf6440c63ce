"""Do the motions of a bracket keep the speed and the depth that were asked for?

Spring walls beyond 2b/T behind an encoder.  Of each bracket the motion is looked at, its
lead-in included; and the bracket for this hand is never worse than that for every hand.
"""

from __future__ import annotations

from fractions import Fraction
from itertools import pairwise

import numpy as np

import zwidth as zw

from .loops import decades, typed

SLACK = Fraction(1, 10**9)
"""Of speed and depth: bounds are those that were typed."""


def bracket(seed: int, effort: float = 2.0) -> str:
    """What is wrong with the bracket of a seed, "" for nothing."""
    rng = np.random.default_rng([20_251, seed])
    period = Fraction(1, int(rng.choice([500, 1000, 2000])))
    damping, count = typed(decades(rng, -1, 0)), typed(decades(rng, -5, -4))
    k = 2 * damping / period * typed(decades(rng, 0, 0.5))
    friction = typed(float(k * count / 2) * decades(rng, -0.1, 0.6))
    depth, speed = count * int(rng.integers(6, 24)), typed(float(count / period) * 8 * rng.random() + 1e-3)
    device = zw.Device(
        mass="0.05",
        damping=damping,
        coulomb_friction=friction,
        resolution=count,
        sample_period=period,
        delay=0,
    )
    found = zw.limit(device, zw.Wall(k), speed=speed, penetration=depth, effort=effort)
    words = f"{device!r}, speed {float(speed):g}, penetration {float(depth):g}"
    motion = getattr(found.witness, "motion", None)
    if motion is not None:
        fastest = max(abs(b - a) for a, b in pairwise(motion.positions)) / period
        if fastest > speed * (1 + SLACK):
            return f"a motion at {float(fastest):.4g} m/s: {words}"
        if motion.depth > depth * (1 + SLACK):
            return f"a motion to {float(motion.depth):.4g} m: {words}"
    every = zw.limit(device, zw.Wall(k), effort=effort)
    here, anywhere = found.proved_passive, every.proved_passive
    if here is not None and anywhere is not None and here < anywhere:
        return f"this hand {float(here):.6g}, every hand {float(anywhere):.6g}: {words}"
    return ""
