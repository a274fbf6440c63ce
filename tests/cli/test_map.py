"""`zwidth map`: report, JSON, picture and store, and one clear line on bad input."""

import json
from pathlib import Path

import pytest

import zwidth as zw

MAP = "map haptic-paddle --stiffness 0:600 --virtual-damping 0:0.3"


def test_the_report_and_the_json_say_the_same(run):
    """As `zw.z_width` has it: 2 (b − B)/T at the smallest B of a cell, and the device in free air."""
    few = f"{MAP} --cells 60x20"
    report = run(few).out
    document = run(f"{few} --json").json
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


def test_options_reach_the_map(run):
    ranges = "--stiffness '0:0.6 kN/m' --virtual-damping -0.1:0.3 --cells 30x20 --workers 1"
    device = "--damping 0.3 --rate '2 kHz'"
    asked = "--velocity-filter 'one-pole 30 ms' --hands finger --speed '1 m/s'"
    document = run(f"map haptic-paddle {ranges} {device} {asked} --json").json
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


def test_a_store_and_a_picture(run, refused):
    command = f"{MAP} --cells 40x40 -o map.zarr --plot map.png"
    first = run(command)
    assert Path("map.png").stat().st_size > 10_000
    assert "exists" in refused(command)
    assert run(f"{command} --force").out == first.out


def test_ctrl_c_says_what_is_kept(run, monkeypatch):
    """Status 130, no traceback; with a store, that the same command goes on with it."""

    def stop(*_, path=None, **__):
        if path is not None:
            Path(path).mkdir()
        raise KeyboardInterrupt

    monkeypatch.setattr("zwidth.study.maps.z_width", stop)
    assert run(MAP, 130).err == "zwidth: interrupted\n"
    err = run(f"{MAP} -o map.zarr", 130).err
    assert "map.zarr keeps what is finished; the same command goes on" in err
    assert err.endswith("zwidth: interrupted\n")


def test_certificates_of_the_columns(run, refused):
    """One for each column with a passive cell; `zwidth verify` accepts the file, not with less damping."""
    command = f"{MAP} --cells 60x12 --certify walls.json --velocity-filter 'window 2'"
    run(command)
    assert "exists" in refused(command)
    document = json.loads(Path("walls.json").read_text(encoding="utf-8"))
    paddle, window = zw.catalogue.device("haptic-paddle"), zw.rendering.Window(2)
    found = zw.z_width(paddle, (0, 600), (0, "0.3"), (60, 12), velocity_filter=window)
    assert len(document["corners"]) == int(found["passive"].any(dim="stiffness").sum())
    assert "is passive, proved" in run("verify walls.json").words
    document["corners"][-1]["loop"]["damping_N_s_per_m"] = "0.05"
    Path("walls.json").write_text(json.dumps(document), encoding="utf-8")
    run("verify walls.json", 1)


def test_a_region_without_walls_has_no_largest_one(run):
    """None, not 0 N/m."""
    area = "--stiffness 400:600 --virtual-damping 0:1 --cells 5x5 --hands finger"
    rows = run(f"map haptic-paddle {area}").out.splitlines()
    (line,) = [row for row in rows if row.startswith("passive, every hand")]
    assert line.split()[-2:] == ["none", "0.0%"]


def test_not_covered_is_not_none(run):
    """A velocity filter whose response does not end: report, JSON and picture say so and name the spring."""
    filtered = '{ type = "filter", numerator = [1, 0, 0], denominator = [1, -0.5, 0.06] }'
    Path("loop.toml").write_text(
        '[device]\nmotion = "rotary"\ninertia = "0.0001 kg*m^2"\ndamping = "0.03 N*m*s/rad"\n'
        'coulomb_friction = "0.1 N*m"\nresolution = "0.0015 rad"\nrate = "1 kHz"\ndelay = "0.5 ms"\n'
        f'[environment]\ntype = "wall"\nstiffness = 1\nvelocity_filter = {filtered}\n',
        encoding="utf-8",
    )
    asked = "map loop.toml --stiffness 0:100 --virtual-damping 0:0.2 --cells 10x4 --hands none"
    said = run(asked).out
    assert "not covered" in said.splitlines()[1]
    assert "a spring alone, B = 0, is passive up to 28.33 N·m/rad" in said
    document = run(f"{asked} --json --plot map.svg").json
    region = document["regions"]["passive"]
    assert region.pop("scope")["contact"] == "made and broken"
    assert region == {"largest_stiffness_N_m_per_rad": None, "cells": 0, "covered": False}
    assert document["spring_limit_N_m_per_rad"] == pytest.approx(28.3282, rel=1e-5)


def test_a_handle_whose_mass_is_unknown_is_left_out_of_free_air(run, tmp_path):
    """It plays no part in the map: no number stands for it, in words, picture or JSON."""
    line = "map --damping 0.06 --mass 0.03 --rate '1 kHz' --transmission.stiffness '30 N/mm' "
    line += "--transmission.handle-damping 0.09 --stiffness 0:200 --virtual-damping 0:0.1 --cells 8x8"
    assert "free air: 0.15 N·s/m, 0 N" in run(f"{line} --plot map.svg").out
    assert "Felt in free air: 0.15 N·s/m" in (tmp_path / "map.svg").read_text(encoding="utf-8")
    assert "free_mass_kg" not in run(f"{line} --json").out
