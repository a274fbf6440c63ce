"""scipy's solve_ivp, started anew at each sample, an event at each zero of the velocity."""

from __future__ import annotations

import math

from scipy.integrate import solve_ivp
from task import COULOMB, DAMPING, MASS, PERIOD, START, hand_forces, report, wall_force


def stops(_t: float, state: list[float], _push: float) -> float:
    """The event: the velocity is 0."""
    return state[1]


stops.terminal = True  # type: ignore[attr-defined]


def motion(_t: float, state: list[float], push: float) -> tuple[float, float]:
    """(v, v̇) while the mass slides; `push` holds the Coulomb friction."""
    return state[1], (push - DAMPING * state[1]) / MASS


def interval(x: float, v: float, force: float) -> tuple[float, float]:
    """One sample interval under a constant force."""
    start = 0.0
    while start < PERIOD:
        if v == 0.0 and abs(force) <= COULOMB:
            break
        side = math.copysign(1.0, v if v != 0.0 else force)
        stops.direction = -side  # type: ignore[attr-defined]
        end = solve_ivp(
            motion,
            (start, PERIOD),
            (x, v),
            method="RK45",
            rtol=1e-9,
            atol=1e-12,
            events=stops,
            args=(force - side * COULOMB,),
        )
        start, x, v = float(end.t[-1]), float(end.y[0, -1]), float(end.y[1, -1])
        if end.status == 1:
            v = 0.0
    return x, v


def simulate(samples: int) -> list[float]:
    """The positions at the sample instants [m]."""
    x, v = START, 0.0
    positions = [x]
    for hand in hand_forces(samples):
        x, v = interval(x, v, hand - wall_force(x))
        positions.append(x)
    return positions


if __name__ == "__main__":
    report(simulate, 2000)
