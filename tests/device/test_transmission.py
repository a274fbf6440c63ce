"""What gives way between motor and hand: kept, bounded, in its units, and never taken for a rigid device."""

from __future__ import annotations

import pickle
import shlex

import numpy as np
import pytest

import zwidth as zw
from zwidth.cli.main import main
from zwidth.model.specification.write import parsed, written

CABLE = zw.Transmission(
    stiffness="12 N/mm", damping=0.5, handle_mass=(0.03, 0.04), handle_damping="0.09 N*s/m", encoder="handle"
)
CAPSTAN = zw.Device(
    mass=0.03, damping=0.06, coulomb_friction=0.1, resolution=1e-5, rate=1000, transmission=CABLE, name="it"
)
CERTAIN = CAPSTAN.replace(transmission=CABLE.replace(handle_mass=0.03))
NUMBERS = ("stiffness", "damping", "handle_mass", "handle_damping", "handle_coulomb_friction")


def test_the_numbers_are_exact_and_in_si():
    assert (CABLE.stiffness, CABLE.handle_damping) == (12000, zw.Exact("0.09"))
    assert CABLE.handle_coulomb_friction == 0
    assert CABLE.handle_mass == zw.Interval("0.03", "0.04")
    assert zw.Transmission(stiffness="3 N*m/deg").stiffness == pytest.approx(3 * 180 / np.pi)
    assert set(CABLE.parameters()) == set(NUMBERS)
    assert set(zw.Transmission().parameters()) == {"damping", "handle_damping", "handle_coulomb_friction"}


@pytest.mark.parametrize("key", NUMBERS)
def test_bounds(key):
    """What cannot be 0 refuses it, and nothing is below 0."""
    positive = key in ("stiffness", "handle_mass")
    smallest = 0 if positive else -1e-9
    with pytest.raises(zw.InputError, match=f"{key} must be {'>' if positive else '≥'} 0"):
        zw.Transmission(**{key: smallest})
    with pytest.raises(zw.InputError, match=key):
        zw.Transmission(**{key: "1 s"})
    assert getattr(zw.Transmission(**{key: 1e-9}), key) == 1e-9


def test_what_is_no_transmission_is_refused():
    with pytest.raises(zw.InputError, match="encoder is one of 'motor', 'handle'"):
        zw.Transmission(encoder="hand")
    with pytest.raises(zw.InputError, match=r"transmission is a zwidth\.Transmission, got float"):
        zw.Device(damping=1, rate=1000, transmission=12e3)


def test_a_device_keeps_it():
    """Through changes of its own numbers, pickle and equality; alone it is the motor's side."""
    assert CAPSTAN.replace(rate=2000).transmission == CAPSTAN.replace(mass=None).transmission == CABLE
    assert pickle.loads(pickle.dumps(CAPSTAN)) == CAPSTAN == CAPSTAN.replace()
    assert CAPSTAN.replace(delay=0.001).assumed == ()
    assert CAPSTAN != CAPSTAN.motor_side != CERTAIN
    assert CAPSTAN.motor_side.transmission is None
    assert CAPSTAN.motor_side.motor_side == CAPSTAN.motor_side
    assert CAPSTAN.parameters() == CAPSTAN.motor_side.parameters()
    assert (CAPSTAN.is_certain, CERTAIN.is_certain, CAPSTAN.motor_side.is_certain) == (False, True, True)
    assert repr(CABLE) in repr(CAPSTAN)


def test_a_notebook_shows_it():
    shown = CAPSTAN._repr_html_()
    for text in ("transmission: stiffness", "12000 N/m", "0.03 … 0.04 kg", "encoder at the", "handle"):
        assert text in shown


def test_at_a_handle_it_is_seen_as_the_device_is():
    """Stiffness, damping and inertia go with 1/r², friction with 1/r."""
    wheel = {"inertia": 0.02, "damping": 0.05, "rate": 1000}
    cable = zw.Transmission(stiffness=3, damping=0.1, handle_mass=0.01, handle_coulomb_friction=0.2)
    turning, handle = (zw.rotary(**wheel, **at, transmission=cable) for at in ({}, {"handle_radius": 0.1}))
    assert turning.transmission == cable
    assert handle.transmission == zw.Transmission(
        stiffness=300, damping=10, handle_mass=1, handle_coulomb_friction=2
    )


WALL = zw.Wall(100)
PRESSED = zw.Log.from_arrays(
    position=np.arange(100.0), hand_force=np.arange(100.0), sample_period=0.001, resolution=0
)
REFUSED = {
    "available storage": lambda d: zw.available_storage(d, WALL, penetration=0.001, speed=0.1),
    "batch": lambda d: zw.simulation.simulate_batch(
        d, WALL, zw.operators.Finger(), 0.1, vary={"environment.stiffness": [100, 200]}
    ),
    "simulated device": lambda d: zw.simulation.SimulatedDevice(d, zw.operators.Finger(), 0.1),
    "pair": lambda d: zw.Pair(d.motor_side, d, stiffness=10),
    "robust boundary": lambda d: zw.maps.robust_boundary(d, zw.operators.Finger(), (0, 1), points=3),
    "stability boundary": lambda d: zw.maps.stability_boundary(d),
    "port": lambda d: zw.links.NaiveWaves(d),
    "links": lambda d: zw.links.compare(d),
    "stability": lambda d: zw.stability.coupled_stability(d, WALL, zw.operators.Finger()),
    "absolute": lambda d: zw.stability.absolute_stability(d, zw.operators.Finger()),
    "activity": lambda d: zw.stability.tolerated_activity(d, WALL),
    "coupling": lambda d: zw.coupling.coupling_condition(d, 100),
    "design": lambda d: zw.coupling.design_coupling(d),
    "indices": lambda d: zw.ports.passivity_indices(WALL, d),
    "plane": lambda d: zw.formulas.plane_point(d, 100),
    "speed": lambda d: zw.formulas.admissible_speed(d, 100),
    "press": lambda d: zw.formulas.fast_press(d, 100),
    "edge": lambda d: zw.formulas.edge_crossing(d, 100),
    "worst": lambda d: zw.formulas.worst_case(d, 100, 0.001),
    "masses": lambda d: zw.coupling.passive_masses(d, zw.coupling.CoupledBody(100, 0, 0.1)),
    "heavy body": lambda d: zw.coupling.heavy_body_damping(d, 100),
    "picture": lambda d: zw.plots.plane(d, 100),
    "curve": lambda d: zw.plots.worst_case(d, 100),
    "tissue": lambda d: zw.tissue.AdaptiveSolid(d, (100, 100, 1)),
    "finger": lambda d: zw.identification.identify_finger(PRESSED, d),
    "bounding": lambda d: zw.formulas.check_bounding(d, zw.render(WALL, zw.rendering.ForceBounding())),
}


@pytest.mark.parametrize("asked", REFUSED)
def test_it_is_never_taken_for_rigid(asked):
    """Whatever does not know a transmission says so, and what to give."""
    for device in (CERTAIN, CAPSTAN)[: 1 if asked == "absolute" else 2]:  # that takes no interval
        with pytest.raises(zw.InputError, match=r"counts motor, encoder and hand as one.*\.motor_side"):
            REFUSED[asked](device)


FILE = """
[device]
mass = "30 g"
damping = "0.06 N*s/m"
coulomb_friction = "0.1 N"
resolution = "10 um"
rate = "1 kHz"
name = "it"

[device.transmission]
stiffness = "12 N/mm"
damping = 0.5
handle_mass = ["30 g", "0.04 kg"]
handle_damping = "0.09 N*s/m"
encoder = "handle"
"""
LOOP = f"{FILE}\n[environment]\ntype = 'wall'\nstiffness = 100\n"


def test_a_file_says_it_and_is_written_again():
    assert parsed(LOOP).device == CAPSTAN
    for device in (CAPSTAN, CERTAIN, CAPSTAN.replace(transmission=zw.Transmission())):
        assert parsed(written(device, WALL)).device == device


def test_a_rotary_file_is_in_its_units():
    """About the axis as written; with a radius at the handle, as the device is."""
    text = "[device]\ninertia = 1e-4\ndamping = 1e-3\nrate = 1000\n{}[device.transmission]\n{}\n"
    wall = "[environment]\ntype = 'wall'\nstiffness = 1"
    stiff = "stiffness = '5 N*m/rad'\nhandle_coulomb_friction = '0.01 N*m'"
    turning = parsed(text.format("", stiff) + wall).device
    assert turning.transmission == zw.Transmission(stiffness=5, handle_coulomb_friction="0.01")
    handle = parsed(text.format("handle_radius = 0.1\n", stiff) + wall).device
    assert handle.transmission == zw.Transmission(stiffness=500, handle_coulomb_friction="0.1")
    with pytest.raises(zw.InputError, match=r"transmission\.stiffness is in N\*m/rad"):
        parsed(text.format("", "stiffness = '5 N/m'") + wall)


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("encoder =", "encodr =", 'a transmission has no "encodr"; did you mean "encoder"'),
        ("handle_mass =", "mass =", 'a transmission has no "mass"; choose from: damping, encoder, '),
        ('"12 N/mm"', "0", "transmission.stiffness must be > 0 N/m, got 0"),
        ('"12 N/mm"', '"12 mm"', "transmission.stiffness is in N/m"),
        ('"handle"', '"hand"', 'transmission.encoder: there is no "hand"'),
        ("handle_mass =", "handle_inertia =", "a transmission has no handle_inertia: of a rotary device "),
        ("encoder =", "backlash =", "leave stiffness, damping and handle_damping out"),
        ("encoder =", "ratio =", "N² times its inertia and damping"),
        ("[device.transmission]", "transmission = 3\n[environment]", "transmission is a table"),
        ("[device.transmission]", "[device.transmision]", 'did you mean "transmission"'),
    ],
)
def test_what_a_file_cannot_mean(old, new, said):
    """Each is refused by its name, and where it stands."""
    with pytest.raises(zw.InputError) as error:
        parsed((FILE if "[environment]" in new else LOOP).replace(old, new))
    table = "[device.transmission]" if "[device" not in old else "[device]"
    assert str(error.value).startswith(f"specification: {table}: ")
    assert said in str(error.value)


@pytest.fixture
def err(capsys, tmp_path, monkeypatch):
    """Runs a line as it is typed behind `zwidth`, beside the file it.toml, and gives its message."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "it.toml").write_text(FILE, encoding="utf-8")

    def run(line: str) -> str:
        assert main(shlex.split(line)) == 2
        return " ".join(capsys.readouterr().err.split())

    return run


def test_options_take_the_place_of_the_file(err):
    """An option is read in the unit of the device, and its message names it."""
    said = err("check it.toml --stiffness 100 --transmission.handle-mass '-1 g'")
    assert "command line: --transmission.handle-mass must be > 0 kg" in said
    said = err("check it.toml --stiffness 100 --transmission.encoder hand")
    assert '--transmission.encoder: there is no "hand"' in said
    assert "--transmission.stiffness?" in err("check it.toml --transmission.stifness 1 --stiffness 1")
    said = err("check it.toml --stiffness 100 --transmission.backlash '0.1 mm'")
    assert "there is no option --transmission.backlash: of a gear with play" in said
    bare = "check --damping 1 --rate 1000 --stiffness 1 --transmission.stiffness '1 N*m/rad'"
    assert "transmission.stiffness is in N/m" in err(bare)


@pytest.mark.parametrize(
    "line",
    [
        "map it.toml --stiffness 0:100 --virtual-damping 0:1 --transmission.handle-mass 1 --hands finger",
        "check it.toml --stiffness 100 --hands finger",
        "check it.toml --stiffness 100 --active-below 3",
        "pair it.toml --stiffness 100",
        "links it.toml",
    ],
)
def test_no_command_takes_it_for_rigid(err, line):
    assert "counts motor, encoder and hand as one" in err(line)


LINEAR = {"stiffness": "30 N/mm", "handle_mass": "30 g", "handle_damping": "0.1 N*s/m"}
ROTARY = {"stiffness": "3 N*m/deg", "handle_mass": "1 g*cm^2", "handle_damping": "0.1 N*m*s/rad"}


@pytest.mark.parametrize(("key", "linear", "rotary"), [(k, LINEAR[k], ROTARY[k]) for k in LINEAR])
def test_units_of_another_motion_are_refused(key, linear, rotary):
    """By the device, and within one transmission, however it is made; plain numbers are of either."""
    slides = {"mass": 0.03, "damping": 0.06, "rate": 1000}
    turns = {"inertia": 1e-5, "damping": 0.06, "rate": 1000}
    assert zw.Device(**slides, transmission=zw.Transmission(**{key: linear}))
    assert zw.rotary(**turns, transmission=zw.Transmission(**{key: rotary}))
    assert zw.rotary(**turns, transmission=zw.Transmission(**{key: 1})).transmission.motion == ""
    with pytest.raises(zw.InputError, match=r"device is linear, and its transmission .* in N/m and not in"):
        zw.Device(**slides, transmission=zw.Transmission(**{key: rotary}))
    with pytest.raises(zw.InputError, match="is rotary, and its transmission"):
        zw.rotary(**turns, transmission=zw.Transmission(**{key: linear}))
    with pytest.raises(zw.InputError, match=f"another number is of what slides, {key} of what turns"):
        zw.Transmission(damping="1 N*s/m").replace(**{key: rotary})
    with pytest.raises(zw.InputError, match="both are of one motion"):
        zw.Transmission(**{key: linear}, damping="1 N*m*s/rad")


def test_at_its_handle_a_device_that_turns_has_a_transmission_that_slides():
    there = zw.rotary(
        inertia=1e-5, damping=1e-3, rate=1000, handle_radius="2 cm", transmission=zw.Transmission(**ROTARY)
    )
    assert there.transmission.motion == there.motion == "linear"
    assert there.transmission.stiffness == pytest.approx(3 * 180 / np.pi / 0.02**2)
