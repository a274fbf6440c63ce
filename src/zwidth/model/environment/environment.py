"""The environment: what the hand meets.

Every linear environment is, in contact, a pulse transfer function H(z) from the sampled position to the
force, exact in its parameters.  That is all that the criteria need; what happens at the surface is said by
`unilateral`, and whether the law may pull by `clamped`.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, fields, replace
from fractions import Fraction
from typing import Any, Literal, NamedTuple, Self

from zwidth.errors import InputError
from zwidth.quantity.exact import Exact, Interval
from zwidth.quantity.glossary import GLOSSARY
from zwidth.quantity.parameter import Parametric, flag
from zwidth.quantity.text import told_quantity


class RationalFunction(NamedTuple):
    """H(z) = numerator/denominator, exact, in descending powers of z."""

    numerator: tuple[Fraction, ...]
    denominator: tuple[Fraction, ...]


@dataclass(frozen=True)
class Average:
    """A velocity over the samples of a window, v(k) = Σ w_j (x(k−j) − x(k−j−1))/T."""

    weights: tuple[Fraction, ...]

    @property
    def gain(self) -> Fraction:
        """Σ|w_j|."""
        return sum((abs(w) for w in self.weights), Fraction(0))

    @property
    def variation(self) -> Fraction:
        """T ‖h_v‖₁ = |w_0| + Σ|w_j − w_{j−1}|, what comes after the last weight included."""
        steps = zip((*self.weights, Fraction(0)), (Fraction(0), *self.weights), strict=True)
        return sum((abs(w - before) for w, before in steps), Fraction(0))

    @property
    def document(self) -> list[str]:
        """As exact data."""
        return [str(w) for w in self.weights]


@dataclass(frozen=True)
class Decay:
    """The same of one pole, whose weights decay: w_j = (1 − p) pʲ, 0 ≤ p < 1."""

    pole: Fraction

    @property
    def gain(self) -> Fraction:
        """Σ|w_j| = 1."""
        return Fraction(1)

    @property
    def variation(self) -> Fraction:
        """T ‖h_v‖₁ = 2 (1 − p)."""
        return 2 * (1 - self.pole)

    @property
    def document(self) -> dict[str, str]:
        """As exact data."""
        return {"pole": str(self.pole)}


class DampedSpring(NamedTuple):
    """K x + B v, the velocity estimated as V(z) x, or with weights w_j where the estimate has such."""

    stiffness: Fraction
    damping: Fraction
    velocity: RationalFunction
    weights: Average | Decay | None


class PowerLaw(NamedTuple):
    """f = K uⁿ (1 + λ v), u = max(x, 0), v the backward difference of x."""

    stiffness: Exact
    exponent: Exact
    dissipation: Exact


class Stepped(NamedTuple):
    """A law that is stepped as a scene is: what its step reads, and the energy in it at first [J]."""

    numbers: Iterable[float]
    stored: float


class CouplingLaw(NamedTuple):
    """K and B of a spring and damper by backward Euler, f_k = K u_k + B (u_k − u_{k−1})/T."""

    stiffness: Fraction
    damping: Fraction


class Box(NamedTuple):
    """Which numbers of a loop are intervals."""

    of_law: frozenset[str]
    """Fields of the law."""

    of_timing: frozenset[str]
    """Of "sample_period" and "delay"."""

    is_undelayed: bool
    """True where the delay is 0 for certain."""

    covers_contact: bool
    """True where contact made and broken is covered at every corner."""


@dataclass(frozen=True, kw_only=True)
class Environment(Parametric, ABC):
    """What renders a force from sampled positions.

    A subclass is a frozen data class whose fields are made by `parameter`, `flag`
    or `part` of `zwidth.quantity.parameter`, and implements `pulse_transfer_function` and `describe`.
    Whatever else is asked of a law has a default that claims nothing.
    """

    @property
    def unilateral(self) -> bool:
        """True when the law acts only for x > 0, as a wall does."""
        return False

    @property
    def clamped(self) -> bool:
        """True when the law never pulls: a force below 0 is given as 0."""
        return False

    @property
    def linear(self) -> bool:
        """True when H(z) says all about the law in contact."""
        return not self.clamped

    @property
    def has_transfer_function(self) -> bool:
        """True when there is an H(z) for contact that is kept."""
        return True

    @property
    def spring(self) -> bool:
        """True when the law is a memoryless spring, f = K x."""
        return False

    @abstractmethod
    def pulse_transfer_function(self, sample_period: Fraction) -> RationalFunction:
        """H(z) in sustained contact for the sample period T [s].

        Raises
        ------
        InputError
            If the law has no H(z) at this period or at any, or a parameter is an interval.
        """

    def replace(self, **changes: Any) -> Self:
        """The same environment with some parameters changed."""
        return replace(self, **changes)

    @property
    def is_certain(self) -> bool:
        """True when no parameter, here or in a part, is an interval."""
        return not any(_uncertain(getattr(self, f.name)) for f in fields(self))

    @property
    def coefficients_rounded(self) -> bool:
        """True when H(z) holds doubles nearest to numbers that no decimal can write."""
        return False

    @abstractmethod
    def describe(self, motion: str = "linear") -> str:
        """The law with its numbers, on one line, in linear or rotary units."""

    @property
    def fed_with(self) -> Literal["position", "penetration"]:
        """What a law with a surface is computed from: the position x, or the penetration max(x, 0)."""
        return "penetration"

    @property
    def surface(self) -> Literal["none", "position", "penetration"]:
        """Where the law acts: everywhere, "none"; or for x > 0 only, computed from what is named."""
        return self.fed_with if self.unilateral else "none"

    @property
    def rests_on_spring(self) -> bool:
        """True where all of the force at rest is that of the parameter `stiffness`, f = K x inside."""
        return False

    @property
    def points(self) -> tuple[tuple[Exact, Exact], ...]:
        """(xᵢ, fᵢ) of a spring that points give [m; rad], [N; N·m]; none of any other law."""
        return ()

    @property
    def power_law(self) -> PowerLaw | None:
        """The numbers of a law K uⁿ (1 + λ v); None of any other."""
        return None

    def damped_spring(self, sample_period: Fraction) -> DampedSpring | None:
        """The numbers of a law K x + B v at the sample period T [s]; None of any other.

        Raises
        ------
        InputError
            If one of them is an interval.
        """
        return None

    @property
    def passive_backward(self) -> bool:
        """True where Σ f_k (x_k − x_{k−1}) ≥ −S for every motion is known of how the law is made."""
        return False

    @property
    def starts_at_rest(self) -> bool:
        """True where the law is at rest wherever a touch starts, as what is `stepped` is."""
        return False

    @property
    def coupling(self) -> CouplingLaw | None:
        """The spring and damper that stand before a law which is `passive_backward`; None where none do.

        Raises
        ------
        InputError
            If one of their numbers is an interval.
        """
        return None

    def stepped(self, sample_period: Fraction, couplings: tuple[CouplingLaw, ...] = ()) -> Stepped | None:
        """What the simulator steps in the place of H(z), couplings first; None of most laws.

        Raises
        ------
        InputError
            If one of its numbers is an interval.
        """
        return None

    def side_by_side(self) -> tuple[Environment, ...]:
        """Laws with an H(z) whose forces add up to this one's: the terms of a sum, or the law itself."""
        return (self,)

    def scaled(self, factor: Fraction) -> Environment | None:
        """The law with its force times a factor, exactly; None where it is not given by its force."""
        return None

    def unit_of(self, key: str, motion: str = "linear") -> str:
        """The SI unit of a parameter."""
        return GLOSSARY[key].unit_for(motion)

    def decided_by_corners(self, box: Box) -> bool:
        """True where passivity at every corner of a box of parameters proves it for all values within.

        So it is where what the law asks of the device is convex, or monotone, in each of them.
        """
        return False

    def least_demanding(self, is_ideal: bool) -> Self | None:
        """The law within its intervals that is active only if all of them are; None where none is known.

        Parameters
        ----------
        is_ideal
            True on a device without delay and encoder counts.
        """
        return None

    @property
    def met(self) -> Environment:
        """What the hand meets, without the laws that render it."""
        return self

    def around(self, environment: Environment) -> Environment:
        """Another environment, rendered by the laws that render this one, if any do."""
        return environment


def _uncertain(value: object) -> bool:
    if isinstance(value, Interval):
        return True
    if isinstance(value, tuple):
        return any(_uncertain(v) for v in value)
    return isinstance(value, Environment) and not value.is_certain


def clamping(default: bool = False) -> Any:
    """The field `clamped` of a law that may be told never to pull."""
    more = ", f = max(0, …); by default only of a Hunt–Crossley contact"
    return flag("for a law that never pulls", default, more=more)


def certain(value: Exact | Interval, key: str) -> Fraction:
    """The exact value of a parameter that H(z) is computed from."""
    if isinstance(value, Interval):
        raise InputError(f"{key} is the interval {value}; H(z) needs one value of it")
    return value.fraction


def multiply(a: tuple[Fraction, ...], b: tuple[Fraction, ...]) -> tuple[Fraction, ...]:
    """The product of two polynomials, descending powers."""
    product = [Fraction(0)] * (len(a) + len(b) - 1)
    for i, x in enumerate(a):
        for j, y in enumerate(b):
            if x and y:  # most coefficients are 0, and a sum of fractions is dear
                product[i + j] = product[i + j] + x * y if product[i + j] else x * y
    return tuple(product)


def add(a: tuple[Fraction, ...], b: tuple[Fraction, ...]) -> tuple[Fraction, ...]:
    """The sum of two polynomials, descending powers."""
    length = max(len(a), len(b))
    x = (Fraction(0),) * (length - len(a)) + a
    y = (Fraction(0),) * (length - len(b)) + b
    return tuple(p + q if p and q else p or q for p, q in zip(x, y, strict=True))


_SUPERSCRIPT = str.maketrans("0123456789", "⁰¹²³⁴⁵⁶⁷⁸⁹")
_LONGEST = 6


def with_unit(key: str, value: Exact | Interval, motion: str) -> str:
    """A value and the unit its glossary entry has for the motion."""
    return told_quantity(value, key, motion)


def never_pulls(clamped: bool) -> str:
    """How the line of a clamped law ends."""
    return ", never pulls" if clamped else ""


def polynomial_text(coefficients: Sequence[float], variable: str) -> str:
    """A polynomial in descending powers; only its order if it is long."""
    order = len(coefficients) - 1
    if order > _LONGEST:
        return f"[order {order}]"
    terms = [_term(c, order - i, variable) for i, c in enumerate(coefficients) if c]
    return " + ".join(terms).replace("+ -", "− ").replace("-", "−") or "0"


def _term(coefficient: float, power: int, variable: str) -> str:
    number = f"{coefficient:.6g}"
    if power == 0:
        return number
    symbol = variable if power == 1 else variable + str(power).translate(_SUPERSCRIPT)
    return symbol if number == "1" else f"{number} {symbol}"
