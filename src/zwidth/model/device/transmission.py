"""Between motor and hand: a cable, a belt or a gear that gives way.

Two bodies in the place of one, x₁ of the motor and x₂ of the handle, joined by a spring k and a damper c:

    m₁ ẍ₁ = −f_a − b₁ ẋ₁ − f_c1 sgn ẋ₁ + k (x₂ − x₁) + c (ẋ₂ − ẋ₁)
    m₂ ẍ₂ =  f_h − b₂ ẋ₂ − f_c2 sgn ẋ₂ − k (x₂ − x₁) − c (ẋ₂ − ẋ₁)

m₁, b₁ and f_c1 are those of the device itself, on whose side the actuator is.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from math import pi, sqrt
from typing import Any, Literal

from zwidth.errors import InputError
from zwidth.quantity.exact import Exact, Interval, middle
from zwidth.quantity.glossary import GLOSSARY, Quantity
from zwidth.quantity.parameter import (
    Parametric,
    Uncertain,
    UncertainOrNone,
    parameter,
    parameters_of,
    read_number,
    word,
)


def _q(name: str, symbol: str, like: str, meaning: str) -> Quantity:
    return GLOSSARY[like]._replace(name=name, symbol=symbol, meaning=meaning)


_FRICTION = "negative friction would itself generate energy"


NOT_OF_IT: Mapping[str, str] = {
    "backlash": "of a gear with play nothing behind it is counted: leave stiffness, damping and "
    "handle_damping out, and what the friction of the motor proves alone holds for every play",
    "ratio": "every number is the one that is seen at the handle: of a motor that turns N times as fast "
    "write N² times its inertia and damping, N times its Coulomb friction, and 1/N of its encoder's step",
    "handle_inertia": "of a rotary device handle_mass is its inertia, in kg*m^2",
}
"""What people ask of a transmission that is no key of it, and what to write."""


@dataclass(frozen=True, kw_only=True)
class Transmission(Parametric):
    """A spring and a damper between motor and handle, and what moves on the handle's side.

    ``m₁ ẍ₁ = −f_a − b₁ ẋ₁ − f_c1 sgn ẋ₁ + k (x₂ − x₁) + c (ẋ₂ − ẋ₁)`` and
    ``m₂ ẍ₂ = f_h − b₂ ẋ₂ − f_c2 sgn ẋ₂ − k (x₂ − x₁) − c (ẋ₂ − ẋ₁)``: mass, damping and friction of
    the `Device` are m₁, b₁ and f_c1, those of the motor's side.  Every number may be an `Interval` (or
    a pair of ends), and a text may carry a unit; the units are those of the device's motion.

    Parameters
    ----------
    stiffness
        k > 0 [N/m; N·m/rad]; None where unknown.
    damping
        c inside it, ≥ 0 [N·s/m; N·m·s/rad].
    handle_mass
        m₂ > 0 [kg; kg·m²]; None where unknown. No criterion depends on it: only a simulated motion needs it.
    handle_damping
        b₂ ≥ 0 [N·s/m; N·m·s/rad].
    handle_coulomb_friction
        f_c2 ≥ 0 [N; N·m].
    encoder
        "motor" or "handle": which of the two it reads, x₁ or x₂.
    motion
        "linear" or "rotary", of the units in texts; a device of the other motion refuses it. "": they do not
        say.

    Raises
    ------
    InputError
        If a number is not finite, or outside its bound, or two units are of different motions.
    """

    stiffness: UncertainOrNone = parameter(
        _q("stiffness", "k", "stiffness", "stiffness of cable, belt or gear"),
        None,
        bound="> 0",
        why="it pulls the handle after the motor; leave it out if unknown",
    )
    damping: Uncertain = parameter(
        _q("damping", "c", "damping", "viscous friction inside cable, belt or gear"),
        0,
        bound="≥ 0",
        why=_FRICTION,
    )
    handle_mass: UncertainOrNone = parameter(
        _q("handle_mass", "m_2", "mass", "inertia on the handle's side; no criterion depends on it"),
        None,
        bound="> 0",
        why="a handle has inertia; leave it out if unknown",
    )
    handle_damping: Uncertain = parameter(
        _q("handle_damping", "b_2", "damping", "viscous friction on the handle's side"),
        0,
        bound="≥ 0",
        why=_FRICTION,
    )
    handle_coulomb_friction: Uncertain = parameter(
        _q("handle_coulomb_friction", "f_c2", "coulomb_friction", "dry friction on the handle's side"),
        0,
        bound="≥ 0",
        why=_FRICTION,
    )
    encoder: Literal["motor", "handle"] = word("motor", "handle")
    motion: str = field(default="", compare=False, repr=False)

    def __post_init__(self) -> None:
        texts = {name: getattr(self, name) for name in parameters_of(Transmission)}
        told = motion_told(texts, self.motion)
        super().__post_init__()
        object.__setattr__(self, "motion", told)

    def require(self, motion: str, whose: str) -> None:
        """Refuse units of another motion than that of a device or a joint."""
        if self.motion not in ("", motion):
            units = [GLOSSARY["stiffness"].unit_for(each) for each in (motion, self.motion)]
            raise InputError(
                f"{whose} is {motion}, and its transmission is given in units of a {self.motion} one: write "
                f"its stiffness in {units[0]} and not in {units[1]}, and the others likewise"
            )

    @property
    def is_certain(self) -> bool:
        """True when no parameter is an interval."""
        return not any(isinstance(value, Interval) for value in self.parameters().values())

    def replace(self, **changes: Any) -> Transmission:
        """The same with some arguments changed."""
        return replace(self, **changes)

    def rings(self, mass: Exact | Interval | None) -> tuple[float | None, float | None]:
        """Where a motor of mass m₁ swings on it with the handle held, √(k/m₁)/2π, and with nobody there,
        √(k (1/m₁ + 1/m₂))/2π [Hz]; of intervals the middles, None where not known."""
        k, motor, handle = map(middle, (self.stiffness, mass, self.handle_mass))
        if k is None or motor is None:
            return None, None
        held = sqrt(k / motor) / (2 * pi)
        return held, None if handle is None else held * sqrt(1 + motor / handle)

    def parameters(self) -> Mapping[str, Exact | Interval]:
        """The known numbers by name, SI."""
        known = {name: getattr(self, name) for name in parameters_of(Transmission)}
        return {name: value for name, value in known.items() if isinstance(value, (Exact, Interval))}


def motion_told(given: Mapping[str, Any], known: str = "") -> str:
    """Whether the units in some texts slide or turn, "linear" or "rotary"; "" where they are of either."""
    found = {known: "another number"} if known else {}
    for name, value in given.items():
        own = parameters_of(Transmission)[name]
        fits = [m for m in ("linear", "rotary") if own.is_number and _reads(value, own.quantity, m)]
        if len(fits) == 1:
            found[fits[0]] = name
    if len(found) == 2:
        raise InputError(
            f"transmission: {found['linear']} is of what slides, {found['rotary']} of what turns: both "
            "are of one motion"
        )
    return next(iter(found), "")


def _reads(value: Any, quantity: Quantity, motion: str) -> bool:
    try:
        read_number(value, quantity, quantity.name, uncertain=True, motion=motion)
    except InputError:
        return False
    return True
