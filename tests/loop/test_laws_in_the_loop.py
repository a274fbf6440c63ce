"""Each law in the simulator, scenes too: commands sample by sample, ledger; a clamped one never pulls."""

from __future__ import annotations

from fractions import Fraction
from math import log1p

import numpy as np
import pytest
import scipy.signal
from hypothesis import given, settings
from hypothesis import strategies as st
from random_scenes import LINEAR, random_scene
from scipy.optimize import brentq
from strategies import seeds

import zwidth as zw
from zwidth import InputError
from zwidth.loop.setup import prepare
from zwidth.model.scene import Contact, CoulombFriction, Damper, Mass, SceneRun, Spring

PADDLE = zw.catalogue.device("haptic-paddle")
IDEAL = zw.amplifiers.Ideal()
PERIOD = 0.002
DOWEL = zw.operators.Dowel()


def moved(law: object, positions: np.ndarray, **device):
    loop = zw.Device(**{"damping": 0.1, "sample_period": PERIOD, **device})
    motion = zw.operators.PrescribedMotion(positions)
    return zw.simulate(loop, law, motion, PERIOD * (len(positions) - 1), amplifier=IDEAL)


def commands(law: object, positions, **device) -> np.ndarray:
    return moved(law, np.asarray(positions), **device).commanded_force.values


LAWS = {
    "damped wall": zw.Wall(300.0, damping=2.0),
    "negative damping": zw.Wall(300.0, damping=-2.0),
    "window": zw.Wall(300.0, damping=2.0, velocity_filter=zw.rendering.Window(5)),
    "one-pole": zw.Wall(300.0, damping=2.0, velocity_filter=zw.rendering.OnePole(0.01)),
    "filter": zw.Wall(
        300.0, damping=2.0, velocity_filter=zw.rendering.VelocityFilter([0.3, 0.1], [1.0, -0.7, 0.1])
    ),
    "gain for an estimator": zw.Wall(
        10.0, damping=-2.0, velocity_filter=zw.rendering.VelocityFilter([50], [1])
    ),
    "standard linear solid": zw.StandardLinearSolid(20.0, 500.0, 2.0),
    "Maxwell": zw.Maxwell(500.0, 2.0),
    "Prony": zw.GeneralizedMaxwell(20.0, [(500.0, 2.0), (30.0, 900.0), (20.0, 5.0)]),
    "Prony, matched": zw.GeneralizedMaxwell(20.0, [(500.0, 2.0), (20.0, 5.0)], discretization="matched"),
    "coupling": zw.VirtualCoupling(500.0, 0.5, zw.Wall(2000.0)),
    "transfer function": zw.PulseTransferFunction([3.0, -1.0, 0.2], [1.0, -0.5, 0.06]),
}
CLAMPABLE = list(LAWS)[:-2]
"""The others have no such keyword."""


@pytest.mark.parametrize("name", LAWS)
def test_each_law_is_run_as_its_pulse_transfer_function_says(name):
    """In contact, from rest at the surface, the commands are those of scipy's lfilter."""
    x = np.abs(np.cumsum(np.random.default_rng(3).normal(size=400))) * 1e-4 + 1e-5
    x[0] = 0.0
    h = LAWS[name].pulse_transfer_function(zw.Exact("0.002").fraction)
    b, a = [float(c) for c in h.numerator], [float(c) for c in h.denominator]
    b = [0.0] * (len(a) - len(b)) + b
    expected = scipy.signal.lfilter(b, a, x)
    assert np.abs(commands(LAWS[name], x) - expected)[1:].max() < 1e-9 * np.abs(expected).max()


def test_a_wall_pushes_inside_only_and_its_estimator_runs_outside_too():
    """f = K x + B v for x > 0; at entry v is the difference to the position outside."""
    x = [-2e-3, -1e-3, 1e-3, 2e-3, 0.0, -1e-3]
    expected = [0.0, 0.0, 300e-3 + 2.0 * 2e-3 / 0.002, 600e-3 + 2.0 * 1e-3 / 0.002, 0.0, 0.0]
    assert commands(LAWS["damped wall"], x) == pytest.approx(expected, abs=1e-12)


def test_a_solid_feels_the_penetration_only():
    """A viscoelastic solid that is left relaxes; it does not follow the hand outside."""
    x = np.array([-5e-3, -1e-3, 1e-3, 2e-3, -4e-3, -4e-3, 1e-3])
    solid = LAWS["standard linear solid"]
    inside, got = commands(solid, np.maximum(x, 0.0)), commands(solid, x)
    assert got[x > 0] == pytest.approx(inside[x > 0], abs=1e-12)
    assert (got[x <= 0] == 0.0).all()


@pytest.mark.parametrize(("name", "force"), [("window", 0.45), ("Prony", 0.03)])
def test_a_law_begins_at_rest_where_the_hand_is(name, force):
    """Held still 1.5 mm inside, the force is K x from the first sample on."""
    assert commands(LAWS[name], np.full(20, 1.5e-3)) == pytest.approx(np.full(20, force), abs=1e-12)


@pytest.mark.parametrize("resolution", [0.0, 1e-4])
@pytest.mark.parametrize("name", CLAMPABLE)
def test_a_clamped_law_commands_the_positive_part_of_the_law(name, resolution):
    """Sample by sample, in and out of contact; the memory is that of the law without a clamp."""
    law, steps = LAWS[name], np.random.default_rng(7).normal(size=600)
    motion = 1e-3 + 4e-3 * np.sin(np.arange(600) / 20) + 2e-4 * np.cumsum(steps)
    whole = commands(law, motion, resolution=resolution)
    assert whole.min() < 0
    assert (commands(law.replace(clamped=True), motion, resolution=resolution) == np.maximum(whole, 0)).all()


@pytest.mark.parametrize("name", CLAMPABLE)
def test_the_ledger_of_a_clamped_law_closes_and_no_sample_pulls(name):
    trace = zw.simulate(PADDLE, LAWS[name].replace(clamped=True), DOWEL, 0.4)
    assert trace.zwidth.energy.closes
    assert float(trace.actuator_force.min()) >= 0
    assert "never pulls" in trace.attrs["environment"]


@pytest.mark.parametrize("solid", [zw.Wall(500.0), zw.StandardLinearSolid(500.0, 0, 3.0)])
def test_a_clamped_spring_is_run_as_the_spring_that_it_is(solid):
    """It never pulls anyway: the quick path, and the same bits."""
    clamped = solid.replace(clamped=True)
    assert prepare(PADDLE, clamped, DOWEL, 0.1).plain
    one, other = (zw.simulate(PADDLE, law, DOWEL, 0.1) for law in (solid, clamped))
    assert (one.position.values == other.position.values).all()


def test_a_clamp_acts_before_the_converter():
    """The nearest step to no force is no force."""
    x = np.array([0.0, 5e-3, 4e-3, 1e-3, 0.5e-3])
    loop = zw.Device(damping=0.1, sample_period=PERIOD, force_resolution=0.05, force_limit=1.0)
    trace = zw.simulate(loop, zw.Wall(300.0, 0.7, clamped=True), zw.operators.PrescribedMotion(x), 4 * PERIOD)
    assert trace.commanded_force.values == pytest.approx([0.0, 1.0, 0.85, 0.0, 0.0])


NONLINEAR = {
    "points": zw.NonlinearSpring([-0.01, -0.002, 0, 0.001, 0.006, 0.02], [-3.0, -0.1, 0.5, 0.2, 0.2, 7.0]),
    "detents": zw.NonlinearSpring.detents(5, 0.004, 0.6),
    "bump stop": zw.NonlinearSpring.bump_stop(0.002, 200, 10**6, 0.02),
    "contact": zw.HuntCrossley(2e4, "1.5", 3),
}


@settings(max_examples=40, deadline=None)
@given(st.data(), st.sampled_from([0.0, 1e-4, 2.24e-3]))
def test_a_spring_through_points_is_read_off_them(data, resolution):
    """Two points or many, at what the encoder reads: at them, between them and beyond the ends."""
    counts = data.draw(st.lists(st.integers(-50, 50), min_size=2, max_size=17, unique=True).map(sorted))
    forces = data.draw(st.lists(st.integers(-40, 40), min_size=len(counts), max_size=len(counts)))
    spring = zw.NonlinearSpring([n / 1000 for n in counts], [f / 8 for f in forces])
    x = np.concatenate([np.array(counts) / 1000, np.linspace(-0.06, 0.06, 301)])
    trace = moved(spring, x, resolution=resolution)
    read = trace.measured_position.values
    assert read == pytest.approx(resolution * np.floor(x / resolution) if resolution else x, abs=1e-15)
    expected = np.interp(read, spring.positions, spring.forces)
    assert trace.commanded_force.values == pytest.approx(expected, abs=1e-12)


def test_a_handle_let_go_comes_to_rest_in_a_detent():
    """A quarter of the way up its edge and no hand: it slides back into the detent."""
    device = zw.Device(mass=0.05, damping=2.0, sample_period=1e-4)
    free = zw.operators.ConstantForce(0.0)
    trace = zw.simulate(device, NONLINEAR["detents"], free, 0.5, initial_position=0.009, amplifier=IDEAL)
    assert float(trace.position[-1]) == pytest.approx(0.008, abs=1e-6)


@pytest.mark.parametrize("clamped", [True, False])
@pytest.mark.parametrize("exponent", [1, 1.5, 2, 3.7])
@pytest.mark.parametrize("resolution", [0.0, 1e-4])
def test_a_contact_commands_its_law(exponent, clamped, resolution):
    """K uⁿ (1 + λ v), v from the readings before, on both sides of the surface."""
    contact = zw.HuntCrossley(5e3, exponent, 1.7, clamped)
    trace = moved(contact, 0.002 + 0.006 * np.sin(np.arange(400) * 0.37), resolution=resolution)
    read = trace.measured_position.values
    speed = np.diff(read, prepend=read[0]) / PERIOD
    expected = 5e3 * np.maximum(read, 0.0) ** exponent * (1 + 1.7 * speed)
    expected = np.maximum(expected, 0.0) if clamped else expected
    assert trace.commanded_force.values == pytest.approx(expected, rel=1e-12, abs=1e-15)
    assert bool((expected < 0).any()) is not clamped
    exact = [float(contact.force(q, v)) for q, v in zip(read[:20].tolist(), speed[:20].tolist(), strict=True)]
    assert exact == pytest.approx(expected[:20].tolist(), rel=1e-12, abs=1e-15)


def parting_speed(dissipation: float, speed: float) -> float:
    """v_o of a body that meets the contact at v_i, whatever its mass, K and n.

    m v dv/dx = −K uⁿ (1 + λ v) gives ∫ v/(1 + λ v) dv the same over both halves of the collision:
    v_i/λ − ln(1 + λ v_i)/λ² = −v_o/λ − ln(1 − λ v_o)/λ²  (Hunt & Crossley 1975).
    """

    def half(v: float) -> float:
        return v / dissipation - log1p(dissipation * v) / dissipation**2

    limit = min(speed, 1 / dissipation) * (1 - 1e-12)
    return brentq(lambda v: half(-v) - half(speed), 0.0, limit)


@pytest.mark.parametrize("exponent", [1, 1.5, 3])
@pytest.mark.parametrize(("dissipation", "speed"), [(0.3, 0.2), (2.0, 0.2), (2.0, 1.5)])
def test_a_body_bounces_as_hunt_and_crossley_say(exponent, dissipation, speed):
    """Free of friction and hands, sampled finely; for slow ones v_o ≈ (1 − ⅔ λ v_i) v_i."""
    loop = zw.Device(mass=0.05, damping=0, sample_period=1e-6)
    stiffness = 0.05 * speed**2 / 0.002 ** (exponent + 1)
    contact = zw.HuntCrossley(stiffness, exponent, dissipation)
    free = zw.operators.ConstantForce(0.0)
    trace = zw.simulate(loop, contact, free, 0.012 / speed, initial_velocity=speed, initial_position=-1e-4)
    expected = parting_speed(dissipation, speed)
    assert float(trace.velocity[-1]) == pytest.approx(-expected, rel=2e-3)
    assert float(trace.position[-1]) < 0
    if dissipation * speed < 0.1:
        assert expected == pytest.approx((1 - 2 / 3 * dissipation * speed) * speed, rel=5e-3)


def test_a_touch_that_begins_inside_a_contact_begins_at_rest():
    contact = zw.HuntCrossley(2e4, 2, 3)
    trace = zw.simulate(PADDLE, contact, zw.operators.ConstantForce(0.1), 0.01, initial_position=0.004)
    read = float(trace.measured_position[0])
    assert float(trace.commanded_force[0]) == pytest.approx(2e4 * read**2, abs=0.0005)


def test_a_missed_sample_leaves_the_contact_as_it_was():
    """The sample after it sees the way of two periods over one."""
    loop = zw.Device(damping=0.1, sample_period=0.001)
    timing = zw.simulation.Timing(missed=[0, 0, 1, 0, 0])
    motion = zw.operators.PrescribedMotion(np.array([0.0, 1e-3, 3e-3, 4e-3, 4e-3]))
    trace = zw.simulate(loop, zw.HuntCrossley(100, 1, 2), motion, 0.004, timing=timing)
    assert trace.commanded_force.values[3] == pytest.approx(100 * 4e-3 * (1 + 2 * 3.0))


@pytest.mark.parametrize("name", NONLINEAR)
@pytest.mark.parametrize("hand", [zw.operators.Finger(), zw.operators.ConstantForce(1.0)])
def test_the_ledger_closes(name, hand):
    """Every joule is accounted for, with a delay and in between samples."""
    law, device = NONLINEAR[name], PADDLE.replace(delay=4e-4)
    trace = zw.simulate(device, law, hand, 0.4, initial_position=-2e-3, points_per_sample=3)
    assert trace.zwidth.energy.closes
    assert trace.attrs["environment"] == law.describe()


DEVICE = zw.Device(mass="0.1", damping="0.5", rate=1000, resolution=0)
HAND = zw.operators.Finger()


@seeds(8)
def test_a_linear_scene_is_simulated_as_its_transfer_function(seed):
    scene = random_scene(seed, 3 + seed % 5, LINEAR)
    law = zw.VirtualCoupling(400, "0.1", scene)
    h = law.pulse_transfer_function(DEVICE.exact("sample_period"))
    stepped = zw.simulate(DEVICE, law, HAND, "0.3", initial_position=0)
    by_filter = zw.PulseTransferFunction(*h)
    filtered = zw.simulate(DEVICE, by_filter, HAND, "0.3", initial_position=0)
    apart = np.abs(stepped.commanded_force - filtered.commanded_force).max()
    assert float(apart) <= 1e-7 * float(np.abs(stepped.commanded_force).max())


def test_the_energy_of_a_touch_balances_with_contact_and_friction():
    scene = zw.Scene(
        [
            Mass("handle", "0.05"),
            Contact("handle", "ground", 2000, 1, "0.005"),
            CoulombFriction("handle", "ground", "0.1"),
        ]
    )
    trace = zw.simulate(DEVICE, zw.VirtualCoupling(500, "0.05", scene), HAND, "0.5")
    assert float(trace.commanded_force.max()) > 0.2
    assert trace.attrs["stored_at_start_J"] == 0
    assert trace.zwidth.energy.extracted == 0


@seeds(15)
def test_no_hand_gains_at_the_limit_of_the_coupling(seed):
    """Random scenes, b = K T/2 + B exactly: more than was in the scene at first."""
    rng = np.random.default_rng(seed)
    k, damping, t = 10 ** rng.uniform(1, 3.5), 10 ** rng.uniform(-3, 0.5), 1e-3
    inside = random_scene(seed, 3 + seed % 20)
    coupling = [
        Spring("hand", "port", k, name="coupling"),
        Damper("hand", "port", damping + k * t / 2, name="loss"),
    ]
    run = SceneRun(zw.Scene([*coupling, *inside.elements], port="hand"), t)
    b = k * t / 2 + damping
    work, force, largest = 0.0, 0.0, 0.0
    for i in range(200):
        greedy = -t * force / (2 * b)  # the most that f D + b D²/T can give
        move = greedy if i % 20 > 4 else float(rng.normal()) * 1e-3
        work += force * move + b / t * move * move
        largest = max(largest, abs(work))
        force = run.step(move)
    assert work + run.energy_at_first >= -1e-11 * largest


def test_a_scene_without_a_port_is_refused():
    alone = zw.Scene([Mass("m", 1)], port="")
    with pytest.raises(InputError, match="port"):
        zw.VirtualCoupling(100, 0, alone)
    with pytest.raises(InputError, match="port"):
        zw.simulate(DEVICE, alone, HAND, "0.1")


def test_a_touch_begins_where_the_scene_is_at_rest():
    """Wherever the hand is at first; one that is loaded there says that its energy is not known."""
    scene = zw.Scene([Spring("handle", "ground", 100)])
    trace = zw.simulate(DEVICE, scene, HAND, "0.05", initial_position=0.02)
    assert float(trace.commanded_force[0]) == 0
    loaded = zw.Scene([Damper("handle", "ground", 1), Contact("handle", "ground", 100, 0, "-0.01")])
    held = zw.simulate(DEVICE, loaded, HAND, "0.05")
    assert "stored_at_start_J" not in held.attrs


def test_positions_are_those_of_the_prescribed_motion():
    scene = zw.Scene([Mass("handle", "0.01"), Contact("handle", "ground", 900, 1, "0.002")])
    motion = zw.operators.PrescribedMotion(np.linspace(0, 0.006, 4001))
    law = zw.VirtualCoupling(600, "0.3", scene)
    trace = zw.simulate(DEVICE, law, motion, Fraction(4))
    assert float(trace.commanded_force[-1]) == pytest.approx(0.004 * 600 * 900 / 1500, rel=0.01)
