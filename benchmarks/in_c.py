"""Functions in C for benchmarks: compiled when they are first asked for, as the step functions are."""

from __future__ import annotations

import ctypes
import subprocess
import tempfile
from functools import cache
from pathlib import Path

import numpy as np

from zwidth.native import build

REALS = np.ctypeslib.ndpointer(np.float64, flags="C")
WHOLES = np.ctypeslib.ndpointer(np.int64, flags="C")
REAL, WHOLE = ctypes.c_double, ctypes.c_int64


@cache
def library(source: Path) -> ctypes.CDLL:
    """What a file of C defines.

    Raises
    ------
    FileNotFoundError
        If there is no C compiler.
    """
    command = build.compiler()
    if command is None:
        raise FileNotFoundError("there is no C compiler")
    with tempfile.TemporaryDirectory() as folder:
        made = Path(folder) / "made.so"
        flags = [flag for flag in build.FLAGS if flag != "-fvisibility=hidden"]
        subprocess.run([*command, *flags, "-o", str(made), str(source), "-lm"], check=True)
        return ctypes.CDLL(str(made))
