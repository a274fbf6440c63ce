"""The same verdict gives the same bytes: no date, no path, no random number, no settings of the person."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

DEVICE = """
[device]
damping = "0.15 N*s/m"
coulomb_friction = 0.12
resolution = "22.4 um"
rate = "1 kHz"
"""

WRITE = """
from zwidth.cli.main import main
import sys
main(["report", sys.argv[1], "--stiffness", "770", "-o", f"{sys.argv[2]}.html"])
"""


def _written(folder: Path, source: str, name: str, **environment: str) -> bytes:
    folder.mkdir()
    (folder / "paddle.toml").write_text(DEVICE, encoding="utf-8")
    (folder / "matplotlibrc").write_text(f"lines.linewidth: {len(name)}\nfont.size: 14\n", encoding="utf-8")
    subprocess.run(
        [sys.executable, "-c", WRITE, source, name],
        cwd=folder,
        env={**os.environ, **environment},
        check=True,
        capture_output=True,
    )
    return (folder / f"{name}.html").read_bytes()


@pytest.fixture(scope="module")
def twice(tmp_path_factory: pytest.TempPathFactory) -> list[bytes]:
    """In two processes, folders, zones of time, under other names, and once by a whole path."""
    top = tmp_path_factory.mktemp("reports")
    first = _written(top / "here", "paddle.toml", "report", PYTHONHASHSEED="1", TZ="UTC")
    whole = str(top / "there" / "paddle.toml")
    return [first, _written(top / "there", whole, "another", PYTHONHASHSEED="2", TZ="Asia/Tokyo")]


def test_the_same_bytes_in_another_process_and_folder(twice: list[bytes]) -> None:
    first, again = twice
    assert len(first) > 10_000
    assert first == again


def test_no_path_and_no_date_is_in_it(twice: list[bytes]) -> None:
    """A file is called by its name; the command is the one that makes the report again."""
    page = twice[1].decode()
    shown = re.sub(r'"data:[^"]*"', "", page)
    assert "zwidth report paddle.toml --stiffness 770 -o report.html" in shown
    assert "paddle.toml, [device]" in shown
    assert "reports" not in shown
    assert not re.search(r"\b20[2-9]\d-\d\d-\d\d\b", shown)
