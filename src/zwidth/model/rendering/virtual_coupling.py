"""The virtual coupling: a spring and damper between the handle and the environment.

    Z_c(z) = K_c + B_c (z − 1)/(T z)        H = Z_c E/(Z_c + E)

The handle pulls at one end of the coupling, the environment E(z) holds the other (Colgate, Stanley & Brown
1995).  A device without delay that renders a wall of K_c and B_c ≥ 0 passively renders it before every E that
is passive in discrete time, and no less will do for all of them: the coupling bounds what the hand can meet.
With a delay or B_c < 0 more is needed: see `zwidth.passivity.coupling.coupling`.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from zwidth.errors import InputError
from zwidth.model.environment.discretization import trimmed
from zwidth.model.environment.environment import (
    CouplingLaw,
    Environment,
    RationalFunction,
    Stepped,
    add,
    certain,
    multiply,
    with_unit,
)
from zwidth.model.environment.transfer_function import as_environment
from zwidth.model.environment.wall import NEGATIVE_SPRING
from zwidth.quantity.exact import ends
from zwidth.quantity.parameter import Reads, Uncertain, parameter, part


def _behind(given: Any, name: str) -> Environment:
    """The environment, if H(z) says all about it, or if its step takes the coupling in."""
    environment = as_environment(given)
    if not (environment.linear or environment.starts_at_rest):
        raise InputError(
            f"the {name} behind a coupling must be linear, or a zwidth.Scene with a port and no line "
            f"ends, which this is not: {environment.describe()}"
        )
    return environment


@dataclass(frozen=True)
class VirtualCoupling(Environment):
    """A spring–damper in series before an environment, ``H = Z_c E/(Z_c + E)``.

    Parameters
    ----------
    stiffness
        K_c ≥ 0 [N/m; N·m/rad].
    damping
        B_c, of either sign, on the backward difference [N·s/m; N·m·s/rad].
    environment
        E: an `Environment`, or a discrete system of python-control, scipy.signal or harold.

    Raises
    ------
    InputError
        If K_c < 0, or the environment is none, or neither linear nor a scene.
    """

    stiffness: Uncertain = parameter("stiffness", bound="≥ 0", why=NEGATIVE_SPRING)
    damping: Uncertain = parameter("virtual_damping")
    environment: Reads[Environment, Any] = part(
        "environment", _behind, meaning="the environment behind the coupling"
    )

    @property
    def unilateral(self) -> bool:
        return self.environment.unilateral

    @property
    def linear(self) -> bool:
        return self.environment.linear

    @property
    def has_transfer_function(self) -> bool:
        return self.environment.has_transfer_function

    @property
    def starts_at_rest(self) -> bool:
        return self.environment.starts_at_rest

    @property
    def passive_backward(self) -> bool:
        """True before what is so, if B_c ≥ 0."""
        return self.environment.passive_backward and ends(self.damping)[0] >= 0

    @property
    def coupling(self) -> CouplingLaw | None:
        """K_c and B_c before what is passive in the backward pairing; None before anything else."""
        return self._law if self.environment.passive_backward else None

    @property
    def _law(self) -> CouplingLaw:
        return CouplingLaw(certain(self.stiffness, "stiffness"), certain(self.damping, "damping"))

    def stepped(self, sample_period: Fraction, couplings: tuple[CouplingLaw, ...] = ()) -> Stepped | None:
        """The step of a scene with this coupling in it; None before anything else."""
        if not self.starts_at_rest:
            return None
        return self.environment.stepped(sample_period, (*couplings, self._law))

    @property
    def spring(self) -> bool:
        """True when both are springs; H is then K_c K/(K_c + K)."""
        return self._undamped and self.environment.spring

    @property
    def coefficients_rounded(self) -> bool:
        return self.environment.coefficients_rounded

    @property
    def _undamped(self) -> bool:
        return ends(self.damping) == (Fraction(0), Fraction(0))

    def pulse_transfer_function(self, sample_period: Fraction) -> RationalFunction:
        """Z_c E/(Z_c + E) [N/m]; common factors are kept.

        Raises
        ------
        InputError
            If Z_c + E is zero, or so at infinite z: nothing then says where the joint
            between coupling and environment is.
        """
        coupling = self._coupling(sample_period)
        inner = self.environment.pulse_transfer_function(sample_period)
        numerator = multiply(coupling.numerator, inner.numerator)
        denominator = add(
            multiply(coupling.numerator, inner.denominator), multiply(coupling.denominator, inner.numerator)
        )
        return _proper(numerator, denominator)

    def _coupling(self, period: Fraction) -> RationalFunction:
        k, b = certain(self.stiffness, "stiffness"), certain(self.damping, "damping")
        if self._undamped:
            return RationalFunction((k,), (Fraction(1),))
        return RationalFunction((k * period + b, -b), (period, Fraction(0)))

    def describe(self, motion: str = "linear") -> str:
        k = with_unit("stiffness", self.stiffness, motion)
        b = with_unit("virtual_damping", self.damping, motion)
        return f"virtual coupling, {k} and {b}, before {self.environment.describe(motion)}"


def _proper(numerator: tuple[Fraction, ...], denominator: tuple[Fraction, ...]) -> RationalFunction:
    if not any(denominator):
        raise InputError(
            "the stiffness of coupling and environment add up to zero: a coupling of no stiffness before "
            "nothing has no force; give the coupling a stiffness"
        )
    num, den = trimmed(numerator), trimmed(denominator)
    if len(num) > len(den):
        raise InputError(
            "coupling and environment cancel at the newest sample, so the force would need positions that "
            "are still to come; change the damping of the coupling"
        )
    return RationalFunction(num, den)
