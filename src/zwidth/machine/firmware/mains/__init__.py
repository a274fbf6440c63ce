"""Main programs around an emitted law: files of C and C++ that take all they need to know from its header.

Nothing in them is filled in.  They compile as they stand beside a header whose prefix is "law"; for another
prefix its names are replaced, ``law_step`` by ``wall_step`` and ``LAW_RATE_HZ`` by ``WALL_RATE_HZ``.
"""

from __future__ import annotations

import re
from importlib.resources import files as resources

from zwidth.errors import InputError

_SHARED = ("shared/guard.h", "shared/telemetry.h")

_FILES: dict[str, tuple[str, ...]] = {
    "arduino": ("arduino/hapkit.ino",),
    "cortex-m": ("cortex-m/main.c", "cortex-m/startup.c", "cortex-m/law.ld", "cortex-m/Makefile"),
    "posix": ("posix/main.c", "posix/device.h", "posix/mass.c", "posix/Makefile"),
    "simplefoc": ("simplefoc/motor.ino",),
    "moteus": ("posix/main.c", "posix/device.h", "moteus/moteus.c", "moteus/Makefile"),
}

TARGETS = tuple(_FILES)
"""What there is a main program for."""

_OF_THE_HEADER = re.compile(r"\blaw(?=\.h\b|_(?:state|force|init|step|reset)\b)|\bLAW(?=_[A-Z])")


def files(target: str, *, prefix: str = "law", folder: str = "law") -> dict[str, str]:
    """The main program of a target: each file's name, in one folder with the header, and its text.

    Parameters
    ----------
    target
        One of `TARGETS`.
    prefix
        Of the names in the header, and the header's own name.
    folder
        Name of the folder: Arduino wants that of a sketch to be the same.
    """
    if target not in _FILES:
        raise InputError(f'there is no main program for "{target}"; there is one for {", ".join(TARGETS)}')
    if not re.fullmatch(r"[a-z][a-z0-9_]*", prefix):
        raise InputError(f'the prefix begins names in C: small letters, digits and _, got "{prefix}"')
    found = {}
    for path in (*_FILES[target], *_SHARED):
        name = path.rpartition("/")[2]
        text = resources(__name__).joinpath(path).read_text(encoding="utf-8")
        found[f"{folder}.ino" if name.endswith(".ino") else name] = _OF_THE_HEADER.sub(
            lambda found: prefix.upper() if found[0] == "LAW" else prefix, text
        )
    return found
