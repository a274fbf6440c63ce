"""The library of all step functions: made by a C compiler when the package is built, opened when it is used.

An installed package has it beside this file.  In a checkout it is made anew where a source that it was made
of has changed.  Where there is neither a library nor a compiler, the step functions run as plain Python.
"""

from __future__ import annotations

import ctypes
import hashlib
import json
import os
import shlex
import shutil
import subprocess
import sys
import warnings
from collections.abc import Iterable
from functools import cache
from importlib.util import find_spec
from pathlib import Path
from threading import RLock
from typing import Any, NamedTuple

PACKAGE = Path(__file__).parent.parent
BUILT = Path(__file__).with_name("steps.dll" if os.name == "nt" else "steps.so")

FLAGS = (
    "-std=gnu11", "-O3", "-fPIC", "-shared", "-fwrapv", "-ffp-contract=off", "-fno-math-errno",
    "-fvisibility=hidden", "-fno-tree-slp-vectorize",
)  # fmt: skip
"""Rounding is that of the source: nothing contracted, nothing taken together otherwise.

Chains of sums without error wait for one another: put in pairs by gcc, a power took half as long again.
"""


class Library(NamedTuple):
    """What was built, opened; `table` says of each step function what it takes and returns."""

    opened: Any
    table: dict[str, Any]


def library() -> Library | None:
    """The library; None where it cannot be had, which is told once."""
    with _ONE_AT_A_TIME:
        return _library()


_ONE_AT_A_TIME = RLock()


@cache
def _library() -> Library | None:
    found = _opened(BUILT) if BUILT.is_file() else None
    if _is_checkout() and (found is None or _is_old(found.table)):
        sys.stderr.write("zwidth: the step functions have changed and are built anew\n")
        try:
            found = build()
        except OSError as fault:
            _warn(str(fault))
            return None
    if found is None:
        _warn(f"{BUILT.name} is not there")
    return found


def _warn(why: str) -> None:
    warnings.warn(
        f"the step functions run as plain Python, a hundred times as slow: {why}; a C compiler (gcc, "
        "clang, or the package ziglang) builds them where zwidth is installed from its source",
        RuntimeWarning,
        stacklevel=4,
    )


def _opened(path: Path) -> Library:
    opened = ctypes.CDLL(str(path))
    text = ctypes.string_at(ctypes.addressof(ctypes.c_char.in_dll(opened, "zw_told")))
    return Library(opened, json.loads(text))


def _is_checkout() -> bool:
    return (PACKAGE.parent.parent / "hatch_build.py").is_file()


def _is_old(table: dict[str, Any]) -> bool:
    """True if a source differs from what the library was made of; looked into only if it is younger."""
    made = BUILT.stat().st_mtime_ns
    sources = [PACKAGE.parent / name for name in table["sources"]]
    try:
        if all(path.stat().st_mtime_ns < made for path in sources):
            return False
        return digest(sources) != str(table["digest"])
    except FileNotFoundError:
        return True


def digest(sources: Iterable[Path]) -> str:
    """Of what the library is made of, and how."""
    whole = hashlib.sha256(repr(FLAGS).encode())
    for path in sources:
        whole.update(path.read_bytes())
    return whole.hexdigest()


def compiler() -> list[str] | None:
    """The C compiler: that of the variable CC, the system's, or the one of the package ziglang."""
    if told := os.environ.get("CC"):  # with what else it is to be given: CC="gcc -DZW_CHECKED"
        return shlex.split(told)
    for name in ("cc", "gcc", "clang"):
        if found := shutil.which(name):
            return [found]
    return [sys.executable, "-m", "ziglang", "cc"] if find_spec("ziglang") else None


def build() -> Library:
    """Translate all step functions, compile them, and put the library in its place."""
    command = compiler()
    if command is None:
        raise FileNotFoundError("there is no C compiler")
    text = translated()
    made = BUILT.with_name(f"{BUILT.name}.{os.getpid()}")
    run = [*command, *FLAGS, "-o", str(made), "-x", "c", "-", "-lm"]
    done = subprocess.run(run, input=text, capture_output=True, text=True, encoding="utf-8", check=False)
    if done.returncode:
        raise OSError(f"{shlex.join(command)} failed: {done.stderr.strip()[-2000:]}")
    found = _opened(made)  # under its own name: another of the same name is not opened anew
    os.replace(made, BUILT)
    return found


def translated() -> str:
    """All step functions in C, and what is told of them."""
    from zwidth.native.translation import Translation

    translation = Translation(PACKAGE)
    text = translation.text()
    sources = translation.sources()
    table = {**translation.table(), "digest": digest(sources)}
    table["sources"] = [os.path.relpath(path, PACKAGE.parent) for path in sources]
    return f"{text}ZW_SEEN const char zw_told[] = {json.dumps(json.dumps(table))};\n"


if __name__ == "__main__":
    build()
