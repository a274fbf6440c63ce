"""The exact motion in 50 digits, event by event: what every position is compared with.

    v(t) = v∞ + (v0 − v∞) e^{−t/τ},   x(t) = x0 + v∞ t + (v0 − v∞) τ (1 − e^{−t/τ})
    v∞ = (F − f_c sgn v)/b,   τ = m/b

until v is 0 at t = τ ln(1 − v0/v∞); there the mass sticks if |F| ≤ f_c, and else slides
with F.  The parameters are the doubles of the task, so that only the arithmetic differs.
"""

from __future__ import annotations

import json

from mpmath import exp, floor, log, mp, mpf, sign
from task import COMPARED, COULOMB, DAMPING, MASS, PERIOD, RESOLUTION, START, STIFFNESS, hand_forces

mp.dps = 50
TAU = mpf(MASS) / mpf(DAMPING)


def interval(x: mpf, v: mpf, force: mpf, left: mpf) -> tuple[mpf, mpf]:
    """Position and velocity after `left` seconds under a constant force."""
    while True:
        if v == 0 and abs(force) <= COULOMB:
            return x, v
        side = sign(v) if v != 0 else sign(force)
        final = (force - side * mpf(COULOMB)) / mpf(DAMPING)
        stops = v != 0 and final * side < 0
        until = TAU * log(1 - v / final) if stops else left
        t = min(until, left)
        fade = exp(-t / TAU)
        x += final * t + (v - final) * TAU * (1 - fade)
        if t == left and not (stops and until == left):
            return x, final + (v - final) * fade
        v, left = mpf(0), left - t


def positions(samples: int) -> list[float]:
    """The position at each sample instant, rounded once [m]."""
    x, v = mpf(START), mpf(0)
    found = [float(x)]
    for hand in hand_forces(samples):
        measured = mpf(RESOLUTION) * floor(x / mpf(RESOLUTION))
        wall = mpf(STIFFNESS) * measured if measured > 0 else mpf(0)
        x, v = interval(x, v, mpf(hand) - wall, mpf(PERIOD))
        found.append(float(x))
    return found


if __name__ == "__main__":
    print(json.dumps({"positions": positions(COMPARED)}))
