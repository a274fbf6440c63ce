"""Units as recordings and their headers spell them: "sec", "Nm", "µm", "°"."""

from __future__ import annotations

WORDS = {
    **dict.fromkeys(("sec", "secs", "second", "seconds"), "s"),
    **dict.fromkeys(("msec", "milliseconds", "millisecond"), "ms"),
    **dict.fromkeys(("usec", "microseconds", "microsecond"), "us"),
    **dict.fromkeys(("nsec", "nanoseconds", "nanosecond"), "ns"),
    **dict.fromkeys(("degree", "degrees"), "deg"),
    **dict.fromkeys(("radian", "radians"), "rad"),
    **dict.fromkeys(("meter", "meters", "metre", "metres"), "m"),
    **dict.fromkeys(("newton", "newtons"), "N"),
    **dict.fromkeys(("turns", "revs"), "turn"),
}
"""Units written out, wherever a value is read."""

_ALIASES = {
    **WORDS,
    "n": "N",
    **dict.fromkeys(("N_m", "Nm", "N.m", "N m", "N-m"), "N*m"),
    **dict.fromkeys(("mNm", "mN_m", "mN.m", "mN m"), "mN*m"),
    **dict.fromkeys(("Nmm", "N_mm", "N.mm", "N mm"), "N*mm"),
}
"""And those of the headers of recordings."""

_SIGNS = str.maketrans({"µ": "u", "μ": "u", "·": "*", "⋅": "*", "°": "deg"})


def plain(text: str) -> str:
    """The same text with signs that `unit_of` reads."""
    return text.translate(_SIGNS)


def spelled(text: str) -> str:
    """A unit as `unit_of` reads it, where it is one: "Nm" is "N*m"."""
    bare = plain(text).strip()
    return _ALIASES.get(bare, bare)
