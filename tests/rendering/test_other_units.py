"""Length, force and time in other units, by powers of two: the same loop, to the last bit."""

from fractions import Fraction

import numpy as np
import pytest
from prescribed import device, follow, tempt, wall, wandering

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

LENGTH, FORCE, TIME = Fraction(2**9), Fraction(1, 2**5), Fraction(2**3)
"""Powers of two: every float of the loop is the same but for its exponent."""

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


def scaled(device):
    """The device with metre, newton and second worth 1/LENGTH, 1/FORCE, 1/TIME of them."""
    scales = {
        "mass": DAMP * TIME,
        "damping": DAMP,
        "coulomb_friction": FORCE,
        "resolution": LENGTH,
        "sample_period": TIME,
        "force_limit": FORCE,
    }
    return zw.Device(**{key: device.exact(key) * scale for key, scale in scales.items()})


@pytest.mark.parametrize(("law", "options"), LAWS)
@pytest.mark.parametrize(("friction", "resolution"), [(0, 0), ("0.0625", "0.00005")])
def test_units_do_not_matter(law, options, friction, resolution):
    paddle = device(friction=friction, resolution=resolution, force_limit=4)
    there = {k: Fraction(v) * SCALED[k] if k in SCALED else v for k, v in options.items()}
    positions = np.concatenate([tempt(wall(2048), paddle, 300, 3)[0], wandering(300)])
    here = follow(paddle, zw.render(zw.Wall(2048), law(**options)), positions)
    elsewhere = zw.render(zw.Wall(2048 * STIFF), law(**there))
    force = follow(scaled(paddle), elsewhere, positions * float(LENGTH)).commanded_force.to_numpy()
    assert np.array_equal(here.commanded_force.to_numpy() * float(FORCE), force)
    assert np.abs(force).max() > 0
