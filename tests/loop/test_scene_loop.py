"""A scene in the loop: stepped as its H(z) says, and no hand gains behind a coupling that fits the device."""

from fractions import Fraction

import numpy as np
import pytest
from random_scenes import LINEAR, random_scene
from strategies import seeds

import zwidth as zw
from zwidth import InputError
from zwidth.model.scene import Contact, CoulombFriction, Damper, Mass, SceneRun, Spring

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
