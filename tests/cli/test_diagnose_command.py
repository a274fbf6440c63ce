"""`zwidth diagnose`: a short report that ends in a line to type, and one clear message on bad input."""

import shutil
from pathlib import Path

import numpy as np
import pytest

import zwidth as zw


@pytest.fixture(autouse=True)
def _files(run):
    """The sample log and its device."""
    for name in ("shaking.csv", "wheel.toml"):
        shutil.copy(zw.samples.path(name), name)


def test_the_report_is_short_and_its_last_command_is_passive(run):
    """Twelve lines of text at 80 columns; the line with $ can be typed as it is, and check agrees."""
    said = run("diagnose shaking.csv wheel.toml").out
    lines = [line for line in said.splitlines() if line.strip()]
    assert "DELAY" in lines[0]
    assert len(lines) <= 12
    assert max(map(len, lines)) <= 80
    (typed,) = (line.strip().removeprefix("$ ") for line in lines if line.strip().startswith("$ "))
    assert typed.startswith("zwidth ")
    run(typed.removeprefix("zwidth "))
    assert "PASSIVE" in said


def test_without_a_device_it_asks_for_one(run):
    said = run("diagnose shaking.csv").out
    assert "the device's numbers" in said
    assert "$ zwidth check" not in said


def test_the_law_as_it_was_programmed(run):
    said = run("diagnose shaking.csv wheel.toml --stiffness '20 N*m/rad'").out
    assert "the command is that of the law as stated" in said
    assert '$ zwidth check wheel.toml --stiffness "20 N*m/rad"' in said
    run("diagnose shaking.csv wheel.toml --stiffness '40 N*m/rad'").says("0.5 times that of the law")


def test_json_says_the_same(run):
    document = run("diagnose shaking.csv wheel.toml --json").json
    assert document["cause"] == "delay"
    assert document["command"].startswith('zwidth check wheel.toml --stiffness "0.349066 N*m/deg"')
    assert document["change"]["parameter"] == "delay"


def test_the_loop_and_the_picture_are_written(run):
    run("diagnose shaking.csv wheel.toml -o mended.toml --plot why.png").says("$ zwidth check mended.toml")
    assert Path("why.png").exists()
    run("check mended.toml")


def test_columns_are_named_as_typed(run, refused):
    text = Path("shaking.csv").read_text(encoding="utf-8").replace("commanded_torque_N_m", "u")
    Path("mine.csv").write_text(text, encoding="utf-8")
    named = "--column commanded_force=u --unit 'commanded_force=N*m'"
    assert "DELAY" in run(f"diagnose mine.csv wheel.toml {named}").out
    assert "there is no quantity" in refused("diagnose mine.csv wheel.toml --column torque=u")


@pytest.mark.parametrize(
    ("argv", "message"),
    [
        ("nowhere.csv", "there is no file"),
        ("wheel.toml", "wheel.toml"),
        ("shaking.csv wheel.toml -o mended.txt", "TOML"),
        ("shaking.csv haptic-paddle", "linear"),
        ("shaking.csv --column commanded_force=nothing", "nothing"),
        ("shaking.csv --unit commanded_force", "is written"),
        ("shaking.csv -o mended.toml", "no number to change"),
    ],
)
def test_bad_input_ends_in_one_message(refused, argv, message):
    assert message in refused(f"diagnose {argv}")


def test_two_arms_in_one_file(run, refused):
    """Two joints that follow each other over a link of 6 ms: the cause, and a pair to check as typed."""
    t = np.arange(1200) * 0.001
    own, other = 0.05 * np.sin(60 * t), -0.04 * np.sin(60 * t + 0.1)
    lines = ["time_s,leader_angle_rad,follower_angle_rad,leader_torque_cmd_N_m,follower_torque_cmd_N_m"]
    late = [np.interp(t - 0.006, t, x) for x in (own, other)]
    torques = 20 * (own - late[1]), 20 * (other - late[0])
    lines += [",".join(f"{x:.9f}" for x in row) for row in zip(t, own, other, *torques, strict=True)]
    Path("arms.csv").write_text("\n".join(lines) + "\n", encoding="utf-8")
    Path("joint.toml").write_text(
        "[device]\nmotion = 'rotary'\ninertia = '0.01 kg*m^2'\ndamping = '0.04 N*m*s/rad'\n"
        "coulomb_friction = '0.001 N*m'\nrate = '1 kHz'\n",
        encoding="utf-8",
    )
    said = run("diagnose arms.csv joint.toml -o mended.toml").out
    assert "LINK DELAY" in said
    assert "$ zwidth pair mended.toml" in said
    assert max(map(len, said.splitlines())) <= 80
    run("pair mended.toml")
    assert "two arms" in refused("diagnose arms.csv --mass 1")
