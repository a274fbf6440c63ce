"""The example for continuous integration: its commands as they are written, before a change and after."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path
from zipfile import ZipFile

import pytest
import yaml

import zwidth

EXAMPLE = Path(__file__).resolve().parents[2] / "examples" / "github-actions"


WORKFLOW = yaml.safe_load((EXAMPLE / "passivity.yml").read_text(encoding="utf-8"))


def the_step(holds: str) -> str:
    """The script of the step that has these words, as the runner gives it to bash."""
    (job,) = WORKFLOW["jobs"].values()
    (script,) = (step["run"] for step in job["steps"] if holds in step.get("run", ""))
    return str(script)


def run_in(folder: Path, step: str = "zwidth check") -> subprocess.CompletedProcess[str]:
    """`bash -e` in a checkout, with this zwidth and this python on the path."""
    tools = folder / "tools"
    tools.mkdir(exist_ok=True)
    for name, words in (("zwidth", "-m zwidth "), ("python", "")):
        tool = tools / name
        tool.write_text(f'#!/bin/sh\nexec "{sys.executable}" {words}"$@"\n', encoding="utf-8")
        tool.chmod(0o755)
    path = {**os.environ, **WORKFLOW["env"], "PATH": f"{tools}{os.pathsep}{os.environ['PATH']}"}
    path |= {"PIP_TARGET": str(folder / "installed"), "PIP_NO_INDEX": "1", "PIP_NO_DEPS": "1"}
    command = ["bash", "-e", "-c", the_step(step)]
    return subprocess.run(command, cwd=folder, env=path, capture_output=True, text=True, check=False)


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
    bad = run_in(tmp_path)
    assert bad.returncode == 1
    said = next(line for line in bad.stdout.splitlines() if "bump-stop.toml" in line)
    assert said.startswith("::error file=walls/bump-stop.toml::active. A motion of the hand takes ")
    assert " out of this loop in " in said
    assert ": lower the stiffness from " in said
    assert "::error file=walls/soft-lock.toml::it cannot be used" in bad.stdout
    assert json.loads((tmp_path / "verdicts" / "bump-stop.json").read_text())["outcome"] == "active"
