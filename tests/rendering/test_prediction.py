"""Laws that look ahead, against plain loops in numpy and an adaptive integrator."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.signal import cont2discrete

import zwidth as zw
from zwidth.model.rendering import CrossingCorrection, Extrapolation, HalfSamplePrediction, PoleMatched
from zwidth.model.rendering.ahead import half_sample_step
from zwidth.model.rendering.rendering_law import LoopContext

T = 0.009
DEVICE = zw.Device(mass=0.31, damping=0.7, sample_period=T)
FINGER = {"finger_mass": 0.011, "finger_stiffness": 430, "finger_damping": 1.3, "finger_position": 0.0037}
MASS, DRAG, SPRING, REST = 0.31 + 0.011, 0.7 + 1.3, 430.0, 0.0037
HAND = zw.operators.Tracking([REST], stiffness=SPRING, damping=1.3, mass=0.011)


def simulated(law, duration=0.9, device=DEVICE, start=-0.017):
    trace = zw.simulate(device, law, HAND, duration, initial_position=start)
    return trace.position.values, trace.velocity.values, trace.commanded_force.values


def hold(time):
    """Φ, Γ of a push towards the wall held for a time."""
    a, b = np.array([[0, 1], [-SPRING / MASS, -DRAG / MASS]]), np.array([[0], [1 / MASS]])
    phi, gamma, *_ = cont2discrete((a, b, np.eye(2), np.zeros((2, 1))), time)
    return phi, gamma[:, 0]


def plain_loop(law, samples, start=-0.017):
    """The same loop; law(state, f) -> f from the true state and the force before."""
    phi, gamma = hold(T)
    state, force, rows = np.array([start, 0.0]), 0.0, []
    for _ in range(samples):
        force = law(state, force)
        rows.append((*state, force))
        state = phi @ state + gamma * (SPRING * REST - force)
    return np.array(rows).T


def assert_same(law, reference, tolerance=1e-9, samples=100):
    x, _, f = simulated(law)
    position, _, force = plain_loop(reference, samples)
    assert x[:samples] == pytest.approx(position, abs=tolerance * np.max(np.abs(position)))
    assert f[:samples] == pytest.approx(force, abs=tolerance * np.max(np.abs(force)))
    assert np.sum(np.diff(np.sign(position)) != 0) >= 4  # contact is made and broken


def test_extrapolations_in_a_row():
    """Each extrapolates what the one before it gives; the surface is where the last says."""
    x, _, f = simulated(zw.render(zw.Wall(731), Extrapolation(samples="0.3"), Extrapolation(samples="0.9")))
    once = x + 0.3 * np.diff(x, prepend=x[0])
    twice = once + 0.9 * np.diff(once, prepend=x[0])
    assert f[:-1] == pytest.approx(731 * np.maximum(twice, 0)[:-1], rel=1e-12)


def test_half_sample_prediction_sample_by_sample():
    """The velocity that two readings tell is the true one; the wall is met T/2 ahead under the last force."""
    phi, gamma = hold(T / 2)

    def law(state, force):
        return 1900 * max((phi @ state + gamma * (SPRING * REST - force))[0], 0.0)

    assert_same(zw.render(zw.Wall(1900), HalfSamplePrediction(**FINGER)), law)


def test_at_the_first_sample_the_hand_is_taken_to_be_at_rest():
    f = simulated(zw.render(zw.Wall(1900), HalfSamplePrediction(**FINGER)), start=0.006)[2]
    phi, gamma = hold(T / 2)
    assert f[0] == pytest.approx(1900 * (phi @ [0.006, 0] + gamma * SPRING * REST)[0], rel=1e-12)


def test_a_push_that_the_model_does_not_know():
    """At rest against d the place T/2 ahead errs by −⅜ d T²/M."""
    law = HalfSamplePrediction(mass="0.37", damping=0)
    packed = np.array(law.numbers(LoopContext(DEVICE, zw.Wall(1))))
    ahead = half_sample_step(packed, 0, np.array([0.002, 1.0]), 0, 0.002, 2.9)
    assert ahead - 0.002 == pytest.approx(-3 / 8 * 2.9 * T**2 / 0.37, rel=1e-9)


def matched_by_numpy(stiffness, damping):
    """(g_x, g_v) by pole placement on the characteristic polynomial, Ackermann's formula."""
    phi, gamma = hold(T)
    poles = np.exp(T * np.roots([MASS, DRAG + damping, SPRING + stiffness]))
    _, one, zero = np.poly(poles).real
    reach = np.column_stack([gamma, phi @ gamma])
    return np.array([0, 1]) @ np.linalg.inv(reach) @ (phi @ phi + one * phi + zero * np.eye(2))


@pytest.mark.parametrize("damping", [0, 4.1])
def test_matched_poles_sample_by_sample(damping):
    wall, law = zw.Wall(2300, damping), PoleMatched(**FINGER)
    gains = matched_by_numpy(2300, damping)
    assert law.gains(LoopContext(DEVICE, wall)) == pytest.approx(gains, rel=1e-10)
    assert_same(zw.render(wall, law), lambda state, _: gains @ state if state[0] > 0 else 0.0)


def test_matched_poles_of_a_free_mass():
    """g_x = (2M/T²)(1 − cos ωT) and g_v = g_x T/2."""
    device = zw.Device(mass=0.31, damping=0, sample_period=T)
    stiff, damp = PoleMatched().gains(LoopContext(device, zw.Wall(2300)))
    assert stiff == pytest.approx(2 * 0.31 / T**2 * (1 - np.cos(np.sqrt(2300 / 0.31) * T)), rel=1e-10)
    assert damp == pytest.approx(stiff * T / 2, rel=1e-10)


def test_matched_poles_of_a_clamped_wall_never_pull():
    smallest = [
        np.min(simulated(zw.render(zw.Wall(2300, 4.1, clamped=c), PoleMatched(**FINGER)))[2])
        for c in (True, False)
    ]
    assert smallest[0] == 0 > smallest[1]


def continuous(state, time, stiffness, damping=0.0, clamped=False):
    """Where a wall without samples has the hand, by Runge-Kutta, restarted where the push begins or ends."""

    def push(x, v):
        f = stiffness * x + damping * v
        return max(f, 0.0) if clamped else f

    def surface(t, y):
        return y[0]

    def release(t, y):
        return stiffness * y[0] + damping * y[1] if clamped and damping else 1.0

    surface.terminal = release.terminal = True
    now, state = 0.0, np.array(state, dtype=float)
    while now < time:
        inside = state[0] > 0 or (state[0] == 0 and state[1] > 0)

        def slope(t, y, inside=inside):
            f = push(*y) if inside else 0.0
            return [y[1], (SPRING * (REST - y[0]) - DRAG * y[1] - f) / MASS]

        run = solve_ivp(
            slope, (now, time), state, "DOP853", rtol=1e-12, atol=1e-15, events=(surface, release)
        )
        now, state = run.t[-1], run.y[:, -1]
        if run.t_events[0].size:
            now, state = now + 1e-13, np.array([np.copysign(1e-16, state[1]), state[1]])
        elif run.t_events[1].size:
            now, state = now + 1e-9, state + 1e-9 * np.array(slope(now, state))
    return state


def correcting(stiffness, damping=0.0, clamped=False, throughout=False):
    """The law in plain Python, which remembers the true state; the velocity is no estimate."""
    phi, gamma = hold(T)
    memory = {"last": None, "plan": []}

    def law(state, force):
        last, memory["last"] = memory["last"], state
        wall = stiffness * state[0] if state[0] > 0 else 0.0
        if len(memory["plan"]) == 2:
            return memory["plan"].pop()
        rested = not memory["plan"]
        memory["plan"] = []
        crossed = last is not None and rested and (state[0] > 0) != (last[0] > 0)
        if not crossed and not (throughout and state[0] > 0):
            return wall
        begin, time = (last, 3 * T) if crossed else (state, 2 * T)
        goal = continuous(begin, time, stiffness, damping, clamped)
        pushes = np.linalg.solve(np.column_stack([phi @ gamma, gamma]), goal - phi @ phi @ state)
        first, second = SPRING * REST - pushes
        memory["plan"] = ["over", second]
        return first

    return law


@pytest.mark.parametrize("throughout", [False, True])
@pytest.mark.parametrize("stiffness", [900, 4100])
def test_correction_sample_by_sample(stiffness, throughout):
    law = CrossingCorrection(throughout=throughout, **FINGER)
    assert_same(zw.render(zw.Wall(stiffness), law), correcting(stiffness, throughout=throughout), 1e-8, 60)


@pytest.mark.parametrize(("damping", "clamped"), [(0, False), (7.3, False), (7.3, True)])
@pytest.mark.parametrize("stiffness", [900, 4100])
def test_two_samples_after_a_crossing_the_state_is_the_one_meant(stiffness, damping, clamped):
    """To 1e-9 m and 1e-7 m/s, on entry, and on exit where the contact is long."""
    wall = zw.Wall(stiffness, damping, clamped=clamped)
    x, v, _ = simulated(zw.render(wall, CrossingCorrection(**FINGER)))
    inside, k, seen = x > 0, 1, 0
    while k < 60:
        if inside[k] == inside[k - 1]:
            k += 1
            continue
        goal = continuous((x[k - 1], v[k - 1]), 3 * T, stiffness, damping, clamped)
        assert x[k + 2] == pytest.approx(goal[0], abs=1e-9)
        assert v[k + 2] == pytest.approx(goal[1], abs=1e-7)
        k, seen = k + 3, seen + 1
    assert seen >= 3


BALL = zw.Device(mass=0.35, damping=0, sample_period=0.010)
UNDAMPED = {"finger_mass": 0.006, "finger_stiffness": 500, "finger_position": 0.004}


def bounces(law):
    """Heights [m] of the ball of Gillespie & Cutkosky from 20 mm, by energy where it is outside."""
    finger = zw.operators.Tracking([0.004], stiffness=500, damping=0, mass=0.006)
    trace = zw.simulate(BALL, law, finger, 2, initial_position=-0.02)
    x, v, f = trace.position.values, trace.velocity.values, trace.actuator_force.values
    free = (x < -0.002) & (f == 0)
    return np.sqrt((x[free] - 0.004) ** 2 + 0.356 / 500 * v[free] ** 2) - 0.004


def test_bounces_grow_are_bounded_and_are_kept():
    wall = zw.Wall(5000)
    assert np.max(bounces(wall)) > 1
    predicted = bounces(zw.render(wall, HalfSamplePrediction(**UNDAMPED)))
    assert np.max(predicted) == pytest.approx(0.02, abs=1e-9)
    assert predicted[-1] < 0.003
    corrected = bounces(zw.render(wall, CrossingCorrection(**UNDAMPED)))
    assert corrected == pytest.approx(0.02, abs=1e-9)
    assert corrected.size > 50


@pytest.mark.parametrize("stiffness", [500, 1300, 2000, 9000])
def test_throughout_keeps_the_height_on_any_wall(stiffness):
    law = zw.render(zw.Wall(stiffness), CrossingCorrection(throughout=True, **UNDAMPED))
    assert bounces(law) == pytest.approx(0.02, abs=1e-9)


def test_prediction_before_and_correction_after():
    """Written in either order: a prediction changes what the wall reads, a correction what it gives."""
    laws = HalfSamplePrediction(**FINGER), CrossingCorrection(**FINGER)
    one, other = simulated(zw.render(zw.Wall(900), *laws)), simulated(zw.render(zw.Wall(900), *laws[::-1]))
    assert np.array_equal(one, other)
    assert not np.array_equal(one[0], simulated(zw.render(zw.Wall(900), laws[1]))[0])
