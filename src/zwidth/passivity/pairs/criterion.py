"""The criterion of two arms: a form of both speeds that must not be negative at any frequency.

With p = d_l + n_l + 1 and q = d_f + n_f + 1, whole samples of delay d and ages n, w the weight of each side,

    M_ii = w [b − K T (½ + cos θ + … + cos dθ) + (B + D) cos (d + 1)θ]
    M_lf = ½ [K T (z^{q−1} + … + z^{−(p−1)}) − B_l z^{−p} − w B_f z^q]

M ⪰ 0 is three polynomials in c = cos θ that are not negative on [−1, 1].  Of springs alone they are least at
θ → 0, so that with N = p + q − 1

    (b_l − (2 d_l + 1) KT/2) (w b_f − (2 d_f + 1) KT/2) ≥ (N KT/2)²

with no negative factor is necessary and sufficient; with a delay of part of a sample, and with forces that
are sent, M(0) ⪰ 0 is.  Without delay: 1/b_l + 1/(w b_f) ≤ 2/(KT).

With a drive that reads its own arm m times in T, moves between samples are free: of all that lead from one
sample to the next it loses least by

    M_ii = m²/Σ_l (1 − cos θ)/((1 − cos φ_l)(β + γ cos φ_l)),  φ_l = (θ + 2πl)/m,
    β = w (b − K T/2m),  γ = w (B + D),

which with springs alone is β.  The cross term stays.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cache, cached_property, partial
from math import isqrt, lcm
from typing import Any

import numpy as np
from flint import fmpq, fmpz_poly
from numpy.typing import NDArray

from zwidth.model.pairs import Pair
from zwidth.passivity.covering_wall import best_tangent
from zwidth.passivity.linear.exact_algebra import from_whole_cosines, whole_product
from zwidth.passivity.linear.positivity import Positivity, prove_nonnegative
from zwidth.passivity.pairs.arm import Arm
from zwidth.quantity.balls import as_fmpq, as_fraction

Sums = dict[int, fmpq]
Floats = NDArray[np.float64]
_HALF = fmpq(1, 2)


@dataclass(frozen=True)
class PairCriterion:
    """The form of a pair, exact.

    Attributes
    ----------
    pair
        What it is about.
    tangents
        r of the lines that compensation of friction is taken for, of leader and follower; 1 is F whatever the
        speed: that of motions so large that F is nothing beside their square.
    any_mean
        True where compensation may take any mean of past moves for the speed, and not the last alone.
    losses
        β and γ of few digits in the place of those of both drives, see `with_few_digits`.
    """

    pair: Pair
    tangents: tuple[Fraction, Fraction] = (Fraction(1), Fraction(1))
    any_mean: bool = False
    losses: tuple[tuple[Fraction, Fraction], tuple[Fraction, Fraction]] | None = None

    @cached_property
    def arms(self) -> tuple[Arm, Arm]:
        """Leader and follower."""
        leader, follower = self.pair.sides
        period = self.pair.sample_period
        often, its = self.pair.readings
        first, second = self.tangents
        least, its_least = self.losses or (None, None)
        return (
            Arm(leader, period, Fraction(1), often, first, self.any_mean, least),
            Arm(follower, period, self.pair.power_ratio, its, second, self.any_mean, its_least),
        )

    def with_few_digits(self, digits: int) -> PairCriterion:
        """With what a move inside a sample loses rounded down: what holds of it, holds."""
        leader, follower = (arm.rounded(digits) for arm in self.arms)
        return replace(self, losses=(leader, follower))

    @cached_property
    def forms(self) -> tuple[Sums, Sums, Sums]:
        """M_ll and M_ff by cosines of kθ, M_lf by powers of z."""
        leader, follower = self.arms
        own = [_own(arm) for arm in self.arms]
        crossed = _crossed(leader, follower)
        for here, arm in enumerate(self.arms):
            if not arm.part:
                continue
            loss = as_fmpq(arm.weight * arm.period**2 * arm.part * (1 - arm.part) / (4 * arm.paying))
            mine, its = ({k: as_fmpq(v) for k, v in row.items()} for row in (arm.own_row, arm.other_row))
            for k, row in ((here, mine), (1 - here, its)):
                _add(own[k], ((abs(i - j), -loss * x * y) for i, x in row.items() for j, y in row.items()))
            sign = 1 if here else -1  # of the power of z that a reading of age n has beside one's own
            _add(crossed, ((sign * (j - i), -loss * x * y) for i, x in mine.items() for j, y in its.items()))
        return own[0], own[1], crossed

    @cached_property
    def polynomials(self) -> tuple[fmpz_poly, fmpz_poly, fmpz_poly]:
        """M_ll, M_ff and det M in c, times positive numbers."""
        leader, follower, crossed = self.forms
        echoes = [_echoed({}, arm) for arm in self.arms]
        scale = lcm(*[int(v.q) for form in (*self.forms, *echoes) for v in form.values()])
        powers = [
            (crossed[k] * scale).p if k in crossed else 0 for k in range(min(crossed), max(crossed) + 1)
        ]
        square = whole_product(powers, powers)
        if self.pair.own_readings > 1:
            (top, bottom), (its_top, its_bottom) = (
                _with_echo(*arm.driven, echo, scale) for arm, echo in zip(self.arms, echoes, strict=True)
            )
            return top, its_top, scale**2 * top * its_top - square * bottom * its_bottom
        first, second = (_polynomial(form, scale) for form in (leader, follower))
        return first, second, first * second - square

    @cached_property
    def signs(self) -> tuple[Positivity, Positivity, Positivity] | Fraction:
        """Why none of them is negative; or a c at which one is."""
        found, known = [], self.of_springs and self._holds_at_rest
        for p in self.polynomials:
            sign = prove_nonnegative(p, known)
            if isinstance(sign, Fraction):
                return sign
            found.append(sign)
        first, second, both = found
        return first, second, both

    @property
    def holds(self) -> bool:
        """True where none of them is negative: friction and encoders aside, no motion gains."""
        if self.undamped:
            return False
        if self.of_springs:
            return self._holds_at_rest
        if self.slips or any(p(1) < 0 or p(-1) < 0 for p in self.polynomials):
            return False
        return not isinstance(self.signs, Fraction)

    @cached_property
    def of_springs(self) -> bool:
        """True of springs alone, without drives: M is least at θ → 0, where all its terms have one sign."""
        return self.pair.own_readings == 1 and not any(
            side.virtual_damping or side.local_damping or side.echo_damping or side.compensation
            for side in self.pair.sides
        )

    @property
    def _holds_at_rest(self) -> bool:
        """M ⪰ 0 at θ → 0, of springs alone."""
        first, second, crossed = self.at_rest
        return bool(first >= 0 and second >= 0 and first * second >= crossed**2)

    @cached_property
    def at_rest(self) -> tuple[fmpq, fmpq, fmpq]:
        """M_ll, M_ff and M_lf at θ → 0, of springs alone: all the terms of `forms` added up."""
        arms, period = self.arms, as_fmpq(self.pair.sample_period)
        felt = [as_fmpq(arm.side.felt_stiffness) for arm in arms]
        weight = felt[0] / felt[1]
        own, jumps, ages = [], [], []
        for arm, k, w in zip(arms, felt, (1, weight), strict=True):
            side, b, alpha = arm.side, as_fmpq(arm.side.damping), as_fmpq(arm.part)
            late = arm.whole + alpha
            stretch = k * (late + _HALF) + as_fmpq(side.echo_stiffness) * arm.echo_age
            own.append(w * (b - period * stretch))
            jumps.append(w * (period * k) ** 2 * alpha * (1 - alpha) / (4 * as_fmpq(arm.paying)))
            ages.append(late + arm.age)
        first, second = (loss - sum(jumps) for loss in own)
        return first, second, felt[0] * period / 2 * (sum(ages) + 1) + sum(jumps)

    @property
    def slips(self) -> bool:
        """True where the drive of an arm alone lets it gain between two samples."""
        return any(arm.slips for arm in self.arms)

    @property
    def missing_friction(self) -> tuple[Fraction, Fraction]:
        """What each arm lacks of Coulomb friction for the steps of both encoders and its compensation."""
        leader, follower = self.arms
        return leader.missing_friction(follower), follower.missing_friction(leader)

    @property
    def proves(self) -> bool:
        """True where friction covers the steps of both encoders too, and what is compensated."""
        return max(self.missing_friction) <= 0 and self.holds

    @property
    def ages_may_vary(self) -> bool:
        """True where no more is asked for if readings are younger than said, as they come: springs alone.

        Each of their terms is worst where all have one sign, and so it is bounded whatever the ages are.
        """
        return not any(
            arm.part or arm.of_own_speed or arm.helped[1] or arm.side.virtual_damping or arm.side.echo_damping
            for arm in self.arms
        )

    @property
    def undamped(self) -> bool:
        """True where a force changes inside a sample of an arm without damping: any size of that gains."""
        return any(arm.part and arm.damping <= 0 for arm in self.arms)

    def at(self, theta: float) -> np.ndarray[tuple[int, int], np.dtype[np.complex128]]:
        """M at a frequency θ = ωT, to rounding [N·s/m; N·m·s/rad]."""
        leader, follower, crossed = self.forms
        diagonal = [_at(form, lambda k: np.cos(k * theta)) for form in (leader, follower)]
        if self.pair.own_readings > 1:
            diagonal = [
                arm.driven_at(theta) + _at(_echoed({}, arm), lambda k: np.cos(k * theta)) for arm in self.arms
            ]
        off = _at(crossed, lambda k: np.exp(1j * k * theta))
        return np.array([[diagonal[0], off], [np.conj(off), diagonal[1]]])


def spending(pair: Pair, any_mean: bool = False) -> PairCriterion:
    """The criterion with the lines that leave most damping, of those that Coulomb friction pays for."""
    criterion = PairCriterion(pair, any_mean=any_mean)
    leader, follower = criterion.arms
    tangents = _tangent(leader, follower), _tangent(follower, leader)
    return criterion if tangents == criterion.tangents else replace(criterion, tangents=tangents)


def _tangent(arm: Arm, other: Arm) -> Fraction:
    law = arm.side.compensation
    move = float(arm.side.resolution / arm.period / law.speed.fraction) if law.speed else 0.0
    missing = cache(partial(arm.roughly_missing, other))  # most laws are paid for, or are none
    return best_tangent(
        law,
        move,
        lambda height, slope: missing()(height, slope),
        lambda r: arm.at_tangent(r).missing_friction(other) <= 0,
    )


def _at(form: Sums, wave: Callable[[int], Any]) -> Any:
    return sum(float(as_fraction(v)) * wave(k) for k, v in form.items())


def _own(arm: Arm) -> Sums:
    found = {0: as_fmpq(arm.weight) * as_fmpq(arm.damping)}
    _add_coupling(found, arm, 0, arm.side.stiffness, arm.of_own_speed)
    return _echoed(found, arm)


def _echoed(found: Sums, arm: Arm) -> Sums:
    """With what of its own motion comes back in the other's force."""
    side = arm.side
    if side.echo_stiffness or side.echo_damping:
        _add_coupling(found, arm, arm.echo_age, side.echo_stiffness, side.echo_damping)
    return found


def _add_coupling(found: Sums, arm: Arm, age: int, stiffness: Fraction, damping: Fraction) -> None:
    """Spring and damper of its own readings of an age."""
    weight = as_fmpq(arm.weight)
    stretch, rubbed = weight * as_fmpq(stiffness) * as_fmpq(arm.period), weight * as_fmpq(damping)
    for late, part in arm.mixed:
        power, share = late + age, as_fmpq(part)
        parts = [(0, -stretch * share / 2), *((k, -stretch * share) for k in range(1, power))]
        _add(found, [*parts, (power, share * rubbed)])


def _crossed(leader: Arm, follower: Arm) -> Sums:
    found: Sums = {}
    stretch = as_fmpq(leader.side.felt_stiffness) * as_fmpq(leader.period)
    mine = [(power + leader.age, as_fmpq(share)) for power, share in leader.mixed]
    its = [(power + follower.age, as_fmpq(share)) for power, share in follower.mixed]
    for p, share in mine:
        for q, part in its:
            _add(found, [(k, stretch * share * part / 2) for k in range(1 - p, q)])
        _add(found, ((-p, -share * _rubbed(leader) / 2),))
    rubbed = as_fmpq(follower.weight) * _rubbed(follower)
    _add(found, ((q, -part * rubbed / 2) for q, part in its))
    return found


def _rubbed(arm: Arm) -> fmpq:
    """B of the other's readings."""
    return as_fmpq(arm.side.virtual_damping) + as_fmpq(arm.side.echo_damping)


def _add(form: Sums, parts: Iterable[tuple[int, fmpq]]) -> None:
    for k, value in parts:
        form[k] = form[k] + value if k in form else value


def _with_echo(top: fmpz_poly, bottom: fmpz_poly, echo: Sums, scale: int) -> tuple[fmpz_poly, fmpz_poly]:
    """Of a drive, with what comes back once a sample."""
    if not echo:
        return top, bottom
    back = _polynomial(echo, scale)
    return scale * top + back * bottom, scale * bottom


def _polynomial(sums: Sums, scale: int) -> fmpz_poly:
    """Σ of cosines, times a number that makes each whole, in powers of c."""
    return from_whole_cosines([(sums[k] * scale).p if k in sums else 0 for k in range(max(sums) + 1)])


def largest_spring(pair: Pair) -> Fraction | None:
    """The largest stiffness of springs alone, rounded down in digit 40; None where it has no closed form.

    From (b_l − pκ)(w b_f − qκ) = N² κ², κ = KT/2, the smaller root.
    """
    leader, follower = PairCriterion(pair).arms
    sides = pair.sides
    if (
        any(side.virtual_damping or side.local_damping for side in sides)
        or leader.part
        or follower.part
        or pair.own_readings > 1
        or any(pair.compensations)
        or any(side.reflection for side in sides)
    ):
        return None
    b, f = leader.side.damping, follower.weight * follower.side.damping
    p, q = 2 * leader.whole + 1, 2 * follower.whole + 1
    n = leader.whole + leader.age + follower.whole + follower.age + 1
    linear, square = p * f + q * b, n * n - p * q
    if b == 0 or f == 0:
        return Fraction(0)
    # κ = 2 b f/(linear + √(linear² + 4 square b f)): the same for n² = pq, and without a difference
    under = linear**2 + 4 * square * b * f
    digits = 10**40
    root = Fraction(isqrt(int(under * digits**2)) + 1, digits)
    return 2 * b * f / (linear + root) * 2 / pair.sample_period
