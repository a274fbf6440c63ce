"""What the papers report, as simulations: each statement from both sides."""

import numpy as np
import pytest

import zwidth as zw

PADDLE = zw.catalogue.device("haptic-paddle")
COARSE = PADDLE.replace(resolution="2.24 mm")
HANDS = zw.operators


@pytest.mark.parametrize("hand", [HANDS.TypicalTouch(), HANDS.MaliciousTouch(), HANDS.Dowel()])
def test_only_a_dowel_sustains_a_vibration_and_only_at_770(hand):
    """Abbott & Okamura (2005), figures 8 and 9; the malicious touch turns more often on the stiffer wall."""
    soft, stiff = (zw.simulate(PADDLE, zw.Wall(k), hand, 2.0) for k in (300.0, 770.0))
    swings = [float(np.ptp(trace.position.values[-trace.sizes["time"] // 4 :])) for trace in (soft, stiff)]
    assert swings[0] < 1e-5
    assert swings[1] > 0.02 if hand == HANDS.Dowel() else swings[1] < 1e-5
    if hand == HANDS.MaliciousTouch():
        assert stiff.attrs["stops"] > soft.attrs["stops"] > 3


@pytest.mark.parametrize(
    ("stiffness", "buzzes"), [(240.0, True), (120.0, True), (90.0, False), (80.0, False)]
)
def test_the_coarse_encoder_buzzes_above_its_bound_only(stiffness, buzzes):
    """Figure 10: 240 and 120 N/m buzz, 80 does not; 90 N/m is below 2f_c/Δ = 107, so the model is still."""
    trace = zw.simulate(COARSE, zw.Wall(stiffness), HANDS.SoftTouch(), 3.0)
    changes = np.count_nonzero(np.diff(trace.actuator_force.values[-1000:]))
    assert changes > 100 if buzzes else changes == 0


@pytest.mark.parametrize("force", [0.125, 0.15, 0.2])
def test_a_push_buzzes_where_it_is_thrown_back_over_the_edge(force):
    """K Δ − F > f_c, on both sides of the stiffness where both are equal."""
    edge = (force + 0.12) / 2.24e-3
    hand = HANDS.SoftTouch(force=force)
    quiet, loud = (zw.simulate(COARSE, zw.Wall(k * edge), hand, 3.0) for k in (0.97, 1.03))
    assert quiet.attrs["stops"] < 10
    assert loud.attrs["stops"] > 200


def test_the_two_modes_do_not_know_of_each_other():
    k = np.arange(540.0, 661.0, 10.0)
    limits = []
    for device in (PADDLE, COARSE):
        vary = {"environment.stiffness": k}
        swing = zw.simulation.simulate_batch(device, zw.Wall(1), HANDS.Dowel(), 4.0, vary=vary).swing.values
        limits.append(k[np.argmax(swing > 1e-3)])
    assert abs(limits[1] / limits[0] - 1) < 0.07
    slow = COARSE.replace(sample_period="3 ms")
    stops = [zw.simulate(slow, zw.Wall(v), HANDS.SoftTouch(), 3.0).attrs["stops"] for v in (112.0, 116.0)]
    assert stops[0] < 10 < 100 < stops[1]


def test_each_bounce_of_the_sampled_ball_is_higher_than_the_last():
    """Gillespie & Cutkosky (1996): 0.35 kg, finger 0.006 kg and 500 N/m, wall 5000 N/m, 100 Hz, undamped."""
    ball = zw.Device(mass=0.35, damping=0, sample_period=0.010)
    finger = HANDS.Tracking([0.004], stiffness=500, damping=0, mass=0.006)
    heights = {}
    for period in (0.010, 1e-5):
        device = ball.replace(sample_period=period)
        points = 40 if period == 0.010 else 1
        x = zw.simulate(
            device, zw.Wall(5000), finger, 0.4, initial_position=-0.02, points_per_sample=points
        ).position.values
        turns = np.flatnonzero((x[1:-1] < x[:-2]) & (x[1:-1] <= x[2:])) + 1
        heights[period] = -x[turns]
    assert (np.diff(heights[0.010]) > 0).all()
    assert heights[0.010][0] > 0.03
    assert heights[1e-5] == pytest.approx(0.02, rel=0.02)


@pytest.mark.parametrize("speed", [0.05, 0.2, 1.0])
def test_the_staircase_leaks_half_k_v_t_squared_per_sample(speed):
    """Colgate & Schenkel's picture, and b = K T/2 pays for it exactly."""
    period, stiffness, count = 1e-3, 800.0, 7
    path = speed * period * np.concatenate([np.arange(count + 1), np.arange(count - 1, -1, -1)])
    motion = HANDS.PrescribedMotion(path)
    bare = zw.Device(mass=0.05, damping=0, sample_period=period)
    trace = zw.simulate(bare, zw.Wall(stiffness), motion, 2 * count * period)
    leak = 2 * count * 0.5 * stiffness * (speed * period) ** 2
    assert float(trace.actuator_work[-1]) == pytest.approx(leak, rel=1e-12)
    for part, sign in ((0.99, -1), (1.01, 1)):
        damped = bare.replace(damping=part * stiffness * period / 2)
        end = zw.simulate(damped, zw.Wall(stiffness), motion, 2 * count * period).isel(time=-1)
        assert np.sign(float(end.hand_work - end.kinetic_energy)) == sign
