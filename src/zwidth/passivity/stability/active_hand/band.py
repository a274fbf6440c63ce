"""The criterion inside the band in which the hand may be active.

Above f₀ the device counts with its damping b, below with b_in: then the loop gives nothing to
a hand of activity a,

    b_in = b − a                               for a ≤ b
    b_in = b (b − a)/(b − a (1 − s₀))          for a > b,  where b > a (1 − s₀)

s₀ = 1 − θ₀²/12 ≤ (sin ½θ/½θ)² for all θ ≤ θ₀ = 2π f₀ T.  Both are b_in of docs/theory/active-hand.md
at its smallest in the band: exact for θ → 0, and too small by a part of less than θ₀²/12 elsewhere.
"""

from __future__ import annotations

from fractions import Fraction
from typing import NamedTuple

from flint import fmpq_poly, fmpz_poly

from zwidth.errors import InputError
from zwidth.passivity.linear.loop import LinearLoop
from zwidth.passivity.linear.positivity import Positivity, prove_nonnegative
from zwidth.quantity.balls import as_fmpq

PI = Fraction(3141592653589793239, 10**18)
"""Above π, by less than 1e-18."""
_TERMS = 30


class Band(NamedTuple):
    """0 … f₀, in the loop's clock.

    Parameters
    ----------
    below
        f₀ [Hz].
    angle
        Not below θ₀ = 2π f₀ T.
    cosine
        Not above cos θ₀.
    """

    below: Fraction
    angle: Fraction
    cosine: Fraction


def band_of(below: Fraction, period: Fraction) -> Band:
    """The band up to f₀."""
    if not 0 < below <= 1 / (2 * period):
        raise InputError(
            f"below must be > 0 and at most half the rate, {float(1 / (2 * period)):g} Hz, got "
            f"{float(below):g} Hz: a hand that is active above has no limit in a sampled loop"
        )
    angle = 2 * PI * below * period
    total, term = Fraction(1), Fraction(1)
    for k in range(1, _TERMS, 2):  # ends with a negative term: from below
        term = -term * angle**2 / ((2 * k - 1) * 2 * k)
        following = -term * angle**2 / ((2 * k + 1) * (2 * k + 2))
        total += term
        if k + 2 < _TERMS:
            total, term = total + following, following
    return Band(below, angle, max(Fraction(-1), _rounded_down(total)))


def _rounded_down(value: Fraction) -> Fraction:
    return Fraction(value.numerator * 10**15 // value.denominator, 10**15)


def damping_inside(damping: Fraction, activity: Fraction, band: Band) -> Fraction | None:
    """b_in [N·s/m]; None where no wall is damped enough for such a hand."""
    if activity <= damping:
        return damping - activity
    rest = damping - activity * band.angle**2 / 12
    return damping * (damping - activity) / rest if rest > 0 else None


def prove_inside(loop: LinearLoop, activity: Fraction, band: Band) -> Positivity | None:
    """A proof that the criterion with b_in holds in the band, in t with 2c = 1 + cos θ₀ + (1 − cos θ₀) t."""
    inside = damping_inside(loop.damping, activity, band)
    if inside is None:
        return None
    half = (1 - band.cosine) / 2
    shift = fmpq_poly([as_fmpq(1 - half), as_fmpq(half)])
    criterion: fmpz_poly = fmpq_poly(loop.with_damping(inside).criterion)(shift).numer()
    found = prove_nonnegative(criterion)
    return found if isinstance(found, Positivity) else None
