"""What the tests of firmware compile, how it is run, and the law of the tests, data/law.h, by hand."""

from __future__ import annotations

import ctypes
import shutil
from functools import cache
from importlib.resources import files as resources
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from firmware.emulated.built import called
from firmware.emulated.required import require, tool
from numpy.typing import NDArray

HERE = Path(__file__).parent
DATA, STUBS = HERE / "data", HERE / "stubs"
MAINS = Path(str(resources("zwidth.machine.firmware") / "mains"))

WARNINGS = ("-Wall", "-Wextra", "-Werror", "-Wno-unused-function")
"""Every one is an error; a law may have functions that a program does not call."""

KINDS = [1, 2, 3, 4]
"""Of the laws of data/law.h: in double, float, fine and coarse whole numbers."""

UNIT = {1: 1.0, 2: 1.0, 3: 2**-12, 4: 0.01}
"""Of their forces [N]."""

NEWTONS = {1: 0.00672, 2: 0.00672, 3: 28 / 4096, 4: 0.01}
DAMPED = {1: 0.0448, 2: 0.0448, 3: 184 / 4096, 4: 0.04}
"""[N] in a count, and in a count of change from one sample to the next."""


def law_forces(counts: NDArray[np.floating], kind: int) -> NDArray[np.floating]:
    """[N], of the law of data/law.h that begins at rest at the first of the counts."""
    moved = np.diff(counts, prepend=counts[0])
    return np.where(counts > 0, np.maximum(NEWTONS[kind] * counts + DAMPED[kind] * moved, 0.0), 0.0)


def run(*command: str | Path, cwd: Path | None = None) -> str:
    return called([str(word) for word in command], cwd)


def written(files: dict[str, str], folder: Path) -> Path:
    folder.mkdir(parents=True, exist_ok=True)
    for name, text in files.items():
        (folder / name).write_text(text, encoding="utf-8")
    shutil.copy(DATA / "law.h", folder / "law.h")
    return folder


def sketch(folder: Path, *options: str) -> Path:
    require("avr")
    chip = ["-mmcu=atmega328p", "-DF_CPU=16000000UL", "-Os", "-fno-exceptions", "-ffp-contract=off"]
    given = ["-std=gnu++11", *WARNINGS, *options, "-I", STUBS / "arduino", "-I", folder]
    source = ["-x", "c++", "-include", "Arduino.h", folder / f"{folder.name}.ino"]
    core = STUBS / "arduino" / "main.cpp"
    run(tool("avr-g++"), *chip, *given, *source, core, "-o", folder / "sketch.elf")
    return folder / "sketch.elf"


@cache
def _compiled(source: Path, options: tuple[str, ...]) -> bytes:
    with TemporaryDirectory() as folder:
        given = ("-std=c99", *WARNINGS, *options, "-I", DATA, "-I", MAINS / "shared", source)
        run(tool("cc"), "-O1", "-shared", "-fPIC", *given, "-o", Path(folder) / "made.so")
        return (Path(folder) / "made.so").read_bytes()


def library(source: Path, folder: Path, *options: str) -> ctypes.CDLL:
    """A file of C with the law of the tests, loaded anew: its variables are as at the start."""
    name = folder / f"{source.stem}-{len(list(folder.iterdir()))}.so"
    name.write_bytes(_compiled(source, options))
    return ctypes.CDLL(str(name))
