"""`zwidth simulate` of two arms: what holds either, the report, the files; one clear line on bad input."""

import json
from pathlib import Path

import pytest

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


@pytest.fixture(autouse=True)
def _files(run):
    """The arms, and what holds them."""
    for name, text in (("arms", ARMS), ("touch", TOUCH)):
        Path(f"{name}.toml").write_text(text, encoding="utf-8")


HELD = "simulate arms.toml touch.toml"


def test_a_hand_against_a_wall_through_two_arms(run):
    out = run(f"{HELD} -o arms.nc --plot arms.png --sound leader.wav").out
    assert "stiffness felt at the leader" in out
    assert "a real wall, 500 N/m, 2 N·s/m" in out
    trace = load_trace("arms.nc")
    assert trace["hand_force"].values[1, -1] == pytest.approx(-1, rel=0.1)
    assert Path("arms.png").stat().st_size > 10_000
    trace.zwidth.sound("again.wav")
    assert Path("leader.wav").read_bytes() == Path("again.wav").read_bytes()


def test_json_has_both_arms_and_units(run):
    told = run(f"{HELD} --stiffness 20 --json").json
    assert told["format"] == "zwidth pair simulation 1"
    assert told["coupling"].startswith("K = 20 N/m")
    assert 10 < told["felt_stiffness_N_per_m"] < 25
    assert told["tracking_error_m"] > 0
    energy = told["energy"]
    lost = [energy[arm]["viscous_loss_J"] + energy[arm]["coulomb_loss_J"] for arm in ("leader", "follower")]
    kinetic = [energy[arm]["kinetic_energy_J"] for arm in ("leader", "follower")]
    put_in = energy["hand_work_J"]
    assert put_in == pytest.approx(energy["coupling_took_J"] + sum(lost) + sum(kinetic), rel=1e-9)


def test_a_follower_that_nobody_holds(run):
    assert "nobody" in run("simulate arms.toml --operator finger --duration 0.3").out


@pytest.mark.parametrize(
    ("line", "words"),
    [
        (f"{HELD} --damping 3", "which arm"),
        (f"{HELD} --follower-operator.stiffness '3 N'", "stiffness is in N/m"),
        (f"{HELD} --follower-operator walls", "there is no hand"),
        (f"{HELD} --law saturation", "virtual wall"),
        (f"{HELD} --lateness 1e-4", "regular clock"),
        (f"{HELD} --follower-operator.mass 3", "mass"),
        ("simulate arms.toml --operator finger --follower-operator wall --duration 1", "stiffness"),
        ("simulate arms.toml --operator finger", "duration"),
        (
            "simulate haptic-paddle --stiffness 300 --operator dowel --duration 1 --follower-operator finger",
            "no follower",
        ),
        ("compare arms.toml --plot a.png", "--plot"),
        ("compare arms.toml --fastest 3", "--fastest"),
        ("compare arms.toml --rate 3", "which arm"),
    ],
)
def test_what_cannot_be_used_is_said(refused, line, words):
    assert words in refused(line)


def test_ways_to_join_two_arms_are_compared(run):
    assert "position–force" in run("compare arms.toml --stiffness 40 -o schemes.json").out
    told = json.loads(Path("schemes.json").read_text(encoding="utf-8"))
    assert told["format"] == "zwidth pairs 1"
    assert list(told["schemes"]) == ["position–position", "position–force", "four channels"]
    for scores in told["schemes"].values():
        assert scores["felt_stiffness_N_per_m"] == pytest.approx(40, rel=0.1)


def test_the_motion_of_two_hands_is_no_witness_of_one(run, refused):
    """It is said what the file holds, and not that it holds nothing."""
    run("pair arms.toml --stiffness 5000 -o active.json", 1)
    message = refused("simulate arms.toml --operator witness --operator.file active.json")
    assert "active.json holds a motion of two hands, one on each arm" in message
