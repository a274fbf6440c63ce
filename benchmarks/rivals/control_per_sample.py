"""python-control's input_output_response, started anew at each sample.

It joins no continuous system to a discrete one, hence the restart, and has no
events, hence f_c tanh(v/v_s) for the Coulomb friction.
"""

from __future__ import annotations

import math
from typing import Any

import control
import numpy as np
from task import COULOMB, DAMPING, MASS, PERIOD, START, hand_forces, report, wall_force

SLIP = 1e-4
"""v_s [m/s]: of 1e-2, 1e-3 and 1e-4 the one of least error."""


def motion(_t: float, state: Any, inputs: Any, _params: Any) -> tuple[float, float]:
    """(v, v̇)."""
    v = state[1]
    return v, (inputs[0] - DAMPING * v - COULOMB * math.tanh(v / SLIP)) / MASS


def simulate(samples: int) -> list[float]:
    """The positions at the sample instants [m]."""
    device = control.nlsys(motion, None, inputs=1, states=2)
    instants = np.array([0.0, PERIOD])
    state = np.array([START, 0.0])
    positions = [START]
    for hand in hand_forces(samples):
        force = hand - wall_force(state[0])
        answer = control.input_output_response(device, instants, np.full((1, 2), force), state)
        state = answer.states[:, -1]
        positions.append(state[0])
    return positions


if __name__ == "__main__":
    report(simulate, 2000)
