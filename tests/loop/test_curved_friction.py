"""Arms of a pair with friction that falls with speed: by other roads, and every joule."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import zwidth as zw
from zwidth.loop.pair.setup import lines_of

ARM = zw.Device(damping="0.2", mass="0.05", coulomb_friction="0.1", resolution=0, delay=0, rate="1 kHz")
PAIR = zw.Pair(ARM, ARM, stiffness=60, delay="1 ms")
FALLS = zw.FrictionCurve([0, "0.05", 1], ["0.3", "0.1", "0.4"])
HAND = zw.operators.Finger(mass=0.01, stiffness=100, damping=0.5, force=5, start=0)


def free(curve: zw.FrictionCurve, hand: zw.operators.Operator, duration: float):
    """An arm that feels next to nothing of the other one."""
    return zw.simulate(PAIR.replace(stiffness="1e-9"), hand, None, duration, friction=curve)


def test_the_lines_of_a_curve():
    np.testing.assert_allclose(
        lines_of(FALLS), [[0, 0.3, -4], [0.05, 0.1 - 0.05 * 0.3 / 0.95, 0.3 / 0.95]], rtol=1e-12
    )
    falling = zw.FrictionCurve(["0.1", "0.2"], [2, 1])
    np.testing.assert_allclose(lines_of(falling), [[0, 2, 0], [0.1, 3, -10], [0.2, 1, 0]], rtol=1e-12)


def test_one_line_is_coulomb_and_viscous_friction():
    line = zw.FrictionCurve([0, 1], ["0.1", "0.3"])
    curved, plain = (zw.simulate(PAIR, HAND, zw.Wall(200, 1), 0.5, friction=f) for f in (line, None))
    for name in ("position", "velocity", "hand_work", "coulomb_loss", "viscous_loss"):
        np.testing.assert_allclose(curved[name], plain[name], rtol=0, atol=1e-12)


@pytest.mark.parametrize("force", [0.31, 0.5])
def test_a_push_along_the_curve_as_an_integrator_has_it(force):
    """From rest over the falling part; below f(0) it does not move."""
    trace = free(FALLS, zw.operators.ConstantForce(force=force), 0.4)

    def friction(v):
        return np.interp(v, [0, 0.05, 1, 11], [0.3, 0.1, 0.4, 0.4 + 10 * 0.3 / 0.95])

    other = solve_ivp(
        lambda t, s: [s[1], (force - friction(s[1])) / 0.05],
        (0, 0.4), [0, 0], rtol=1e-10, atol=1e-13, max_step=1e-3, t_eval=trace.time.values,
    )  # fmt: skip
    leader = trace.sel(arm="leader")
    np.testing.assert_allclose(leader["velocity"], other.y[1], rtol=0, atol=1e-7)
    np.testing.assert_allclose(leader["position"], other.y[0], rtol=0, atol=1e-7)
    held = free(FALLS, zw.operators.ConstantForce(force=0.299), 0.05)
    assert float(np.abs(held["position"]).max()) == 0


@pytest.mark.parametrize("hand", [HAND, zw.operators.PrescribedMotion(lambda t: 0.01 * np.sin(20 * t))])
def test_every_joule(hand):
    trace = zw.simulate(PAIR, hand, zw.Wall(200, 1), 0.5, friction=FALLS)
    assert trace.zwidth.energy.closes
    lost = trace["coulomb_loss"] + trace["viscous_loss"]
    moved = np.abs(np.diff(trace["position"])).sum()
    assert float(lost.isel(time=-1).sum()) > 0.1 * moved
    assert bool((lost.diff("time") >= -1e-15).all())


def test_it_sticks_and_slips_where_friction_falls():
    """Drawn slowly by a spring: with the falling part in jumps, without it steadily."""
    slow = zw.operators.Finger(mass=0, stiffness=100, damping=0.1, force=100, speed=0.01, start=0)
    flat = zw.FrictionCurve([0, 1], ["0.3", "0.6"])
    falls, even = (free(curve, slow, 4.0).attrs["leader_stops"] for curve in (FALLS, flat))
    assert falls > 5
    assert even <= 1


def led_together(pair: zw.Pair) -> float:
    """What two hands get out that lead both arms to and fro at 0.05 m/s, with the real curve."""
    t = np.arange(2001) * 1e-3
    path = 0.05 * np.abs((t + 0.125) % 0.5 - 0.25)
    hand = zw.operators.PrescribedMotion(path - path[0])
    return zw.simulate(pair, hand, hand, 2.0, friction=FALLS).zwidth.energy.got_out


def test_what_is_proved_with_the_line_below_is_quiet_with_the_curve():
    damping = FALLS.largest_damping
    arm = ARM.replace(damping=damping, coulomb_friction=FALLS.largest_coulomb_friction(damping))
    pair = zw.Pair(arm, arm, stiffness=100, delay="1 ms")
    for coulomb, gains in (("0.08", False), ("0.15", True)):
        law = zw.FrictionCompensation(coulomb=coulomb, speed="0.02")
        compensated = pair.replace(compensation=law)
        assert zw.check(compensated).passive is not gains
        assert (led_together(compensated) > 0) is gains


def test_bad_input():
    with pytest.raises(zw.InputError, match="friction of the follower is a FrictionCurve or None"):
        zw.simulate(PAIR, HAND, None, 0.1, friction=(None, 0.3))
    with pytest.raises(zw.InputError, match="of the arms of a pair"):
        zw.simulate(ARM, zw.Wall(100), HAND, 0.1, friction=FALLS)
