"""A law on an emulated ATmega328P at 16 MHz: its forces, the cycles of each step, flash and RAM.

avr-gcc compiles it, libsimavr runs it.  The cycles are those from the call of a step to its return, less
those of an empty function that is called in the same way: what arguments and call cost is not the law's.
"""

from __future__ import annotations

import ctypes
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from firmware.emulated.answers import IDLE, Answers, as_counts, force_type
from firmware.emulated.built import STRICT, WARNED, called, defined, sizes
from numpy.typing import NDArray

HERE = Path(__file__).parent
CHIP, FREQUENCY = "atmega328p", 16_000_000
FLASH, RAM = 32 * 1024, 2 * 1024
_STEP, _INIT, _RESET, _EMPTY = range(4)
_FAILURES = {-1: "the program ended", -2: "a step took more than 4 000 000 cycles"}


class AvrLaw:
    """A header on the chip, which is switched on; a `sketch` of the Arduino is compiled as C++.

    AssertionError if it does not compile, or the program ends or runs for ever.
    """

    def __init__(self, header: str, optimized: str = "-Os", *, sketch: bool = False) -> None:
        self._folder = TemporaryDirectory(prefix="zwidth-avr-")
        program = _program(header, Path(self._folder.name), optimized, sketch)
        self.flash, self.ram = (
            a - b for a, b in zip(sizes("avr-size", program), _idle_sizes(optimized), strict=True)
        )
        self._library = _machine_library()
        self._machine = self._library.machine_open(str(program).encode(), CHIP.encode(), FREQUENCY)
        assert self._machine, "the program does not come to its loop"
        size = self._library.machine_bytes(self._machine)
        self.dtype = force_type(self._library.machine_whole(self._machine), size)
        self.force_per_unit = defined(header, "FORCE_PER_UNIT")
        self._empty = int(self._run(_EMPTY, [0])[1][0])

    def __enter__(self) -> AvrLaw:
        return self

    def __exit__(self, *_: object) -> None:
        self._library.machine_close(self._machine)
        self._folder.cleanup()

    def init(self, counts: int) -> None:
        self._run(_INIT, [counts])

    def reset(self) -> None:
        self._run(_RESET, [0])

    def run(self, counts: object) -> Answers:
        forces, cycles = self._run(_STEP, counts)
        return Answers(forces, cycles - self._empty, self.flash, self.ram)

    def force(self, counts: int) -> float:
        """One step: the force [N, N*m]."""
        return float(self._run(_STEP, [counts])[0][0]) * self.force_per_unit

    def _run(self, wanted: int, counts: object) -> tuple[NDArray[Any], NDArray[np.int64]]:
        given = as_counts(counts)
        forces, cycles = np.zeros(given.size, self.dtype), np.zeros(given.size, np.uint32)
        arrays = (given.ctypes.data, forces.ctypes.data, cycles.ctypes.data)
        failed = self._library.machine_run(self._machine, wanted, *arrays, given.size)
        assert failed == 0, _FAILURES[failed]
        return forces, cycles.astype(np.int64)


def _program(header: str, folder: Path, optimized: str, sketch: bool = False) -> Path:
    (folder / "law.h").write_text(header, encoding="utf-8")
    program = folder / "law.elf"
    language = ("-x", "c++", "-std=gnu++11", *WARNED) if sketch else STRICT
    line = ["avr-gcc", f"-mmcu={CHIP}", f"-DF_CPU={FREQUENCY}UL", *language, optimized, f"-I{folder}"]
    called([*line, str(HERE / "avr_main.c"), "-o", str(program), "-lm"])
    return program


@cache
def _idle_sizes(optimized: str) -> tuple[int, int]:
    with TemporaryDirectory(prefix="zwidth-avr-") as folder:
        return sizes("avr-size", _program(IDLE, Path(folder), optimized))


@cache
def _machine_library() -> Any:
    """The chip itself, compiled once in a process; the library stays loaded when its file is gone."""
    with TemporaryDirectory(prefix="zwidth-avr-") as folder:
        library = Path(folder) / "avr_machine.so"
        strict = ("-O2", "-Wall", "-Wextra", "-Werror", "-shared", "-fPIC")
        called(["gcc", *strict, str(HERE / "avr_machine.c"), "-o", str(library), "-lsimavr"])
        loaded = ctypes.CDLL(str(library))
    pointer = ctypes.c_void_p
    loaded.machine_open.restype = pointer
    loaded.machine_open.argtypes = [ctypes.c_char_p, ctypes.c_char_p, ctypes.c_uint32]
    for name in ("machine_close", "machine_bytes", "machine_whole"):
        getattr(loaded, name).argtypes = [pointer]
    loaded.machine_run.argtypes = [pointer, ctypes.c_int, pointer, pointer, pointer, ctypes.c_long]
    return loaded
