"""One arm of a pair in samples, and what moves within a sample lose.

Compensation of friction under a line h + s v takes h of Coulomb friction, s/2 of damping and C + s/2 of local
damping (`covering_wall`).  Of an arm whose drive reads more often it is computed once in T all the same: it
takes w (s/2 + (C + s/2) cos θ) from what the moves of a whole sample lose.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from decimal import ROUND_FLOOR, Context, Decimal
from fractions import Fraction
from functools import cached_property
from math import lcm

import numpy as np
from flint import fmpq, fmpz_poly
from numpy.typing import NDArray

from zwidth.model.pairs import Side
from zwidth.passivity.covering_wall import Line, line_of
from zwidth.quantity.balls import as_fmpq, as_fraction

Floats = NDArray[np.float64]
_NONE = fmpq(0)


@dataclass(frozen=True)
class Arm:
    """One side in samples: `whole` + `part` of delay, `age` of the other's reading, and its weight.

    `often` is how many readings of its own it takes in a sample period, `tangent` the r of its compensation,
    `any_mean` true where that may take any mean of past moves for the speed; `least` a β and γ of few digits
    that stand for those of a drive, `inside`.
    """

    side: Side
    period: Fraction
    weight: Fraction
    often: int = 1
    tangent: Fraction = Fraction(1)
    any_mean: bool = False
    least: tuple[Fraction, Fraction] | None = None

    @cached_property
    def line(self) -> Line:
        """Above what it compensates of Coulomb friction."""
        return line_of(self.side.compensation, self.tangent)

    def at_tangent(self, r: Fraction) -> Arm:
        """With another line."""
        return self if r == self.tangent else replace(self, tangent=r)

    @cached_property
    def helped(self) -> tuple[Fraction, Fraction]:
        """s/2 and C + s/2, what compensation takes of damping and local damping; C + s and 0 of any mean."""
        slope, viscous = self.line.slope, self.side.compensation.viscous.fraction
        if self.any_mean:
            return viscous + slope, Fraction(0)
        return slope / 2, viscous + slope / 2

    @property
    def damping(self) -> Fraction:
        """b, less what compensation takes of it; all of b where its drive reads more often."""
        return self.side.damping - self.helped[0] if self.often == 1 else self.side.damping

    @property
    def of_own_speed(self) -> Fraction:
        """B + D, less what compensation takes, as `damping`."""
        both = self.side.virtual_damping + self.side.local_damping
        return both - self.helped[1] if self.often == 1 else both

    @cached_property
    def whole(self) -> int:
        """d."""
        return int(self.side.delay // self.period)

    @cached_property
    def part(self) -> Fraction:
        """α."""
        return self.side.delay / self.period - self.whole

    @cached_property
    def age(self) -> int:
        """n."""
        return int(-(-self.side.link_delay // self.period))

    @cached_property
    def echo_age(self) -> int:
        """Samples after which its own reading comes back to it in the other's force."""
        return self.age + int(-(-self.side.return_delay // self.period))

    @property
    def oldest(self) -> int:
        """Of the readings that it uses, in samples."""
        return self.echo_age if any(self.echo) else self.age

    @property
    def mixed(self) -> list[tuple[int, Fraction]]:
        """Powers of ζ at which its force acts within a sample, and in which part of it."""
        late = [(self.whole + 1, 1 - self.part)]
        return [*late, (self.whole + 2, self.part)] if self.part else late

    @property
    def own(self) -> tuple[Fraction, Fraction]:
        """Taps of its own readings, the newest first."""
        past = self.often * self.of_own_speed / self.period
        return self.side.stiffness + past, -past

    @cached_property
    def inside(self) -> tuple[Fraction, Fraction]:
        """β and γ of a drive: what a move between two of its own readings loses, and with the one before."""
        if self.least is not None:
            return self.least
        lost = self.damping - self.side.stiffness * self.period / self.often / 2
        return self.weight * lost, self.weight * self.of_own_speed

    def rounded(self, digits: int) -> tuple[Fraction, Fraction]:
        """β' and γ' of so many digits, β' + γ' cos φ ≤ β + γ cos φ at every φ: β − β' ≥ |γ − γ'|."""
        beta, gamma = self.inside
        if self.often == 1:
            return beta, gamma
        near = Fraction(f"{float(gamma):.{digits - 1}e}")
        below = beta - abs(gamma - near)
        context = Context(prec=digits, rounding=ROUND_FLOOR)
        return Fraction(context.divide(Decimal(below.numerator), Decimal(below.denominator))), near

    @property
    def driven(self) -> tuple[fmpz_poly, fmpz_poly]:
        """M_ii of a drive, top and bottom in c, both positive where β > |γ| and nothing is compensated.

        From Σ_l 1/(y − cos φ_l) = m U_{m−1}(y)/(T_m(y) − cos θ), y = −β/γ.
        """
        top, bottom = self._within
        still, moving = (self.weight * v for v in self.helped)
        if self.often == 1 or not (still or moving):
            return top, bottom
        scale = lcm(still.denominator, moving.denominator)
        taken = fmpz_poly([int(v * scale) for v in (still, moving)])
        return scale * top - taken * bottom, scale * bottom

    @property
    def _within(self) -> tuple[fmpz_poly, fmpz_poly]:
        beta, gamma = self.inside
        if gamma == 0:
            return fmpz_poly([beta.numerator]), fmpz_poly([beta.denominator])
        scale = lcm(beta.denominator, gamma.denominator)
        b, g, m = int(beta * scale), int(gamma * scale), self.often
        if m == 1:
            return fmpz_poly([b, g]), fmpz_poly([scale])
        t, u = _homogeneous(fmpz_poly.chebyshev_t(m), b, g), _homogeneous(fmpz_poly.chebyshev_u(m - 1), b, g)
        at = (-g) ** m
        return (
            (b + g) * m * fmpz_poly([t, -at]),
            scale * (m * fmpz_poly([t, -at]) + g * u * fmpz_poly([1, -1])),
        )

    def driven_at(self, theta: float) -> float:
        """M_ii of a drive at a frequency θ, to rounding [N·s/m; N·m·s/rad]."""
        beta, gamma = map(float, self.inside)
        still, moving = (float(self.weight * v) for v in self.helped)
        if self.often == 1:
            return float(beta + gamma * np.cos(theta))
        lost = 1 / float(np.sum(self.shares(theta) / (beta + gamma * np.cos(self.places(theta)))))
        return lost - still - moving * float(np.cos(theta))

    def places(self, theta: float) -> Floats:
        """φ_l."""
        return np.asarray((theta + 2 * np.pi * np.arange(self.often)) / self.often)

    def shares(self, theta: float) -> Floats:
        """(1 − cos θ)/(m² (1 − cos φ_l)), which add up to 1."""
        if theta == 0:
            return np.asarray([1.0] + [0.0] * (self.often - 1))
        return np.asarray((np.sin(theta / 2) / (self.often * np.sin(self.places(theta) / 2))) ** 2)

    @property
    def slips(self) -> bool:
        """True where it gains between two samples, by itself."""
        beta, gamma = self.inside
        return self.often > 1 and (beta < abs(gamma) or beta == -gamma)

    @property
    def other(self) -> tuple[Fraction, Fraction]:
        """Taps of the readings that it received."""
        past = (self.side.virtual_damping + self.side.echo_damping) / self.period
        return -self.side.felt_stiffness - past, past

    @property
    def echo(self) -> tuple[Fraction, Fraction]:
        """Taps of its own readings that come back in the other's force."""
        past = self.side.echo_damping / self.period
        return self.side.echo_stiffness + past, -past

    @property
    def own_row(self) -> dict[int, Fraction]:
        """Taps of all its own readings, by their age in samples, where its drive reads no more often."""
        row: dict[int, Fraction] = {}
        for age, taps in ((0, self.own), (self.echo_age, self.echo)):
            for k, tap in enumerate(taps):
                row[age + k] = row.get(age + k, Fraction(0)) + tap
        return {age: tap for age, tap in row.items() if tap}

    @property
    def other_row(self) -> dict[int, Fraction]:
        """The same of the readings that it received."""
        return {self.age + k: tap for k, tap in enumerate(self.other) if tap}

    @property
    def paying(self) -> Fraction:
        """b, which pays for moves inside a sample; a thousandth of KT of an arm that has none."""
        return self.damping if self.damping > 0 else self.side.felt_stiffness * self.period / 1000

    def force_error(self, other: Arm) -> Fraction:
        """The largest error of its force by the steps of both encoders [N; N·m]."""
        mine, its = self.error_of_steps
        steps = as_fmpq(self.side.resolution), as_fmpq(other.side.resolution)
        return as_fraction(mine * steps[0] + its * steps[1])

    @cached_property
    def error_of_steps(self) -> tuple[fmpq, fmpq]:
        """The same of one step of its own encoder, and of the other's."""
        side, period = self.side, as_fmpq(self.period)
        past = self.often * as_fmpq(self.of_own_speed) / period
        back = as_fmpq(side.echo_damping) / period
        taps = as_fmpq(side.stiffness) + past, -past, as_fmpq(side.echo_stiffness) + back, -back
        row: dict[int, fmpq] = {}
        ages = (0, 1, self.echo_age, self.echo_age + 1) if self.often == 1 else range(4)
        for age, tap in zip(ages, taps, strict=True):
            row[age] = row.get(age, 0) + tap
        still, moving = self.helped
        unsure = still if self.often == 1 else still + moving
        heard = as_fmpq(side.virtual_damping) / period + back
        mine = sum(map(abs, row.values()), _NONE) / 2 + as_fmpq(unsure) / period
        return mine, (abs(as_fmpq(side.felt_stiffness) + heard) + abs(heard)) / 2

    def missing_friction(self, other: Arm) -> Fraction:
        """What it lacks of Coulomb friction for the steps of both encoders and for its compensation."""
        return self.force_error(other) + self.line.height - self.side.coulomb_friction

    def roughly_missing(self, other: Arm) -> Callable[[float, float], float]:
        """The same to rounding, as it depends on the height and the slope of the line."""
        flat, period, count = self.at_tangent(Fraction(1)), float(self.period), float(self.side.resolution)
        still = float(flat.helped[0])
        together = self.often == 1 and not self.any_mean
        row = {age: float(tap) for age, tap in flat.own_row.items()} if together else {}
        rest = flat.missing_friction(other) - flat.line.height
        fixed = float(rest) - (sum(map(abs, row.values())) / 2 + still / period) * count * together

        def missing(height: float, slope: float) -> float:
            if not together:
                return fixed + height + slope / period * count
            past = slope / 2 / period
            taps = row | {0: row.get(0, 0.0) - past, 1: row.get(1, 0.0) + past}
            return fixed + height + (sum(map(abs, taps.values())) / 2 + (still + slope / 2) / period) * count

        return missing


def _homogeneous(p: fmpz_poly, b: int, g: int) -> int:
    """gⁿ p(b/g), n the degree."""
    total, power = 0, 1
    for c in reversed(p.coeffs()):
        total, power = total * b + int(c) * power, power * g
    return total
