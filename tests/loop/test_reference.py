"""The reference simulator against roads of its own: closed forms, mpmath's and scipy's integrators."""

from __future__ import annotations

import math
import random
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from mpmath import mp, mpf
from reference import DIGITS, Loop, Sum, integral, motion, polynomial, simulate, zeros
from scipy.integrate import solve_ivp

FREE = Loop(
    mass=0.036,
    damping=0.0,
    coulomb=0.12,
    period=0.001,
    resolution=22.4e-6,
    wall_stiffness=0.0,
    position=-0.05,
    velocity=0.3,
)
PUSH = [1 + 0.5 * math.sin(0.01 * math.pi * k) for k in range(1000)]
PATH = [0.03 * math.sin(0.02 * k) - 0.01 for k in range(1001)]

PADDLE = Loop(
    mass=0.036,
    damping=0.15,
    coulomb=0.12,
    period=0.001,
    resolution=22.4e-6,
    wall_stiffness=770.0,
    position=-0.003,
    force=PUSH,
)
HELD = replace(PADDLE, hand_mass=0.006, hand_stiffness=500.0, hand_damping=2.0, anchor=PATH)

LOOPS = {
    "free": replace(PADDLE, wall_stiffness=300.0),
    "no viscous friction": replace(PADDLE, damping=0.0),
    "stiction": replace(HELD, stiction=0.2),
    "finger": HELD,
    "no damper": replace(HELD, damping=0.0, hand_damping=0.0),
    "nearly critical": replace(HELD, hand_damping=math.sqrt(4 * 0.042 * 500.0) - 0.15),
    "overdamped": replace(HELD, hand_damping=20.0),
    "lag and damped wall": replace(HELD, lag=2e-4, wall_damping=0.5),
    "slew and delay": replace(HELD, slew=1500.0, delay=1.4e-3),
    "converter and limit": replace(PADDLE, converter_step=0.05, force_limit=2.0),
}


@pytest.fixture(autouse=True)
def _digits():
    with mp.workdps(DIGITS):
        yield


def close(a, b, tolerance="1e-45"):
    return abs(mpf(a) - b) <= mpf(tolerance) * max(1, abs(b))


def test_coulomb_friction_stops_a_free_mass():
    """It stops at m v₀/f_c, after m v₀²/(2 f_c), and stays."""
    trace = simulate(FREE, 120)
    m, fc, v = mpf(FREE.mass), mpf(FREE.coulomb), mpf(FREE.velocity)
    (stop,) = trace.reversals
    assert close(stop, m * v / fc)
    assert close(trace.position[-1], FREE.position + m * v**2 / (2 * fc))
    assert trace.velocity[-1] == 0
    assert close(trace.energy["coulomb_loss"][-1], m * v**2 / 2)


def test_both_frictions_stop_a_free_mass():
    """It stops at (m/b) ln(1 + b v₀/f_c), after (m/b)(v₀ − (f_c/b) ln(1 + b v₀/f_c))."""
    loop = replace(FREE, damping=0.15)
    trace = simulate(loop, 120)
    m, b, fc, v = mpf(loop.mass), mpf(loop.damping), mpf(loop.coulomb), mpf(loop.velocity)
    logarithm = mp.log(1 + b * v / fc)
    assert close(trace.reversals[0], m / b * logarithm)
    assert close(trace.position[-1], loop.position + m / b * (v - fc / b * logarithm))


def test_a_spring_without_damping_swings_for_ever():
    """x − x_a = A cos ωt, turning at every half period."""
    loop = replace(
        FREE, coulomb=0.0, velocity=0.0, hand_mass=0.006, hand_stiffness=500.0, anchor=[0.01] * 301
    )
    trace = simulate(loop, 300)
    omega = mp.sqrt(mpf(500) / (mpf(loop.mass) + loop.hand_mass))
    start, middle = mpf(loop.position), mpf(0.01)
    for k in (1, 77, 300):
        assert close(trace.position[k], middle + (start - middle) * mp.cos(omega * k * mpf(0.001)))
    assert len(trace.reversals) == 10
    assert all(close(t, (n + 1) * mp.pi / omega) for n, t in enumerate(trace.reversals))


def test_exactly_critical_damping():
    """x = (x₀ + (v₀ + ω x₀) t) e^{−ωt} where B² = 4 M k."""
    x = motion(mpf(0.25), mpf(8), mpf(64), Sum({}), mpf(-0.7), mpf(3.1))
    s = mpf("0.0637")
    assert close(x(s), (mpf(-0.7) + (mpf(3.1) - 16 * mpf(0.7)) * s) * mp.exp(-16 * s))


def test_products_are_integrated():
    """∫ f g by terms is mpmath's quadrature."""
    f = polynomial(mpf(0.3), mpf(-2)) + Sum({mpf(-5): (mpf(1.5), mpf(0.1))})
    x = motion(mpf(0.042), mpf(2.15), mpf(500), f, mpf(0.01), mpf(-0.3))
    end = mpf("0.013")
    assert close(integral(f, x.derivative(), end), mp.quad(lambda s: f(s) * x.derivative()(s), [0, end]))


def test_no_zero_is_missed():
    """Sums with up to five terms change sign where a fine grid sees them do so, and nowhere else."""
    draw = random.Random(20050)
    several = 0
    for _ in range(60):
        drive = polynomial(draw.gauss(0, 1), draw.gauss(0, 40)) + Sum({mpf(-300): (mpf(draw.gauss(0, 2)),)})
        damping, stiffness = draw.choice([0.0, 0.3, 6.0]), draw.choice([0.0, 500.0])
        x = motion(mpf(0.042), mpf(damping), mpf(stiffness), drive, mpf(0), mpf(draw.gauss(0, 0.02)))
        v, end = x.derivative(), mpf("0.1")
        found = [float(s) for s in zeros(v, end)]
        with mp.workdps(20):
            grid = [k / 400 * 0.1 for k in range(401)]
            seen = [(a, b) for a, b in pairwise(grid) if v(mpf(a)) * v(mpf(b)) < 0]
        assert all(any(a <= s <= b for s in found) for a, b in seen)
        assert all(abs(v(mpf(s))) < 1e-12 for s in found)
        assert len(found) - len(seen) in (0, 2)
        several += len(found) > 1
    assert several >= 10


def test_stiction_holds_until_it_is_outgrown():
    """A spring drawn at speed u breaks loose at f_s/(k u); then f_c < f_s is left of the friction."""
    u, k = 0.04, 500.0
    anchor = [FREE.position + u * j * 0.001 for j in range(41)]
    loop = replace(FREE, velocity=0.0, stiction=0.2, hand_stiffness=k, anchor=anchor)
    trace = simulate(loop, 40)
    assert close(trace.releases[0], mpf(0.2) / (k * mpf(u)), "1e-15")
    first = int(trace.releases[0] / mpf(0.001))
    assert trace.position[first] == mpf(loop.position) < trace.position[first + 1]
    weaker = simulate(replace(loop, stiction=0.12), 40)
    assert close(weaker.releases[0], mpf(0.12) / (k * mpf(u)), "1e-15")


def test_a_push_of_just_the_stiction_is_held():
    """At rest |net force| ≤ f_s moves nothing; one rounding more does."""
    held = replace(FREE, velocity=0.0, force=5 * [FREE.coulomb])
    assert simulate(held, 5).position[-1] == held.position
    pushed = replace(held, force=5 * [math.nextafter(FREE.coulomb, 1)])
    assert simulate(pushed, 5).position[-1] > held.position


def test_delay_and_slew():
    """Force k comes at kT + delay and then rises at its rate."""
    loop = replace(FREE, position=0.0501, velocity=0.0, coulomb=1e3, wall_stiffness=300.0)
    force = mpf(300) * loop.resolution * math.floor(0.0501 / 22.4e-6)
    late = simulate(replace(loop, delay=0.0014), 4)
    assert late.actuator_force == [0, 0, *[late.commanded_force[0]] * 3]
    assert close(late.commanded_force[0], force)
    slow = simulate(replace(loop, delay=0.0014, slew=10000.0), 4)
    ramp = 10000 * (2 * mpf(loop.period) - mpf(0.0014))
    assert close(slow.actuator_force[2], ramp)
    assert close(slow.actuator_force[3], min(force, ramp + 10000 * mpf(loop.period)))
    assert close(slow.actuator_force[4], force)


def test_lag():
    """f_a = f (1 − e^{−t/τ}) under a held command."""
    loop = replace(FREE, position=0.0501, velocity=0.0, coulomb=1e3, wall_stiffness=300.0, lag=2e-4)
    trace = simulate(loop, 3)
    decay = mp.exp(-3 * mpf(loop.period) / mpf(2e-4))
    assert close(trace.actuator_force[3], trace.commanded_force[0] * (1 - decay))


@pytest.mark.parametrize("name", LOOPS)
def test_the_ledgers_close(name):
    """Kinetic energy is work less losses, and the hand's source pays for all, to 1e-40 J."""
    loop = LOOPS[name]
    trace = simulate(loop, 250)
    joules = trace.energy
    ends = range(len(trace.position))
    kinetic = [mpf(loop.mass) / 2 * v**2 for v in trace.velocity]
    hand = [mpf(loop.hand_mass) / 2 * v**2 for v in trace.velocity]
    anchor = loop.anchor or [0.0] * len(ends)
    spring = [mpf(loop.hand_stiffness) / 2 * (mpf(anchor[k]) - trace.position[k]) ** 2 for k in ends]
    for k in ends:
        gained = joules["hand_work"][k] + joules["actuator_work"][k]
        lost = joules["viscous_loss"][k] + joules["coulomb_loss"][k]
        assert close(gained - lost, kinetic[k] - kinetic[0], "1e-40")
        stored = spring[k] - spring[0] + hand[k] - hand[0]
        paid = joules["hand_work"][k] + joules["hand_damper_loss"][k] + stored
        assert close(joules["hand_source_work"][k], paid, "1e-40")
    assert trace.reversals


class Stepped:
    """The same loop by scipy's Runge–Kutta method, halted by events; delay below one sample, no lag."""

    def __init__(self, loop: Loop):
        self.loop, self.x, self.v, self.fa, self.way, self.turns = (
            loop,
            loop.position,
            loop.velocity,
            0.0,
            0,
            0,
        )

    def run(self, samples: int) -> np.ndarray:
        loop, T, positions = self.loop, self.loop.period, [self.x]
        for k in range(samples):
            target = max(loop.wall_stiffness * loop.resolution * math.floor(self.x / loop.resolution), 0.0)
            self.go(k, k * T, k * T + loop.delay, 0.0)
            rate = math.copysign(loop.slew, target - self.fa)
            rise = abs(target - self.fa) / loop.slew if loop.slew else 0.0
            reached = min(k * T + loop.delay + rise, (k + 1) * T)
            self.go(k, k * T + loop.delay, reached, rate)
            if reached < (k + 1) * T:
                self.fa = target
            self.go(k, reached, (k + 1) * T, 0.0)
            positions.append(self.x)
        return np.array(positions)

    def go(self, k: int, time: float, end: float, rate: float):
        loop, start, fa = self.loop, time, self.fa
        speed = (loop.anchor[k + 1] - loop.anchor[k]) / loop.period
        breakaway = loop.coulomb if loop.stiction is None else loop.stiction

        def net(t, x, v):
            anchor = loop.anchor[k] + speed * (t - k * loop.period)
            pull = loop.hand_stiffness * (anchor - x) + loop.hand_damping * (speed - v)
            return loop.force[k] + pull - fa - rate * (t - start)

        def sliding(t, y):
            friction = self.way * loop.coulomb + loop.damping * y[1]
            return [y[1], (net(t, *y) - friction) / (loop.mass + loop.hand_mass)]

        def stop(t, y):
            return y[1] if t > time else self.way * 1.0

        stop.terminal = True
        while end - time > 1e-15:
            if self.way == 0:
                time = self.rest(net, time, end, breakaway)
                continue
            stop.direction = -self.way
            y = solve_ivp(
                sliding, (time, end), [self.x, self.v], "DOP853", rtol=1e-12, atol=1e-15, events=stop
            )
            time, (self.x, self.v) = y.t[-1], y.y[:, -1]
            if y.status == 1:
                self.v, self.way, self.turns = 0.0, 0, self.turns + 1
        self.fa += rate * (end - start)

    def rest(self, net, time, end, breakaway) -> float:
        """Until the net force, straight in time while at rest, outgrows the stiction."""
        now, then = net(time, self.x, 0.0), net(end, self.x, 0.0)
        if abs(now) <= breakaway and abs(then) <= breakaway:
            return end
        force = now if abs(now) > breakaway else then
        self.way = 1 if force > 0 else -1
        if abs(now) > breakaway:
            return time
        return time + (end - time) * (self.way * breakaway - now) / (then - now)


@pytest.mark.parametrize(
    ("changes", "turns", "releases"),
    [
        ({"stiction": 0.3, "force": [0.1 * f for f in PUSH], "anchor": [0.2 * a for a in PATH]}, 6, 3),
        ({"slew": 1500.0, "delay": 3e-4, "hand_damping": 20.0}, 4, 0),
        ({"wall_stiffness": 5000.0, "hand_damping": 0.3}, 24, 0),
    ],
)
def test_stick_and_slip_are_those_of_an_event_driven_integrator(changes, turns, releases):
    """Positions over 0.4 s, with reversals, stops and releases, to what the integrator gives."""
    loop = replace(HELD, **changes)
    stepped = Stepped(loop)
    expected = stepped.run(400)
    trace = simulate(loop, 400)
    assert len(trace.reversals) == stepped.turns == turns
    assert len(trace.releases) == releases
    assert np.abs(np.array([float(x) for x in trace.position]) - expected).max() < 1e-11
