"""`zwidth each`: several devices in a table, what was measured beside it, files, and bad input."""

import csv
import json
from pathlib import Path

import pytest

import zwidth as zw

KIT = """[device]
damping = "{low} .. {high} N*s/m"
coulomb_friction = "0.1 N"
resolution = "24 um"
rate = "1 kHz"
"""
WHEEL = """[device]
damping = "0.01 N*m*s/rad"
coulomb_friction = "0.05 N*m"
rate = "1 kHz"
handle_radius = "14 cm"
"""
MEASURED = "device;stiffness [N/mm]\nkit-1; 0.41\nkit-2; 180 N/m\n"


@pytest.fixture(autouse=True)
def _files(run):
    for name, low, high in (("kit-1", "0.13", "0.19"), ("kit-2", "0.1", "0.12"), ("kit-3", "0.02", "0.03")):
        Path(f"{name}.toml").write_text(KIT.format(low=low, high=high), encoding="utf-8")
    Path("wheel.toml").write_text(WHEEL, encoding="utf-8")
    Path("class.csv").write_text(MEASURED, encoding="utf-8")


KITS = "each kit-1.toml kit-2.toml kit-3.toml"


def test_each_has_the_verdict_of_check(run):
    """Outcome and limit of each are those of `zw.check`; on all the smallest; the worst is the status."""
    out = run(f"{KITS} --stiffness 210", 1).words
    assert "wall, 210 N/m: " in out
    assert "on every one of them up to 40 N/m, the limit of kit-3" in out
    for name in ("kit-1", "kit-2", "kit-3"):
        verdict = zw.check(zw.load(f"{name}.toml").device, zw.Wall(210), iterate=False)
        assert f"{name} {verdict.outcome} {verdict.max_stiffness:.4g}" in out
        assert f"{verdict.limit}: " in out
    assert "delay not given, taken as 0: kit-1, kit-2, kit-3" in out
    run(f"{KITS} --stiffness 40")


def test_a_pattern_is_the_files_that_match(run, refused):
    """A class on Windows, whose shells leave it as it is; the value of an option stays."""
    assert run("each --json 'kit-?.toml' --stiffness 10").json == run(f"{KITS} --stiffness 10 --json").json
    assert "class*.csv cannot be read" in refused("each 'kit-*.toml' --stiffness 10 --measured 'class*.csv'")
    assert "there is no file" in refused("each 'kat-*.toml' --stiffness 10")


def test_what_was_measured_stands_beside_it(run):
    """In units of the head or its own; what shook below the proof is named, the unmeasured has none."""
    out = run(f"{KITS} --stiffness 100 --measured class.csv -o table.csv", 1).words
    assert "shook from 0.9 to 1.58 times what is proved" in out
    assert "shook below what is proved: kit-2." in out
    assert "kit-3 active 40 – –" in out
    heads, *rows = csv.reader(Path("table.csv").read_text(encoding="utf-8").splitlines())
    assert heads[2:5:2] == ["largest passive stiffness [N/m]", "shook from [N/m]"]
    assert [row[4:] for row in rows] == [["410", "1.57692"], ["180", "0.9"], ["", ""]]


def test_saved_verdicts_are_checked(run):
    run(f"{KITS} --stiffness 30 -o class.json")
    assert run("verify class.json").out.count("VALID") >= 3
    saved = json.loads(Path("class.json").read_text(encoding="utf-8"))
    assert [one["device"] for one in saved["devices"]] == ["kit-1", "kit-2", "kit-3"]


def test_wheels_are_told_in_degrees(run):
    """About the axis, where one asks so; one file has the wall of both."""
    Path("other.toml").write_text(WHEEL.replace("0.01", "0.02"), encoding="utf-8")
    wall = '[environment]\ntype = "wall"\nstiffness = "0.1 N*m/deg"\n'
    Path("wall.toml").write_text(wall, encoding="utf-8")
    told = run("each wheel.toml other.toml wall.toml")
    assert "up to 0.349 N·m/deg, the limit of wheel" in told.words
    assert run("each wheel.toml other.toml --stiffness '0.1 N*m/deg'") == told


@pytest.mark.parametrize(
    ("typed", "said"),
    [
        ("kit-1.toml --stiffness 100", "two devices or more, got 1"),
        ("kit-1.toml kit-1.toml --stiffness 100", "two devices are called"),
        ("kit-1.toml kit-2.toml", "no environment is given"),
        ("kit-1.toml kit-2.toml --stiffness 100 -o x.txt", ".csv or .json"),
        ("kit-1.toml kit-3.toml --stiffness 9 --measured class.csv", '"kit-2" is none of these'),
        ("kit-1.toml kit-2.toml --stiffness 9 --measured no.csv", "no.csv cannot be read"),
    ],
)
def test_bad_input(refused, typed, said):
    assert said in refused(f"each {typed}")


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("kit-1", "line 2: a device and a stiffness"),
        ("kit-1,-4", "is > 0"),
        ("kit-1,3 kg", "stiffness is in"),
        ("kit-1,4\nkit-1,5", "stands there twice"),
        ("kit-1,4.1.2", "stiffness is in"),
    ],
)
def test_bad_tables(refused, line, said):
    Path("bad.csv").write_text(f"device,stiffness\n{line}\n", encoding="utf-8")
    err = refused("each kit-1.toml kit-2.toml --stiffness 9 --measured bad.csv")
    assert said in err
    assert "bad.csv" in err


def test_a_table_as_a_spreadsheet_saves_it(run, refused):
    """Decimal commas between semicolons; where nobody measured an empty cell; an empty file says so."""
    Path("class.csv").write_text("device;stiffness [N/m]\r\nkit-1;410,5\r\nkit-2;\r\n", encoding="utf-8-sig")
    found = run("each kit-1.toml kit-2.toml --stiffness 9 --measured class.csv --json").json["devices"]
    assert [device.get("measured_stiffness_N_per_m") for device in found] == [410.5, None]
    Path("class.csv").write_text("device;stiffness\nkit-1;1,018\n", encoding="utf-8")
    assert "without a comma" in refused("each kit-1.toml kit-2.toml --stiffness 9 --measured class.csv")
    Path("class.csv").write_text("\n", encoding="utf-8")
    assert "is empty" in refused("each kit-1.toml kit-2.toml --stiffness 9 --measured class.csv")


def test_an_encoder_on_the_motor(run, refused):
    """Counts in a turn of the motor, times its turns in one of the handle."""
    typed = "--motion rotary --rate '1 kHz' --damping '0.001 N*m*s/rad' --no-questions"
    run(f"new device new.toml {typed} --encoder '980 counts/turn x 17.45'")
    assert 'counts_per_turn = "17101"' in Path("new.toml").read_text(encoding="utf-8")
    told = refused(f"new device new.toml {typed} --force --encoder '0.09 deg x 17.45'")
    assert "counts in a turn of the motor" in told


def test_devices_on_cables_have_the_limit_of_every_cable(run, tmp_path):
    """2b₁/T = 120 N/m, whatever the outcome at this wall."""
    table = '[device]\nmass = "30 g"\ndamping = 0.06\nrate = 1000\n[device.transmission]\nstiffness = '
    for name, stiffness in (("soft", 2132), ("stiff", 28657)):
        (tmp_path / f"{name}.toml").write_text(f"{table}{stiffness}\nhandle_damping = 0.09\n", "utf-8")
    said = run(f"each {tmp_path}/soft.toml {tmp_path}/stiff.toml --stiffness 125", 1).words
    assert "passive on every one of them up to 120 N/m" in said
    assert "active on 1, passive in contact on 1 of 2 devices" in said
