"""A law on an emulated Cortex-M4: its forces, the instructions of each step, flash and RAM.

arm-none-eabi-gcc compiles it, qemu-system-arm runs it as the machine mps2-an386.  The instructions are those
executed from the call of a step to its return, less those of an empty function.  They are no cycles: QEMU has
no pipeline and no flash that must be waited for.  On the chip most take one cycle, loads and taken branches
two or more, a division up to 14: there are more cycles than instructions.
"""

from __future__ import annotations

from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from firmware.emulated.answers import IDLE, Answers, as_counts, force_type
from firmware.emulated.built import STRICT, called, sizes

HERE = Path(__file__).parent
SOFT = ("-mfloat-abi=soft",)
HARD = ("-mfloat-abi=hard", "-mfpu=fpv4-sp-d16")
"""What computes in floats: the library, or the unit of the chip. In doubles it is the library always."""

SECONDS = 600
"""After which a run that does not end has failed."""

_TICKS = 25.6
"""Of SysTick at 25 MHz in one instruction of 1024 ns."""


def run(header: str, counts: object, start: int = 0, floats: tuple[str, ...] = HARD) -> Answers:
    given = as_counts(counts)
    with TemporaryDirectory(prefix="zwidth-cortex-") as name:
        folder = Path(name)
        program = _program(header, folder, floats)
        np.append(np.int32(start), given).tofile(folder / "counts")
        (folder / "forces").touch()
        machine = ["-M", "mps2-an386", "-display", "none", "-monitor", "none", "-serial", "none"]
        clock = ["-icount", "shift=10,sleep=off", "-semihosting-config", "enable=on,target=native"]
        called(["qemu-system-arm", *machine, *clock, "-kernel", str(program)], folder, SECONDS)
        told = np.fromfile(folder / "cost", np.uint32)
        forces = np.fromfile(folder / "forces", force_type(told[1], told[0]))[1:]
        flash, ram = (
            a - b for a, b in zip(sizes("arm-none-eabi-size", program), _idle_sizes(floats), strict=True)
        )
    ticks = (told[4:].astype(np.int64) - int(told[2])) / _TICKS
    assert forces.size == given.size == ticks.size, "the program has not answered every count"
    return Answers(forces, np.rint(ticks).astype(np.int64), flash, ram)


def _program(header: str, folder: Path, floats: tuple[str, ...]) -> Path:
    (folder / "law.h").write_text(header, encoding="utf-8")
    program = folder / "law.elf"
    line = ["arm-none-eabi-gcc", "-mcpu=cortex-m4", "-mthumb", *floats, *STRICT, "-O2", f"-I{folder}"]
    bare = ["-ffunction-sections", "-Wl,--gc-sections", "-nostartfiles", "-T", str(HERE / "cortex.ld")]
    called([*line, *bare, str(HERE / "cortex_main.c"), "-o", str(program), "-lm"])
    return program


@cache
def _idle_sizes(floats: tuple[str, ...]) -> tuple[int, int]:
    with TemporaryDirectory(prefix="zwidth-cortex-") as folder:
        return sizes("arm-none-eabi-size", _program(IDLE, Path(folder), floats))
