"""Prescribed hands for the laws: one that tempts a law, one that wanders; and what is made of them."""

from fractions import Fraction
from math import floor

import numpy as np

import zwidth as zw

T = Fraction(1, 1000)


def device(damping="0.15", friction=0, resolution=0, **more):
    """A paddle of 36 g at 1 kHz."""
    given = {"coulomb_friction": friction, "resolution": resolution, **more}
    return zw.Device(mass="0.036", damping=damping, sample_period=T, **given)


def read(x, resolution):
    return resolution * floor(x / resolution) if resolution > 0 else x


def wall(stiffness):
    return lambda x: max(stiffness * x, 0.0)


def tempt(law, device, samples, seed, depth=0.003):
    """The positions of a hand that knows the force, and the forces: at random the move that takes out most.

    `law` maps a reading to a force.  Between such moves it presses, wanders, jitters about an edge of the
    encoder or stands still.
    """
    rng = np.random.default_rng(seed)
    b, fc, size = (float(device.exact(key)) for key in ("damping", "coulomb_friction", "resolution"))
    x, positions, forces = float(rng.uniform(-depth, depth)), [], []
    kind, left = 0, 0
    for _ in range(samples + 1):
        force = law(read(x, size))
        positions.append(x)
        forces.append(force)
        if left == 0:
            kind, left = int(rng.integers(7)), int(rng.integers(1, 12))
        left -= 1
        if kind == 0:  # the best move of one sample
            x -= np.sign(force) * max(abs(force) - fc, 0.0) * float(T) / (2 * b) * rng.uniform(0.7, 1.2)
        elif kind == 1:  # inwards, less and less
            x += (depth - x) * rng.uniform(0, 0.3)
        elif kind == 2:
            x += rng.normal(0, depth / 5)
        elif kind == 3 and size > 0:  # to and fro over an edge
            edge = size * round(x / size)
            x = edge + (1e-9 if x < edge else -1e-9) * size
        elif kind == 4 and size > 0:  # a count out, quickly
            x = size * floor(x / size) - size * rng.uniform(0, 1)
        elif kind == 5:
            x -= rng.uniform(0, 0.1) * depth
        x = min(max(x, -2 * depth), 2 * depth)
    return np.array(positions), np.array(forces)


def follow(device, environment, positions, **more):
    duration = (len(positions) - 1) * device.exact("sample_period")
    return zw.simulate(device, environment, zw.operators.PrescribedMotion(positions), duration, **more)


def energy_in(trace):
    """What the hand has put in besides moving the mass [J]: actuator work and friction."""
    return (-trace.actuator_work + trace.viscous_loss + trace.coulomb_loss).to_numpy()


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
    steps = random.normal(0, speed, count // 12 + 1) * random.integers(0, 2, count // 12 + 1)
    x = np.cumsum(np.repeat(steps, 12)[:count]) * PERIOD
    return 0.6 * (x - x.mean()) + 1e-3 * np.sin(np.arange(count) * 0.031)
