"""`zwidth map`: report, JSON, picture and store, and one clear line on bad input."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

import zwidth as zw
from zwidth.cli.main import main

MAP = ("map", "haptic-paddle", "--stiffness", "0:600", "--virtual-damping", "0:0.3")


def test_the_report_and_the_json_say_the_same(capsys: pytest.CaptureFixture[str]) -> None:
    """As `zw.z_width` has it: 2 (b − B)/T at the smallest B of a cell, and the device in free air."""
    few = (*MAP, "--cells", "60x20")
    assert main(few) == 0
    report = capsys.readouterr().out
    assert main((*few, "--json")) == 0
    document = json.loads(capsys.readouterr().out)
    assert document["regions"]["passive"].pop("scope")["contact"] == "made and broken"
    found = zw.z_width(zw.catalogue.device("haptic-paddle"), (0, 600), (0, "0.3"), (60, 20))
    assert document["regions"]["passive"] == {
        "largest_stiffness_N_per_m": found["largest_stiffness"].sel(region="passive").item(),
        "cells": int(found["passive"].sum()),
        "covered": True,
    }
    assert document["not_covered"] is None
    assert "passive, every hand" in report
    assert "285" in report
    assert "free air: 0.036 kg, 0.15 N·s/m, 0.12 N" in report


def test_options_reach_the_map(capsys: pytest.CaptureFixture[str]) -> None:
    """Units, cells, a filter, a hand, a speed, the damping of the device itself."""
    status = main(
        ("map", "haptic-paddle", "--stiffness", "0:0.6 kN/m", "--virtual-damping", "-0.1:0.3",
         "--cells", "30x20", "--velocity-filter", "one-pole 30 ms",
         "--hands", "finger", "--speed", "1 m/s", "--json",
         "--damping", "0.3", "--rate", "2 kHz", "--workers", "1")
    )  # fmt: skip
    assert status == 0
    document = json.loads(capsys.readouterr().out)
    assert document["regions"]["passive"].pop("scope")["contact"] == "made and broken"
    found = zw.z_width(
        zw.catalogue.device("haptic-paddle", damping=0.3, rate=2000), (0, 600), ("-0.1", "0.3"), (30, 20),
        velocity_filter=zw.rendering.OnePole(0.03), hands={"finger": zw.operators.Finger()}, speed=1,
    )  # fmt: skip
    assert document["cells"] == 600
    assert set(document["regions"]) == {"passive", "passive_sustained", "quiet", "stable_finger"}
    for name, region in document["regions"].items():
        assert region["cells"] == int(found[name].sum())
    assert document["free_damping_N_s_per_m"] == 0.3


def test_a_store_and_a_picture(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Both are written; the picture is not replaced without --force, the store is gone on with."""
    command = (
        *MAP,
        "--cells",
        "40x40",
        "-o",
        str(tmp_path / "map.zarr"),
        "--plot",
        str(tmp_path / "map.png"),
    )
    assert main(command) == 0
    first = capsys.readouterr().out
    assert (tmp_path / "map.png").stat().st_size > 10_000
    assert main(command) == 2
    assert "exists" in capsys.readouterr().err
    assert main((*command, "--force")) == 0
    assert capsys.readouterr().out == first


def test_ctrl_c_says_what_is_kept(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Status 130, no traceback; with a store, that the same command goes on with it."""

    def stop(*_: object, path: object = None, **__: object) -> None:
        if path is not None:
            Path(str(path)).mkdir()
        raise KeyboardInterrupt

    monkeypatch.setattr("zwidth.study.maps.z_width", stop)
    assert main(MAP) == 130
    assert capsys.readouterr().err == "zwidth: interrupted\n"
    assert main((*MAP, "-o", str(tmp_path / "map.zarr"))) == 130
    err = capsys.readouterr().err
    assert "map.zarr keeps what is finished; the same command goes on" in err
    assert err.endswith("zwidth: interrupted\n")


def test_certificates_of_the_columns(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """One for each column with a passive cell; `zwidth verify` accepts the file, not with less damping."""
    path = tmp_path / "walls.json"
    command = (*MAP, "--cells", "60x12", "--certify", str(path), "--velocity-filter", "window 2")
    assert main(command) == 0
    assert main(command) == 2
    assert "exists" in capsys.readouterr().err
    document = json.loads(path.read_text(encoding="utf-8"))
    found = zw.z_width(
        zw.catalogue.device("haptic-paddle"),
        (0, 600),
        (0, "0.3"),
        (60, 12),
        velocity_filter=zw.rendering.Window(2),
    )
    assert len(document["corners"]) == int(found["passive"].any(dim="stiffness").sum())
    assert main(("verify", str(path))) == 0
    assert "is passive, proved" in " ".join(capsys.readouterr().out.split())
    document["corners"][-1]["loop"]["damping_N_s_per_m"] = "0.05"
    path.write_text(json.dumps(document))
    assert main(("verify", str(path))) == 1


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("map", "haptic-paddle", "--virtual-damping", "0:1"), "--stiffness LOW:HIGH is missing"),
        (
            ("map", "haptic-paddle", "--stiffness", "300", "--virtual-damping", "0:1"),
            "--stiffness is a range",
        ),
        ((*MAP, "--damping", "0:1"), "--virtual-damping LOW:HIGH"),
        ((*MAP, "--cells", "40"), "--cells is written NxM"),
        ((*MAP, "--cells", "40xmany"), "whole numbers"),
        ((*MAP, "--hands", "fingr"), "did you mean"),
        ((*MAP, "--plot", "map.gif"), "must end in"),
        ((*MAP, "--plot", "a.png", "--certify", "a.png"), "--plot and --certify"),
        (
            (
                "map",
                "haptic-paddle",
                "--stiffness",
                "400:900",
                "--virtual-damping",
                "0:9",
                "--certify",
                "c.json",
            ),
            "no wall",
        ),
        (("map", "--stiffness", "0:1", "--virtual-damping", "0:1"), "no device is given"),
        ((*MAP, "--velocity-filter", "wavelet"), "no type"),
    ],
)
def test_bad_input_is_one_line(
    arguments: tuple[str, ...], message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    """Status 2 and what to write instead."""
    assert main(arguments) == 2
    error = capsys.readouterr().err
    assert message in error
    assert error.count("\n") == 1


def test_a_region_without_walls_has_no_largest_one(capsys: pytest.CaptureFixture[str]) -> None:
    """None, not 0 N/m."""
    arguments = ("--stiffness", "400:600", "--virtual-damping", "0:1", "--cells", "5x5", "--hands", "finger")
    assert main(("map", "haptic-paddle", *arguments)) == 0
    (line,) = [row for row in capsys.readouterr().out.splitlines() if row.startswith("passive, every hand")]
    assert line.split()[-2:] == ["none", "0.0%"]


def test_not_covered_is_not_none(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A velocity filter whose response does not end: report, JSON and picture say so and name the spring."""
    wheel = tmp_path / "wheel.toml"
    wheel.write_text(
        '[device]\nmotion = "rotary"\ninertia = "0.0001 kg*m^2"\ndamping = "0.03 N*m*s/rad"\n'
        'coulomb_friction = "0.1 N*m"\nresolution = "0.0015 rad"\nrate = "1 kHz"\ndelay = "0.5 ms"\n',
        encoding="utf-8",
    )
    filtered = '{ type = "filter", numerator = [1, 0, 0], denominator = [1, -0.5, 0.06] }'
    wall = tmp_path / "wall.toml"
    wall.write_text(f'[environment]\ntype = "wall"\nstiffness = 1\nvelocity_filter = {filtered}\n')
    asked = [
        "map",
        str(wheel),
        str(wall),
        "--stiffness",
        "0:100",
        "--virtual-damping",
        "0:0.2",
        "--cells",
        "10x4",
        "--hands",
        "none",
    ]
    assert main(asked) == 0
    said = capsys.readouterr().out
    assert "not covered" in said.splitlines()[1]
    assert "a spring alone, B = 0, is passive up to 28.33 N·m/rad" in said
    assert main([*asked, "--json", "--plot", str(tmp_path / "map.svg")]) == 0
    document = json.loads(capsys.readouterr().out)
    assert document["regions"]["passive"].pop("scope")["contact"] == "made and broken"
    assert document["regions"]["passive"] == {
        "largest_stiffness_N_m_per_rad": None,
        "cells": 0,
        "covered": False,
    }
    assert document["spring_limit_N_m_per_rad"] == pytest.approx(28.3282, rel=1e-5)
