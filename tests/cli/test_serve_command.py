"""`zwidth serve` as it is typed."""

import json
import os
import shlex
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

SLOW = "--safety.longest-gap '60 s' --safety.host-timeout '60 s'"
"""A machine that stands still for some seconds makes a loop miss samples, and does not end it."""

SOFT = f"serve haptic-paddle --stiffness 50 --duration '0.3 s' {SLOW}"


HAPKIT = "--connection hapkit --connection.port x --connection.count"


@pytest.mark.real_time
def test_serves_the_simulated_device(run):
    """The report as JSON, what was measured before it on standard error."""
    said = run(f"{SOFT} --json")
    report = said.json
    assert report["format"] == "zwidth served 1"
    assert report["outcome"] == "passive"
    assert report["ended"] == "ended, since the time was over"
    assert report["samples"] + report["missed_samples"] in (300, 301)
    assert "samples with force 0" in said.err
    assert "if nothing comes any more" in said.err


def test_what_is_active_is_not_served(run):
    """The exit status is that of `zwidth check`; --anyway serves it."""
    hard = f"serve haptic-paddle --stiffness 900 --duration '0.2 s' {SLOW}"
    assert "not served" in run(hard, 1).err
    run(f"{hard} --anyway --safety.force '1 N'")


def test_records(run):
    assert "touch.mcap: " in run(f"{SOFT} -o touch.mcap").out
    assert Path("touch.mcap").stat().st_size > 1000
    run(f"{SOFT} -o touch.mcap", 2)
    run(f"{SOFT} -o touch.mcap --force")


def served(*more, **pipes):
    """The command in a process of its own, once it says that it serves."""
    command = [sys.executable, "-m", "zwidth", "serve", "haptic-paddle", "--stiffness", "50"]
    command += ["--duration", "600 s", "--json", *shlex.split(SLOW), *more]
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, **pipes}
    running = subprocess.Popen(command, text=True, env=os.environ, **pipes)
    for line in running.stderr:
        if line.startswith("serving"):
            break
    return running


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no such signals")
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_ends_it_without_force(number, tmp_path):
    path = tmp_path / "touch.mcap"
    with served("-o", str(path)) as running:
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
def test_two_arms_of_a_file_are_served(run, refused):
    """As a wall is; an active pair is refused, and so is what a pair does not have."""
    Path("arms.toml").write_text(ARMS, encoding="utf-8")
    serve = "serve arms.toml --duration '0.2 s'"
    report = run(f"{serve} --json").json
    assert report["format"] == "zwidth served pair 1"
    assert report["samples"] + report["missed_samples"] in (200, 201)
    assert "not served" in run(f"{serve} --stiffness 4000", 1).err
    run(f"{serve} -o a.mcap", 2)
    Path("arms.toml").write_text(ARMS + '[follower_connection]\ntype = "hapkit"\n', encoding="utf-8")
    assert "needs port" in refused(serve)


def test_lines_on_standard_input_change_the_law_and_end_it():
    """What is not proved passive is refused, what is no command has its message, stop stops."""
    with served("--commands", stdin=subprocess.PIPE) as running:

        def said(line):
            print(line, file=running.stdin, flush=True)
            return running.stderr.readline()

        while "does not run" in (answer := said("stiffness = 4000")) or "another law" in answer:
            pass  # it has not begun yet
        assert "not served, it is active" in answer
        assert 'did you mean "stiffness"' in said("stifness = 40")
        assert "passive: " in said("stiffness = 40 N/m")
        print("stop", file=running.stdin, flush=True)
        out, _ = running.communicate()
    assert running.returncode == 0
    assert json.loads(out)["ended"] == "ended, since it was asked to end"
