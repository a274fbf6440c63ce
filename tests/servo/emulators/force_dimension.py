"""A device of Force Dimension: the maker's library in C, made here, under the real Python package.

The package takes hold of hundreds of functions of the library when it is imported; those that are not called
here are in it as well, and fail.
"""

import ctypes
import importlib.util
import os
import platform
import re
import shutil
import subprocess
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from enum import IntEnum
from pathlib import Path

SOURCE = Path(__file__).parent / "libdrd.c"
COMPILER = shutil.which("cc") or shutil.which("gcc")
PACKAGE = importlib.util.find_spec("forcedimension_core")
"""It is found, not imported: to import it needs the library."""


class Failure(IntEnum):
    """What goes wrong, as in libdrd.c."""

    NONE = 0
    CLOSED = 1
    GARBAGE = 2
    LATE = 3
    FORCE_REFUSED = 4


def built(folder: Path) -> Path:
    assert PACKAGE is not None
    assert PACKAGE.origin is not None
    wanted = set()
    for path in Path(PACKAGE.origin).parent.rglob("*.py"):
        wanted |= set(re.findall(r"_libd[hr]d\.(\w+)", path.read_text(encoding="utf-8")))
    own = set(re.findall(r"(d[hr]d\w+)\(", SOURCE.read_text(encoding="utf-8")))
    rest = folder / "rest.c"
    rest.write_text("".join(f"int {name}(void) {{ return -1; }}\n" for name in sorted(wanted - own)))
    place = folder / "lib" / "release" / f"lin-{platform.machine()}-gcc"
    place.mkdir(parents=True)
    library = place / "libdrd.so.3.16.0"
    command = [str(COMPILER), "-std=gnu11", "-Wall", "-Wextra", "-Werror", "-shared", "-fPIC"]
    subprocess.run([*command, str(SOURCE), str(rest), "-lm", "-o", str(library)], check=True)
    return folder


class Device:
    def __init__(self, folder: Path, present: bool = True, watchdog: bool = True) -> None:
        (library,) = folder.rglob("libdrd.so.*")
        self.library = ctypes.CDLL(str(library))
        self.library.fd_force.restype = ctypes.c_double
        self.library.fd_begin(present, watchdog)

    def move(self, path: Sequence[tuple[float, float, float]]) -> None:
        """Where the tip is at each question [m]."""
        for step, place in enumerate(path):
            self.library.fd_move(step, *map(ctypes.c_double, place))

    def fail(self, failure: Failure, at: int) -> None:
        """From so many questions on."""
        self.library.fd_fail(int(failure), at)

    @property
    def asked(self) -> int:
        return int(self.library.fd_asked())

    @property
    def forces(self) -> list[tuple[float, float, float]]:
        given = range(self.library.fd_given())
        return [tuple(self.library.fd_force(k, axis) for axis in range(3)) for k in given]  # type: ignore[misc]

    @property
    def state(self) -> dict[str, int]:
        """What else it was told; −1 where it was told nothing, or is closed."""
        names = ("opened", "watchdog", "time_guard", "force_enabled", "simulator", "enablings")
        return {name: self.library.fd_state(i) for i, name in enumerate(names)}


@contextmanager
def installed(folder: Path) -> Iterator[None]:
    """The SDK in this folder, found by the package; it is forgotten afterwards."""
    before = os.environ.get("FDSDK")
    os.environ["FDSDK"] = str(folder)
    try:
        yield
    finally:
        forget()
        if before is None:
            del os.environ["FDSDK"]
        else:
            os.environ["FDSDK"] = before


def forget() -> None:
    for name in [name for name in sys.modules if name.split(".")[0] == "forcedimension_core"]:
        del sys.modules[name]
