"""The targets: what is written for each, and in which numbers."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

from zwidth.machine.firmware import mains

ALL = ("double", "float", "fixed")


@dataclass(frozen=True)
class Target:
    """What a law is written for.

    Parameters
    ----------
    name
        As it is asked for.
    language
        "c99" or "javascript".
    number
        The numbers that it has by default.
    numbers
        All that it may have.
    why_numbers
        Why no others.
    """

    name: str
    language: str
    number: str
    numbers: tuple[str, ...] = ALL
    why_numbers: str = "others are not written"

    def mains(self, name: str) -> dict[str, str]:
        """The files of its main program, by name."""
        return mains.files(self.name, prefix=name, folder=name) if self.name in mains.TARGETS else {}


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
