"""Which tools a target needs, and whether this machine has them.

Where ZWIDTH_EVERY_TARGET is set a missing one fails the test that needs it; else the test is skipped, and
says which.
"""

from __future__ import annotations

import os
import shutil
import subprocess
from functools import cache
from typing import NoReturn

import pytest

TOOLS = {
    "host": {"gcc": None},
    "gappa": {"gappa": None},
    "avr": {"gcc": "simavr/sim_avr.h", "avr-gcc": "avr/io.h", "avr-size": None},
    "cortex-m4": {"arm-none-eabi-gcc": "math.h", "arm-none-eabi-size": None, "qemu-system-arm": None},
}
"""By target: programs, and a header that a compiler among them must find."""


@cache
def missing(target: str) -> tuple[str, ...]:
    lacks = []
    for program, header in TOOLS[target].items():
        if shutil.which(program) is None:
            lacks.append(program)
        elif header is not None and not _finds(program, header):
            lacks.append(f"{header} of {program}")
    return tuple(lacks)


def _finds(compiler: str, header: str) -> bool:
    chip = ["-mmcu=atmega328p"] if compiler == "avr-gcc" else []
    line = [compiler, *chip, "-fsyntax-only", "-x", "c", "-"]
    done = subprocess.run(line, input=f"#include <{header}>\n", text=True, capture_output=True)
    return done.returncode == 0


def require(*targets: str) -> None:
    """Skip the test that asks, or fail it where every target is wanted, if one of them lacks a tool."""
    if lacks := dict.fromkeys(name for target in targets for name in missing(target)):
        _without(", ".join(lacks))


def tool(name: str) -> str:
    """The path of a compiler or another program, which the test that asks requires."""
    return shutil.which(name) or _without(name)


def _without(lacks: str) -> NoReturn:
    reason = f"not on this machine: {lacks}"
    if os.environ.get("ZWIDTH_EVERY_TARGET"):
        pytest.fail(reason)
    pytest.skip(reason)
