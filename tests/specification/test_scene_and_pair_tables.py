"""Scenes, and two arms and what joins them, in a file: what it may say, and what is said of a mistake."""

from __future__ import annotations

from pathlib import Path

import pytest

import zwidth as zw
from zwidth import InputError
from zwidth.model.specification.environments import ELEMENTS, build_environment
from zwidth.model.specification.table import Table

SPRING = {"type": "spring", "first": "handle", "second": "ground", "stiffness": "1 N/m"}


@pytest.mark.parametrize(
    ("elements", "says"),
    [
        ("spring", "elements are tables"),
        ([SPRING, {"type": "sprung"}], 'element 2: there is no element "sprung"; did you mean "spring"'),
        ([{"first": "handle"}], "element 1: type is missing"),
        ([{**SPRING, "damping": 1}], 'has no "damping"'),
        ([{"type": "mass", "node": "handle"}], r"needs mass \[kg\]"),
        ([{**SPRING, "stiffness": "-3 N/m"}], "must be > 0"),
        ([{**SPRING, "stiffness": "3 kg"}], "stiffness"),
        ([{**SPRING, "first": 7}], "name in quotes"),
        ([{**SPRING, "first": "ground"}], "both ends"),
    ],
)
def test_a_mistake_is_named_with_its_place(elements, says):
    with pytest.raises(InputError, match=says):
        build_environment(Table("[environment]", {"type": "scene", "elements": elements}), "linear")


def test_a_rotary_device_has_rotary_scenes():
    element = {**SPRING, "stiffness": "2 N*m/rad"}
    found = build_environment(Table("x", {"type": "scene", "elements": [element]}), "rotary")
    assert found == zw.Scene([zw.scene.Spring("handle", "ground", 2)])


def test_every_element_of_the_package_has_a_name():
    from zwidth.model import scene

    made = {kind.made for kind in ELEMENTS.values()}
    assert made == {
        thing
        for thing in (getattr(scene, name) for name in scene.__all__)
        if isinstance(thing, type) and issubclass(thing, scene.Element) and thing is not scene.Element
    }


WORLD = """
[device]
damping = "0.5 N*s/m"
coulomb_friction = 0
resolution = 0
rate = "1 kHz"
delay = 0
[environment]
type = "virtual-coupling"
stiffness = "600 N/m"
damping = "0.1 N*s/m"
[environment.environment]
type = "scene"
port = "tool"
elements = [
  {type = "mass", node = "tool", mass = "50 g"},
  {type = "contact", first = "tool", second = "ground", stiffness = "2 N/mm", gap = "5 mm"},
]
"""


def test_a_file_is_checked(tmp_path, capsys):
    from zwidth.cli.main import main

    path = tmp_path / "world.toml"
    path.write_text(WORLD, encoding="utf-8")
    assert main(["check", str(path)]) == 0
    assert "coupling" in capsys.readouterr().out
    assert main(["check", str(path), "--stiffness", "1200"]) == 3


ARMS = '[leader]\ndamping = 0.2\nrate = 1000\n[follower]\ncatalogue = "haptic-paddle"\n'
ALIKE = "[device]\ninertia = 0.006\ndamping = 0.02\nrate = 1000\n"
COUPLING = '[coupling]\nstiffness = "0.1 N/mm"\n'


def read(folder: Path, text: str) -> zw.Pair:
    path = folder / "two.toml"
    path.write_text(text, encoding="utf-8")
    return zw.load(path)


def test_every_key_is_an_argument_of_a_pair(tmp_path):
    more = (
        'damping = "20 mN*s/m"\nlocal_damping = 0.03\nfollower_stiffness = 120\nfollower_damping = -0.01\n'
        'follower_local_damping = "0.04 N*s/m"\nlink_delay = "2 ms"\nlink_delay_back = 0.003\n'
    )
    pair = read(tmp_path, ARMS + COUPLING + more)
    leader = zw.Device(damping="0.2", rate=1000, name="leader")
    assert pair == zw.Pair(
        leader, zw.catalogue.device("haptic-paddle"), stiffness=100, damping="0.02", local_damping="0.03",
        follower_stiffness=120, follower_damping="-0.01", follower_local_damping="0.04",
        delay=("0.002", "0.003"),
    )  # fmt: skip
    coupling = '[coupling]\nstiffness = "3 N*m/rad"\nvirtual_damping = 0.02\nlink_delay = "2 ms"\n'
    pair = read(tmp_path, ALIKE + coupling)
    wheel = zw.rotary(inertia="0.006", damping="0.02", rate=1000, name="two")
    assert pair == zw.Pair(wheel, wheel, stiffness=3, damping="0.02", delay=("0.002", "0.002"))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (ARMS, r"no spring joins the arms: set --stiffness \[N/m\], or write it in a \[coupling\]"),
        (ARMS + "[coupling]\ndamping = 1\n", r"\[coupling\]: stiffness \[N/m\] is missing"),
        (ARMS + COUPLING + "stifness = 3\n", r'a coupling has no "stifness"; did you mean "stiffness"'),
        (ARMS + COUPLING + "mass = 3\n", r'a coupling has no "mass"; choose from: compensation_coulomb'),
        (ARMS + COUPLING + "damping = 1\nvirtual_damping = 1\n", "are the same quantity"),
        (ARMS + COUPLING + 'local_damping = "3 N/m"\n', r"\[coupling\]: local_damping is in N\*s/m"),
        (ARMS + COUPLING + "link_delay = -1\n", r"\[coupling\]: link_delay must be ≥ 0"),
        (ARMS + COUPLING + "link_delay = 5\n", 'link_delay 5 without a unit is 5 s; write "5 ms"'),
        (ARMS + "[coupling]\nstiffness = [10, 20]\n", "stiffness"),
        (ARMS + COUPLING + ALIKE, r"\[leader\] and \[follower\], or one \[device\]"),
        (ARMS + COUPLING + '[environment]\ntype = "wall"\nstiffness = 3\n', "no environment"),
        (ARMS.partition("[follower]")[0] + COUPLING, r"there is no \[follower\]"),
        ("[follower]" + ARMS.partition("[follower]")[2] + COUPLING, r"there is no \[leader\]"),
        (COUPLING, r"\[coupling\]: there is no arm"),
        (ARMS.replace("1000", "600") + COUPLING, "1 kHz and 600 Hz"),
        (ARMS.replace("damping = 0.2", "damping = [0.1, 0.2]") + COUPLING, "leader: damping has no single"),
        (ARMS.replace("damping = 0.2", "dumping = 0.2") + COUPLING, r"\[leader\]: a device has no"),
        ("[leeder]\ndamping = 1\n" + COUPLING, 'did you mean "leader"'),
    ],
)  # fmt: skip
def test_what_cannot_be_used_is_said(text, message, tmp_path):
    with pytest.raises(zw.InputError, match=message):
        read(tmp_path, text)


def test_a_pair_is_read_alone(tmp_path):
    (tmp_path / "two.toml").write_text(ARMS + COUPLING, encoding="utf-8")
    with pytest.raises(zw.InputError, match="read alone"):
        zw.load("haptic-paddle", tmp_path / "two.toml")


def test_compensation_of_friction_is_of_both_sides_unless_told(tmp_path):
    """A number that the follower has none of is the leader's; 0 where it has none of that."""
    law = 'compensation_coulomb = "80 mN"\ncompensation_viscous = 0.01\ncompensation_speed = "2 cm/s"\n'
    both = zw.FrictionCompensation(coulomb="0.08", viscous="0.01", speed="0.02")
    assert read(tmp_path, ARMS + COUPLING + law).compensations == (both, both)
    other = read(tmp_path, ARMS + COUPLING + law + "follower_compensation_coulomb = 0\n")
    assert other.compensations == (both, zw.FrictionCompensation(viscous="0.01", speed="0.02"))
