"""A law compiled for this machine, by its C compiler: called here, or watched for undefined behaviour."""

from __future__ import annotations

import ctypes
from pathlib import Path
from typing import Any

import numpy as np
from firmware.emulated.answers import as_counts, force_type
from firmware.emulated.built import STRICT, called, defined
from numpy.typing import NDArray

HERE = Path(__file__).parent


class HostLaw:
    def __init__(self, header: str, folder: Path, optimized: str = "-O2") -> None:
        (folder / "law.h").write_text(header, encoding="utf-8")
        library = folder / "law.so"
        source = str(HERE / "host_main.c")
        called(
            ["gcc", *STRICT, optimized, "-shared", "-fPIC", f"-I{folder}", source, "-o", str(library), "-lm"]
        )
        self._library = ctypes.CDLL(str(library))
        self._library.init.argtypes = [ctypes.c_int32]
        self._library.run.argtypes = [ctypes.c_void_p, ctypes.c_void_p, ctypes.c_long]
        self.dtype = force_type(self._library.whole(), self._library.size())
        self.force_per_unit = defined(header, "FORCE_PER_UNIT")

    def init(self, counts: int) -> None:
        self._library.init(counts)

    def reset(self) -> None:
        self._library.reset()

    def run(self, counts: object) -> NDArray[Any]:
        given = as_counts(counts)
        forces = np.empty(given.size, self.dtype)
        self._library.run(given.ctypes.data, forces.ctypes.data, given.size)
        return forces

    def force(self, counts: int) -> float:
        """One step: the force [N, N*m]."""
        return float(self.run([counts])[0]) * self.force_per_unit


def watched(header: str, counts: object, folder: Path, start: int = 0) -> None:
    """Run a law on these counts from rest at `start`, in a process that ends at undefined behaviour.

    AssertionError if a whole number overflows, a shift is too far, or a float does not fit into a whole
    number.
    """
    (folder / "law.h").write_text(header, encoding="utf-8")
    program = folder / "law"
    watching = ("-O1", "-fsanitize=undefined,float-cast-overflow", "-fno-sanitize-recover=all", "-DSEPARATE")
    called(["gcc", *STRICT, *watching, f"-I{folder}", str(HERE / "host_main.c"), "-o", str(program), "-lm"])
    given = np.append(np.int32(start), as_counts(counts))
    called([str(program)], sent=given.astype(np.int32).tobytes())
