"""Units that the keys of a document end in, of a device that slides and of one that turns."""

from __future__ import annotations

from typing import NamedTuple


class Unit(NamedTuple):
    """Of a linear device, and of a rotary one."""

    linear: str
    rotary: str

    def of(self, motion: str) -> str:
        """The ending of a key."""
        return self.rotary if motion == "rotary" else self.linear


def always(unit: str) -> Unit:
    """The same for both."""
    return Unit(unit, unit)


_SEVERAL = {
    "m_N": "m, N",
    "rad_N_m": "rad, N·m",
    "m_per_s_N": "m/s, N",
    "rad_per_s_N_m": "rad/s, N·m",
    "N_N_s_per_m": "N, N·s/m",
    "N_m_N_m_s_per_rad": "N·m, N·m·s/rad",
    "N_m_rad": "in N, m, rad",
    "N_m_s_rad": "in N, m, s, rad",
}
"""Keys of pairs, and of matrices that hold forces and moments."""


def in_words(ending: str) -> str:
    """The ending of a key as people write a unit: "N_s_per_m" is N·s/m."""
    plain = ending.replace("_per_", "/").replace("_", "·").replace("2", "²")
    return _SEVERAL.get(ending, plain)


NONE = always("")
SECONDS = always("s")
JOULES = always("J")
HERTZ = always("Hz")
FORCE = Unit("N", "N_m")
LENGTH = Unit("m", "rad")
SPEED = Unit("m_per_s", "rad_per_s")
MASS = Unit("kg", "kg_m2")
DAMPING = Unit("N_s_per_m", "N_m_s_per_rad")
STIFFNESS = Unit("N_per_m", "N_m_per_rad")
FORCE_AT = Unit("m_N", "rad_N_m")
FORCE_AT_SPEED = Unit("m_per_s_N", "rad_per_s_N_m")
FRICTION_MODEL = Unit("N_N_s_per_m", "N_m_N_m_s_per_rad")
PER_LENGTH = Unit("m", "rad")
