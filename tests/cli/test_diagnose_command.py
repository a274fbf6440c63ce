"""`zwidth diagnose`: a short report that ends in a line to type, and one clear message on bad input."""

from __future__ import annotations

import json
import shlex
from pathlib import Path

import numpy as np
import pytest

import zwidth as zw
from zwidth.cli.main import main


@pytest.fixture
def there(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with the sample log and its device, in a terminal of 80 columns."""
    for name in ("shaking.csv", "wheel.toml"):
        (tmp_path / name).write_text(zw.samples.path(name).read_text(encoding="utf-8"), encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "80")
    return tmp_path


def test_the_report_is_short_and_its_last_command_is_passive(there: Path, capsys) -> None:
    """Twelve lines of text at 80 columns; the line with $ can be typed as it is, and check agrees."""
    assert main(["diagnose", "shaking.csv", "wheel.toml"]) == 0
    said = capsys.readouterr().out
    lines = [line for line in said.splitlines() if line.strip()]
    assert "DELAY" in lines[0]
    assert len(lines) <= 12
    assert max(map(len, lines)) <= 80
    (typed,) = (line.strip().removeprefix("$ ") for line in lines if line.strip().startswith("$ "))
    program, *argv = shlex.split(typed)
    assert program == "zwidth"
    assert main(argv) == 0
    assert "PASSIVE" in said


def test_without_a_device_it_asks_for_one(there: Path, capsys) -> None:
    """The cause is named, and no number."""
    assert main(["diagnose", "shaking.csv"]) == 0
    said = capsys.readouterr().out
    assert "the device's numbers" in said
    assert "$ zwidth check" not in said


def test_the_law_as_it_was_programmed(there: Path, capsys) -> None:
    """It is held beside the file, and the line to type has its numbers."""
    assert main(["diagnose", "shaking.csv", "wheel.toml", "--stiffness", "20 N*m/rad"]) == 0
    said = capsys.readouterr().out
    assert "the command is that of the law as stated" in said
    assert "$ zwidth check wheel.toml --stiffness '20 N*m/rad'" in said
    assert main(["diagnose", "shaking.csv", "wheel.toml", "--stiffness", "40 N*m/rad"]) == 0
    assert "0.5 times that of the law" in " ".join(capsys.readouterr().out.split())


def test_json_says_the_same(there: Path, capsys) -> None:
    """The cause, the change and the command, in the angle of the log."""
    assert main(["diagnose", "shaking.csv", "wheel.toml", "--json"]) == 0
    document = json.loads(capsys.readouterr().out)
    assert document["cause"] == "delay"
    assert document["command"].startswith("zwidth check wheel.toml --stiffness '0.349066 N*m/deg'")
    assert document["change"]["parameter"] == "delay"


def test_the_loop_and_the_picture_are_written(there: Path, capsys) -> None:
    """The line to type is then about the file."""
    assert main(["diagnose", "shaking.csv", "wheel.toml", "-o", "mended.toml", "--plot", "why.png"]) == 0
    assert "$ zwidth check mended.toml" in capsys.readouterr().out
    assert (there / "why.png").exists()
    assert main(["check", "mended.toml"]) == 0


def test_columns_are_named_as_typed(there: Path, capsys) -> None:
    """A log with names of its own, its force counted the other way."""
    text = (there / "shaking.csv").read_text(encoding="utf-8").replace("commanded_torque_N_m", "u")
    (there / "mine.csv").write_text(text, encoding="utf-8")
    options = [
        "--column",
        "commanded_force=u",
        "--unit",
        "commanded_force=N*m",
        "--scale",
        "actuator_force=-1",
    ]
    assert main(["diagnose", "mine.csv", "wheel.toml", *options[:4]]) == 0
    assert "DELAY" in capsys.readouterr().out
    assert main(["diagnose", "mine.csv", "wheel.toml", "--column", "torque=u"]) == 2
    assert "there is no quantity" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("argv", "message"),
    [
        (["nowhere.csv"], "no such file"),
        (["wheel.toml"], "wheel.toml"),
        (["shaking.csv", "wheel.toml", "-o", "mended.txt"], "TOML"),
        (["shaking.csv", "haptic-paddle"], "linear"),
        (["shaking.csv", "--column", "commanded_force=nothing"], "nothing"),
        (["shaking.csv", "--unit", "commanded_force"], "is written"),
        (["shaking.csv", "-o", "mended.toml"], "no number to change"),
    ],
)
def test_bad_input_ends_in_one_message(argv: list[str], message: str, there: Path, capsys) -> None:
    """Status 2, and what to do; no traceback."""
    assert main(["diagnose", *argv]) == 2
    said = capsys.readouterr().err
    assert message in said
    assert said.startswith("zwidth: ")


def test_two_arms_in_one_file(there: Path, capsys) -> None:
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
    assert main(["diagnose", "arms.csv", "joint.toml", "-o", "mended.toml"]) == 0
    said = capsys.readouterr().out
    assert "LINK DELAY" in said
    assert "$ zwidth pair mended.toml" in said
    assert max(map(len, said.splitlines())) <= 80
    assert main(["pair", "mended.toml"]) == 0
    assert main(["diagnose", "arms.csv", "--mass", "1"]) == 2
    assert "two arms" in capsys.readouterr().err
