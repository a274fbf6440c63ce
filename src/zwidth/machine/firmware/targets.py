"""The targets: what is written for each, in which numbers, and the main programs around a law."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from importlib.resources import files as resources
from types import MappingProxyType

from zwidth.errors import InputError

ALL = ("double", "float", "fixed")


@dataclass(frozen=True)
class Target:
    """What a law is written for: in which language, and in which numbers."""

    name: str
    language: str
    number: str
    numbers: tuple[str, ...] = ALL
    why_numbers: str = "others are not written"

    def mains(self, name: str) -> dict[str, str]:
        """The files of its main program, by name."""
        return main_files(self.name, prefix=name, folder=name) if self.name in MAINS else {}


TARGETS: Mapping[str, Target] = MappingProxyType(
    {
        "c99": Target("c99", "c99", "double"),
        "arduino": Target(
            "arduino", "c99", "fixed", ("float", "fixed"), "double has 32 bits on an AVR, as float has"
        ),
        "cortex-m": Target("cortex-m", "c99", "float"),
        "posix": Target("posix", "c99", "double"),
        "simplefoc": Target("simplefoc", "c99", "float"),
        "moteus": Target("moteus", "c99", "double"),
        "javascript": Target(
            "javascript", "javascript", "double", ("double",), "all numbers of JavaScript are double"
        ),
    }
)
"""By name."""

_SHARED = ("shared/guard.h", "shared/telemetry.h")

MAINS: dict[str, tuple[str, ...]] = {
    "arduino": ("arduino/hapkit.ino",),
    "cortex-m": ("cortex-m/main.c", "cortex-m/startup.c", "cortex-m/law.ld", "cortex-m/Makefile"),
    "posix": ("posix/main.c", "posix/device.h", "posix/mass.c", "posix/Makefile"),
    "simplefoc": ("simplefoc/motor.ino",),
    "moteus": ("posix/main.c", "posix/device.h", "moteus/moteus.c", "moteus/Makefile"),
}

_OF_THE_HEADER = re.compile(r"\blaw(?=\.h\b|_(?:state|force|init|step|reset)\b)|\bLAW(?=_[A-Z])")


def main_files(target: str, *, prefix: str = "law", folder: str = "law") -> dict[str, str]:
    """The main program of a target: each file's name, in one folder with the header, and its text.

    Files of C and C++ that take all they need to know from the header.  For another prefix than "law" its
    names are replaced, ``law_step`` by ``wall_step`` and ``LAW_RATE_HZ`` by ``WALL_RATE_HZ``; Arduino wants a
    sketch to be called as its folder.
    """
    if target not in MAINS:
        raise InputError(f'there is no main program for "{target}"; there is one for {", ".join(MAINS)}')
    if not re.fullmatch(r"[a-z][a-z0-9_]*", prefix):
        raise InputError(f'the prefix begins names in C: small letters, digits and _, got "{prefix}"')
    found = {}
    for path in (*MAINS[target], *_SHARED):
        name = path.rpartition("/")[2]
        text = resources("zwidth.machine.firmware").joinpath("mains", path).read_text(encoding="utf-8")
        found[f"{folder}.ino" if name.endswith(".ino") else name] = _OF_THE_HEADER.sub(
            lambda found: prefix.upper() if found[0] == "LAW" else prefix, text
        )
    return found
