"""Velocity estimators, as people really use them.

Each is a pulse transfer function from sampled position to velocity [1/s]:

    backward difference   (z − 1)/(T z)
    window of N samples   (1 − z⁻ᴺ)/(N T)
    one-pole low-pass     (1 − z⁻¹)/(T + τ (1 − z⁻¹))   (backward Euler of s/(1 + τ s))
    any filter            F(z) · (z − 1)/(T z)
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

from flint import fmpq, fmpq_poly

from zwidth.errors import InputError
from zwidth.model.environment.environment import Average, Decay, RationalFunction, certain, multiply
from zwidth.quantity.exact import Exact, RealLike, ends
from zwidth.quantity.parameter import Parametric, Reads, Uncertain, parameter, part
from zwidth.quantity.text import shown

LONGEST_TIME_CONSTANT = 1000
"""Largest time constant of a velocity filter [s]."""

_ONE = Fraction(1)


@dataclass(frozen=True)
class BackwardDifference:
    """v(k) = (x(k) − x(k−1))/T."""

    def describe(self) -> str:
        """In words."""
        return "backward difference"

    def transfer(self, period: Fraction) -> RationalFunction:
        """(z − 1)/(T z) [1/s]."""
        return RationalFunction((_ONE, -_ONE), (period, Fraction(0)))

    @property
    def time_constant(self) -> None:
        """It has none."""

    def weights(self, period: Fraction) -> Average:
        """The last move alone."""
        return Average((_ONE,))


@dataclass(frozen=True)
class Window:
    """v(k) = (x(k) − x(k−N))/(N T).

    Parameters
    ----------
    samples
        N, 1 ≤ N ≤ 100; 1 is the backward difference.
    """

    samples: int

    def __post_init__(self) -> None:
        number = Exact(self.samples).fraction
        if number.denominator != 1 or not 1 <= number <= 100:
            raise InputError(
                f"a velocity window has a whole number of samples from 1 to 100, got {self.samples}; "
                "a longer one is better written as a one-pole filter"
            )
        object.__setattr__(self, "samples", int(number))

    def describe(self) -> str:
        """In words."""
        return f"window of {self.samples} samples"

    def transfer(self, period: Fraction) -> RationalFunction:
        """(zᴺ − 1)/(N T zᴺ) [1/s]."""
        zeros = (Fraction(0),) * (self.samples - 1)
        return RationalFunction((_ONE, *zeros, -_ONE), (self.samples * period, *zeros, Fraction(0)))

    @property
    def time_constant(self) -> None:
        """It has none."""

    def weights(self, period: Fraction) -> Average:
        """1/N each."""
        return Average((Fraction(1, self.samples),) * self.samples)


@dataclass(frozen=True)
class OnePole(Parametric):
    """τ v̇ + v = ẋ by backward Euler: v(k) = (τ v(k−1) + x(k) − x(k−1))/(τ + T).

    Parameters
    ----------
    time_constant
        τ ≥ 0 [s]; the cut-off frequency is 1/(2πτ).
    """

    time_constant: Uncertain = parameter(
        "time_constant", bound="≥ 0", why="a filter with a negative one grows without bound"
    )

    def __post_init__(self) -> None:
        super().__post_init__()
        if ends(self.time_constant)[1] > LONGEST_TIME_CONSTANT:
            raise InputError(
                f"time_constant must be ≤ {shown(LONGEST_TIME_CONSTANT, 's')}, got "
                f"{shown(self.time_constant, 's')}: a slower filter never follows a hand; check the unit, or "
                "leave the virtual damping out"
            )

    def describe(self) -> str:
        """In words."""
        return f"one-pole filter of {shown(self.time_constant, 's', 6)}"

    def transfer(self, period: Fraction) -> RationalFunction:
        """(z − 1)/((T + τ) z − τ) [1/s]."""
        tau = certain(self.time_constant, "time_constant")
        return RationalFunction((_ONE, -_ONE), (period + tau, -tau))

    def weights(self, period: Fraction) -> Decay:
        """p = τ/(T + τ)."""
        tau = certain(self.time_constant, "time_constant")
        return Decay(tau / (period + tau))


def _coefficients(given: Sequence[RealLike], name: str) -> tuple[Exact, ...]:
    return tuple(Exact(c) for c in given)


@dataclass(frozen=True)
class VelocityFilter(Parametric):
    """F(z) applied to the backward difference.

    Parameters
    ----------
    numerator, denominator
        Coefficients of F in descending powers of z; F proper.
    """

    numerator: Reads[tuple[Exact, ...], Sequence[RealLike]] = part(
        "coefficients", _coefficients, meaning="numerator, descending powers"
    )
    denominator: Reads[tuple[Exact, ...], Sequence[RealLike]] = part(
        "coefficients", _coefficients, meaning="denominator, descending powers"
    )

    def __post_init__(self) -> None:
        super().__post_init__()
        num, den = self.numerator, self.denominator
        while den and den[0] == 0:
            den = den[1:]
        while len(num) > 1 and num[0] == 0:
            num = num[1:]
        if not den or not num:
            raise InputError("a velocity filter needs a numerator and a denominator that is not zero")
        if len(num) > len(den):
            raise InputError(
                f"a velocity filter cannot have more zeros ({len(num) - 1}) than poles ({len(den) - 1}): "
                "it would need samples that are still to come"
            )
        self._keep(numerator=num, denominator=den)

    def describe(self) -> str:
        """In words."""
        return f"velocity filter of order {len(self.denominator) - 1}"

    def transfer(self, period: Fraction) -> RationalFunction:
        """F(z) (z − 1)/(T z) [1/s]."""
        num = tuple(c.fraction for c in self.numerator)
        den = tuple(c.fraction for c in self.denominator)
        return RationalFunction(multiply(num, (_ONE, -_ONE)), multiply(den, (period, Fraction(0))))

    @property
    def time_constant(self) -> None:
        """It has none."""

    def weights(self, period: Fraction) -> Average | None:
        """F(z) = Σ w_j z⁻ʲ; None where it does not end."""
        return finite_response(*(tuple(c.fraction for c in p) for p in (self.numerator, self.denominator)))


VelocityEstimator = BackwardDifference | Window | OnePole | VelocityFilter


def finite_response(numerator: tuple[Fraction, ...], denominator: tuple[Fraction, ...]) -> Average | None:
    """F(z) = Σ w_j z⁻ʲ, if it ends; coefficients in descending powers of z, F proper."""
    late = (Fraction(0),) * (len(denominator) - len(numerator))
    n, d = (
        fmpq_poly([fmpq(c.numerator, c.denominator) for c in part])
        for part in ((*late, *numerator), denominator)
    )
    if n % d != 0:
        return None
    return Average(tuple(Fraction(int(c.p), int(c.q)) for c in (n // d).coeffs()))
