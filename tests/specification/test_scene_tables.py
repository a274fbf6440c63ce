"""A scene in a file: what it may say, and what is said of a mistake."""

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
