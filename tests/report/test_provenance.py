"""Where each number comes from: typed, of a file, published, or not given."""

from __future__ import annotations

import pytest

import zwidth as zw
from zwidth.model.specification.laws import with_laws
from zwidth.model.specification.load import pair_of
from zwidth.model.specification.read import PAIR_TABLES, WITH_LAWS, built, merged, tables_of
from zwidth.show.report.provenance import of_device, of_environment, of_pair, of_verdict

WHEEL = """
[device]
inertia = "0.02 kg*m^2"
damping = 0.05
counts_per_turn = 2400
rate = "1 kHz"

[environment]
type = "wall"
stiffness = "80 N*m/rad"
damping = 0.001

[[law]]
type = "saturation"
limit = 2
"""

WHEEL_IN_PYTHON = zw.rotary(inertia=0.02, damping=0.05, counts_per_turn=2400, rate=1000)


def _origins(text: str, **typed: str) -> dict[str, tuple[str, str]]:
    tables = tables_of(text, "somewhere/else/wheel.toml", WITH_LAWS)
    device_table, environment_table = merged(tables, typed)
    loop = built(device_table, environment_table)
    law = with_laws(loop.environment, tables.get("law"), None, loop.device.motion)
    rows = [
        *of_device(device_table, loop.device),
        *of_environment(environment_table, law, loop.device.motion, tables.get("law")),
    ]
    return {what: (value, where) for what, value, where in rows}


def test_a_file_is_called_by_its_name_and_the_table_and_what_it_lacks_is_told() -> None:
    told = _origins(WHEEL)
    assert told["damping b"] == ("0.05 N·m·s/rad", "wheel.toml, [device]")
    assert told["resolution Δ"] == ("2.61799 mrad", "wheel.toml, [device]: counts_per_turn")
    assert told["sample period T"] == ("1 ms", "wheel.toml, [device]: rate")
    assert told["counts per turn"] == ("2400", "wheel.toml, [device]")
    assert told["stiffness K"] == ("80 N·m/rad", "wheel.toml, [environment]")
    assert told["virtual damping B"] == ("1 mN·m·s/rad", "wheel.toml, [environment]")
    assert told["law behind it"] == ("saturation at 2 N·m", "wheel.toml, [[law]]")
    assert told["Coulomb friction f_c"] == ("0 N·m", "not given: taken as 0")
    assert told["delay τ"] == ("0 s", "not given: taken as 0")
    assert told["velocity filter"] == ("backward difference", "not given: the default")
    assert told["clamped"] == ("no", "not given: the default")


def test_of_a_wheel_the_inertia_is_told_once_and_as_that() -> None:
    told = _origins(WHEEL)
    assert told["inertia"] == ("0.02 kg·m²", "wheel.toml, [device]")
    assert not [what for what in told if "mass" in what]
    rows = [what for what, _, _ in of_verdict(zw.check(WHEEL_IN_PYTHON, zw.Wall(80))).numbers]
    assert rows.count("inertia") == 1
    assert not [what for what in rows if "mass" in what]
    linear = _origins(
        WHEEL.replace("[device]", "[device]\nhandle_radius = 0.1").replace('"80 N*m/rad"', "80")
    )
    spring = WHEEL.partition("[environment]")[0] + (
        '[environment]\ntype = "nonlinear-spring"\npositions = ["7.5 rad", 8]\nforces = [0, 6]\n'
    )
    told = _origins(spring)
    assert (told["angles"][0], told["torques"][0]) == ("7.5 rad, 8 rad", "0 N·m, 6 N·m")
    assert linear["mass m"] == ("2 kg", "wheel.toml, [device]: inertia")
    assert linear["inertia"][0] == "0.02 kg·m^2"


def test_what_was_typed_is_told_as_it_was_typed() -> None:
    told = _origins(WHEEL, damping="60 mN*m*s/rad", virtual_damping="0.002")
    assert told["damping b"] == ("0.06 N·m·s/rad", "typed: --damping 60 mN*m*s/rad")
    assert told["virtual damping B"][1] == "typed: --virtual-damping 0.002"


def test_the_catalogue_is_told_with_its_source() -> None:
    """Of the numbers that are still those of the catalogue, from a command or in Python."""
    told = _origins('[device]\ncatalogue = "haptic-paddle"\nrate = "2 kHz"\n', stiffness="100")
    assert told["damping b"][1] == "catalogue: Abbott & Okamura 2005, section IV-B"
    assert told["sample period T"][1] == "wheel.toml, [device]: rate"
    assert told["law"] == ("wall", "not given: the default")
    paddle = zw.catalogue.device("haptic-paddle", rate=2000)
    in_python = {what: where for what, _, where in of_verdict(zw.check(paddle, zw.Wall(100))).numbers}
    assert in_python["damping b"] == told["damping b"][1]
    assert in_python["sample period T"] == "given in Python"
    assert in_python["delay τ"] == "not given: taken as 0"
    assert in_python["law"] == "given in Python"


def test_of_an_interval_its_worst_end_is_told_as_that() -> None:
    uncertain = zw.check(zw.Device(damping=(0.2, 0.3), rate=1000), zw.Wall(100))
    rows = {what: (value, where) for what, value, where in of_verdict(uncertain).numbers}
    assert rows["damping b"] == ("0.2 N·s/m", "the worst of the interval given in Python")
    told = _origins(WHEEL.replace("damping = 0.05", "damping = [0.05, 0.07]"))
    assert told["damping b"] == ("0.05 … 0.07 N·m·s/rad", "wheel.toml, [device]")


@pytest.mark.parametrize("law", [zw.Maxwell(100, 2), zw.PulseTransferFunction([100, -50], [1, 0])])
def test_of_every_law_something_is_told(law: zw.Maxwell) -> None:
    rows = of_verdict(zw.check(zw.Device(damping=1, rate=1000), law)).numbers
    assert rows[-1] == ("law", law.describe(), "given in Python")


PAIR = """
[leader]
catalogue = "haptic-paddle"
[follower]
damping = 0.3
rate = "1 kHz"
[coupling]
stiffness = "100 N/m"
virtual_damping = "0.01 N*s/m"
link_delay = 0.002
"""


def test_of_two_arms_each_number_is_told() -> None:
    tables = tables_of(PAIR, "arms.toml", PAIR_TABLES)
    told = {what: (value, where) for what, value, where in of_pair(tables, pair_of(tables))}
    assert told["leader: damping b"] == ("0.15 N·s/m", "catalogue: Abbott & Okamura 2005, section IV-B")
    assert told["follower: damping b"] == ("0.3 N·s/m", "arms.toml, [follower]")
    assert told["follower: resolution Δ"][1] == "not given: taken as 0"
    assert told["coupling: damping"] == ("0.01 N·s/m", "arms.toml, [coupling]")
    assert told["coupling: link delay"][0] == "0.002 s"
