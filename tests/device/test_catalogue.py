"""Every number of the catalogue has a source; what has none stays unknown."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import pytest

import zwidth as zw
from zwidth.device.catalogue import PROPERTIES, RECOMMENDATION, UNKNOWN

NAMES = [
    "haptic-paddle",
    "phantom",
    "excalibur",
    "novint-falcon",
    "omega.3",
    "delta.3",
    "sigma.7",
    "lambda.7",
    "touch",
    "phantom-omni",
    "phantom-desktop",
    "phantom-premium-1.5-6dof",
    "haply-2diy-gen3",
    "hapkit",
    "course-plant",
]


def test_names() -> None:
    """The devices, in the order of the file."""
    assert list(zw.catalogue.names()) == NAMES


@pytest.mark.parametrize("name", NAMES)
def test_every_value_has_a_source_and_a_unit(name: str) -> None:
    """And every quantity of a device is listed, known or not."""
    entry = zw.catalogue.entry(name)
    assert entry.name == name
    assert entry.title
    assert set(PROPERTIES) - set(entry.values) in ({"rate"}, {"sample_period"})
    for value, unit, source in entry.values.values():
        assert unit
        assert (value is None) == (source == UNKNOWN)
    assert any(datum.value is not None for datum in entry.values.values())


def test_entries_cannot_be_changed() -> None:
    """They are shared by everyone who asks."""
    with pytest.raises(TypeError):
        zw.catalogue.entry("phantom").values["mass"] = None  # type: ignore[index]


def test_the_paddle_is_the_paper_s() -> None:
    """Abbott & Okamura 2005: 300 N/m and about 10 700 N/m."""
    paddle = zw.catalogue.device("haptic-paddle")
    b, t = paddle.exact("damping"), paddle.exact("sample_period")
    assert 2 * b / t == 300
    assert round(2 * paddle.exact("coulomb_friction") / paddle.exact("resolution"), -2) == 10_700
    assert paddle.exact("force_limit") == 10 * Fraction("1.65")
    assert paddle.exact("force_resolution") == Fraction(20, 65536) * Fraction("1.65")
    assert paddle.assumed == ("delay",)


def test_what_the_phantom_lacks_is_assumed_aloud() -> None:
    """Only damping and rate of it are published."""
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
        ("touch", ["--damping", "--rate"]),
    ],
)
def test_needed_numbers_that_nobody_published(name: str, missing: list[str]) -> None:
    """They are listed together, with the way to give them; and no others."""
    with pytest.raises(zw.InputError) as caught:
        zw.catalogue.device(name)
    assert [option for option in ("--damping", "--rate") if option in str(caught.value)] == missing
    given: dict[str, Any] = {"--damping": {"damping": "0.1 N*s/m"}, "--rate": {"rate": "1 kHz"}}
    arguments = {k: v for option in missing for k, v in given[option].items()}
    assert zw.catalogue.device(name, **arguments).exact("rate") == 1000


def test_overrides() -> None:
    """A rate replaces the published period, and texts carry units."""
    paddle = zw.catalogue.device("haptic-paddle", rate="3 kHz", resolution=["1 um", "2 um"], name="mine")
    assert paddle.exact("sample_period") == Fraction(1, 3000)
    assert paddle.resolution == zw.Interval("1e-6", "2e-6")
    assert paddle.name == "mine"
    assert zw.catalogue.device("phantom", sample_period=0.002).exact("rate") == 500


@pytest.mark.parametrize(
    ("name", "overrides", "part"),
    [
        ("phantm", {}, 'did you mean "phantom"'),
        ("", {}, "it has: haptic-paddle"),
        ("phantom", {"dampng": 1}, 'did you mean "damping"'),
        ("phantom", {"damping": "1 kg"}, "a mass"),
        ("phantom", {"damping": None}, "no source gives the damping"),
        ("phantom", {"recommended_stiffness": 1}, "a device has no"),
    ],
)
def test_slips_are_refused(name: str, overrides: dict[str, Any], part: str) -> None:
    """With the nearest name, or all of them."""
    with pytest.raises(zw.InputError, match=part):
        zw.catalogue.device(name, **overrides)


def test_a_recommendation_is_called_one() -> None:
    """The largest stiffness of a driver is not a property of the device."""
    datum = zw.catalogue.entry("novint-falcon").values["recommended_stiffness"]
    assert datum.value == 3000
    assert RECOMMENDATION in datum.source
