"""`zwidth serve` as it is typed."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from zwidth.cli.main import main

SLOW = ["--safety.longest-gap", "60 s", "--safety.host-timeout", "60 s"]
"""A machine that stands still for some seconds makes a loop miss samples, and does not end it."""

SOFT = ["serve", "haptic-paddle", "--stiffness", "50", "--duration", "0.3 s", *SLOW]


@pytest.mark.real_time
def test_serves_the_simulated_device(capsys: pytest.CaptureFixture[str]) -> None:
    """The report as JSON, what was measured before it on standard error."""
    assert main([*SOFT, "--json"]) == 0
    said = capsys.readouterr()
    report = json.loads(said.out)
    assert report["format"] == "zwidth served 1"
    assert report["outcome"] == "passive"
    assert report["ended"] == "ended, since the time was over"
    assert report["samples"] + report["missed_samples"] in (300, 301)
    assert "samples with force 0" in said.err
    assert "if nothing comes any more" in said.err


def test_what_is_active_is_not_served(capsys: pytest.CaptureFixture[str]) -> None:
    """The exit status is that of `zwidth check`; --anyway serves it."""
    hard = ["serve", "haptic-paddle", "--stiffness", "900", "--duration", "0.2 s", *SLOW]
    assert main(hard) == 1
    assert "not served" in capsys.readouterr().err
    assert main([*hard, "--anyway", "--safety.force", "1 N"]) == 0


def test_records(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Into a file that is not replaced unless it is said."""
    path = tmp_path / "touch.mcap"
    assert main([*SOFT, "-o", str(path)]) == 0
    assert path.stat().st_size > 1000
    assert f"{path}: " in capsys.readouterr().out
    assert main([*SOFT, "-o", str(path)]) == 2
    assert main([*SOFT, "-o", str(path), "--force"]) == 0


def test_sense_is_not_rounded(capsys: pytest.CaptureFixture[str]) -> None:
    """1.5 is neither of the two ways along the axis."""
    hapkit = ["--connection", "hapkit", "--connection.port", "x", "--connection.count", "1e-5"]
    assert main([*SOFT, *hapkit, "--connection.sense", "1.5"]) == 2
    assert "sense is 1 or -1" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("given", "said"),
    [
        (["--connection", "odrve"], 'did you mean "odrive"'),
        (["--connection", "odrive"], "needs port"),
        (["--connection", "odrive", "--connection.port", "x", "--connection.count", "1 mm"], "has no"),
        (["--connection", "odrive", "--connection.port", "x", "--connection.axis", "1.5"], "whole number"),
        (["--connection", "odrive", "--connection.port", "/dev/none"], "rotary"),
        (["--connection", "hapkit", "--connection.port", "x", "--connection.count", "1 s"], "count"),
        (["--connection.origin", "1 mm"], "leave out origin"),
        (["--safety.force", "-1 N"], "> 0"),
        (["--safety.bad-answers", "1.5"], "number of samples"),
        (["--watch", "wall"], "terminal, browser, foxglove"),
        (["--watch", "terminal", "--watch-port", "1"], "--watch-port goes with"),
        (["--watch", "browser", "--watch-origin", "https://app.example"], "goes with --watch foxglove"),
        (["--watch", "foxglove", "--watch-origin", "null"], "is no origin of pages"),
        (["--operator", "fingr"], "did you mean"),
        (["-o", "session.csv"], "ends in .mcap"),
        (["-o", "session.parquet"], "zwidth replay run.mcap -o run.nc"),
        (["--duration", "0 s"], "> 0"),
    ],
)
def test_bad_input_is_one_message(given: list[str], said: str, capsys: pytest.CaptureFixture[str]) -> None:
    """Status 2, and a line that says what is wrong."""
    assert main(["serve", "haptic-paddle", "--stiffness", "50", *given]) == 2
    message = capsys.readouterr().err
    assert said in message
    assert message.count("\n") == 1


def test_hand_is_of_the_simulated_device_alone(capsys: pytest.CaptureFixture[str]) -> None:
    """A person holds a real one."""
    hapkit = ["--connection", "hapkit", "--connection.port", "x", "--connection.count", "1 um"]
    assert main(["serve", "haptic-paddle", "--stiffness", "50", *hapkit, "--operator", "finger"]) == 2
    assert "held by a person" in capsys.readouterr().err


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no such signals")
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_ends_it_without_force(number: int, tmp_path: Path) -> None:
    """The report is printed, and says who ended it."""
    command = [sys.executable, "-m", "zwidth", "serve", "haptic-paddle", "--stiffness", "50"]
    path = tmp_path / "touch.mcap"
    with subprocess.Popen(
        [*command, "--duration", "600 s", "--json", "-o", str(path), *SLOW],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env=os.environ,
    ) as running:
        assert running.stderr is not None
        for line in running.stderr:
            if line.startswith("serving"):
                break
        while not path.exists() or path.stat().st_size < 20_000:  # it runs and is recorded
            assert running.poll() is None
            time.sleep(0.01)
        running.send_signal(number)
        out, _ = running.communicate()
    assert running.returncode == 0
    assert json.loads(out)["ended"] == "ended, since it was asked to end"


ARMS = """
[leader]
catalogue = "haptic-paddle"
[follower]
catalogue = "haptic-paddle"
[coupling]
stiffness = "4 N/m"
link_delay = "1 ms"
"""


@pytest.mark.real_time
def test_two_arms_of_a_file_are_served(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """As a wall is; an active pair is refused, and so is what a pair does not have."""
    path = tmp_path / "arms.toml"
    path.write_text(ARMS, encoding="utf-8")
    serve = ["serve", str(path), "--duration", "0.2 s"]
    assert main([*serve, "--json"]) == 0
    report = json.loads(capsys.readouterr().out)
    assert report["format"] == "zwidth served pair 1"
    assert report["samples"] + report["missed_samples"] in (200, 201)
    assert main([*serve, "--stiffness", "4000"]) == 1
    assert "not served" in capsys.readouterr().err
    assert main([*serve, "-o", str(tmp_path / "a.mcap")]) == 2
    path.write_text(ARMS + '[follower_connection]\ntype = "hapkit"\n', encoding="utf-8")
    assert main(serve) == 2
    assert "needs port" in capsys.readouterr().err


def test_lines_on_standard_input_change_the_law_and_end_it() -> None:
    """What is not proved passive is refused, what is no command has its message, stop stops."""
    command = [sys.executable, "-m", "zwidth", "serve", "haptic-paddle", "--stiffness", "50"]
    with subprocess.Popen(
        [*command, "--duration", "600 s", "--json", "--commands", *SLOW],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env=os.environ,
    ) as running:
        assert running.stdin is not None
        assert running.stderr is not None
        for line in running.stderr:
            if line.startswith("serving"):
                break

        def said(line: str) -> str:
            print(line, file=running.stdin, flush=True)
            return running.stderr.readline()  # type: ignore[union-attr]

        while "does not run" in (answer := said("stiffness = 4000")) or "another law" in answer:
            pass  # it has not begun yet
        assert "not served, it is active" in answer
        assert 'did you mean "stiffness"' in said("stifness = 40")
        assert "passive: " in said("stiffness = 40 N/m")
        print("stop", file=running.stdin, flush=True)
        out, _ = running.communicate()
    assert running.returncode == 0
    assert json.loads(out)["ended"] == "ended, since it was asked to end"
