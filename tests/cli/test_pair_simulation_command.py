"""`zwidth simulate` of two arms: what holds either, the report, the files; one clear line on bad input."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from zwidth.cli.main import main
from zwidth.loop.traces import load_trace

ARMS = """
[leader]
damping = 0.5
coulomb_friction = 0.05
mass = 0.05
rate = "1 kHz"
[follower]
damping = 0.5
coulomb_friction = 0.05
mass = 0.1
rate = "1 kHz"
[coupling]
stiffness = "50 N/m"
link_delay = "2 ms"
"""
TOUCH = """
[operator]
type = "constant-force"
force = "1 N"
[follower_operator]
type = "wall"
stiffness = "500 N/m"
damping = 2
[simulation]
duration = "0.8 s"
"""


@pytest.fixture
def files(tmp_path: Path) -> list[str]:
    """The arms, and what holds them."""
    for name, text in (("arms", ARMS), ("touch", TOUCH)):
        (tmp_path / f"{name}.toml").write_text(text, encoding="utf-8")
    return [str(tmp_path / f"{name}.toml") for name in ("arms", "touch")]


def said(capsys, *argv: str) -> str:
    """The one line on standard error of input that cannot be used."""
    assert main(["simulate", *argv]) == 2
    told = capsys.readouterr().err
    assert told.count("\n") == 1
    return told


def test_a_hand_against_a_wall_through_two_arms(files, capsys, tmp_path):
    saved = str(tmp_path / "arms.nc")
    plot, sound = str(tmp_path / "arms.png"), tmp_path / "leader.wav"
    assert main(["simulate", *files, "-o", saved, "--plot", plot, "--sound", str(sound)]) == 0
    out = capsys.readouterr().out
    assert "stiffness felt at the leader" in out
    assert "a real wall, 500 N/m, 2 N·s/m" in out
    trace = load_trace(saved)
    assert trace["hand_force"].values[1, -1] == pytest.approx(-1, rel=0.1)
    assert Path(plot).stat().st_size > 10_000
    trace.zwidth.sound(tmp_path / "again.wav")
    assert sound.read_bytes() == (tmp_path / "again.wav").read_bytes()


def test_json_has_both_arms_and_units(files, capsys):
    assert main(["simulate", *files, "--stiffness", "20", "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told["format"] == "zwidth pair simulation 1"
    assert told["coupling"].startswith("K = 20 N/m")
    assert 10 < told["felt_stiffness_N_per_m"] < 25
    assert told["tracking_error_m"] > 0
    energy = told["energy"]
    lost = [energy[arm]["viscous_loss_J"] + energy[arm]["coulomb_loss_J"] for arm in ("leader", "follower")]
    kinetic = [energy[arm]["kinetic_energy_J"] for arm in ("leader", "follower")]
    put_in = energy["hand_work_J"]
    assert put_in == pytest.approx(energy["coupling_took_J"] + sum(lost) + sum(kinetic), rel=1e-9)


def test_a_follower_that_nobody_holds(files, capsys):
    assert main(["simulate", files[0], "--operator", "finger", "--duration", "0.3"]) == 0
    assert "nobody" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("argv", "words"),
    [
        (["--damping", "3"], "which arm"),
        (["--follower-operator.stiffness", "3 N"], "stiffness is in N/m"),
        (["--follower-operator", "walls"], "there is no hand"),
        (["--law", "saturation"], "virtual wall"),
        (["--lateness", "1e-4"], "regular clock"),
        (["--follower-operator.mass", "3"], "mass"),
    ],
)
def test_what_cannot_be_used_is_said(files, capsys, argv, words):
    assert words in said(capsys, *files, *argv)


def test_a_wall_needs_its_stiffness_and_a_pair_its_duration(files, capsys):
    hand = ["--operator", "finger"]
    assert "stiffness" in said(capsys, files[0], *hand, "--follower-operator", "wall", "--duration", "1")
    assert "duration" in said(capsys, files[0], *hand)


def test_one_device_has_no_follower(capsys):
    loop = ["haptic-paddle", "--stiffness", "300", "--operator", "dowel", "--duration", "1"]
    assert "no follower" in said(capsys, *loop, "--follower-operator", "finger")


def test_ways_to_join_two_arms_are_compared(files, capsys, tmp_path):
    saved = tmp_path / "schemes.json"
    assert main(["compare", files[0], "--stiffness", "40", "-o", str(saved)]) == 0
    out = capsys.readouterr().out
    assert "position–force" in out
    told = json.loads(saved.read_text(encoding="utf-8"))
    assert told["format"] == "zwidth pairs 1"
    assert list(told["schemes"]) == ["position–position", "position–force", "four channels"]
    for scores in told["schemes"].values():
        assert scores["felt_stiffness_N_per_m"] == pytest.approx(40, rel=0.1)


@pytest.mark.parametrize(
    ("argv", "words"),
    [(["--plot", "a.png"], "--plot"), (["--fastest", "3"], "--fastest"), (["--rate", "3"], "which arm")],
)
def test_what_is_of_laws_is_not_of_arms(files, capsys, argv, words):
    assert main(["compare", files[0], *argv]) == 2
    assert words in capsys.readouterr().err
