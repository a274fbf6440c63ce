"""Which virtual coupling for this device: the stiffest, or the nearest to a wanted one.

With κ = K_c T and s = K_c T + 2 B_c the need of a coupling (`coupling`) is

    max over θ of ½ F(θ) [s sin²(θ/2) + (κ²/s) cos²(θ/2)]

convex in (κ, s) and proportional to them: what a device can render before every
passive environment is a convex cone's section, and a best coupling in it is the
best one.  Without delay it is the triangle K_c T/2 + B_c ≤ b, and

    stiffest             K_c = 2b/T,  B_c = 0
    nearest to (K, B)    K_c = min(K, 2b/T),  B_c = min(B, b − K_c T/2)

with (1 − margin) b for b.  With one sample of delay the stiffest has
K_c = 4b/(3√3 T), B_c = ((√3 − 1)/2) K_c T: virtual damping buys stiffness there.
Other delays are optimised numerically over κ/s.  Derived for this project.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import Any, Literal

import numpy as np
from numpy.polynomial import chebyshev
from scipy.optimize import minimize_scalar

from zwidth.errors import InputError
from zwidth.model.device import Device
from zwidth.model.device.instead import instead_of_device
from zwidth.model.environment import BackwardDifference, Wall
from zwidth.model.environment.environment import Environment, certain
from zwidth.model.environment.wall import wall_of
from zwidth.model.rendering import VirtualCoupling
from zwidth.passivity.check import check
from zwidth.passivity.coupling.coupling import CouplingCondition, coupling_condition
from zwidth.passivity.formulas.colgate_stanley_brown import needed_damping
from zwidth.passivity.formulas.hypotheses import number
from zwidth.passivity.result import Result, share_left
from zwidth.passivity.scope import Scope
from zwidth.passivity.verdict import Verdict
from zwidth.quantity.answered import answers, known
from zwidth.quantity.exact import Exact, RealLike
from zwidth.quantity.text import shown, told_quantity
from zwidth.showing import Part, Table

Goal = Literal["stiffest"] | Wall

Edge = Callable[[float], tuple[float, float]]
"""κ/s → (κ, s) on the edge of what the device can render [N·s/m]."""

_RATIOS = 400
"""Values of κ/s among which the nearest coupling is looked for, before it is refined."""


@dataclass(frozen=True, repr=False)
class CouplingDesign(Result):
    """A virtual coupling made for a device."""

    _FORMAT = "zwidth coupling design 1"

    device: Device = known("the one it is for")
    stiffness: Exact = known("K_c", quantity="stiffness")
    damping: Exact = known("B_c", quantity="damping")
    condition: CouplingCondition = known(
        "that it is passive before every passive environment, on an ideal encoder, with the certificate"
    )

    @property
    def coupling(self) -> Wall:
        """What is felt before a rigid environment: the wall of K_c and B_c."""
        return Wall(self.stiffness, self.damping)

    @cached_property
    def verdict(self) -> Verdict:
        """`zw.check` of that wall on the device as it is, with its encoder and Coulomb friction."""
        return check(self.device, self.coupling)

    @property
    @answers(key="felt_slowly_stiffness", quantity="stiffness")
    def felt_slowly(self) -> float:
        """|Z_c| towards 0 Hz, the most that slow motions meet: K_c [N/m; N·m/rad]."""
        return float(self.stiffness)

    @property
    @answers(key="felt_quickly_stiffness", quantity="stiffness")
    def felt_quickly(self) -> float:
        """|Z_c| at half the rate: K_c + 2 B_c/T [N/m; N·m/rad]."""
        period = self.device.exact("sample_period")
        return float(abs(self.stiffness.fraction + 2 * self.damping.fraction / period))

    @property
    @answers()
    def margin(self) -> float:
        """The part of the device damping that is left, (b − need)/b."""
        left = share_left(self.condition.required_damping, float(self.device.exact("damping")))
        assert left is not None, "a design has a need"
        return left

    def before(self, environment: Environment | Any) -> VirtualCoupling:
        """The coupling with an environment behind it."""
        return self.condition.before(environment)

    def rows(self) -> list[tuple[str, str]]:
        """The main numbers as (name, text) for a report."""
        motion = self.device.motion
        rigid = self.verdict
        return [
            *self.condition.rows(),
            ("felt slowly", told_quantity(self.felt_slowly, "stiffness", motion)),
            ("felt at half the rate", told_quantity(self.felt_quickly, "stiffness", motion)),
            ("margin of damping", shown(self.margin, "%", 3)),
            ("before every passive environment", "passive" if self.condition.holds else "not proved"),
            ("before a rigid one, encoder and friction counted", rigid.outcome),
        ]

    @property
    def scope(self) -> Scope:
        """That of the condition."""
        return self.condition.scope

    def describe(self) -> str:
        """The numbers in a line."""
        return "; ".join(f"{name}: {text}" for name, text in self.rows())

    def to_dict(self) -> dict[str, Any]:
        """The condition on the coupling with its certificate, and what is felt, as plain data."""
        return {**self.condition.to_dict(), **super().to_dict()}

    def report(self) -> Iterable[Part]:
        """The numbers."""
        yield Table(rows=self.rows())


def design_coupling(device: Device, goal: Goal = "stiffest", margin: RealLike = 0.1) -> CouplingDesign:
    """A virtual coupling that is passive on this device before every passive environment.

    Among K_c, B_c ≥ 0 whose need is at most (1 − margin) b.  Without delay the stiffest
    is K_c = 2b (1 − margin)/T with B_c = 0, at every frequency; with a delay it has virtual damping.

    Parameters
    ----------
    device
        Certain b > 0, T and delay.
    goal
        "stiffest": the largest K_c.  Or a wanted `Wall(K, B)`, B ≥ 0: the coupling whose Z_c has the least
        mean square difference from it over the frequencies up to half the rate; the wanted one if it will do.
    margin
        Part of the damping that is left over, 0 ≤ margin < 1. Default 0.1.

    Raises
    ------
    InputError
        If b = 0, a number is outside its bound, a value is an interval or the goal is none of these.
    """
    if not isinstance(device, Device):
        raise InputError(f"the first argument is a Device, {instead_of_device(device)}")
    part = number("margin", margin)
    if not 0 <= part < 1:
        raise InputError(f"margin must be ≥ 0 and < 1, got {margin}: it is a part of the device damping")
    b, t = device.exact("damping") * (1 - part), device.exact("sample_period")
    if b == 0:
        raise InputError("damping is 0 N·s/m: a device without damping renders no coupling passively")
    wanted = None if goal == "stiffest" else _wanted(goal)
    if device.exact("delay") == 0:
        k, d = _undelayed(b, t, wanted)
    else:
        k, d = _delayed(device.replace(damping=Exact(b)), b, t, wanted)
    return CouplingDesign(device, Exact(k), Exact(d), coupling_condition(device, k, d))


def _wanted(goal: object) -> tuple[Fraction, Fraction]:
    wall = wall_of(goal)
    if wall is None or wall.clamped or wall.velocity_filter != BackwardDifference():
        raise InputError(
            f'goal is "stiffest" or a plain Wall(stiffness, damping), not clamped or filtered; got {goal!r}'
        )
    k, b = certain(wall.stiffness, "stiffness"), certain(wall.damping, "damping")
    if b < 0:
        raise InputError(f"damping of the goal must be ≥ 0, got {float(b):g}: less of it never asks for less")
    return k, b


def _undelayed(
    b: Fraction, t: Fraction, wanted: tuple[Fraction, Fraction] | None
) -> tuple[Fraction, Fraction]:
    if wanted is None:
        return 2 * b / t, Fraction(0)
    k = min(wanted[0], 2 * b / t)
    return k, min(wanted[1], b - k * t / 2)


def _delayed(
    device: Device, b: Fraction, t: Fraction, wanted: tuple[Fraction, Fraction] | None
) -> tuple[Fraction, Fraction]:
    """The best on the edge of the admissible region, drawn in until the exact condition holds."""
    if wanted is not None and coupling_condition(device, *wanted).holds:
        return wanted
    delay = device.exact("delay") / t

    def edge(ratio: float) -> tuple[float, float]:
        """(κ, s) where the need is b, at κ/s = ratio."""
        s = float(b) / _need(ratio, delay)
        return ratio * s, s

    ratio = _stiffest(edge) if wanted is None else _nearest(edge, wanted, float(t))
    kappa, s = edge(ratio)
    for inward in (0.0, 1e-14, 1e-12, 1e-9, 1e-6, 1e-3):
        k, d = (Exact(part * (1 - inward)).fraction for part in (kappa / float(t), max(s - kappa, 0.0) / 2))
        if coupling_condition(device, k, d).holds:
            return k, d
    raise AssertionError("the need is proportional to the coupling")


def _need(ratio: float, delay: Fraction) -> float:
    """The need at s = 1, κ = ratio."""
    r = Fraction(ratio)
    cosines = needed_damping(r, (1 - r) / 2, Fraction(1), delay)
    assert cosines is not None, "s = 1"
    series = np.array([float(a) for a in cosines])
    roots = chebyshev.chebroots(chebyshev.chebder(series)) if len(series) > 2 else np.array([])
    at = np.clip(np.concatenate((np.real(roots), [-1.0, 1.0])), -1, 1)
    return float(np.max(chebyshev.chebval(at, series)))


def _stiffest(edge: Edge) -> float:
    """κ along the edge of a convex region has one maximum."""
    found = minimize_scalar(lambda r: -edge(r)[0], bounds=(0, 1), method="bounded", options={"xatol": 1e-12})
    return float(max((found.x, 1.0), key=lambda r: edge(r)[0]))


def _nearest(edge: Edge, wanted: tuple[Fraction, Fraction], t: float) -> float:
    """The mean square of Z_c − Z over the frequencies is (δK + δB/T)² + (δB/T)²."""
    k, d = (float(part) for part in wanted)

    def distance(ratio: float) -> float:
        kappa, s = edge(ratio)
        stiffness, rate = kappa / t - k, (s - kappa) / (2 * t) - d / t
        return (stiffness + rate) ** 2 + rate**2

    ratios = np.linspace(0, 1, _RATIOS + 1)
    best = int(np.argmin([distance(r) for r in ratios]))
    low, high = ratios[max(best - 1, 0)], ratios[min(best + 1, _RATIOS)]
    found = minimize_scalar(distance, bounds=(low, high), method="bounded", options={"xatol": 1e-12})
    return float(min((found.x, ratios[best]), key=distance))
