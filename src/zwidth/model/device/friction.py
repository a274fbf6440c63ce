"""From a measured friction curve to the Coulomb-plus-viscous model below it.

Real friction has stiction and bends.  Where the friction f(v) is at least f_c + b v at every speed, every
passivity proof made with (f_c, b) holds (Abbott & Okamura 2005, section III-D and Fig. 6).  The models below
a curve through the points (v_i, f_i) are the polygon

    f_c ≥ 0,   0 ≤ b ≤ s,   f_c + b v_i ≤ f_i  for all i,

with s the slope of the last chord.  No model is the largest in both numbers:
the best ones are the upper-right edge of the polygon, exact here.

What is assumed of the speeds that were not measured: between two points friction lies on their chord or above
it; below the first speed, not below the first force; beyond the last speed, not below the last chord
continued (or the last force, where that chord falls).  Hence b ≤ s.  A hand is free to be faster than any
measurement, so this assumption belongs into the claim.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise
from typing import NamedTuple

from zwidth.errors import InputError
from zwidth.quantity.exact import Exact, RealLike
from zwidth.quantity.parameter import Numbers, Parametric, listed

ASSUMPTION = (
    "friction is not below the chords between the measured points, nor below the first force at lower "
    "speeds, nor below the last chord continued (the last force, if that chord falls) at higher speeds"
)


class FrictionModel(NamedTuple):
    """f_c + b v: friction that the device has at least."""

    coulomb_friction: Exact
    damping: Exact


@dataclass(frozen=True)
class FrictionCurve(Parametric):
    """Measured friction: the force f_i at each speed v_i.

    Parameters
    ----------
    speeds
        v_i ≥ 0, strictly increasing, two at least [m/s; rad/s]. A point at
        v = 0 is the stiction, the largest force that does not move the device.
    forces
        f_i ≥ 0 [N; N·m].

    Raises
    ------
    InputError
        If the points are fewer than two, not ordered, negative or not finite.
    """

    speeds: Numbers = listed("speed", meaning="of the points, increasing")
    forces: Numbers = listed("force", meaning="of friction at the points")

    def __post_init__(self) -> None:
        try:
            super().__post_init__()
        except InputError as error:
            raise InputError(f"a friction curve: {error}") from None
        v, f = self.speeds, self.forces
        for name, numbers in (("speeds", v), ("forces", f)):
            if any(n < 0 for n in numbers):
                raise InputError(f"the {name} of a friction curve must be ≥ 0, got {min(numbers):g}")
        if len(v) != len(f) or len(v) < 2:
            raise InputError(
                f"a friction curve needs two points or more, one force for each speed; "
                f"got {len(v)} speeds and {len(f)} forces"
            )
        if any(a.fraction >= b.fraction for a, b in pairwise(v)):
            raise InputError("the speeds of a friction curve must increase from point to point")

    @property
    def assumption(self) -> str:
        """What is taken for granted at the speeds between and beyond the points."""
        return ASSUMPTION

    @property
    def largest_damping(self) -> Exact:
        """The largest b of any model below the curve [N·s/m; N·m·s/rad]."""
        return self.minorants()[-1].damping

    def minorants(self) -> tuple[FrictionModel, ...]:
        """The corners of the best models, from the largest f_c to the largest b.

        Every best model is one of them or lies on the straight line between
        two neighbours: there, f_c cannot grow without b falling.
        """
        return tuple(FrictionModel(Exact(f), Exact(b)) for f, b in self._edge())

    def largest_coulomb_friction(self, damping: RealLike) -> Exact:
        """The largest f_c of a model with this b [N; N·m].

        Raises
        ------
        InputError
            If b is negative or no model below the curve has it.
        """
        b = Exact(damping).fraction
        limit = self._edge()[-1][1]
        if not 0 <= b <= limit:
            raise InputError(
                f"damping must be from 0 to {float(limit):g}, got {float(b):g}: a larger one crosses the "
                "friction curve or rises faster than its last chord"
            )
        return Exact(min(f.fraction - b * v.fraction for v, f in zip(self.speeds, self.forces, strict=True)))

    def best(self, sample_period: RealLike, resolution: RealLike) -> FrictionModel:
        """The model that proves the stiffest spring wall, K = min(2b/T, 2f_c/Δ).

        Parameters
        ----------
        sample_period
            T > 0 [s].
        resolution
            Δ ≥ 0 [m; rad]; with 0 only b counts.
        """
        period, delta = Exact(sample_period).fraction, Exact(resolution).fraction
        if period <= 0 or delta < 0:
            raise InputError(
                f"sample_period must be > 0 s and resolution ≥ 0, got {sample_period} and {resolution}"
            )
        edge = self._edge()
        # Along the edge b/T grows and f_c/Δ falls: the best is where they meet.
        if edge[0][1] * delta >= edge[0][0] * period:
            return FrictionModel(Exact(edge[0][0]), Exact(edge[0][1]))
        for (f0, b0), (f1, b1) in pairwise(edge):
            if b1 * delta >= f1 * period:
                slope = (f0 - f1) / (b1 - b0)
                b = period * (f0 + slope * b0) / (delta + slope * period)
                return FrictionModel(Exact(f0 - slope * (b - b0)), Exact(b))
        return FrictionModel(Exact(edge[-1][0]), Exact(edge[-1][1]))

    def _edge(self) -> list[tuple[Fraction, Fraction]]:
        """The corners (f_c, b): the lower envelope of the lines f_i − b v_i, b rising."""
        points = [(v.fraction, f.fraction) for v, f in zip(self.speeds, self.forces, strict=True)]
        (v0, f0), (v1, f1) = points[-2:]
        steepest = max(Fraction(0), (f1 - f0) / (v1 - v0))
        force, speed, b = *min((f, -v) for v, f in points), Fraction(0)
        speed = -speed
        corners: list[tuple[Fraction, Fraction]] = []
        while True:
            if speed:  # at speed 0 the line is level: a larger b costs nothing
                corners.append((force - b * speed, b))
            last = min(steepest, force / speed) if speed else steepest
            crossings = [((f - force) / (v - speed), -v, f) for v, f in points if v > speed]
            nearest = min(crossings, default=None)
            if nearest is None or nearest[0] >= last:
                break
            b, speed, force = nearest[0], -nearest[1], nearest[2]
        if not corners or last > b:
            corners.append((force - last * speed, last))
        return corners
