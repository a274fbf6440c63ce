"""Any linear law, given as H(s) or as H(z), position → force.

Both take coefficients in descending powers, as scipy.signal does, or a system
of python-control, scipy.signal or harold.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import floor, log10
from typing import Any, Self

from zwidth.errors import InputError
from zwidth.model.environment.discretization import (
    LARGEST_ORDER,
    ROUNDED,
    Discretization,
    choices,
    discretize,
    discretized_by,
    trimmed,
)
from zwidth.model.environment.environment import Box, Environment, RationalFunction, polynomial_text
from zwidth.model.environment.system import LinearSystem, is_system, read_system
from zwidth.quantity.exact import Exact, RealLike
from zwidth.quantity.parameter import CertainOrNone, Reads, exact, parameters_of, part
from zwidth.quantity.text import shown

_SAME_PERIOD = Fraction(1, 10**9)
"""Two sample periods that differ by less, relatively, are one."""


def require_period(own: Fraction, given: Fraction) -> None:
    """Refuse a device whose sample period is not that of an H(z) [s]."""
    if abs(own - given) > _SAME_PERIOD * own:
        raise InputError(
            f"H(z) was made for the sample period {shown(own, 's', 12)} and the device samples every "
            f"{shown(given, 's', 12)}; discretize it again, or change the device's rate"
        )


def _side(name: str, *default: None) -> Any:
    """Numerator or denominator, which are read together."""
    return part(
        "coefficients", lambda value, _: value, *default, meaning=f"{name}, descending powers", required=True
    )


class _Ratio(Environment):
    numerator: Any
    denominator: Any

    def scaled(self, factor: Fraction) -> Self:
        """The law factor · H, exactly."""
        return self.replace(numerator=tuple(c.fraction * factor for c in self.numerator))

    def _in(self, variable: str) -> str:
        top, bottom = (polynomial_text(c, variable) for c in (self.numerator, self.denominator))
        return top if bottom == "1" else f"({top})/({bottom})"


@dataclass(frozen=True)
class PulseTransferFunction(_Ratio):
    """A law given as the controller runs it, H(z) from sampled position to force.

    It acts at any position: there is no surface.

    Parameters
    ----------
    numerator, denominator
        Coefficients in descending powers of z [N/m; N·m/rad]; H proper, of order ≤ 200.  Common factors are
        kept.  Or, in the place of both, a discrete system of python-control, scipy.signal or harold.
    sample_period
        T > 0 [s] that the coefficients are meant for; a device of another is then refused.
        None (default) where they do not say.

    Raises
    ------
    InputError
        If H is improper, has a zero denominator or too high an order; if a system is
        continuous, complex, or has several inputs or outputs.
    """

    numerator: Reads[Coefficients, Any] = _side("numerator")
    denominator: Reads[Coefficients, Sequence[RealLike] | None] = _side("denominator", None)
    sample_period: CertainOrNone = exact("sample_period", None, "> 0", "the force is held for T")

    def __post_init__(self) -> None:
        num, den, system = read_transfer_function(self.numerator, self.denominator)
        if len(num) > len(den):
            raise InputError(
                f"H(z) has more zeros ({len(num) - 1}) than poles ({len(den) - 1}): it would need positions "
                "that are still to come; multiply the denominator by a power of z"
            )
        self._keep(numerator=num, denominator=den, sample_period=_period(self.sample_period, system))
        super().__post_init__()

    def pulse_transfer_function(self, sample_period: Fraction) -> RationalFunction:
        """H(z) as given [N/m].

        Raises
        ------
        InputError
            If H(z) was made for another sample period.
        """
        if self.sample_period is not None:
            require_period(self.sample_period.fraction, sample_period)
        return RationalFunction(_fractions(self.numerator), _fractions(self.denominator))

    def describe(self, motion: str = "linear") -> str:
        """The law with its numbers, on one line; coefficients carry no unit of their own."""
        period = "" if self.sample_period is None else f", T = {shown(self.sample_period, 's', 6)}"
        return f"H(z) = {self._in('z')}{period}"

    def decided_by_corners(self, box: Box) -> bool:
        """For T without delay: the requirement is proportional to it."""
        return box.is_undelayed


@dataclass(frozen=True)
class ContinuousTransferFunction(_Ratio):
    """A law given as H(s) from position to force, and how the controller discretizes it.

    It acts at any position: there is no surface.

    Parameters
    ----------
    numerator, denominator
        Coefficients in descending powers of s [N/m; N·m/rad], of order ≤ 200.
        Or, in the place of both, a continuous system of python-control, scipy.signal or harold.
    discretization
        "backward", "forward", "tustin", "zoh", "impulse" or "matched".  Needed: the same
        H(s) may be passive under one and active under another.  The coefficients of H(z)
        are exact for the first three and correctly rounded to doubles for the others.

    Raises
    ------
    InputError
        If the discretization is missing or unknown, H has a zero denominator or too high
        an order; if a system is discrete, complex, or has several inputs or outputs.
    """

    numerator: Reads[Coefficients, Any] = _side("numerator")
    denominator: Reads[Coefficients, Sequence[RealLike] | None] = _side("denominator", None)
    discretization: Reads[Discretization, Discretization | None] = discretized_by(None)

    def __post_init__(self) -> None:
        if self.discretization is None:
            raise InputError(
                "a continuous H(s) needs a discretization, for the verdict depends on it: "
                f"give discretization = one of {choices()}, of a system as "
                "ContinuousTransferFunction(system, discretization=…)"
            )
        super().__post_init__()
        num, den, system = read_transfer_function(self.numerator, self.denominator)
        if system is not None and system.time == "discrete":
            raise InputError("the system is discrete already; give it as PulseTransferFunction(system)")
        self._keep(numerator=num, denominator=den)

    @property
    def coefficients_rounded(self) -> bool:
        """True when H(z) has coefficients rounded to doubles."""
        constant = len(self.numerator) == len(self.denominator) == 1
        return self.discretization in ROUNDED and not constant

    def pulse_transfer_function(self, sample_period: Fraction) -> RationalFunction:
        """H(z) of H(s) [N/m]; common factors are kept.

        Raises
        ------
        InputError
            If the discretization would need samples that are still to come, or cannot be computed in doubles.
        """
        num, den = _fractions(self.numerator), _fractions(self.denominator)
        return discretize(num, den, self.discretization, sample_period)

    def describe(self, motion: str = "linear") -> str:
        """The law with its numbers, on one line; coefficients carry no unit of their own."""
        return f"H(s) = {self._in('s')}, discretization {self.discretization}"


def as_environment(
    thing: object, discretization: Discretization | None = None, device: object = None
) -> Environment:
    """An environment from anything that has an H.

    Parameters
    ----------
    thing
        An environment, which is returned as it is; or a linear system of python-control,
        scipy.signal or harold.
    discretization
        For a continuous system, and for it alone.
    device
        That meets it; an environment that was given in the units of another motion is refused.
    """
    if isinstance(thing, Environment):
        _refuse(discretization, "an environment has its own H(z)")
        motion, given_for = getattr(device, "motion", None), thing.met.given_for
        if motion and given_for is not None and given_for[1] != motion:
            name, other = given_for
            has, wants = (parameters_of(type(thing.met))[name].unit_for(of) for of in (other, motion))
            moves = {"linear": "slides", "rotary": "turns"}[motion]
            raise InputError(f"{name} is given in {has}, and the device {moves}: give it in {wants}")
        return thing
    if not is_system(thing):
        raise InputError(
            f"an environment is a wall, a solid, a transfer function, or a system of python-control, "
            f"scipy.signal or harold; got {thing!r}: a spring is Wall(stiffness=…) [N/m; rotary N·m/rad], "
            "coefficients are PulseTransferFunction(numerator, denominator)"
        )
    system = read_system(thing)
    if system.time == "discrete" or (discretization is None and _is_constant(system)):
        _refuse(discretization, "a discrete system has its own H(z)")
        return PulseTransferFunction(system)
    if system.time == "unsaid" and discretization is None:
        raise InputError(
            "the system has dt=None and so does not say whether it is H(s) or H(z); give it a dt, or write "
            "PulseTransferFunction(system) or ContinuousTransferFunction(system, discretization=…)"
        )
    return ContinuousTransferFunction(system, discretization=discretization)


def _refuse(discretization: object, why: str) -> None:
    if discretization is not None:
        raise InputError(f"discretization = {discretization!r} has nothing to act on: {why}")


def _is_constant(system: LinearSystem) -> bool:
    return len(trimmed(system.numerator)) == len(trimmed(system.denominator)) == 1


def _fractions(coefficients: Coefficients) -> tuple[Fraction, ...]:
    return tuple(c.fraction for c in coefficients)


def _period(given: Exact | None, system: LinearSystem | None) -> Exact | Fraction | None:
    if system is not None and system.time == "continuous" and not _is_constant(system):
        raise InputError(
            "the system is continuous; give it as ContinuousTransferFunction(system, discretization=…) "
            f"with one of {choices()}"
        )
    own = None if system is None else system.sample_period
    if own is not None and given is not None:
        raise InputError("the system has its own sample period; leave sample_period out")
    return own if own is not None else given


Coefficients = tuple[Exact, ...]
"""Descending powers; the first is not zero unless it is the only one."""

Polynomial = tuple[Fraction, ...]

_DECADES = 76
"""Room for every coefficient between the smallest and the largest magnitude of `Exact`."""


def read_transfer_function(
    numerator: object, denominator: Sequence[RealLike] | None
) -> tuple[Coefficients, Coefficients, LinearSystem | None]:
    """Numerator and denominator as a person gives them: two sequences, or a system, read already or not.

    Leading zeros are dropped and nothing else is: common factors stay.
    """
    if isinstance(numerator, LinearSystem):
        return (*_checked(*_in_range(numerator.numerator, numerator.denominator)), numerator)
    if not is_system(numerator):
        if denominator is None:
            raise InputError("a transfer function needs a numerator and a denominator, or a system")
        num, den = _coefficients(numerator, "numerator"), _coefficients(denominator, "denominator")
        return (*_checked(num, den), None)
    if denominator is not None:
        raise InputError("give either a system or a numerator and a denominator, got both")
    system = read_system(numerator)
    return (*_checked(*_in_range(system.numerator, system.denominator)), system)


def _coefficients(given: object, key: str) -> Coefficients:
    if isinstance(given, str) or not isinstance(given, Iterable):
        raise InputError(f"{key} is a list of coefficients in descending powers, got {given!r}")
    return tuple(read_coefficient(c, f"{key}[{i}]") for i, c in enumerate(given))


def read_coefficient(value: Any, key: str) -> Exact:
    """One exact number; `key` names it in a message."""
    try:
        return Exact(value)
    except InputError as error:
        raise InputError(f"{key}: {error}") from None


def _checked(numerator: Coefficients, denominator: Coefficients) -> tuple[Coefficients, Coefficients]:
    num, den = _without_leading_zeros(numerator), _without_leading_zeros(denominator)
    if not any(den):
        raise InputError("the denominator of a transfer function is zero")
    if not num:
        raise InputError("the numerator of a transfer function has no coefficient; for no force give [0]")
    order = max(len(num), len(den)) - 1
    if order > LARGEST_ORDER:
        raise InputError(f"the transfer function has order {order}; at most {LARGEST_ORDER} is read")
    return num, den


def _without_leading_zeros(coefficients: Coefficients) -> Coefficients:
    start = next((i for i, c in enumerate(coefficients) if c.fraction), len(coefficients) - 1)
    return coefficients[max(start, 0) :]


def _in_range(numerator: Polynomial, denominator: Polynomial) -> tuple[Coefficients, Coefficients]:
    """Both polynomials times one power of ten, where they need it to be within range."""
    sizes = [_decade(c) for c in (*numerator, *denominator) if c]
    if sizes and max(sizes) - min(sizes) > _DECADES:
        raise InputError(
            f"the coefficients of the transfer function lie {max(sizes) - min(sizes)} decades apart, "
            f"more than the {_DECADES} that are read; reduce its order, or its fastest modes"
        )
    if sizes and (min(sizes) < -39 or max(sizes) > 39):
        shift = Fraction(10) ** (-(min(sizes) + max(sizes)) // 2)
        numerator, denominator = (tuple(c * shift for c in part) for part in (numerator, denominator))
    num, den = (
        tuple(read_coefficient(c, key) for c in part)
        for part, key in ((numerator, "numerator"), (denominator, "denominator"))
    )
    return num, den


def _decade(value: Fraction) -> int:
    return floor((abs(value.numerator).bit_length() - value.denominator.bit_length()) * log10(2))
