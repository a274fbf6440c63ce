"""The exact step in C, compiled here and now: `exact_c.py simulate` or `exact_c.py chain`.

`simulate` keeps positions and four energies; `chain` is only what each sample must wait for,
so that its positions are those of another loop.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
from ctypes import CDLL, Structure, byref, c_double, c_long
from pathlib import Path

from task import COULOMB, DAMPING, MASS, PERIOD, RESOLUTION, START, STIFFNESS, hand_forces, report

FLAGS = ("-O3", "-march=native", "-ffp-contract=off", "-shared", "-fPIC")
SAMPLES = 100_000
ENERGIES = 4


class Loop(Structure):
    """The parameters, as the C source has them."""

    _fields_ = tuple(
        (name, c_double) for name in ("mass", "damping", "coulomb", "stiffness", "resolution", "period")
    )


def compiled(folder: str) -> CDLL:
    """The library."""
    compiler = os.environ.get("CC") or shutil.which("gcc") or shutil.which("cc")
    if compiler is None:
        sys.exit("no C compiler: neither gcc nor cc is there, and CC is not set")
    library = Path(folder) / "exact.so"
    source = Path(__file__).with_name("exact.c")
    if subprocess.run([compiler, *FLAGS, str(source), "-o", str(library), "-lm"], check=False).returncode:
        sys.exit(f"{compiler} does not compile {source.name}")
    return CDLL(str(library))


def main(name: str) -> None:
    """Compile, run, print."""
    with tempfile.TemporaryDirectory() as folder:
        function = getattr(compiled(folder), name)
    loop = Loop(MASS, DAMPING, COULOMB, STIFFNESS, RESOLUTION, PERIOD)
    hand = (c_double * SAMPLES)(*hand_forces(SAMPLES))
    positions = (c_double * (SAMPLES + 1))(START)
    energies = (c_double * (ENERGIES * (SAMPLES + 1)))()
    arguments = (positions, energies) if name == "simulate" else (positions,)

    def simulate(samples: int) -> list[float]:
        function(byref(loop), hand, c_long(samples), *arguments)
        return positions

    report(simulate, SAMPLES)


if __name__ == "__main__":
    main(sys.argv[1])
