"""The simulator against the same loops at sixty digits, which are held against mpmath's integrator."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
import pytest
from mpmath import mp, mpf
from reference import DIGITS, Loop, Sum, motion, polynomial, simulate

import zwidth as zw
from zwidth.model.operator import LinearHand, Operator, Signals

POSITION = 1e-14
"""Largest error of a position [m]."""

VELOCITY = 1e-12
"""Largest error of a velocity [m/s]."""

FORCE = 1e-12
"""Largest error of a force [N]."""

ENERGY = 1e-12
"""Largest error of an energy, as a part of the work done by hand and actuator."""


@dataclass(frozen=True, kw_only=True)
class Given(Operator):
    """The hand of a `Loop`."""

    loop: Loop

    @property
    def hand(self):
        return LinearHand(self.loop.hand_mass, self.loop.hand_stiffness, self.loop.hand_damping)

    def signals(self, times):
        force, anchor = np.array(self.loop.force), np.array(self.loop.anchor)
        return Signals(force=force, anchor=anchor if len(anchor) else None)

    def describe(self, motion="linear"):
        return "as given"


def pushed(samples, period, mean=1.0, swing=0.5):
    """F_k, a push that swings at 5 Hz [N]."""
    return [mean + swing * math.sin(2 * math.pi * 5 * k * period) for k in range(samples)]


def moved(samples, period, middle, swing, frequency):
    """x_a at the samples, swinging [m]."""
    return [middle + swing * math.sin(2 * math.pi * frequency * k * period) for k in range(samples + 1)]


PADDLE = Loop(
    mass=0.036,
    damping=0.15,
    coulomb=0.12,
    period=0.001,
    resolution=22.4e-6,
    wall_stiffness=300.0,
    position=-0.01,
    force=pushed(1000, 0.001),
)
FINGER = replace(
    PADDLE,
    hand_mass=0.006,
    hand_stiffness=500.0,
    hand_damping=2.0,
    force=pushed(400, 0.001, 0.0, 0.1),
    anchor=moved(400, 0.001, 0.002, 0.004, 2.3),
    position=-0.0031,
)
BALL = replace(
    FINGER,
    mass=0.35,
    coulomb=0.2,
    damping=0.5,
    period=0.01,
    wall_stiffness=2000.0,
    hand_damping=4.0,
    force=pushed(100, 0.01, 0.0, 0.1),
    anchor=moved(100, 0.01, -0.001, 0.01, 3.0),
    position=-0.011,
)

LOOPS = {
    "paddle": PADDLE,
    "finger": FINGER,
    "dowel": replace(PADDLE, wall_stiffness=770.0, hand_mass=0.0049, phase=0.37),
    "critical damping": replace(FINGER, hand_damping=math.sqrt(4 * 0.042 * 500.0) - 0.15),
    "overdamped": replace(FINGER, hand_damping=25.0, wall_damping=0.1),
    "no damping": replace(FINGER, damping=0.0, hand_damping=0.0, stiction=0.15),
    "no viscous friction": replace(PADDLE, damping=0.0, coulomb=0.2),
    "stiction": replace(FINGER, stiction=0.2, phase=0.81),
    "short delay": replace(FINGER, delay=0.0003, wall_stiffness=200.0),
    "long delay": replace(FINGER, delay=0.0014, wall_stiffness=100.0),
    "lag": replace(FINGER, lag=0.0002),
    "slew": replace(PADDLE, slew=800.0, force_limit=3.0, stiction=0.15),
    "slew in the hand": replace(FINGER, slew=150.0, force_limit=2.0, delay=0.0003),
    "coarse converter": replace(PADDLE, converter_step=0.01, stiction=0.2),
    "bouncing": BALL,
}


def simulated(loop):
    known = {"force_limit": loop.force_limit, "force_resolution": loop.converter_step}
    if loop.slew:
        known |= {
            "current_limit": 1.0,
            "supply_voltage": loop.slew / loop.force_limit,
            "motor_inductance": 1.0,
        }
    device = zw.Device(
        mass=loop.mass,
        damping=loop.damping,
        coulomb_friction=loop.coulomb,
        stiction=loop.stiction,
        resolution=loop.resolution,
        sample_period=loop.period,
        delay=loop.delay,
        **{key: value for key, value in known.items() if value},
    )
    amplifier = zw.amplifiers.CurrentAmplifier()
    if loop.slew:
        amplifier = zw.amplifiers.VoltageLimited()
    if loop.lag:
        amplifier = zw.amplifiers.FirstOrderLag(loop.lag)
    return zw.simulate(
        device,
        zw.Wall(stiffness=loop.wall_stiffness, damping=loop.wall_damping),
        operator=Given(loop=loop),
        duration=round(len(loop.force) * loop.period, 9),
        initial_position=loop.position,
        initial_velocity=loop.velocity,
        encoder_phase=loop.phase,
        amplifier=amplifier,
    )


def largest(got, expected):
    """The largest difference, taken at the reference's digits."""
    return max(abs(float(mpf(float(a)) - b)) for a, b in zip(got, expected, strict=True))


def states(loop, trace):
    """What the masses and the spring store, by the names of the simulator."""
    anchor = loop.anchor or [0.0] * len(trace.position)
    stretch = [mpf(a) - x for a, x in zip(anchor, trace.position, strict=True)]
    return {
        "kinetic_energy": [mpf(loop.mass) / 2 * v**2 for v in trace.velocity],
        "hand_kinetic_energy": [mpf(loop.hand_mass) / 2 * v**2 for v in trace.velocity],
        "hand_spring_energy": [mpf(loop.hand_stiffness) / 2 * d**2 for d in stretch],
    }


def moved_energy(trace):
    """What hand and actuator did, every sample counted with its size [J]."""
    works = (trace.energy["hand_work"], trace.energy["actuator_work"])
    return sum(float(abs(b - a)) for work in works for a, b in pairwise(work))


@pytest.mark.parametrize("name", LOOPS)
def test_every_sample_is_right(name):
    """Positions to 1e-14 m, energies to 1e-12 of the work done, and every encoder count."""
    loop = LOOPS[name]
    expected, trace = simulate(loop, len(loop.force)), simulated(loop)
    counts = np.rint(trace.measured_position.values / loop.resolution)
    assert counts.tolist() == expected.count
    assert trace.attrs["stops"] == len(expected.reversals) >= 2
    assert largest(trace.position.values, expected.position) <= POSITION
    assert largest(trace.velocity.values, expected.velocity) <= VELOCITY
    assert largest(trace.commanded_force.values, expected.commanded_force) <= FORCE
    assert largest(trace.actuator_force.values, expected.actuator_force) <= FORCE
    assert largest(trace.hand_force.values[:-1], expected.hand_force) <= FORCE
    bound = ENERGY * moved_energy(expected)
    for quantity, joules in (expected.energy | states(loop, expected)).items():
        assert largest(trace[quantity].values, joules) <= bound, quantity


@pytest.fixture
def _digits():
    with mp.workdps(DIGITS):
        yield


def close(a, b, tolerance="1e-45"):
    return abs(mpf(a) - b) <= mpf(tolerance) * max(1, abs(b))


@pytest.mark.parametrize("damping", [0.0, 3.0, 8.0, 8.125, 40.0])
@pytest.mark.parametrize("stiffness", [0.0, 64.0])
@pytest.mark.usefixtures("_digits")
def test_the_motion_obeys_its_equation(damping, stiffness):
    """M ẍ + B ẋ + k x = drive, also where the drive's rate is one of the motion's own."""
    own = -damping / 0.25 if stiffness == 0 else -16.0
    drive = polynomial(mpf(1.3), mpf(-200)) + Sum({mpf(own or -5000): (mpf(0.8),)})
    x = motion(mpf(0.25), mpf(damping), mpf(stiffness), drive, mpf(-0.01), mpf(0.2))
    v = x.derivative()
    assert close(x(mpf(0)), mpf(-0.01))
    assert close(v(mpf(0)), mpf(0.2))
    for s in (mpf("1e-5"), mpf("0.0011")):
        left = mpf(0.25) * v.derivative()(s) + damping * v(s) + stiffness * x(s)
        assert close(left, drive(s), "1e-50")


@pytest.mark.usefixtures("_digits")
def test_a_smooth_piece_is_that_of_a_taylor_integrator():
    """One lagged sample in the hand, by mpmath's Taylor series to 30 digits, its energies too."""
    loop = replace(FINGER, position=0.002, velocity=-0.2, lag=2e-4, wall_damping=0.5)
    trace = simulate(loop, 1)
    f, T, push, start = trace.commanded_force[0], mpf(loop.period), mpf(loop.force[0]), mpf(loop.anchor[0])
    speed = (mpf(loop.anchor[1]) - start) / T

    def rates(t, y):
        x, v, fa = y[:3]
        tie = 500 * (start + speed * t - x) + 2 * (speed - v)
        a = (push + tie - fa + mpf(0.12) - mpf(0.15) * v) / (mpf(0.036) + mpf(0.006))
        hand = push + tie - mpf(0.006) * a
        powers = [hand * v, -fa * v, mpf(0.15) * v**2, -mpf(0.12) * v]
        return [v, a, (f - fa) / mpf(2e-4), *powers, push * v + tie * speed, 2 * (speed - v) ** 2]

    with mp.workdps(34):
        end = mp.odefun(rates, 0, [mpf(0.002), mpf(-0.2)] + 7 * [mpf(0)])(T)
    got = [trace.position[1], trace.velocity[1], trace.actuator_force[1]]
    got += [joules[1] for joules in trace.energy.values()]
    assert not trace.reversals
    assert all(close(a, b, "1e-30") for a, b in zip(got, end, strict=True))
