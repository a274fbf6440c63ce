"""A wheel of 65 536 counts, 1 kHz USB and a delay of part of a sample, in degrees through every command."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from zwidth.cli.main import main

WHEEL = """[device]
name = "wheel"
motion = "rotary"
inertia = "60 kg*cm^2"
damping = "0.0009 N*m*s/deg"
coulomb_friction = "0.15 N*m"
counts_per_turn = 65536
rate = "1 kHz"
delay = "1.4 ms"
force_limit = "8 N*m"
"""
STOP = '[environment]\ntype = "wall"\nstiffness = "0.4 N*m/deg"\n'

Run = Callable[..., tuple[int, str]]


@pytest.fixture
def run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Run:
    """One command line beside the files of a wheel: its status, and what it printed with single blanks."""
    monkeypatch.chdir(tmp_path)
    Path("wheel.toml").write_text(WHEEL + STOP, encoding="utf-8")
    Path("device.toml").write_text(WHEEL, encoding="utf-8")

    def runner(*argv: str) -> tuple[int, str]:
        status = main(argv)
        captured = capsys.readouterr()
        return status, " ".join((captured.out + captured.err).split())

    return runner


RIM = ("--handle-radius", "0.15 m", "--laws", "wall")
HANDS = ("--operator", "hands-on", "--duration", "0.2 s")
MAP = ("--stiffness", "0.1:1 N*m/deg", "--virtual-damping", "0:0.001 N*m*s/deg", "--cells", "4x4")

TOLD: dict[str, tuple[tuple[str, ...], int, tuple[str, ...]]] = {
    "check": (
        ("check", "wheel.toml"),
        0,
        ("stiffness may go up to 0.466 N·m/deg (now 0.4 N·m/deg)", "Δ = 0.00549316 deg"),
    ),
    "check in full": (
        ("check", "wheel.toml", "--stiffness", "0.6 N*m/deg", "--all"),
        1,
        ("required device damping 0.00115865 N·m·s/deg", "deg at up to 7515 deg/s"),
    ),
    "simulate": (
        ("simulate", "wheel.toml", *HANDS, "--operator.speed", "60 rpm", "--all"),
        0,
        ("stiffness 0.106029 N·m/deg", "speed 60 rpm", "start -17.1887 deg", "deepest position"),
    ),
    "hands off": (
        ("simulate", "wheel.toml", "--operator", "hands-off", "--initial-velocity", "360 deg/s", *HANDS[2:]),
        0,
        ("hand hands off", "deg"),
    ),
    "compare": (("compare", "wheel.toml", *RIM, "--all"), 0, ("touched 150 mm from its axis", "N·m/deg")),
    "map": (("map", "device.toml", *MAP), 0, ("largest K [N·m/deg]", "stable, hands-on", "28.65 deg/s")),
    "pair": (
        ("pair", "device.toml", "--stiffness", "0.1 N*m/deg", "--link-delay", "2 ms"),
        0,
        ("stiffness may go up to 0.154 N·m/deg",),
    ),
    "plan": (
        ("plan", "device.toml", "--force-noise", "0.05 N*m", "--length", "90 deg"),
        0,
        ("strokes of some 90 deg", "deg/s"),
    ),
    "emit": (("emit", "wheel.toml", "-o", "emitted"), 0, ("wall, 0.4 N·m/deg",)),
    "report": (("report", "wheel.toml", "-o", "report.html"), 0, ("passive",)),
    "play": (("play", "wheel.toml", "-o", "play.html"), 0, ("wall, 0.4 N·m/deg",)),
}
"""Command lines, their status, and what is read in each."""


@pytest.mark.parametrize("name", TOLD)
def test_a_wheel_in_degrees(run: Run, name: str) -> None:
    """Nobody reads radians who typed none; nothing stops the wheel."""
    argv, status, parts = TOLD[name]
    got, said = run(*argv)
    assert got == status, said
    for part in parts:
        assert part in said
    assert not re.search(r"\brad\b", said), said


def test_what_the_page_says(run: Run) -> None:
    """A report is in degrees, tables and captions too."""
    run("report", "wheel.toml", "-o", "report.html")
    page = Path("report.html").read_text(encoding="utf-8")
    text = re.sub(r"<script.*?</script>|<style.*?</style>|base64,[^\"]*|<[^>]+>", " ", page, flags=re.DOTALL)
    assert "0.466062 N·m/deg" in text
    assert not re.search(r"\brad\b", text.split("What the checker read")[0])


def test_documents_are_si(run: Run) -> None:
    """The unit stands in the key, and is that of SI."""
    _, said = run("check", "wheel.toml", "--json")
    document: dict[str, Any] = json.loads(said)
    assert document["max_stiffness_N_m_per_rad"] == pytest.approx(26.7034, rel=1e-5)


def test_a_saved_trace_remembers_the_question(run: Run) -> None:
    """Its numbers are SI; who reads them together is told in degrees."""
    run("simulate", "wheel.toml", *HANDS, "-o", "a.csv")
    _, said = run("traces", "a.csv")
    assert "deepest [deg]" in said
    run(
        "simulate",
        "wheel.toml",
        *HANDS,
        "--stiffness",
        "20 N*m/rad",
        "--damping",
        "0.05 N*m*s/rad",
        "-o",
        "b.csv",
    )
    Path("plain.toml").write_text(WHEEL.replace("0.0009 N*m*s/deg", "0.05"), encoding="utf-8")
    run("simulate", "plain.toml", "--stiffness", "20", *HANDS, "-o", "c.csv")
    assert "deepest [rad]" in run("traces", "c.csv")[1]


def test_who_types_radians(run: Run) -> None:
    """Reads radians, from the next command on."""
    assert "N·m/rad" not in run("check", "wheel.toml")[1]
    Path("plain.toml").write_text(WHEEL.replace("0.0009 N*m*s/deg", "0.05"), encoding="utf-8")
    said = run("check", "plain.toml", "--stiffness", "5 N*m/rad")[1]
    assert "5 N·m/rad" in said
    assert "deg" not in said


def test_the_unit_of_a_range_is_of_both_its_ends(run: Run) -> None:
    """0.1:1 N·m/deg begins at 0.1 N·m/deg."""
    one = run("map", "device.toml", *MAP, "--json")[1]
    both = ("--stiffness", "0.1 N*m/deg:1 N*m/deg", *MAP[2:])
    assert run("map", "device.toml", *both, "--json")[1] == one


REFUSED = {
    "no radius": (("compare", "wheel.toml"), "--handle-radius '0.15 m' for a wheel"),
    "your own laws": (("compare", "wheel.toml", *RIM, "--law", "extrapolation"), "the bench touches the rim"),
    "hands off and nothing": (
        ("simulate", "wheel.toml", "--operator", "hands-off", "--duration", "1"),
        "--initial-velocity '360 deg/s'",
    ),
    "hands on a handle": (
        ("simulate", "haptic-paddle", "--stiffness", "300", *HANDS),
        "holds a device that turns",
    ),
    "a wall where there is none": (("plan", "wheel.toml", "--force-noise", "1"), "takes a device alone"),
    "a map of another law": (("map", "other.toml", *MAP), "a map is of walls"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_what_cannot_be_is_said(run: Run, name: str) -> None:
    """One message that says what to do."""
    Path("other.toml").write_text(
        WHEEL + '[environment]\ntype = "maxwell"\nstiffness = 1\nvirtual_damping = 1\n', encoding="utf-8"
    )
    argv, part = REFUSED[name]
    status, said = run(*argv)
    assert status == 2
    assert part in said


def test_a_device_in_its_ranges(run: Run) -> None:
    """Undecided: what to measure first; passive for every device; and other commands say where to go."""
    status, said = run("check", "moza-r9", "--stiffness", "2 N*m/deg")
    assert status == 3
    for part in ("measure first damping", "for every device in the ranges: up to 0.034", "delay 0 … 2 ms"):
        assert part in said
    status, said = run("check", "moza-r9", "--stiffness", "0.03 N*m/deg", "--all")
    assert status == 0
    assert "let go at a turn a second" in said
    document = json.loads(run("check", "moza-r9", "--stiffness", "2 N*m/deg", "--json")[1])
    assert document["ranges"]["measure_first"]["parameter"] == "damping"
    said = run("check", "dynamixel-mx-64", "--stiffness", "1")[1]
    assert "measure first rate: if it is at least 84.1 Hz" in said
    status, said = run("check", "moza-r9", "--stiffness", "2 N*m/deg", "--law", "force-bounding")
    assert status == 2
    assert "give yours, --delay '1 ms'" in said
    assert "zwidth check moza-r9" in run("simulate", "moza-r9", "--stiffness", "1", *HANDS)[1]
    run("report", "moza-r9", "--stiffness", "1 N*m/deg", "-o", "ranges.html")
    assert "stated and not measured" in Path("ranges.html").read_text(encoding="utf-8")
