"""Length, force and time in other units, by powers of two: the same loop, to the last bit."""

from fractions import Fraction

import numpy as np
import pytest
from prescribed import wandering
from tempting import FORCE, LENGTH, TIME, device, same_in_other_units, tempt, wall

import zwidth as zw
from zwidth.model.rendering import (
    DualRate,
    EnergyBounding,
    EnergyTank,
    ForceBounding,
    Held,
    PassiveLeap,
    PassivityController,
    RateTerm,
    WindowedController,
)

STIFF, DAMP, ENERGY = FORCE / LENGTH, FORCE * TIME / LENGTH, FORCE * LENGTH
SCALED = {
    "level": ENERGY,
    "refill": DAMP / ENERGY,
    "largest_damping": DAMP,
    "slowest": LENGTH / TIME,
    "stiffness": STIFF,
    "slope": STIFF,
    "time_constant": TIME,
}

LAWS = [
    (EnergyBounding, {}),
    (EnergyTank, {}),
    (EnergyTank, {"level": "0.002", "refill": 70, "largest_damping": "0.1"}),
    (ForceBounding, {}),
    (ForceBounding, {"resets": True}),
    (PassiveLeap, {}),
    (PassiveLeap, {"stiffness": 500}),
    (PassivityController, {}),
    (PassivityController, {"largest_damping": "0.2", "credit": True, "slowest": "0.03"}),
    (WindowedController, {"slowest": "0.03", "largest_damping": "0.1", "window": 7, "share": "0.5"}),
    (RateTerm, {"time_constant": "0.0015"}),
    (DualRate, {"samples": 7}),
    (DualRate, {"samples": 7, "updates": "jump"}),
    (DualRate, {"samples": 7, "slope": 100}),
    (Held, {"samples": 3}),
]


@pytest.mark.parametrize(("law", "options"), LAWS)
@pytest.mark.parametrize(("friction", "resolution"), [(0, 0), ("0.0625", "0.00005")])
def test_units_do_not_matter(law, options, friction, resolution):
    paddle = device(friction=friction, resolution=resolution, force_limit=4)
    there = {k: Fraction(v) * SCALED[k] if k in SCALED else v for k, v in options.items()}
    positions = np.concatenate([tempt(wall(2048), paddle, 300, 3)[0], wandering(300)])
    walls = zw.Wall(2048), zw.Wall(2048 * STIFF)
    assert same_in_other_units(paddle, law(**options), law(**there), *walls, positions)
