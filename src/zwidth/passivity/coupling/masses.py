"""Which masses a body behind a virtual coupling may have, as its integrator steps it.

The loop is linear, and of its criterion the mass is a parameter: all masses at which the verdict may
change are roots of polynomials (`linear.critical_values`), and one mass between two of them decides for
all that lie there.  What is passive is closed: where a proof holds on both sides of a root it holds at it.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from itertools import pairwise
from math import inf, nextafter
from typing import Any, get_args

from zwidth.errors import InputError
from zwidth.model.device import Device
from zwidth.model.environment.bodies import POWER_OF_MASS, Body, CoupledBody, Integrator, stepped, times
from zwidth.model.environment.environment import RationalFunction
from zwidth.passivity.check import check_by_closed_forms
from zwidth.passivity.formulas.hypotheses import NEGATIVE_SPRING, nonnegative
from zwidth.passivity.linear.criterion import LinearProof, decide_linear
from zwidth.passivity.linear.critical_values import critical_values
from zwidth.passivity.linear.loop import linear_loop
from zwidth.passivity.linear_verdict import LinearVerdict
from zwidth.passivity.result import Result, evidence_of
from zwidth.passivity.scope import Scope, unit_key
from zwidth.passivity.witness.sinusoid import simplest_between
from zwidth.passivity.wording import lines
from zwidth.quantity.answered import answered, answers, known
from zwidth.quantity.exact import Exact, RealLike
from zwidth.quantity.parameter import one_of
from zwidth.quantity.text import from_to, quantity_unit, shown, told_quantity

_BESIDE = Fraction(1, 10**6)
"""How far beyond an end, relatively, a motion is looked for."""

_BETWEEN_ENDS = (
    "certificates are of the ends and of the body's own mass; that nothing changes between two ends is exact "
    "algebra of this program alone"
)


@dataclass(frozen=True)
class MassLimit:
    """One end of an interval of masses."""

    passive: LinearVerdict = known("the verdict at the end, with its certificate")
    beyond: LinearVerdict = known("the verdict at a mass a millionth beyond it, with what takes energy out")


@dataclass(frozen=True, repr=False)
class PassiveMasses(Result):
    """All masses of a body behind a coupling with which the loop is passive, single ones apart."""

    _FORMAT = "zwidth passive masses 1"

    device: Device = known("its encoder and Coulomb friction play no part")
    body: CoupledBody = known("coupling, body and integrator; `verdict` is about its own mass")
    intervals: tuple[tuple[float, float], ...] = answered(
        "(lightest, heaviest) of each interval, ascending: 0 where none is too light, without bound (null) "
        "where none is too heavy; empty where no mass is passive",
        quantity="virtual_mass",
        key="intervals_virtual_mass",
        finite=True,
    )

    @property
    def smallest(self) -> float | None:
        """The lightest passive mass [kg; kg·m²]; None where there is none."""
        return self.intervals[0][0] if self.intervals else None

    @property
    def largest(self) -> float | None:
        """The heaviest passive mass [kg; kg·m²], inf where none is too heavy; None where there is none."""
        return self.intervals[-1][1] if self.intervals else None

    @cached_property
    def limits(self) -> tuple[MassLimit, ...]:
        """Each end that is a mass, ascending: a proof at it, a violation beyond it."""
        return tuple(self._limits())

    @cached_property
    def verdict(self) -> LinearVerdict:
        """Of the body's own mass."""
        return _verdict(_ideal(self.device), self.body)

    @property
    def scope(self) -> Scope:
        """Every hand, on an exact position."""
        counted = self.device.exact("resolution")
        return replace(self.verdict.scope, encoder="not counted") if counted else self.verdict.scope

    @property
    @answers()
    def assumptions(self) -> tuple[str, ...]:
        """What is taken for granted, line by line."""
        return (*lines(self.scope), _BETWEEN_ENDS)

    def describe(self) -> str:
        """The masses in a sentence."""
        return f"passive {self._masses()}: {self.body.describe(self.device.motion)}"

    def rows(self) -> list[tuple[str, str]]:
        """The intervals, and what proves and refutes at their ends."""
        rows = [("passive masses", self._masses())]
        for limit in self.limits:
            at, past = (
                told_quantity(_mass(verdict), "virtual_mass", self.device.motion)
                for verdict in (limit.passive, limit.beyond)
            )
            rows.append((f"at {at}", f"{limit.passive.outcome}, {limit.passive.limit}"))
            rows.append((f"at {past}, a millionth beyond", limit.beyond.outcome))
        return rows

    def to_dict(self) -> dict[str, Any]:
        """The intervals, and at each end its proof and violation, as plain data."""
        key = unit_key("virtual_mass", self.device.motion)
        both = (verdict for limit in self.limits for verdict in (limit.passive, limit.beyond))
        return {
            **super().to_dict(),
            "body": self.body.describe(self.device.motion),
            "verdicts": [_stated(verdict, key) for verdict in (self.verdict, *both)],
        }

    def _masses(self) -> str:
        unit = quantity_unit("virtual_mass", self.device.motion)
        if not self.intervals:
            return "for no mass"
        return " and ".join(_span(low, high, unit) for low, high in self.intervals)

    def _limits(self) -> Iterator[MassLimit]:
        for interval in self.intervals:
            for end, outward in zip(interval, (-1, 1), strict=True):
                if 0 < end < inf:
                    mass = Exact(end).fraction
                    both = (mass, mass * (1 + outward * _BESIDE))
                    yield MassLimit(*(_verdict(_ideal(self.device), _with(self.body, m)) for m in both))


def passive_masses(device: Device, body: CoupledBody) -> PassiveMasses:
    """All masses with which this body, stepped so, is passive behind its coupling.

    Exactly: the criterion of `zwidth.check` is decided between all masses at which it can change.

    Parameters
    ----------
    device
        Certain b, T and delay; the answer is for an ideal encoder.
    body
        Coupling, body and integrator; its own mass is where `verdict` is about.

    Raises
    ------
    InputError
        If it is no such body, a number of the device is an interval, or delays are too long to be decided.

    Notes
    -----
    Behind a spring alone a free body by an explicit integrator is passive with no mass, however much the
    device damps.  Derived for this project; that explicit integrators ask for a least mass is said by Brown &
    Colgate (1997, 1998).
    """
    if not isinstance(device, Device) or not isinstance(body, CoupledBody):
        raise InputError(
            "passive_masses(device, body) takes a Device and a CoupledBody, "
            f"got {type(device).__name__} and {type(body).__name__}"
        )
    ideal = _ideal(device)
    found: list[tuple[Fraction, Fraction | None]] = []
    for low, high in pairwise([Fraction(0), *_critical(ideal, body), None]):
        assert low is not None, "only the last is none"
        if _holds(ideal, body, _between(low, high)):
            joined = found and found[-1][1] == low
            found = [*found[:-1], (found[-1][0], high)] if joined else [*found, (low, high)]
    intervals = (
        (_edge(ideal, body, low, inf) if low else 0.0, inf if high is None else _edge(ideal, body, high, 0.0))
        for low, high in found
    )
    return PassiveMasses(device, body, tuple(intervals))


def _ideal(device: Device) -> Device:
    """The device with an ideal encoder and no Coulomb friction."""
    return device.replace(resolution=0, coulomb_friction=0, stiction=None)


def _critical(device: Device, body: CoupledBody) -> list[Fraction]:
    """Masses at which the verdict may change."""
    period = device.exact("sample_period")

    def law(mass: Fraction) -> RationalFunction:
        h = _with(body, mass).pulse_transfer_function(period)
        return RationalFunction(*(times(mass**POWER_OF_MASS, side) for side in h))

    scale = (body.damping.fraction or body.stiffness.fraction * period or device.exact("damping")) * period
    return critical_values(law, POWER_OF_MASS + 1, linear_loop(device, body), scale or period)


def _with(body: CoupledBody, mass: Fraction) -> CoupledBody:
    return body.replace(virtual_mass=Exact(mass))


def _holds(device: Device, body: CoupledBody, mass: Fraction) -> bool:
    return isinstance(decide_linear(linear_loop(device, _with(body, mass))), LinearProof)


def _verdict(device: Device, body: CoupledBody) -> LinearVerdict:
    verdict = check_by_closed_forms(device, body)
    assert isinstance(verdict, LinearVerdict), "H(z) says all about it"
    return verdict


def _span(low: float, high: float, unit: str) -> str:
    if high == inf:
        return "for every mass" if low == 0 else f"from {shown(low, unit, 6)} on"
    return f"up to {shown(high, unit, 6)}" if low == 0 else f"from {from_to(low, high, unit, 6)}"


def _stated(verdict: LinearVerdict, key: str) -> dict[str, Any]:
    return {
        key: _mass(verdict),
        "outcome": verdict.outcome,
        "claim": verdict.claim,
        "scope": verdict.scope.to_dict(),
        **evidence_of(verdict),
    }


def _mass(verdict: LinearVerdict) -> float:
    assert isinstance(verdict.environment, CoupledBody)
    return float(verdict.environment.virtual_mass)


def _between(low: Fraction, high: Fraction | None) -> Fraction:
    """A mass with few digits well inside an interval."""
    if high is None:
        high = 3 * low or Fraction(3)
    third = (high - low) / 3
    return simplest_between(low + third, high - third)


def _edge(device: Device, body: CoupledBody, root: Fraction, inward: float) -> float:
    """The double next to a root, on the inner side, at which the loop is proved passive."""
    mass = float(root)
    while not _holds(device, body, Exact(mass).fraction):
        mass = nextafter(mass, inward)
    return mass


# How much damping a coupling needs before heavy bodies.
#
#     B_c ≥ φ κ + min(g² κ²/(4b), g κ/2),    κ = K_c T,    g = ½ + δ − φ,    φ = φ₀ + 2d
#
# without the minimum, g² κ²/(4b), for g ≤ 0; δ is the device's delay and d that of an exchange each way, in
# samples.  φ₀ says how late the position is: 1 by forward, −1 by backward Euler, ½ where a held force is
# integrated, −½ by the implicit midpoint, 0 by semi-implicit Euler, Verlet's and the trapezoidal rule.
# Derived for this project.


def heavy_body_damping(
    device: Device,
    stiffness: RealLike,
    integrator: Integrator = "semi-implicit-euler",
    exchange_delay: RealLike = 0,
) -> Exact:
    """The coupling damping B_c that every heavy free body asks for behind a spring K_c [N·s/m; N·m·s/rad].

    With more of it, and more b than the wall of K_c and B_c needs, all bodies from some mass on are passive;
    with less no heavy one is.  Without delay, by semi-implicit Euler, it is (K_c T)²/(16 b).

    Parameters
    ----------
    device
        Certain b > 0 and T, a delay of whole samples; the answer is for an ideal encoder.
    stiffness
        K_c ≥ 0 [N/m; N·m/rad].
    integrator
        As of `CoupledBody`.
    exchange_delay
        Samples each way to the process of the body, ≥ 0.

    Raises
    ------
    InputError
        If a number is outside its bound or an interval, or the delay is no whole number of samples.
    """
    one_of("integrator", integrator, *get_args(Integrator))
    b, t = device.exact("damping"), device.exact("sample_period")
    delta = device.exact("delay") / t
    if b == 0 or delta.denominator != 1:
        raise InputError(
            "heavy_body_damping is for a device with damping and a delay of whole samples, got "
            f"{float(b):g} and {float(delta):g} samples; ask passive_masses"
        )
    kappa = nonnegative("stiffness", stiffness, NEGATIVE_SPRING) * t
    lag = _lag(integrator) + 2 * nonnegative(
        "exchange_delay", exchange_delay, "a message cannot come early", "delay"
    )
    lead = Fraction(1, 2) + delta - lag
    tuned = lead**2 * kappa**2 / (4 * b)
    return Exact(max(lag * kappa + (min(tuned, lead * kappa / 2) if lead > 0 else tuned), Fraction(0)))


def _lag(integrator: Integrator) -> Fraction:
    """φ₀ = 1 − the mean power of z in M (z − 1)² Y/T² of a free body."""
    position = stepped(integrator, Body(Fraction(1), Fraction(0), Fraction(0), Fraction(1))).position
    mean = sum((i * c for i, c in enumerate(reversed(position))), Fraction(0)) / sum(position)
    return 1 - mean
