"""The example for continuous integration: its commands as they are written, before a change and after."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
import yaml

EXAMPLE = Path(__file__).resolve().parents[2] / "examples" / "github-actions"


def the_step() -> dict[str, Any]:
    """The step that checks: its script, as the runner gives it to bash, and its environment."""
    (job,) = yaml.safe_load((EXAMPLE / "passivity.yml").read_text(encoding="utf-8"))["jobs"].values()
    (step,) = (step for step in job["steps"] if "zwidth check" in step.get("run", ""))
    return dict(step)


def run_in(folder: Path, **env: str) -> subprocess.CompletedProcess[str]:
    """`bash -e` in a checkout, with this zwidth and this python on the path."""
    tools = folder / "tools"
    tools.mkdir(exist_ok=True)
    for name, words in (("zwidth", "-m zwidth "), ("python", "")):
        tool = tools / name
        tool.write_text(f'#!/bin/sh\nexec "{sys.executable}" {words}"$@"\n', encoding="utf-8")
        tool.chmod(0o755)
    step, path = the_step(), f"{tools}{os.pathsep}{os.environ['PATH']}"
    given = {**os.environ, **step["env"], **env, "PATH": path}
    command = ["bash", "-e", "-c", step["run"]]
    return subprocess.run(command, cwd=folder, env=given, capture_output=True, text=True, check=False)


@pytest.mark.skipif(shutil.which("bash") is None, reason="the runner's shell is bash")
def test_a_gain_change_that_makes_a_wall_active_fails_the_build(tmp_path):
    """As it is the build goes on; with a stiffer bump stop and a wall that cannot be read it fails."""
    shutil.copy(EXAMPLE / "device.toml", tmp_path)
    shutil.copytree(EXAMPLE / "walls", tmp_path / "walls")
    good = run_in(tmp_path)
    assert good.returncode == 0, good.stdout + good.stderr
    assert good.stdout.count("VALID") == len(list((tmp_path / "walls").iterdir()))
    assert "::" not in good.stdout
    stop = tmp_path / "walls" / "bump-stop.toml"
    stop.write_text(stop.read_text(encoding="utf-8").replace("15 N*m/rad", "25 N*m/rad"), encoding="utf-8")
    (tmp_path / "walls" / "soft-lock.toml").write_text("[environment]\ntype = 3\n", encoding="utf-8")
    bad = run_in(tmp_path)
    assert bad.returncode == 1
    assert (
        "::error file=walls/bump-stop.toml::active. The hand can take any amount of energy out" in bad.stdout
    )
    assert "::error file=walls/soft-lock.toml::it cannot be used" in bad.stdout
    assert json.loads((tmp_path / "verdicts" / "bump-stop.json").read_text())["outcome"] == "active"


@pytest.mark.skipif(shutil.which("bash") is None, reason="the runner's shell is bash")
def test_what_is_not_proved_fails_the_build_too(tmp_path):
    """A delay within which some value is active is status 3; contact kept, 4, passes where it was chosen."""
    (tmp_path / "walls").mkdir()
    (tmp_path / "walls" / "wall.toml").write_text(
        '[environment]\ntype = "wall"\nstiffness = "250 N/m"\n', encoding="utf-8"
    )
    device = '[device]\ndamping = "0.15 N*s/m"\ncoulomb_friction = "0.1 N"\nrate = "1 kHz"\n'
    (tmp_path / "device.toml").write_text(f'{device}delay = "0 .. 0.25 ms"\n', encoding="utf-8")
    some = run_in(tmp_path)
    assert some.returncode == 1
    said = "::error file=walls/wall.toml::undecided. Active for some values of its intervals: at delay 250 µs"
    assert said in some.stdout
    saved = json.loads((tmp_path / "verdicts" / "wall.json").read_text())
    assert saved["active_at"] == {"delay_s": 0.00025}
    damped = '[environment]\ntype = "wall"\nstiffness = 100\ndamping = 0.03\n'
    (tmp_path / "walls" / "wall.toml").write_text(damped, encoding="utf-8")
    (tmp_path / "device.toml").write_text(
        '[device]\ndamping = 0.12\nrate = "1 kHz"\ndelay = "0.4 ms"\n', encoding="utf-8"
    )
    in_contact = run_in(tmp_path)
    assert (in_contact.returncode, "::passive in contact. " in in_contact.stdout) == (1, True)
    assert run_in(tmp_path, ACCEPTED="0 4").returncode == 0
