"""Specifications as Python reads them: `zw.load`."""

from __future__ import annotations

from pathlib import Path

import pytest

import zwidth as zw

WHEEL = '[device]\ninertia = 0.006\ndamping = "0.02 N*m*s/rad"\nrate = "1 kHz"\n'
STOP = '[environment]\ntype = "wall"\nstiffness = "20 N*m/rad"\n'


def written(folder: Path, text: str, name: str = "a.toml") -> Path:
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return path


def test_device_and_environment_in_files_of_their_own(tmp_path):
    loop = zw.load(written(tmp_path, WHEEL), written(tmp_path, STOP, "b.toml"))
    assert loop.device == zw.rotary(inertia="0.006", damping="0.02", sample_period="0.001", name="a")
    assert loop.environment == zw.Wall(20)
    assert zw.check(*loop).max_stiffness == 40


def test_a_name_of_the_catalogue_and_a_law(tmp_path):
    law = written(tmp_path, STOP.replace("20 N*m/rad", "20 N/m") + '[[law]]\ntype = "force-bounding"\n')
    loop = zw.load("haptic-paddle", law)
    assert loop.environment == zw.render(zw.Wall(20), zw.rendering.ForceBounding())
    assert zw.check(*loop).passive


def test_a_device_alone(tmp_path):
    assert zw.load("haptic-paddle") == (zw.catalogue.device("haptic-paddle"), None)
    with pytest.raises(zw.InputError, match="no file is given"):
        zw.load()
    with pytest.raises(zw.InputError, match=r"no file has an \[environment\]"):
        zw.load("haptic-paddle", written(tmp_path, '[[law]]\ntype = "force-bounding"\n'))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("[device]\nmass = 1\n", "sample_period"),
        ("[devise]\nmass = 1\n", "devise"),
        (WHEEL + "stiffness = 3\n", "stiffness"),
        (STOP, "no device"),
    ],
)
def test_what_cannot_be_used_is_said(text, message, tmp_path):
    with pytest.raises(zw.InputError, match=message):
        zw.load(written(tmp_path, text))
