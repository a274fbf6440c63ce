"""The same verdict gives the same bytes: no date, no path, no random number, no settings of the person."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from collections.abc import Callable
from functools import partial
from pathlib import Path

import pytest

from zwidth.cli.main import main

DEVICE = """
[device]
damping = "0.15 N*s/m"
coulomb_friction = 0.12
resolution = "22.4 um"
rate = "1 kHz"
"""


def _written(folder: Path, report: Callable[[], object], name: str) -> bytes:
    (folder / "paddle.toml").write_text(DEVICE, encoding="utf-8")
    (folder / "matplotlibrc").write_text(f"lines.linewidth: {len(name)}\nfont.size: 14\n", encoding="utf-8")
    report()
    return (folder / f"{name}.html").read_bytes()


@pytest.fixture(scope="module")
def twice(tmp_path_factory: pytest.TempPathFactory) -> list[bytes]:
    """In two processes, folders, zones of time, under other names, and once by a whole path."""
    here, there = tmp_path_factory.mktemp("here"), tmp_path_factory.mktemp("there")
    words = ["report", str(there / "paddle.toml"), "--stiffness", "770", "-o", "another.html"]
    command = [sys.executable, "-c", f"from zwidth.cli.main import main\nmain({words})"]
    environment = {**os.environ, "PYTHONHASHSEED": "2", "TZ": "Asia/Tokyo"}
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(here)
        first = _written(here, lambda: main(["report", "paddle.toml", *words[2:5], "report.html"]), "report")
    run = partial(subprocess.run, command, cwd=there, env=environment, check=True, capture_output=True)
    return [first, _written(there, run, "another")]


def test_the_same_bytes_in_another_process_and_folder(twice: list[bytes]) -> None:
    first, again = twice
    assert len(first) > 10_000
    assert first == again


def test_no_path_and_no_date_is_in_it(twice: list[bytes]) -> None:
    page = twice[1].decode()
    shown = re.sub(r'"data:[^"]*"', "", page)
    assert "zwidth report paddle.toml --stiffness 770 -o report.html" in shown
    assert "paddle.toml, [device]" in shown
    assert "there" not in shown
    assert not re.search(r"\b20[2-9]\d-\d\d-\d\d\b", shown)
