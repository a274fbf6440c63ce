"""Contact after Hunt and Crossley: a spring that stiffens, and damping that grows with the depth.

    f = K uⁿ (1 + λ v),     u = max(x, 0),   v = (x(k) − x(k−1))/T

and f = max(f, 0) where the contact never pulls.  Unlike a Kelvin–Voigt wall it
begins without a jump of force and lets go without holding back; two bodies that
meet at the speed v_i part at about (1 − ⅔ λ v_i) v_i.  n = 3/2 is a sphere on a
plane (Hertz).

Hunt & Crossley, Journal of Applied Mechanics 42(2), 1975; clamped so that it
never pulls as in Drake and Simbody, where λ is called the dissipation too.
"""

from __future__ import annotations

from dataclasses import dataclass
from decimal import Context, Decimal
from fractions import Fraction
from typing import Literal, NoReturn, Self

from zwidth.errors import InputError
from zwidth.model.environment.environment import Environment, PowerLaw, clamping
from zwidth.model.environment.wording import never_pulls, with_unit
from zwidth.quantity.exact import Exact, RealLike
from zwidth.quantity.glossary import GLOSSARY
from zwidth.quantity.parameter import Certain, parameter, plain, read_number
from zwidth.quantity.text import told

LARGEST_EXPONENT = 10
"""A contact much harder than any is."""

DIGITS = 17
"""Digits to which K uⁿ is rounded where n is no whole number: more than a double has."""


@dataclass(frozen=True)
class HuntCrossley(Environment):
    """Contact inside x > 0 whose damping grows with the depth, ``f = K uⁿ (1 + λ v)``.

    v is the backward difference of the measured positions, inside and outside.

    Parameters
    ----------
    stiffness
        K ≥ 0 [N/mⁿ; N·m/radⁿ].
    exponent
        n from 1 to 10. Default 1.5, a sphere on a plane.
    dissipation
        λ ≥ 0 [s/m; s/rad]. Default 0.
    clamped
        True (default) for a contact that never pulls, ``f = max(0, K uⁿ (1 + λ v))``.

    Raises
    ------
    InputError
        If one of them is not such a number, or clamped is not a bool.
    """

    stiffness: Certain = parameter(
        plain("hunt_crossley_stiffness", "K of a Hunt–Crossley contact, in N/mⁿ"),
        kept=Exact,
        bound="≥ 0",
        why="a contact that pulls the hand in has no end",
    )
    exponent: Certain = parameter("exponent", "1.5", kept=Exact)
    dissipation: Certain = parameter(
        "dissipation", 0, kept=Exact, bound="≥ 0", why="it would give energy to the hand"
    )
    clamped: bool = clamping(default=True)

    def __post_init__(self) -> None:
        super().__post_init__()
        if not 1 <= self.exponent <= LARGEST_EXPONENT:
            raise InputError(
                f"exponent must be from 1 to {LARGEST_EXPONENT}, got {self.exponent:g}: below 1 a contact is "
                "stiffest where it begins; a sphere on a plane has 1.5"
            )

    @property
    def unilateral(self) -> bool:
        return True

    @property
    def linear(self) -> bool:
        return False

    @property
    def has_transfer_function(self) -> bool:
        """False."""
        return False

    def unit_of(self, key: str, motion: str = "linear") -> str:
        """The SI unit of a parameter, that of the stiffness with the exponent in it."""
        force, length = ("N*m", "rad") if motion == "rotary" else ("N", "m")
        power = f"^{self.exponent:g}" if self.exponent != 1 else ""
        return {"stiffness": f"{force}/{length}{power}", "dissipation": f"s/{length}"}.get(key, "1")

    def force(self, position: RealLike, velocity: RealLike = 0) -> Exact:
        """f at a position [m; rad] and a velocity [m/s; rad/s], K uⁿ as `resting_force` has it [N; N·m].

        Raises
        ------
        InputError
            If one of them is no finite number.
        """
        x = read_number(position, GLOSSARY["position"], "position").fraction
        v = read_number(velocity, GLOSSARY["speed"], "velocity").fraction
        f = resting_force(self.stiffness.fraction, self.exponent.fraction, x)
        f *= 1 + self.dissipation.fraction * v
        return Exact(max(f, Fraction(0)) if self.clamped else f)

    def pulse_transfer_function(self, sample_period: Fraction) -> NoReturn:
        """There is none.

        Raises
        ------
        InputError
            Always: only a linear law has an H(z).
        """
        raise InputError(
            "a Hunt–Crossley contact has no H(z): the law is not linear; "
            "zwidth.check, zwidth.simulate and zwidth.limit take it"
        )

    def scaled(self, factor: Fraction) -> Self:
        """The contact with factor · K, exactly: every force times the factor."""
        return self.replace(stiffness=Exact(self.stiffness.fraction * factor))

    def describe(self, motion: str = "linear") -> str:
        """The law with its numbers, on one line, in linear or rotary units."""
        k = told(self.stiffness, self.unit_of("stiffness", motion))
        parts = [k, f"exponent {self.exponent:g}"]
        if self.dissipation:
            parts.append(with_unit("dissipation", self.dissipation, motion))
        return f"Hunt–Crossley contact, {', '.join(parts)}{never_pulls(self.clamped)}"

    @property
    def fed_with(self) -> Literal["position", "penetration"]:
        """The position: v is the difference of readings inside and outside."""
        return "position"

    @property
    def power_law(self) -> PowerLaw:
        """K, n and λ."""
        return PowerLaw(self.stiffness, self.exponent, self.dissipation)


def resting_force(stiffness: Fraction, exponent: Fraction, position: Fraction) -> Fraction:
    """K uⁿ for u = max(x, 0): exact where n is a whole number, else rounded to `DIGITS` digits [N; N·m]."""
    if position <= 0 or stiffness == 0:
        return Fraction(0)
    if exponent.denominator == 1:
        return stiffness * position**exponent.numerator
    wide = Context(prec=2 * DIGITS)
    k, n, u = (
        wide.divide(Decimal(v.numerator), Decimal(v.denominator)) for v in (stiffness, exponent, position)
    )
    exact = wide.multiply(k, wide.power(u, n))
    return Fraction(Context(prec=DIGITS).plus(exact))
