"""Units as exact scales and dimensions: "N*s/m" is 1 kg/s.

A unit text is a product of SI units with prefixes, read from left to right,
so that N*s/m is (N·s)/m.  Data sheets write products without a sign: Nm is N*m,
mNms is mN*m*s, kgm2 is kg*m^2; nm stays the nanometre.  A dimension is the exponents of kg, m, s, A and
rad; the radian is kept, so that rad/s is not taken for Hz.
"""

from __future__ import annotations

import re
from difflib import get_close_matches
from fractions import Fraction
from functools import lru_cache
from typing import NamedTuple

from zwidth.errors import InputError
from zwidth.quantity.spelling import WORDS

Dimension = tuple[int, int, int, int, int]


class Unit(NamedTuple):
    """scale · π^turns in SI, and the exponents of kg, m, s, A, rad."""

    scale: Fraction
    turns: int
    dimension: Dimension


PI = Fraction("3.1415926535897932384626433832795028841972")
ONE = Unit(Fraction(1), 0, (0, 0, 0, 0, 0))
_PREFIXES = {
    "n": Fraction(1, 10**9),
    "u": Fraction(1, 10**6),
    "m": Fraction(1, 1000),
    "c": Fraction(1, 100),
    "k": Fraction(1000),
    "M": Fraction(10**6),
}
_PREFIXED = {
    "g": Unit(Fraction(1, 1000), 0, (1, 0, 0, 0, 0)),
    "m": Unit(Fraction(1), 0, (0, 1, 0, 0, 0)),
    "s": Unit(Fraction(1), 0, (0, 0, 1, 0, 0)),
    "A": Unit(Fraction(1), 0, (0, 0, 0, 1, 0)),
    "rad": Unit(Fraction(1), 0, (0, 0, 0, 0, 1)),
    "Hz": Unit(Fraction(1), 0, (0, 0, -1, 0, 0)),
    "N": Unit(Fraction(1), 0, (1, 1, -2, 0, 0)),
    "J": Unit(Fraction(1), 0, (1, 2, -2, 0, 0)),
    "V": Unit(Fraction(1), 0, (1, 2, -3, -1, 0)),
    "H": Unit(Fraction(1), 0, (1, 2, -2, -2, 0)),
}
_UNITS = {
    **{
        p + name: Unit(f * u.scale, 0, u.dimension)
        for p, f in _PREFIXES.items()
        for name, u in _PREFIXED.items()
    },
    **_PREFIXED,
    "min": Unit(Fraction(60), 0, (0, 0, 1, 0, 0)),
    "deg": Unit(Fraction(1, 180), 1, (0, 0, 0, 0, 1)),
    "turn": Unit(Fraction(2), 1, (0, 0, 0, 0, 1)),
    "rev": Unit(Fraction(2), 1, (0, 0, 0, 0, 1)),
    "rpm": Unit(Fraction(1, 30), 1, (0, 0, -1, 0, 1)),
}
_JOINED = {
    **{f"{force}N{way}": (f"{force}N", way) for force in ("", "u", "m", "k") for way in ("m", "mm", "cm")},
    **{f"{force}N{rest}": (f"{force}N", *rest) for force in ("", "u", "m", "k") for rest in ("s", "ms")},
    **{f"{mass}{way}": (mass, way) for mass in ("kg", "g") for way in ("m", "mm", "cm")},
    **{f"{first}s": (first, "s") for first in ("V", "mV", "J", "mJ")},
}
"""Products that data sheets write as one word, each with the one meaning that it has there."""

_KINDS: dict[Dimension, str] = {
    (0, 0, 0, 0, 0): "a plain number",
    (1, 0, 0, 0, 0): "a mass (kg)",
    (0, 1, 0, 0, 0): "a length (m)",
    (0, 0, 1, 0, 0): "a time (s)",
    (0, 0, -1, 0, 0): "a frequency (1/s)",
    (0, 0, 0, 0, 1): "an angle (rad)",
    (0, 0, -1, 0, 1): "an angular speed (rad/s)",
    (0, 1, -1, 0, 0): "a speed (m/s)",
    (0, -1, 1, 0, 0): "a dissipation (s/m)",
    (0, 0, 1, 0, -1): "a rotary dissipation (s/rad)",
    (1, 1, -2, 0, 0): "a force (N)",
    (1, 0, -2, 0, 0): "a stiffness (N/m)",
    (1, 0, -1, 0, 0): "a damping (N*s/m)",
    (1, 2, -2, 0, 0): "a torque or an energy (N*m)",
    (1, 2, -2, 0, -1): "a rotary stiffness (N*m/rad)",
    (1, 2, -1, 0, 0): "a rotary damping (N*m*s)",
    (1, 2, -1, 0, -1): "a rotary damping (N*m*s/rad)",
    (1, 2, 0, 0, 0): "a moment of inertia (kg*m^2)",
    (0, 0, 0, 1, 0): "a current (A)",
    (1, 2, -3, -1, 0): "a voltage (V)",
    (1, 2, -2, -2, 0): "an inductance (H)",
}

_FACTOR = re.compile(
    r"\s*([*/]?)\s*(?:([A-Za-z]+)(?:(?:\^|\*\*)([+-]?[0-9])|([23]))?|([0-9]{1,15}))(?![0-9])"
)


@lru_cache(maxsize=256)
def unit_of(text: str, example: str = "N*s/m") -> Unit:
    """The unit that a text such as "N*s/m" spells; "" and "1" are the plain number.

    Parameters
    ----------
    text
        The unit as it was typed.
    example
        A unit that would do, for the message.
    """
    total, position = ONE, 0
    while position < len(text):
        factor = _FACTOR.match(text, position)
        if factor is None or (position == 0 and factor[1] == "*"):
            raise InputError(f'"{text}" is not a product of units such as {example}')
        for unit, power in _factors(factor, text):
            total = _times(total, unit, power)
        position = factor.end()
    return total


def _factors(match: re.Match[str], text: str) -> list[tuple[Unit, int]]:
    """One factor, or those of a joined word, of which the last has the exponent: kgm^2 is kg*m^2."""
    operator, name, exponent, raised, number = match.groups()
    sign = -1 if operator == "/" else 1
    if number is not None:
        # "1/3000 s" and "60 1/min" are values; "1 2 N" is a slip.
        if int(number) == 0 or (sign > 0 and number != "1"):
            raise InputError(f'the number {number} stands inside the unit "{text}"')
        return [(Unit(Fraction(int(number)), 0, ONE.dimension), sign)]
    name = WORDS.get(name, name)
    if name not in _UNITS and name not in _JOINED:
        raise InputError(f'"{name}" is not a known unit{_suggestion(name)}')
    *before, last = (name,) if name in _UNITS else _JOINED[name]
    power = int(exponent or raised or 1)
    return [*((_UNITS[one], sign) for one in before), (_UNITS[last], sign * power)]


def _times(a: Unit, b: Unit, power: int) -> Unit:
    k, m, s, i, r = (x + power * y for x, y in zip(a.dimension, b.dimension, strict=True))
    return Unit(a.scale * b.scale**power, a.turns + power * b.turns, (k, m, s, i, r))


def _suggestion(name: str) -> str:
    every = [*_JOINED, *_UNITS]
    same = [known for known in every if known.lower() == name.lower()]
    near = same or get_close_matches(name, every, n=1, cutoff=0.75)
    return f'; did you mean "{near[0]}"?' if near else ""


def compatible(given: Unit, wanted: Unit) -> bool:
    """True when `given` may stand for `wanted`; "per radian" may be left out."""
    if given.dimension == wanted.dimension:
        return True
    # Only below the bar: an angle without its radian would leave nothing to check.
    return wanted.dimension[4] < 0 and given.dimension == (*wanted.dimension[:4], 0)


def kind_of(unit: Unit) -> str:
    """What a unit measures, in words: "a frequency (1/s)"."""
    if unit.dimension in _KINDS:
        return _KINDS[unit.dimension]
    names = zip(("kg", "m", "s", "A", "rad"), unit.dimension, strict=True)
    return "in " + "*".join(n if e == 1 else f"{n}^{e}" for n, e in names if e)
