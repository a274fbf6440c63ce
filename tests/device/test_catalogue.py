"""Every number of the catalogue has a source; what has none stays unknown."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import pytest

import zwidth as zw
from zwidth.model.device.catalogue import PROPERTIES, RECOMMENDATION, UNKNOWN, DeviceInRange

NAMES = [
    "haptic-paddle", "phantom", "excalibur", "novint-falcon", "omega.3", "delta.3", "sigma.7", "lambda.7",
    "touch", "phantom-omni", "phantom-desktop", "phantom-premium-1.5-6dof", "haply-2diy-gen3", "hapkit",
    "course-plant", "openffboard-wheel", "simucube-2-pro", "fanatec-csl-dd", "moza-r9", "smartknob",
    "feetech-sts3215", "dynamixel-xl330-m288", "dynamixel-mx-64", "dynamixel-mx-106",
    "dynamixel-xm430-w350",
]  # fmt: skip
RANGED = [name for name in NAMES if zw.catalogue.entry(name).ranges]


def test_names_and_entries_are_what_they_are():
    assert list(zw.catalogue.names()) == NAMES
    with pytest.raises(TypeError):
        zw.catalogue.entry("phantom").values["mass"] = None


@pytest.mark.parametrize("name", NAMES)
def test_every_value_has_a_source_and_a_unit(name):
    entry = zw.catalogue.entry(name)
    assert entry.name == name
    assert entry.title
    left_out = set(PROPERTIES) - set(entry.values)
    assert left_out - {"resolution"} in ({"rate"}, {"sample_period"})
    assert ("resolution" in left_out) == ("counts_per_turn" in entry.values)
    for value, unit, source in entry.values.values():
        assert unit
        assert (value is None) == (source == UNKNOWN)
    assert any(datum.value is not None for datum in entry.values.values())
    device = zw.catalogue.in_range(name).device
    assert device.damping, "`zwidth check NAME` never asks for what a verdict needs"
    assert device.sample_period


def test_the_paddle_is_the_paper_s():
    """Abbott & Okamura 2005: 300 N/m and about 10 700 N/m."""
    paddle = zw.catalogue.device("haptic-paddle")
    b, t = paddle.exact("damping"), paddle.exact("sample_period")
    assert 2 * b / t == 300
    assert round(2 * paddle.exact("coulomb_friction") / paddle.exact("resolution"), -2) == 10_700
    assert paddle.exact("force_limit") == 10 * Fraction("1.65")
    assert paddle.exact("force_resolution") == Fraction(20, 65536) * Fraction("1.65")
    assert paddle.assumed == ("delay",)


def test_what_the_phantom_lacks_is_assumed_aloud():
    phantom = zw.catalogue.device("phantom")
    assert phantom.exact("damping") == Fraction(27, 100)
    assert phantom.exact("rate") == 1000
    assert phantom.mass is None
    assert phantom.assumed == ("coulomb_friction", "resolution", "delay")


@pytest.mark.parametrize(
    ("name", "missing"),
    [
        ("excalibur", ["--damping"]),
        ("course-plant", ["--rate"]),
        ("touch", ["--damping"]),
        ("sigma.7", ["--damping", "--rate"]),
    ],
)
def test_needed_numbers_that_nobody_published(name, missing):
    with pytest.raises(zw.InputError) as caught:
        zw.catalogue.device(name)
    assert [option for option in ("--damping", "--rate") if option in str(caught.value)] == missing
    assert f'zwidth links, in a file whose [device] has catalogue = "{name}"' in str(caught.value)
    given: dict[str, Any] = {"--damping": {"damping": "0.1 N*s/m"}, "--rate": {"rate": "1 kHz"}}
    arguments = {k: v for option in missing for k, v in given[option].items()}
    assert zw.catalogue.device(name, **arguments).exact("rate") == 1000


def test_overrides():
    paddle = zw.catalogue.device("haptic-paddle", rate="3 kHz", resolution=["1 um", "2 um"], name="mine")
    assert paddle.exact("sample_period") == Fraction(1, 3000)
    assert paddle.resolution == zw.Interval("1e-6", "2e-6")
    assert paddle.name == "mine"
    assert zw.catalogue.device("phantom", sample_period=0.002).exact("rate") == 500


@pytest.mark.parametrize(
    ("name", "overrides", "part"),
    [
        ("phantm", {}, 'did you mean "phantom"'),
        ("", {}, "choose from: haptic-paddle"),
        ("phantom", {"dampng": 1}, 'did you mean "damping"'),
        ("phantom", {"damping": "1 kg"}, "a mass"),
        ("phantom", {"damping": None}, "no source gives the damping"),
        ("phantom", {"recommended_stiffness": 1}, "a device has no"),
    ],
)
def test_slips_are_refused(name, overrides, part):
    with pytest.raises(zw.InputError, match=part):
        zw.catalogue.device(name, **overrides)


def test_a_recommendation_is_called_one():
    """The largest stiffness of a driver is not a property of the device."""
    datum = zw.catalogue.entry("novint-falcon").values["recommended_stiffness"]
    assert datum.value == 3000
    assert RECOMMENDATION in datum.source


@pytest.mark.parametrize("name", RANGED)
def test_a_device_in_its_ranges_can_be_decided(name):
    found, entry = zw.catalogue.in_range(name), zw.catalogue.entry(name)
    assert set(found.ranges) == {
        {"rate": "sample_period", "counts_per_turn": "resolution"}.get(key, key) for key in entry.ranges
    }
    for key, own in entry.ranges.items():
        assert own.low < own.high
        assert len(own.why) > 20
        assert entry.values.get(key) is None or entry.values[key].value is None
    intervals = {k for k, v in found.device.parameters().items() if isinstance(v, zw.Interval)}
    assert intervals == set(found.ranges)
    assert found.device.motion == entry.motion
    assert zw.check(found.device, zw.Wall("1e-9")).outcome == "passive"


def test_what_is_given_needs_no_range():
    found = zw.catalogue.in_range(
        "simucube-2-pro", rate="1 kHz", counts_per_turn=65536, inertia="0.05 kg*m^2"
    )
    assert set(found.ranges) == {"damping", "coulomb_friction", "delay"}
    assert found.device.exact("rate") == 1000
    assert float(found.device.exact("resolution")) == pytest.approx(2 * 3.141592653589793 / 65536)
    assert float(found.device.exact("mass")) == 0.05
    assert zw.catalogue.in_range("haptic-paddle") == DeviceInRange(zw.catalogue.device("haptic-paddle"), {})


def test_a_range_is_no_value():
    with pytest.raises(zw.InputError, match="zwidth check moza-r9 answers for a stated range"):
        zw.catalogue.device("moza-r9")
    with pytest.raises(zw.InputError, match="no source gives the damping"):
        zw.catalogue.in_range("haptic-paddle", damping=None)
    with pytest.raises(zw.InputError, match="is rotary"):
        zw.catalogue.in_range("smartknob", motion="linear")


def test_units_of_a_rotary_entry():
    entry = zw.catalogue.entry("dynamixel-mx-64")
    assert entry.values["damping"].unit == "N*m*s/rad"
    assert entry.key("mass") == "inertia"
    joint = zw.catalogue.device("dynamixel-mx-64", rate="1 kHz", handle_radius="0.1 m")
    assert joint.motion == "linear"
    assert float(joint.exact("damping")) == pytest.approx(1.17)
