"""The commands of laws in a chain at prescribed positions, sample by sample."""

import numpy as np

import zwidth as zw

PERIOD, COUNT = 1e-3, 2e-5
DEVICE = zw.Device(
    mass=0.07,
    damping=0.1,
    sample_period=PERIOD,
    resolution=COUNT,
    force_limit=9,
    force_resolution=0.02,
    motor_inductance=1e-3,
    supply_voltage=24,
    current_limit=3,
    name="rig",
)


def touched(positions, *stages, environment=None, device=DEVICE, **options):
    """The trace of a prescribed motion; the amplifier is ideal unless told."""
    law = zw.render(zw.Wall(0) if environment is None else environment, *stages)
    hand = zw.operators.PrescribedMotion(np.asarray(positions, dtype=float))
    duration = float(device.exact("sample_period")) * (len(positions) - 1)
    options.setdefault("amplifier", zw.amplifiers.Ideal())
    return zw.simulate(device, law, hand, duration + 1e-9, **options)


def commands(positions, *stages, **options):
    trace = touched(positions, *stages, **options)
    return trace.measured_position.values, trace.commanded_force.values


def wandering(count=600, seed=3, speed=0.08):
    """In and out of the wall, slow and fast, with stops."""
    random = np.random.default_rng(seed)
    v = np.repeat(random.normal(0, speed, count // 12 + 1) * random.integers(0, 2, count // 12 + 1), 12)[
        :count
    ]
    x = np.cumsum(v) * PERIOD
    return 0.6 * (x - x.mean()) + 1e-3 * np.sin(np.arange(count) * 0.031)
