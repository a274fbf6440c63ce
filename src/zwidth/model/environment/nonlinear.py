"""Springs and contacts that are not linear: through points, and after Hunt and Crossley.

The nonlinear spring: a force given by points, for detents, magnets, bump stops, contact.

    f(x) = fᵢ + (fᵢ₊₁ − fᵢ)(x − xᵢ)/(xᵢ₊₁ − xᵢ)      for xᵢ ≤ x ≤ xᵢ₊₁

and constant beyond the first and the last point.  The sign is that of every law here: f > 0 pushes towards
smaller x, so that the handle rests where f rises through 0.  There is no memory, and no H(z).
"""

from __future__ import annotations

from bisect import bisect_right
from dataclasses import dataclass
from decimal import Context, Decimal
from fractions import Fraction
from itertools import pairwise
from typing import ClassVar, Literal, NoReturn, Self

from zwidth.errors import InputError
from zwidth.model.environment.environment import Environment, PowerLaw, clamping, never_pulls, with_unit
from zwidth.model.environment.transfer_function import read_coefficient
from zwidth.model.environment.wall import NEGATIVE_SPRING
from zwidth.quantity.exact import Exact, RealLike
from zwidth.quantity.glossary import GLOSSARY, Quantity
from zwidth.quantity.parameter import Certain, Numbers, exact, listed, plain, read_number
from zwidth.quantity.text import shown

MOST_POINTS = 10_000
"""More points than any force profile is measured with."""

_HARDENING = Quantity("hardening", "H", "N/m^3", "N*m/rad^3", "of a stop, with the cube of the depth")


class _Nonlinear(Environment):
    _name: ClassVar[str]

    def pulse_transfer_function(self, sample_period: Fraction) -> NoReturn:
        """There is none.

        Raises
        ------
        InputError
            Always: only a linear law has an H(z).
        """
        raise InputError(
            f"a {self._name} has no H(z): the law is not linear; "
            "zwidth.check, zwidth.simulate and zwidth.limit take it"
        )


@dataclass(frozen=True)
class NonlinearSpring(_Nonlinear):
    """A memoryless spring through points, linear between them and constant beyond.

    It acts on both sides of x = 0.

    Parameters
    ----------
    positions
        xᵢ, strictly increasing, from 2 to 10 000 of them [m; rad].
    forces
        fᵢ, as many, positive towards smaller x [N; N·m].

    Raises
    ------
    InputError
        If they are not lists of numbers, not equally many, too few or too many, or the positions
        do not increase.
    """

    _name = "nonlinear spring"

    positions: Numbers = listed("position", meaning="positions of the points, increasing")
    forces: Numbers = listed("force", meaning="forces at the points, > 0 towards smaller positions")

    def __post_init__(self) -> None:
        super().__post_init__()
        x, f = self.positions, self.forces
        if len(x) != len(f):
            raise InputError(f"a nonlinear spring has a force at each position; got {len(x)} and {len(f)}")
        if not 2 <= len(x) <= MOST_POINTS:
            raise InputError(f"a nonlinear spring has 2 to {MOST_POINTS} points, got {len(x)}")
        for i, (low, high) in enumerate(pairwise(x)):
            if low.fraction >= high.fraction:
                raise InputError(
                    f"positions must increase strictly; positions[{i}] is {low:g} and "
                    f"positions[{i + 1}] is {high:g}"
                )
        read_coefficient(self._steepest(), "the largest slope of a nonlinear spring")

    @classmethod
    def detents(cls, count: int, pitch: RealLike, force: RealLike) -> Self:
        """Detents at 0, p, 2p, …: a triangle wave between −F and F, of slope ±4F/p.

        The handle rests in each of them; half a pitch beyond the first and the last
        the force is 0 and stays so.

        Parameters
        ----------
        count
            How many, ≥ 1.
        pitch
            p > 0 from one to the next [m; rad].
        force
            F > 0 that leads over the edge of one [N; N·m].
        """
        _check_count(count, "count", 1)
        p, top = _positive(pitch, "pitch", "position"), _positive(force, "force", "force")
        inner = [(k * p + side * p / 4, side * top) for k in range(count) for side in (-1, 1)]
        points = [(-p / 2, Fraction(0)), *inner, ((count - 1) * p + p / 2, Fraction(0))]
        return cls(*zip(*points, strict=True))

    @classmethod
    def bump_stop(
        cls, start: RealLike, stiffness: RealLike, hardening: RealLike, depth: RealLike, points: int = 32
    ) -> Self:
        """A stop that hardens, f = K u + H u³ for u = x − x₀ > 0, sampled at even steps of u.

        Deeper than the last point the force is constant.  Between two points the chord
        is above the curve by at most ¾ H D³/(n − 1)².

        Parameters
        ----------
        start
            x₀, where it begins [m; rad].
        stiffness
            K ≥ 0 [N/m; N·m/rad].
        hardening
            H ≥ 0 [N/m³; N·m/rad³].
        depth
            D > 0, the largest u [m; rad].
        points
            n ≥ 2, how many. Default 32.
        """
        _check_count(points, "points", 2)
        x0 = read_number(start, GLOSSARY["position"], "start").fraction
        d = _positive(depth, "depth", "position")
        k, h = (
            read_number(value, quantity, quantity.name, bound="≥ 0", why=NEGATIVE_SPRING).fraction
            for value, quantity in ((stiffness, GLOSSARY["stiffness"]), (hardening, _HARDENING))
        )
        depths = [d * i / (points - 1) for i in range(points)]
        return cls([x0 + u for u in depths], [k * u + h * u**3 for u in depths])

    linear = False
    has_transfer_function = False

    @property
    def largest_slope(self) -> Exact:
        """The largest df/dx, 0 at least, as it is beyond the ends [N/m; N·m/rad]."""
        return Exact(self._steepest())

    def force(self, position: RealLike) -> Exact:
        """f(x) at a position [m; rad], exactly [N; N·m].

        Raises
        ------
        InputError
            If the position is no finite number.
        """
        x = read_number(position, GLOSSARY["position"], "position").fraction
        places = [p.fraction for p in self.positions]
        i = bisect_right(places, x)
        if i == 0 or i == len(places):
            return self.forces[max(i - 1, 0)]
        low, high = self.forces[i - 1].fraction, self.forces[i].fraction
        return Exact(low + (high - low) * (x - places[i - 1]) / (places[i] - places[i - 1]))

    def describe(self, motion: str = "linear") -> str:
        """The points in short and the largest slope, on one line, in linear or rotary units."""
        first, last = (with_unit("position", x, motion) for x in (self.positions[0], self.positions[-1]))
        low, high = (with_unit("force", f(self.forces), motion) for f in (min, max))
        slope = with_unit("stiffness", self.largest_slope, motion)
        return (
            f"nonlinear spring, {len(self.positions)} points from {first} to {last}, "
            f"force {low} to {high}, slope up to {slope}"
        )

    @property
    def points(self) -> tuple[tuple[Exact, Exact], ...]:
        return tuple(zip(self.positions, self.forces, strict=True))

    def scaled(self, factor: Fraction) -> Self:
        """The spring with forces factor · fᵢ."""
        return self.replace(forces=[f.fraction * factor for f in self.forces])

    def _steepest(self) -> Fraction:
        points = list(zip(self.positions, self.forces, strict=True))
        slopes = [
            (f1.fraction - f0.fraction) / (x1.fraction - x0.fraction)
            for (x0, f0), (x1, f1) in pairwise(points)
        ]
        return max(Fraction(0), *slopes)


def _check_count(value: object, key: str, least: int) -> None:
    if isinstance(value, bool) or not isinstance(value, int) or not least <= value <= MOST_POINTS:
        raise InputError(f"{key} is a whole number from {least} to {MOST_POINTS}, got {value!r}")


def _positive(value: RealLike, key: str, quantity: str) -> Fraction:
    number: Exact = read_number(
        value, GLOSSARY[quantity], key, bound="> 0", why="without it there are no points"
    )
    return number.fraction


# Contact after Hunt and Crossley: a spring that stiffens, and damping that grows with the depth.
#
#     f = K uⁿ (1 + λ v),     u = max(x, 0),   v = (x(k) − x(k−1))/T
#
# and f = max(f, 0) where the contact never pulls.  Unlike a Kelvin–Voigt wall it begins without a jump of
# force and lets go without holding back; two bodies that meet at the speed v_i part at about (1 − ⅔ λ v_i)
# v_i.  n = 3/2 is a sphere on a plane (Hertz).
#
# Hunt & Crossley, Journal of Applied Mechanics 42(2), 1975; clamped so that it
# never pulls as in Drake and Simbody, where λ is called the dissipation too.

LARGEST_EXPONENT = 10
"""A contact much harder than any is."""

DIGITS = 17
"""Digits to which K uⁿ is rounded where n is no whole number: more than a double has."""


@dataclass(frozen=True)
class HuntCrossley(_Nonlinear):
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

    _name = "Hunt–Crossley contact"

    stiffness: Certain = exact(
        plain("hunt_crossley_stiffness", "K of a Hunt–Crossley contact, in N/mⁿ"),
        bound="≥ 0",
        why="a contact that pulls the hand in has no end",
    )
    exponent: Certain = exact("exponent", "1.5")
    dissipation: Certain = exact("dissipation", 0, "≥ 0", "it would give energy to the hand")
    clamped: bool = clamping(default=True)

    def __post_init__(self) -> None:
        super().__post_init__()
        if not 1 <= self.exponent <= LARGEST_EXPONENT:
            raise InputError(
                f"exponent must be from 1 to {LARGEST_EXPONENT}, got {self.exponent:g}: below 1 a contact is "
                "stiffest where it begins; a sphere on a plane has 1.5"
            )

    unilateral = True
    linear = False
    has_transfer_function = False

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

    def scaled(self, factor: Fraction) -> Self:
        """The contact with factor · K, exactly: every force times the factor."""
        return self.replace(stiffness=Exact(self.stiffness.fraction * factor))

    def describe(self, motion: str = "linear") -> str:
        """The law with its numbers, on one line, in linear or rotary units."""
        k = shown(self.stiffness, self.unit_of("stiffness", motion), 6)
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
