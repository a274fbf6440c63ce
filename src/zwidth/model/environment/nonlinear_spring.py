"""The nonlinear spring: a force given by points, for detents, magnets, bump stops, contact.

    f(x) = fᵢ + (fᵢ₊₁ − fᵢ)(x − xᵢ)/(xᵢ₊₁ − xᵢ)      for xᵢ ≤ x ≤ xᵢ₊₁

and constant beyond the first and the last point.  The sign is that of every
law here: f > 0 pushes towards smaller x, so that the handle rests where f rises
through 0.  There is no memory, and no H(z).
"""

from __future__ import annotations

from bisect import bisect_right
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise
from typing import NoReturn, Self

from zwidth.errors import InputError
from zwidth.model.environment.coefficients import read_coefficient
from zwidth.model.environment.environment import Environment
from zwidth.model.environment.wall import NEGATIVE_SPRING
from zwidth.model.environment.wording import with_unit
from zwidth.quantity.exact import Exact, RealLike
from zwidth.quantity.glossary import GLOSSARY, Quantity
from zwidth.quantity.parameter import Numbers, listed, read_number

MOST_POINTS = 10_000
"""More points than any force profile is measured with."""

_HARDENING = Quantity("hardening", "H", "N/m^3", "N*m/rad^3", "of a stop, with the cube of the depth")


@dataclass(frozen=True)
class NonlinearSpring(Environment):
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

        Raises
        ------
        InputError
            If one of them is not such a number.
        """
        _check_count(count, "count", 1)
        p, top = _positive(pitch, "pitch", "position"), _positive(force, "force", "force")
        inner = [(k * p + side * p / 4, side * top) for k in range(count) for side in (-1, 1)]
        points = [(-p / 2, Fraction(0)), *inner, ((count - 1) * p + p / 2, Fraction(0))]
        return cls(*zip(*points, strict=True))

    @classmethod
    def bump_stop(
        cls,
        start: RealLike,
        stiffness: RealLike,
        hardening: RealLike,
        depth: RealLike,
        points: int = 32,
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

        Raises
        ------
        InputError
            If one of them is not such a number.
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

    @property
    def linear(self) -> bool:
        return False

    @property
    def has_transfer_function(self) -> bool:
        """False."""
        return False

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

    def pulse_transfer_function(self, sample_period: Fraction) -> NoReturn:
        """There is none.

        Raises
        ------
        InputError
            Always: only a linear law has an H(z).
        """
        raise InputError(
            "a nonlinear spring has no H(z): the law is not linear; "
            "zwidth.check, zwidth.simulate and zwidth.limit take it"
        )

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
        """(xᵢ, fᵢ) [m; rad], [N; N·m]."""
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
