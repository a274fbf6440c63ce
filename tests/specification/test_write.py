"""A loop written as a specification is the loop that is read again, digit for digit."""

from __future__ import annotations

from fractions import Fraction

import pytest
from test_read import needed

import zwidth as zw
from zwidth.model import rendering, scene
from zwidth.model.rendering import LAWS
from zwidth.model.specification.environments import TYPES
from zwidth.model.specification.write import parsed, written

THIRD = Fraction(1, 3)
DEVICE = zw.Device(
    name='Tom\'s "wheel" \\ μ',
    mass="0.2",
    damping=THIRD,
    coulomb_friction=("0.1", "0.2"),
    resolution="1e-30",
    sample_period="0.001",
    force_limit=10,
)
ENVIRONMENTS = {
    "wall": zw.Wall(THIRD, damping=-1, clamped=True),
    "wall, window": zw.Wall(10, damping=1, velocity_filter=zw.rendering.Window(5)),
    "wall, one pole": zw.Wall((10, 20), damping=1, velocity_filter=zw.rendering.OnePole(("0.001", "0.002"))),
    "wall, filter": zw.Wall(
        10, damping=1, velocity_filter=zw.rendering.VelocityFilter([500, 0, -500], [1, 0, 0])
    ),
    "maxwell": zw.Maxwell(stiffness=100, damping=THIRD, discretization="tustin"),
    "standard-linear-solid": zw.StandardLinearSolid(100, branch_stiffness=("1", "2"), branch_damping=3),
    "generalized-maxwell": zw.GeneralizedMaxwell(5, branches=[(800, 3), (THIRD, 20)]),
    "nonlinear-spring": zw.NonlinearSpring([0, "0.001", "0.002"], [0, 1, 4]),
    "hunt-crossley": zw.HuntCrossley(1000, exponent="1.5", dissipation="0.7"),
    "transfer-function": zw.ContinuousTransferFunction([1, 2], [1, THIRD], discretization="zoh"),
    "pulse-transfer-function": zw.PulseTransferFunction([1, "-0.5"], [1, "0.25"]),
    "its own period": zw.PulseTransferFunction([1], [1], sample_period="0.001"),
    "coupled-body": zw.coupling.CoupledBody(
        100, "0.05", THIRD, "0.1", 3, "trapezoidal", exchange_delay=2, wave_impedance=4
    ),
    "scene": zw.Scene(
        [
            scene.Spring("tip", "a", THIRD),
            scene.Mass("a", "0.02", name='the "tool"'),
            scene.Damper("a", "b", 2),
            scene.Lever("a", "b", "-1.5"),
            scene.Contact("b", "ground", 1000, "0.5", "0.001"),
            scene.CoulombFriction("b", "ground", "0.1"),
            scene.NonlinearSpring("a", "ground", [-1, THIRD], [-1, 2]),
            scene.LineEnd("a", 3),
        ],
        port="tip",
    ),
    "virtual-coupling": zw.VirtualCoupling(1000, 2, zw.VirtualCoupling(500, 1, zw.Wall(100))),
}
CHOSEN = {
    "extrapolation": {"samples": THIRD},
    "damper": {"damping": "0.1", "velocity": rendering.AdaptiveWindow(noise="1e-5", longest=9, fit="best")},
    "hysteresis": {"force": "0.03", "stiffness": 700, "clamped": True},
    "passivity-controller": {"observer": "published", "largest_damping": THIRD, "credit": True},
    "windowed-controller": {"window": 7, "slowest": THIRD, "share": "0.5", "largest_damping": THIRD},
    "rate-term": {"time_constant": THIRD},
    "held": {"samples": 3},
    "dual-rate": {"samples": 4, "updates": "jump"},
    "braking-pulse": {"velocity": rendering.Kalman(3000)},
    "event-transient": {"kind": "acceleration", "record": ["100", THIRD]},
    "dither": {"amplitude": "0.01", "kind": "random", "seed": 7},
    "friction-compensation": {"coulomb": "0.3", "viscous": THIRD, "speed": "0.1"},
    "saturation": {"limit": "1e-30"},
    "slew-limit": {"rate": THIRD},
}


def same(device: zw.Device, environment: object) -> None:
    found = parsed(written(device, environment))
    assert found.device.parameters() == device.parameters()
    assert (found.device.motion, found.device.assumed) == (device.motion, device.assumed)
    assert found.environment == environment


@pytest.mark.parametrize("name", sorted({*TYPES, *ENVIRONMENTS}))
def test_every_environment_is_read_as_it_was(name):
    environment = ENVIRONMENTS.get(name) or TYPES[name].made(**needed(TYPES[name]))
    same(DEVICE, environment)
    assert parsed(written(DEVICE, environment)).device.name == DEVICE.name


@pytest.mark.parametrize("name", LAWS)
def test_every_law_is_read_as_it_was(name):
    chosen = CHOSEN.get(name) or needed(LAWS[name])
    same(DEVICE, zw.render(zw.Wall(300), LAWS[name].made(**chosen)))


def test_no_limit_is_a_word():
    law = rendering.PassivityController(observer="past", largest_damping="unlimited")
    assert 'largest_damping = "unlimited"' in written(DEVICE, zw.render(zw.Wall(300), law))
    same(DEVICE, zw.render(zw.Wall(300), law))


def test_laws_keep_their_order():
    laws = rendering.Saturation("0.5"), rendering.SlewLimit(100), rendering.Saturation("0.25")
    same(DEVICE, zw.render(zw.VirtualCoupling(1000, 2, zw.Wall(100)), *laws))


def test_a_wheel_is_written_in_its_own_units():
    """N·m and rad, an inertia in the place of a mass."""
    wheel = zw.rotary(inertia="0.01", damping="0.02", counts_per_turn=65536, rate=1000, delay="0.002")
    same(wheel, zw.render(zw.Wall(30, damping="0.1"), rendering.SlewLimit(50)))
    text = written(wheel, zw.render(zw.Wall(30), rendering.SlewLimit(50)))
    assert 'inertia = "0.01 kg*m^2"' in text
    assert 'rate = "50 N*m/s"' in text


def test_what_has_no_words_is_refused():
    class Own(zw.Wall):
        """Somebody's wall."""

    with pytest.raises(zw.InputError, match="a specification has no Own"):
        written(DEVICE, Own(300))


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "none of the tables"),
        ("[device", "not TOML"),
        ("[device]\ndamping = 1\nrate = 1000", "no environment is given"),
        ("[environment]\ntype = 'wall'\nstiffness = 1", "no device is given"),
        ("[operator]\ntype = 'finger'", "zwidth simulate"),
    ],
)
def test_what_is_no_loop_is_refused(text, said):
    with pytest.raises(zw.InputError, match=said):
        parsed(text, "here")
