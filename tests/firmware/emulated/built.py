"""Compilers called, and what the emitted text declares."""

from __future__ import annotations

import re
import subprocess
from collections.abc import Sequence
from pathlib import Path

WARNED = ("-Wall", "-Wextra", "-Werror", "-pedantic", "-ffp-contract=off")
STRICT = ("-std=c99", *WARNED)
"""As a law is compiled wherever it runs: a warning is an error, and no two operations become one."""


def called(
    line: Sequence[str], folder: Path | None = None, seconds: float | None = None, sent: bytes = b""
) -> str:
    """What the program says, to which `sent` is sent; AssertionError with all of it where it fails."""
    done = subprocess.run(list(line), cwd=folder, input=sent, capture_output=True, timeout=seconds)
    said, complaint = done.stdout.decode(errors="replace"), done.stderr.decode(errors="replace")
    assert done.returncode == 0, f"{' '.join(line)}\n{said}{complaint}"
    return said


def defined(header: str, name: str) -> float:
    """The number that a header gives a name, such as FORCE_PER_UNIT of LAW_FORCE_PER_UNIT."""
    found = re.search(
        rf"^\s*#\s*define\s+[A-Z]\w*?_{name}\s+\(?([-+.\w]+?)f?\)?(?:\s*/\*.*\*/)?\s*$", header, re.MULTILINE
    )
    assert found, f"the header defines no {name}"
    return float.fromhex(found[1]) if found[1].lower().startswith("0x") else float(found[1])


def sizes(size: str, program: Path) -> tuple[int, int]:
    """Bytes that a program takes of flash and of RAM, without its stack, by a `size` of binutils."""
    text, data, bss = (int(word) for word in called([size, str(program)]).splitlines()[1].split()[:3])
    return text + data, data + bss
