"""Prescribed hands for the laws: a plain loop that tempts a law, and the simulator's account of it."""

from fractions import Fraction
from math import floor

import numpy as np

import zwidth as zw

T = Fraction(1, 1000)


def device(damping="0.15", friction=0, resolution=0, **more):
    """A paddle of 36 g at 1 kHz."""
    return zw.Device(
        mass="0.036",
        damping=damping,
        coulomb_friction=friction,
        resolution=resolution,
        sample_period=T,
        **more,
    )


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
    total = -trace.actuator_work + trace.viscous_loss + trace.coulomb_loss
    return total.to_numpy()


def scaled(device, length, force, time):
    """The device in other units: metre, newton and second worth 1/length, 1/force, 1/time."""
    speed = length / time
    more = {} if device.force_limit is None else {"force_limit": device.exact("force_limit") * force}
    return zw.Device(
        mass=device.exact("mass") * force * time / speed,
        damping=device.exact("damping") * force / speed,
        coulomb_friction=device.exact("coulomb_friction") * force,
        resolution=device.exact("resolution") * length,
        sample_period=device.exact("sample_period") * time,
        **more,
    )


LENGTH, FORCE, TIME = Fraction(2**9), Fraction(1, 2**5), Fraction(2**3)
"""Powers of two: every float of the loop is the same but for its exponent."""


def same_in_other_units(device, stage, other, environment, elsewhere, positions):
    """Whether a law gives the same forces in other units, to the last bit."""
    here = follow(device, zw.render(environment, stage), positions).commanded_force.to_numpy()
    there = follow(
        scaled(device, LENGTH, FORCE, TIME), zw.render(elsewhere, other), positions * float(LENGTH)
    ).commanded_force.to_numpy()
    return np.array_equal(here * float(FORCE), there) and np.abs(here).max() > 0
