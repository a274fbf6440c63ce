"""What the tests of firmware need of the machine: compilers, and where the files are that they compile.

A tool that is missing skips the test by its name; with ZWIDTH_EVERY_TARGET=1 in the environment it fails.
"""

from __future__ import annotations

import ctypes
import os
import shutil
import subprocess
from importlib.resources import files as resources
from pathlib import Path
from typing import NoReturn

import pytest

HERE = Path(__file__).parent
DATA, STUBS = HERE / "data", HERE / "stubs"

WARNINGS = ("-Wall", "-Wextra", "-Werror", "-Wno-unused-function")
"""Every one is an error; a law may have functions that a program does not call."""


def tool(name: str) -> str:
    """The path of a compiler or another program; without it the test is skipped."""
    found = shutil.which(name)
    return _missing(name) if found is None else found


def needed_header(name: str) -> None:
    """Without a header of a library, such as simavr/sim_avr.h, the test is skipped."""
    asked = [tool("cc"), "-E", "-include", name, "-x", "c", os.devnull]
    if subprocess.run(asked, capture_output=True, check=False).returncode != 0:
        _missing(name)


def _missing(name: str) -> NoReturn:
    reason = f"{name} is not on this machine"
    if os.environ.get("ZWIDTH_EVERY_TARGET") == "1":
        pytest.fail(f"{reason}, and every target is asked for")
    pytest.skip(reason)


def run(*command: str | Path, cwd: Path | None = None) -> str:
    done = subprocess.run(
        [str(word) for word in command], cwd=cwd, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, f"{command[0]} ended with {done.returncode}:\n{done.stdout}{done.stderr}"
    return done.stdout


def written(files: dict[str, str], folder: Path) -> Path:
    """The folder with these files, and the law of the tests."""
    folder.mkdir(parents=True, exist_ok=True)
    for name, text in files.items():
        (folder / name).write_text(text, encoding="utf-8")
    shutil.copy(DATA / "law.h", folder / "law.h")
    return folder


def mains() -> Path:
    return Path(str(resources("zwidth.machine.firmware") / "mains"))


def library(source: Path, folder: Path, *options: str) -> ctypes.CDLL:
    """A file of C with the law of the tests, compiled for this machine and loaded anew."""
    name = folder / f"{source.stem}-{len(list(folder.iterdir()))}.so"
    include = ("-I", DATA, "-I", mains() / "shared")
    run(tool("cc"), "-std=c99", *WARNINGS, "-O1", "-shared", "-fPIC", *options, *include, source, "-o", name)
    return ctypes.CDLL(str(name))
