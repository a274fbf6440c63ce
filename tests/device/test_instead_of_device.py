"""What is given in the place of a device is told how a device is made of it."""

from __future__ import annotations

import pytest

import zwidth as zw

WALL = zw.Wall(300)
ASKED = {
    "check": lambda device: zw.check(device, WALL),
    "limit": lambda device: zw.limit(device, WALL),
    "available_storage": lambda device: zw.available_storage(device, WALL),
    "simulate": lambda device: zw.simulate(device, WALL, zw.operators.Dowel(), 1.0),
}


@pytest.mark.parametrize("asked", ASKED.values(), ids=ASKED)
@pytest.mark.parametrize(
    ("given", "told"),
    [
        ("haptic-paddle", "zw.catalogue.device('haptic-paddle') is that device"),
        ("wheel.toml", "zw.load('wheel.toml').device reads a file"),
        (3, "got int"),
    ],
)
def test_it_says_what_to_type(asked, given, told):
    with pytest.raises(zw.InputError) as refused:
        asked(given)
    assert told in str(refused.value)


def test_what_it_says_to_type_works(tmp_path):
    (tmp_path / "wheel.toml").write_text("[device]\ndamping = 1\nrate = 1000\n", encoding="utf-8")
    file = zw.load(tmp_path / "wheel.toml").device
    for device in (file, zw.catalogue.device("haptic-paddle")):
        assert zw.check(device, WALL).outcome == "passive"
