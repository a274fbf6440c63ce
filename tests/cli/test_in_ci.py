"""The example for continuous integration: its commands as they are written, before a change and after."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path
from typing import Any
from zipfile import ZipFile

import pytest
import yaml

import zwidth
from zwidth.cli.main import main

EXAMPLE = zwidth.samples.path("firmware/device.toml").parent
WORKFLOW = yaml.safe_load((EXAMPLE / ".github/workflows/passivity.yml").read_text(encoding="utf-8"))


def the_step(holds: str) -> dict[str, Any]:
    """The step that has these words: its script, as the runner gives it to bash, and its environment."""
    (job,) = WORKFLOW["jobs"].values()
    (step,) = (step for step in job["steps"] if holds in step.get("run", ""))
    return dict(step)


def run_in(folder: Path, holds: str = "zwidth check", **env: str) -> subprocess.CompletedProcess[str]:
    """`bash -e` in a checkout, with this zwidth and this python on the path."""
    tools = folder / "tools"
    tools.mkdir(exist_ok=True)
    for name, words in (("zwidth", "-m zwidth "), ("python", "")):
        tool = tools / name
        tool.write_text(f'#!/bin/sh\nexec "{sys.executable}" {words}"$@"\n', encoding="utf-8")
        tool.chmod(0o755)
    step, path = the_step(holds), f"{tools}{os.pathsep}{os.environ['PATH']}"
    given = {**os.environ, **WORKFLOW["env"], **step.get("env", {}), **env, "PATH": path}
    given |= {"PIP_TARGET": str(folder / "installed"), "PIP_NO_INDEX": "1", "PIP_NO_DEPS": "1"}
    command = ["bash", "-e", "-c", step["run"]]
    return subprocess.run(command, cwd=folder, env=given, capture_output=True, text=True, check=False)


@pytest.mark.skipif(shutil.which("bash") is None, reason="the runner's shell is bash")
@pytest.mark.skipif(
    sys.platform != "linux" or find_spec("pip") is None, reason="its runner is Linux and has pip"
)
def test_zwidth_is_installed_from_what_the_one_line_names(tmp_path):
    """The wheel beside the firmware, of this version; without it the build ends there."""
    wheel = tmp_path / WORKFLOW["env"]["ZWIDTH"]
    assert wheel.name.startswith(f"zwidth-{zwidth.__version__}-py3-none-")
    assert run_in(tmp_path, "pip install").returncode != 0
    wheel.parent.mkdir(exist_ok=True)
    version = zwidth.__version__
    about = f"zwidth-{version}.dist-info"
    with ZipFile(wheel, "w") as file:
        file.writestr("zwidth/__init__.py", "")
        file.writestr(f"{about}/METADATA", f"Metadata-Version: 2.1\nName: zwidth\nVersion: {version}\n")
        file.writestr(f"{about}/WHEEL", "Wheel-Version: 1.0\nRoot-Is-Purelib: true\nTag: py3-none-any\n")
        file.writestr(f"{about}/RECORD", "")
    done = run_in(tmp_path, "pip install")
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "installed" / "zwidth" / "__init__.py").is_file()


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
    bad = run_in(tmp_path, GITHUB_STEP_SUMMARY=str(tmp_path / "summary.md"))
    assert bad.returncode == 1
    summary = (tmp_path / "summary.md").read_text(encoding="utf-8").splitlines()
    assert summary[:2] == ["| wall | verdict |", "|---|---|"]
    assert summary[2].startswith("| walls/bump-stop.toml | active. A motion of the hand takes ")
    assert summary[3] == "| walls/soft-lock.toml | it cannot be used, see the log |"
    said = next(line for line in bad.stdout.splitlines() if "bump-stop.toml" in line)
    assert said.startswith("::error file=walls/bump-stop.toml::active. A motion of the hand takes ")
    assert " out of this loop in " in said
    assert ": lower the stiffness from " in said
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


@pytest.mark.skipif(shutil.which("git") is None, reason="the line of the docs asks git")
def test_emitted_files_in_a_repository_are_compared_with_their_law(tmp_path, monkeypatch):
    """The line of docs/firmware.md: nothing differs until the gain does."""
    shutil.copy(EXAMPLE / "device.toml", tmp_path)
    shutil.copytree(EXAMPLE / "walls", tmp_path / "walls")
    monkeypatch.chdir(tmp_path)

    def differs() -> int:
        assert main(["emit", "device.toml", "walls/bump-stop.toml", "-o", "bump-stop", "--force"]) == 0
        return subprocess.run(["git", "diff", "--exit-code", "--", "bump-stop"], check=False).returncode

    stop = tmp_path / "walls" / "bump-stop.toml"
    main(["emit", "device.toml", "walls/bump-stop.toml", "-o", "bump-stop"])
    subprocess.run(["git", "init", "-q"], check=True)
    subprocess.run(["git", "add", "bump-stop"], check=True)
    assert differs() == 0
    stop.write_text(stop.read_text(encoding="utf-8").replace("15 N*m/rad", "14 N*m/rad"), encoding="utf-8")
    assert differs() == 1
