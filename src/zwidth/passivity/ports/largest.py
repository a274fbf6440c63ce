"""The largest level at which a port is positive real, and which pole it is that lets none be.

What a port absorbs is largest where its least eigenvalue is least: of one axis that is the least
Re F (`real_part`), of several the least root of a polynomial in σ and c (`spectrum`).  That what is
found is the least is proved afterwards.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction

from zwidth.passivity.ports.circle import Time
from zwidth.passivity.ports.poles import growing_place, places_of
from zwidth.passivity.ports.port import Port
from zwidth.passivity.ports.positive_real import is_stable, prove_minors
from zwidth.passivity.ports.real_part import real_part
from zwidth.passivity.ports.spectrum import spectrum
from zwidth.passivity.ports.zeros import near, vanishes


@dataclass(frozen=True)
class Largest:
    """low ≤ σ* ≤ high: F − low is proved positive real, and Re F(c) reaches high at `cosine`.

    `cosine` is None where it is reached at every frequency.
    """

    low: Fraction
    high: Fraction
    cosine: Fraction | None


@dataclass(frozen=True)
class NoLevel:
    """No σ will do; `reason` says why."""

    reason: str


def largest_level(port: Port, root: str = "pole") -> Largest | NoLevel:
    """The largest σ; `root` is what a pole is called in a reason, of the inverse a zero."""
    values = real_part(port) if port.axes == 1 else spectrum(port)
    if values is None:
        return NoLevel("an input without effect is paired with an output that other inputs move")
    if vanishes(values.weight):
        return NoLevel(_without_bound(port.time, root, values.weight(-1) == 0))
    least, cosine = values.least
    low = _proved_below(least, lambda level: not isinstance(prove_minors(port, level), Fraction))
    if not is_stable(port, low):
        return NoLevel(_not_stable(port, root))
    return Largest(low, values.reached(low), cosine)


def _proved_below(least: Fraction, holds: Callable[[Fraction], bool]) -> Fraction:
    """A level at most `least` that holds: the same one, its simplest neighbour, or one a little less."""
    simple = least.limit_denominator(10**15)
    candidates = [least] if least.denominator < 10**60 else []
    if abs(simple - least) <= near(least):
        candidates.append(simple)
    for level in candidates:
        if holds(level):
            return level
    step = near(least)
    while not holds(least - step):
        step *= 1024
    return least - step


def _without_bound(time: Time, root: str, at_end: bool) -> str:
    """Why no level holds where the real part has a pole of its own."""
    if time == "discrete":
        return f"the real part is without bound at a {root} on the unit circle"
    where = "as the frequency grows" if at_end else f"at a {root} on the imaginary axis"
    return f"the real part is without bound {where}"


def _not_stable(port: Port, root: str) -> str:
    """Which pole it is that the port may not have."""
    continuous, alone = port.time == "continuous", port.axes == 1
    improper = alone and len(port.outputs[0][0]) > len(port.inputs[0][0])
    if improper and not continuous:
        return "the output does not answer the input within the same sample"
    poles = port.poles()
    growing = None if poles is None else growing_place(places_of(poles.numer()), port.time)
    if growing is not None:
        return f"there is an unstable {root} at {growing}"
    if improper:
        return "it grows with the frequency, with a negative sign"
    if not continuous and not alone and root == "zero":
        return "some output does not answer within the same sample, or a zero on the unit circle is multiple"
    where = "the imaginary axis" if continuous else "the unit circle"
    if alone:
        return f"a {root} on {where} is multiple, or has a negative residue"
    where += " or at infinity" if continuous else ""
    return f"a {root} on {where} is multiple, or its residue is not positive semidefinite"
