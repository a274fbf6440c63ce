"""Viscoelastic solids: springs with Maxwell branches beside them.

A branch is a spring μ and a dashpot η in series.  Under the position x it gives

    H_i(s) = μ η s/(μ + η s)

at first the spring, in the end nothing, relaxing with the time η/μ.  Then

    Maxwell                 H = H_1
    standard linear solid   H = μ0 + H_1
    generalized Maxwell     H = μ0 + H_1 + H_2 + …      (a Prony series)

A controller runs H(z), which the discretization makes of H(s).  Backward Euler
gives H_i(z) = μ η (z − 1)/((μ T + η) z − η).

The solids are touched and left: they push for x > 0 only.  A clamped one never
pulls, f = max(0, H x): it does not hold back the hand that leaves it quickly.
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import ClassVar, Self

from zwidth.errors import InputError
from zwidth.model.environment.discretization import ROUNDED, Discretization, discretize, discretized_by
from zwidth.model.environment.environment import (
    Box,
    Environment,
    RationalFunction,
    add,
    certain,
    clamping,
    multiply,
    never_pulls,
    with_unit,
)
from zwidth.model.environment.wall import NEGATIVE_SPRING, Wall
from zwidth.quantity.exact import Exact, Interval, ends, times
from zwidth.quantity.glossary import GLOSSARY
from zwidth.quantity.parameter import Given, Reads, Uncertain, parameter, part, read_number

Branch = tuple[Exact | Interval, Exact | Interval]
"""Spring μ and dashpot η in series."""

MOST_BRANCHES = 60
"""More branches than any fitted Prony series has."""


def _branches(given: Iterable[Sequence[Given]], name: str) -> tuple[Branch, ...]:
    if isinstance(given, str) or not isinstance(given, Iterable):
        raise InputError(f"{name} is a list of pairs (stiffness, damping), got {given!r}")
    pairs = [_pair(pair, f"{name}[{i}]") for i, pair in enumerate(given)]
    if len(pairs) > MOST_BRANCHES:
        raise InputError(f"{name} has {len(pairs)} pairs; at most {MOST_BRANCHES} are read")
    return tuple(pairs)


def _pair(pair: Sequence[Given], name: str) -> Branch:
    if isinstance(pair, str) or not hasattr(pair, "__len__") or len(pair) != 2:
        raise InputError(f"{name} is a pair (stiffness, damping), got {pair!r}")
    spring, dashpot = GLOSSARY["branch_stiffness"], GLOSSARY["branch_damping"]
    bounded = {"bound": "≥ 0", "why": NEGATIVE_SPRING}
    mu = read_number(pair[0], spring, f"{name} stiffness", uncertain=True, **bounded)
    return mu, read_number(pair[1], dashpot, f"{name} damping", uncertain=True)


class Solid(Environment):
    """A spring, if it has one, with Maxwell branches beside it."""

    discretization: Discretization
    kind: ClassVar[str]
    branch_numbers: ClassVar[tuple[str, str]]
    """What μ and η of a branch, and of which, are called in messages."""

    unilateral = True
    rests_on_spring = True
    """True: the branches relax to nothing."""

    @property
    @abstractmethod
    def prony(self) -> tuple[Exact | Interval | None, tuple[Branch, ...]]:
        """μ0, None of a solid without such a spring, and (μᵢ, ηᵢ) of the branches."""

    @property
    def spring(self) -> bool:
        return not any(map(_acts, self.prony[1]))

    @property
    def coefficients_rounded(self) -> bool:
        return self.discretization in ROUNDED and any(map(_acts, self.prony[1]))

    def pulse_transfer_function(self, sample_period: Fraction) -> RationalFunction:
        """H(z) [N/m]; of a branch, backward, μ η (z − 1)/((μ T + η) z − η).

        Branches of one relaxation time keep their common factor.
        """
        spring, branches = self.prony
        num: tuple[Fraction, ...] = (Fraction(0) if spring is None else certain(spring, "stiffness"),)
        den: tuple[Fraction, ...] = (Fraction(1),)
        for i, branch in enumerate(branches):
            names = (name.format(i) for name in self.branch_numbers)
            mu, eta = map(certain, branch, names)
            # a branch without spring or dashpot transmits no force
            if mu and eta:
                top, bottom = (mu * eta, Fraction(0)), (eta, mu)
                num, den = add(multiply(num, bottom), multiply(den, top)), multiply(den, bottom)
        return discretize(num, den, self.discretization, sample_period)

    def scaled(self, factor: Fraction) -> Self:
        """The solid factor · H(s), exactly: stiffer, and it relaxes as before."""
        numbers = {key: v for key, v in vars(self).items() if isinstance(v, Exact | Interval)}
        return self.replace(**{key: times(value, factor) for key, value in numbers.items()})

    def describe(self, motion: str = "linear") -> str:
        spring, branches = self.prony
        parts = [] if spring is None else [with_unit("stiffness", spring, motion)]
        for branch in branches:
            mu, eta = map(with_unit, ("branch_stiffness", "branch_damping"), branch, (motion, motion))
            parts.append(f"({mu} in series with {eta})")
        beside = " beside ".join(parts)
        return f"{self.kind}, {beside}, discretization {self.discretization}{never_pulls(self.clamped)}"


def _acts(branch: Branch) -> bool:
    """False when the branch transmits no force, whatever its uncertain value."""
    return all(ends(value) != (Fraction(0), Fraction(0)) for value in branch)


@dataclass(frozen=True)
class StandardLinearSolid(Solid):
    """A spring with one Maxwell branch beside it, ``H(s) = μ0 + μ1 η1 s/(μ1 + η1 s)``.

    A step of depth 1 is answered with μ0 + μ1 at first, relaxing to μ0.

    Parameters
    ----------
    stiffness
        μ0 ≥ 0 [N/m; N·m/rad].
    branch_stiffness
        μ1 ≥ 0 [N/m; N·m/rad]; with 0 the solid is a spring.
    branch_damping
        η1, of either sign [N·s/m; N·m·s/rad]; with 0 the solid is a spring.  A negative
        one makes H(s) unstable.
    discretization
        "backward" (default), "forward", "tustin", "zoh", "impulse" or "matched".
    clamped
        True for a solid that never pulls: a force below 0 is given as 0. Default False.

    Raises
    ------
    InputError
        If a stiffness is negative, the discretization is unknown, or clamped is not a bool.

    Notes
    -----
    For μ1, η1 > 0 the loop without delay is passive iff b ≥ μ0 T/2 + μ1 η1 T/(2 η1 + μ1 T) with backward
    Euler, and b ≥ (μ0 + μ1) T/2 with Tustin's rule.
    """

    stiffness: Uncertain = parameter("stiffness", bound="≥ 0", why=NEGATIVE_SPRING)
    branch_stiffness: Uncertain = parameter("branch_stiffness", bound="≥ 0", why=NEGATIVE_SPRING)
    branch_damping: Uncertain = parameter("branch_damping")
    discretization: Discretization = discretized_by("backward")
    clamped: bool = clamping()

    kind = "standard linear solid"
    branch_numbers = ("branch_stiffness", "branch_damping")

    @property
    def prony(self) -> tuple[Exact | Interval, tuple[Branch, ...]]:
        return self.stiffness, ((self.branch_stiffness, self.branch_damping),)

    def decided_by_corners(self, box: Box) -> bool:
        """For the spring μ0, which enters H linearly; without delay for a branch ≥ 0, backward or Tustin.

        The required damping is then μ0T/2 + μ1η1T/(2η1+μ1T), or (T/2)(μ0+μ1); ‖h‖₁ is
        μ0 + 2μ1η1/(μ1T+η1), or μ0 + μ1 max(1, 4η1/(μ1T+2η1)).
        """
        if box.of_law <= {"stiffness"} and not box.of_timing:
            return True
        is_positive = min(ends(self.branch_stiffness)[0], ends(self.branch_damping)[0]) >= 0
        return box.is_undelayed and is_positive and self.discretization in ("backward", "tustin")


@dataclass(frozen=True)
class GeneralizedMaxwell(Solid):
    """A spring with Maxwell branches beside it, ``H(s) = μ0 + Σ μᵢ ηᵢ s/(μᵢ + ηᵢ s)``.

    Its relaxation is the Prony series μ0 + Σ μᵢ exp(−t μᵢ/ηᵢ).

    Parameters
    ----------
    stiffness
        μ0 ≥ 0 [N/m; N·m/rad].
    branches
        Pairs (μᵢ, ηᵢ): μᵢ ≥ 0 [N/m; N·m/rad], ηᵢ of either sign [N·s/m; N·m·s/rad]; at most 60 of them.
    discretization
        "backward" (default), "forward", "tustin", "zoh", "impulse" or "matched".
    clamped
        True for a solid that never pulls: a force below 0 is given as 0. Default False.

    Raises
    ------
    InputError
        If a stiffness is negative, a branch is not a pair, the discretization is unknown, or
        clamped is not a bool.
    """

    stiffness: Uncertain = parameter("stiffness", bound="≥ 0", why=NEGATIVE_SPRING)
    branches: Reads[tuple[Branch, ...], Iterable[Sequence[Given]]] = part(
        "branches", _branches, meaning="pairs of branch stiffness and branch damping"
    )
    discretization: Discretization = discretized_by("backward")
    clamped: bool = clamping()

    kind = "generalized Maxwell"
    branch_numbers = ("branches[{}] stiffness", "branches[{}] damping")

    @property
    def prony(self) -> tuple[Exact | Interval, tuple[Branch, ...]]:
        return self.stiffness, self.branches

    def scaled(self, factor: Fraction) -> Self:
        branches = [(times(mu, factor), times(eta, factor)) for mu, eta in self.branches]
        return super().scaled(factor).replace(branches=branches)

    def decided_by_corners(self, box: Box) -> bool:
        """For the spring μ0, which enters H linearly."""
        return box.of_law <= {"stiffness"} and not box.of_timing

    def side_by_side(self) -> tuple[Environment, ...]:
        """Spring and branches, but for the matched rule, which matches their sum.

        Multiplied out, slow branches would lose each other's digits.
        """
        if self.discretization == "matched":
            return (self,)
        branches = (
            Maxwell(stiffness=mu, damping=eta, discretization=self.discretization)
            for mu, eta in self.branches
        )
        return (Wall(stiffness=self.stiffness), *branches)


@dataclass(frozen=True)
class Maxwell(Solid):
    """A spring and a dashpot in series, ``H(s) = μ η s/(μ + η s)``: a viscoelastic fluid.

    Parameters
    ----------
    stiffness
        μ ≥ 0 [N/m; N·m/rad].
    damping
        η, of either sign [N·s/m; N·m·s/rad]; 0 transmits no force, a negative one makes H(s) unstable.
    discretization
        "backward" (default), "forward", "tustin", "zoh", "impulse" or "matched".
    clamped
        True for a solid that never pulls: a force below 0 is given as 0. Default False.

    Raises
    ------
    InputError
        If the stiffness is negative, the discretization is unknown, or clamped is not a bool.
    """

    stiffness: Uncertain = parameter("stiffness", bound="≥ 0", why=NEGATIVE_SPRING)
    damping: Uncertain = parameter("virtual_damping")
    discretization: Discretization = discretized_by("backward")
    clamped: bool = clamping()

    kind = "Maxwell body"
    branch_numbers = ("stiffness", "damping")
    spring = rests_on_spring = False

    @property
    def prony(self) -> tuple[None, tuple[Branch, ...]]:
        return None, ((self.stiffness, self.damping),)
