"""Answers in the units of the question: who types degrees reads degrees.

    1 deg = π/180 rad      1 turn = 2π rad      1 rpm = 2π/60 rad/s

Everything is computed in SI, and radians are what a file holds: its keys say so.  What a person
reads is told in the angle that the person typed.  While a command reads its values, `units` notes
the angles among them; once one was in degrees every angle of the answer is, so that what is compared
has one unit: that of the stiffness, where it was typed per angle.  In Python nothing is noted: answers
are in radians, or as `answers_in` says.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from contextvars import ContextVar
from functools import cache
from math import pi
from typing import TYPE_CHECKING

from zwidth.errors import InputError

if TYPE_CHECKING:
    from xarray import Dataset

_ANGLES = {"deg": 180 / pi, "turn": 0.5 / pi, "rad": 1.0}
"""How many of each are one radian; of several that were typed the first one here is told."""

_WORDS = {
    **dict.fromkeys(("deg", "degree", "degrees"), "deg"),
    **dict.fromkeys(("turn", "turns", "rev", "revs"), "turn"),
    **dict.fromkeys(("rad", "mrad"), "rad"),
    "rpm": "rpm",
}
ANGLES = (*_ANGLES, "rpm")
"""In which an answer may be."""
_WORD = re.compile(r"[A-Za-z]+")
_RADIAN = re.compile(r"\brad(?:\^([0-9.]+))?(?![A-Za-z])")

_NOTED: ContextVar[set[tuple[int, str]] | None] = ContextVar("angles that were typed", default=None)


@contextmanager
def answers_as_typed() -> Iterator[None]:
    """Inside, answers are in the units of the angles that are read."""
    with _noting(set()):
        yield


@contextmanager
def answers_in(*units: str) -> Iterator[None]:
    """Inside, answers are in these units of angle.

    Parameters
    ----------
    units
        "rad", "deg" or "turn", and "rpm" for speeds.
    """
    unknown = [unit for unit in units if unit not in ANGLES]
    if unknown:
        raise InputError(f"an angle is told in rad, deg or turn, a speed also in rpm; got {unknown[0]!r}")
    with _noting({(2, unit) for unit in units}):
        yield


@contextmanager
def _noting(noted: set[tuple[int, str]]) -> Iterator[None]:
    token = _NOTED.set(noted)
    try:
        yield
    finally:
        _NOTED.reset(token)


@contextmanager
def of_less_weight() -> Iterator[None]:
    """Angles that are read inside are told where no others were typed: a hand is no part of the loop."""
    noted = _NOTED.get()
    if noted is None:
        yield
        return
    inside: set[tuple[int, str]] = set()
    with _noting(inside):
        yield
    noted.update((-1, unit) for unit in _told(frozenset(inside)))


def note(unit: str, rank: int = 0) -> None:
    """Take down the angle in a unit that a person typed: "N*m/deg" has degrees.

    The highest rank is told: 2 of what is asked for, 1 of a stiffness, 0 of anything else, −1 of a hand's.
    """
    noted = _NOTED.get()
    if noted is not None:
        noted.update((rank, _WORDS[word]) for word in _WORD.findall(unit) if word in _WORDS)


def angles_in(value: object) -> frozenset[str]:
    """The angles in the units of a text, a list or a table: {"deg"} of "0.5 N*m/deg"; rad, deg, turn, rpm."""
    if isinstance(value, str):
        words = _WORD.findall(value.replace("°", " deg "))
        return frozenset(_WORDS[word] for word in words if word in _WORDS)
    parts = (
        value.values() if isinstance(value, Mapping) else value if isinstance(value, (list, tuple)) else ()
    )
    return frozenset().union(*map(angles_in, parts))


def angles_typed() -> frozenset[str]:
    """Those that were noted so far, as far as they are told."""
    return _told(frozenset(_NOTED.get() or ()))


def spoken(unit: str) -> tuple[float, str]:
    """(factor, unit) in which a value in an SI unit is told: (π/180, "N*m/deg") for "N*m/rad" in degrees.

    A part of one is told in "%".
    """
    if unit == "%":
        return 100.0, unit
    noted = _NOTED.get()
    return _spoken(unit, _told(frozenset(noted))) if noted else (1.0, unit)


def _told(noted: frozenset[tuple[int, str]]) -> frozenset[str]:
    """Of those typed the angles of the highest rank, and rpm."""
    angles = [one for one in noted if one[1] in _ANGLES]
    most = max(angles, default=(0, ""))[0]
    return frozenset(name for rank, name in noted if rank == most or name == "rpm")


def spoken_data(found: Dataset) -> Dataset:
    """A dataset with every variable and coordinate in the unit in which it is told."""
    told = found.copy()
    for name, value in found.variables.items():
        factor, unit = spoken(str(value.attrs.get("units", "")))
        if factor != 1.0:
            told[name] = (value.dims, factor * value.values, {**value.attrs, "units": unit})
    return told


@cache
def _spoken(unit: str, noted: frozenset[str]) -> tuple[float, str]:
    if unit == "rad/s" and "rpm" in noted:
        return 30 / pi, "rpm"
    angle = next((name for name in _ANGLES if name in noted), "rad")
    found = _RADIAN.search(unit)
    if found is None or angle == "rad" or unit.count("rad") > 1:
        return 1.0, unit
    per_radian = _ANGLES[angle] ** float(found[1] or 1)
    above = "/" not in unit[: found.start()]
    return (per_radian if above else 1 / per_radian), unit.replace("rad", angle)
