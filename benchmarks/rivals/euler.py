"""Semi-implicit Euler in plain Python, as a lab writes it: `euler.py STEPS_PER_SAMPLE`.

    v ← v + h (F − b v − f_c sgn v)/m,   x ← x + h v

with v set to 0 where it would change its sign, and left there while |F| ≤ f_c.
"""

from __future__ import annotations

import sys

from task import COULOMB, DAMPING, MASS, PERIOD, START, hand_forces, report, wall_force


def simulate(samples: int, steps: int) -> list[float]:
    """The positions at the sample instants [m]."""
    h = PERIOD / steps
    x, v = START, 0.0
    positions = [x]
    for hand in hand_forces(samples):
        force = hand - wall_force(x)
        for _ in range(steps):
            if v == 0.0:
                if abs(force) > COULOMB:
                    v = h * (force - (COULOMB if force > 0 else -COULOMB)) / MASS
            else:
                after = v + h * (force - DAMPING * v - (COULOMB if v > 0 else -COULOMB)) / MASS
                v = after if (after > 0) == (v > 0) else 0.0
            x += h * v
        positions.append(x)
    return positions


if __name__ == "__main__":
    steps = int(sys.argv[1])
    report(lambda samples: simulate(samples, steps), 20_000 if steps == 1 else 2000)
