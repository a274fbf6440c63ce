"""Device and hand behind the hold, with error bounds: what a sampled force does to the position.

    M ẍ + D ẋ + k x = −f,    f held from (n + d + α) T on for T

In periods, with η = k T²/M, δ = D T/M and the unit of force M/T², a constant force moves (x, ẋT) from rest by

    γ₂(τ) = Σ tₙ,  γ₁(τ) = τ Σ tₙ/(n + 1),    tₙ = qₙ τⁿ/n!,  q₁ = 1,  qₙ₊₂ = −δ qₙ₊₁ − η qₙ

|qₙ| ≤ Nⁿ with N = max(1, η + δ): what is left out after n terms is at most Nⁿ/n!/(1 − N/n).  In ζ = z − 1,
with s = η γ₁(1) + δ γ₂(1),

    −x/f = z^−e (T²/M) (r(1) [+ ζ r(1 − α)]) / (ζ² + (s + η γ₁) ζ + η (s γ₁ + γ₂²)),
    r(τ) = γ₁(τ) ζ + s γ₁(τ) + γ₂(1) γ₂(τ),    e = d, with the bracket where α > 0 and then e = d + 1
"""

from __future__ import annotations

from fractions import Fraction
from typing import Any, NamedTuple

from ..document.refusal import Invalid
from ..exact.enclosed import Enclosed, apart, between, known

MOST_LATE = 300
LARGEST_NORM = 500

Range = tuple[Fraction, Fraction]


class Motion(NamedTuple):
    """M, D and k, each from … to; T, and the delay in samples."""

    mass: Range
    damping: Range
    stiffness: Range
    period: Fraction
    late: Fraction

    @property
    def is_free(self) -> bool:
        """True without spring and damper: all is rational then."""
        return not (self.damping[1] or self.stiffness[1])

    @property
    def norm(self) -> Fraction:
        """The largest η + δ."""
        return (self.stiffness[1] * self.period + self.damping[1]) * self.period / self.mass[0]

    @property
    def middle(self) -> Motion:
        """One of them, itself where it is certain."""
        mass, damping, stiffness = (((a + b) / 2,) * 2 for a, b in self[:3])
        return self._replace(mass=mass, damping=damping, stiffness=stiffness)

    def halves(self, whole: Motion, wall: Fraction) -> list[Motion]:
        """Cut in two across the side that is longest beside where it lies; the spring lies beside the wall's.

        Damping counts twice: how much there is of it is what most limits hang on.  The choice decides only
        how many boxes it takes; every side is cut in the end, for what counts goes to 0 with its length.
        """
        beside = (Fraction(0), Fraction(0), 4 * abs(wall))
        counts = (1, 2, 1)
        shares = [
            count * (b - a) / (a + b + more + (d - c) / 64) if c < d else 0
            for (a, b), (c, d), more, count in zip(self[:3], whole[:3], beside, counts, strict=True)
        ]
        name = self._fields[shares.index(max(shares))]
        low, high = getattr(self, name)
        cut = (low + high) / 2
        ends: list[dict[str, Any]] = [{name: (low, cut)}, {name: (cut, high)}]
        return [self._replace(**end) for end in ends]


class Sampled(NamedTuple):
    """−x/f = numerator/(z^late · denominator), descending powers of ζ, all Enclosed or all Fraction."""

    numerator: list[Any]
    denominator: list[Any]
    late: int


def motion_of(mass: Range, damping: Range, stiffness: Range, period: Fraction, delay: Fraction) -> Motion:
    """Of mass > 0, damping and stiffness ≥ 0, each from … to."""
    late = delay / period
    if late > MOST_LATE:
        raise Invalid(f"the delay is more than {MOST_LATE} samples")
    return Motion(mass, damping, stiffness, period, late)


def sampled(motion: Motion, bits: int) -> Sampled:
    """The exact hold of every motion in the bounds, above and below times M/M₀, M₀ the middle of M.

    So what enters it once enters to first order alone, and what is left of each number may cancel.
    """
    low, high = motion.mass
    usual = (low + high) / 2
    heavy, light = _near_1(low / usual, high / usual, bits)
    damping, stiffness = between(*motion.damping, 1, 3, bits), between(*motion.stiffness, 2, 3, bits)
    unit = known(motion.period**2 / usual, bits)
    pull, drag = unit * stiffness, known(motion.period / usual, bits) * damping
    spring, loss = light * pull, light * drag
    whole, part = int(motion.late), motion.late % 1
    first, second = _pushed(spring, loss, Fraction(1), bits)
    slow = spring * first + loss * second

    def row(speed: Enclosed, way: Enclosed) -> list[Enclosed]:
        return [unit * speed, unit * (slow * speed + second * way)]

    rest = row(*_pushed(spring, loss, 1 - part, bits)) if part else []
    bent, slowed, drawn = pull * first, drag * second, pull * (slow * first + second * second)
    numbers = [heavy, bent, slowed, drawn, *row(first, second), *rest]
    heavy, bent, slowed, drawn, *moved = apart(numbers)
    denominator = [heavy, bent + slowed + bent, drawn]
    if not part:
        return Sampled(moved, denominator, whole)
    now, then, rest_now, rest_then = moved
    return Sampled([rest_now, rest_then + now, then], denominator, whole + 1)


def _near_1(low: Fraction, high: Fraction, bits: int) -> tuple[Enclosed, Enclosed]:
    """Every 1 + ρε between these ends, and 1/(1 + ρε) = 1 − ρε + ρ²ε²/(1 + ρε)."""
    part = (high - low) / 2
    half = part**2 / (1 - part) / 2
    inverse = known(1 + half, bits).widened(half) - between(-part, part, 0, 3, bits)
    return between(low, high, 0, 3, bits), inverse


def sampled_free(motion: Motion) -> Sampled:
    """The same of a certain mass without spring and damper, exact."""
    unit, rest = motion.period**2 / motion.mass[0], 1 - motion.late % 1
    now, denominator = [unit / 2, unit], [Fraction(1), Fraction(0), Fraction(0)]
    if rest == 1:
        return Sampled(now, denominator, int(motion.late))
    return Sampled([unit * rest**2 / 2, unit * rest + now[0], now[1]], denominator, int(motion.late) + 1)


def _pushed(spring: Enclosed, loss: Enclosed, tau: Fraction, bits: int) -> tuple[Enclosed, Enclosed]:
    """γ₁ and γ₂ after a part τ of a sample."""
    largest = spring.middle + spring.reach + loss.middle + loss.reach
    norm = max(1, -(-largest >> bits))
    if norm > LARGEST_NORM:
        raise Invalid("device and hand move too far within one sample for the series")
    fine = bits + 3 * norm  # its terms are as large as e^norm
    step = known(tau, fine)
    damped = loss.in_bits(fine) * step
    bent = spring.in_bits(fine) * step * step
    before, term = Enclosed(fine, 0), step
    speed, way = term, term.over(2)
    count, left = 1, norm << fine  # Nⁿ/n!, rounded up
    while count < 2 * norm or left > 1:
        before, term = term, (damped * term + (bent * before).over(count)).over(count + 1).times(-1)
        count += 1
        left = left * norm // count + 1
        speed, way = speed + term, way + term.over(count + 1)
    rest = Fraction(left, 1 << fine)  # N < n/2: what follows is less than the last term
    return (way * step).widened(rest).in_bits(bits), speed.widened(rest).in_bits(bits)
